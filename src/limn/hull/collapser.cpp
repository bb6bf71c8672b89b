#include "limn/hull/collapser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/parallel.h"

namespace limn {
namespace {

// Of placements that add the same volume, how much nearer to the edge's middle one must lie to be taken (docs/hull.md).
constexpr double kTie = 0.005;
// Volume of edge length cubed that a collapse is charged besides: short edges go first where volumes say little.
constexpr double kShape = 0.0033;
// Normals are kept as floats, and placements have a tolerance: how far outside of the planes to aim, in edge lengths.
constexpr double kAim = 2e-6;
constexpr std::size_t kGrain = 512;
// Added to the births of a vertex that is gone: no candidate of its edges fits any more.
constexpr std::uint32_t kDead = 0x40000000u;

/// Spacing of floats about the two points and as far away as a vertex may go, halved.
double half_spacing(const DVec3& a, const DVec3& b, double reach) {
  const DVec3 largest = glm::max(glm::abs(a), glm::abs(b));
  return (largest.x + largest.y + largest.z + 3.0 * reach) * 0x1.0p-24 + 0x1.0p-148;
}

}  // namespace

Collapser::Collapser(RingSurface& surface, std::vector<HullStep>& log, Certificate& certificate, StepGuard* guard)
    : surface_(surface),
      log_(log),
      certificate_(certificate),
      guard_(guard),
      born_(surface.vertex_count(), 0),
      touched_(surface.vertex_count(), 0) {}

void Collapser::offer_all() {
  queue_.clear();
  std::vector<Candidate> edges;
  for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
    for (const RingLink& link : surface_.ring(v)) {
      if (v < link.vertex) edges.push_back({v, link.vertex, 0, 0, Vec3(0), -1.0f});
    }
  }
  parallel_for(edges.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Workspace workspace;
    for (std::size_t i = begin; i < end; ++i) {
      Candidate candidate;
      const bool placed = place(edges[i].a, edges[i].b, workspace, candidate);
      if (placed) edges[i] = candidate;
      surface_.set_cost(candidate.a, candidate.b, placed ? candidate.cost : -1.0f);
    }
  });
  counts_.programs += edges.size();
  for (const Candidate& candidate : edges) {
    if (candidate.cost >= 0.0f) {
      queue_.push(candidate);
    } else {
      ++counts_.infeasible;
    }
  }
}

void Collapser::offer_around(std::span<const VertexId> vertices) {
  born_.resize(surface_.vertex_count(), 0);
  touched_.resize(surface_.vertex_count(), 0);
  for (const VertexId v : vertices) {
    if (!surface_.alive(v)) {
      born_[v] |= kDead;
      continue;
    }
    ++born_[v];
    ++touched_[v];
    for (const RingLink& link : surface_.ring(v))
      ++touched_[link.vertex];
  }
  for (const VertexId v : vertices) {
    for (const RingLink& link : surface_.ring(v)) {
      if (link.cost < 0.0f || surface_.live_faces() <= eager_from_) {
        offer(v, link.vertex);
      } else {
        // Costs seldom fall: the last one says soon enough when to look again.
        queue_.push({v, link.vertex, born_[v] + born_[link.vertex], touched_[v] + touched_[link.vertex] - 1, Vec3(0),
                     link.cost});
      }
    }
  }
}

void Collapser::offer(VertexId a, VertexId b) {
  Candidate candidate;
  ++counts_.programs;
  const bool placed = place(a, b, workspace_, candidate);
  surface_.set_cost(a, b, placed ? candidate.cost : -1.0f);
  if (placed) {
    queue_.push(candidate);
  } else {
    ++counts_.infeasible;
  }
}

/// The faces around an edge: first those around a. \return how many those are
std::size_t Collapser::gather(VertexId a, VertexId b, std::vector<FaceId>& faces) const {
  const std::span<const RingLink> ring_a = surface_.ring(a);
  const std::span<const RingLink> ring_b = surface_.ring(b);
  if (faces.size() < ring_a.size() + ring_b.size()) faces.resize(2 * (ring_a.size() + ring_b.size()));
  FaceId left = kInvalidId, right = kInvalidId;
  FaceId* end = faces.data();
  FaceId last = ring_a.back().face;
  for (const RingLink& link : ring_a) {
    *end++ = link.face;
    left = link.vertex == b ? link.face : left;
    right = link.vertex == b ? last : right;
    last = link.face;
  }
  for (const RingLink& link : ring_b) {
    *end = link.face;
    end += link.face != left && link.face != right ? 1 : 0;
  }
  return static_cast<std::size_t>(end - faces.data());
}

bool Collapser::place(VertexId a, VertexId b, Workspace& workspace, Candidate& candidate) const {
  const DVec3 at_a(surface_.position(a));
  const DVec3 at_b(surface_.position(b));
  const DVec3 along = at_b - at_a;
  const double length = glm::length(along);
  candidate = {a, b, born_[a] + born_[b], touched_[a] + touched_[b], surface_.position(a), 0.0f};
  if (length == 0.0) return true;  // nothing moves
  const double inverse = 1.0 / length;
  const auto margin = static_cast<float>(half_spacing(at_a, at_b, reach_ * length) * inverse + kAim);
  const std::size_t count = gather(a, b, workspace.faces);
  PlacementPlanes& planes = workspace.planes;
  planes.set(surface_.planes(), std::span(workspace.faces).first(count), surface_.degree(a),
             Vec3(along * (0.5 * inverse)), margin);
  const DVec3 gradient = planes.gradient();
  const double steepness = glm::length(gradient);
  if (!(steepness > 0.0)) return false;
  DVec3 x;
  if (!nearest_point(planes, gradient * (-1.0 / (kTie * steepness)), x)) return false;
  if (glm::dot(x, x) > reach_ * reach_) return false;
  candidate.position = Vec3(0.5 * (at_a + at_b) + x * length);
  const double scaled = length * surface_.scale();
  candidate.cost = static_cast<float>(planes.volume3(x, margin) * scaled / 3.0 + kShape * scaled * scaled * scaled);
  return is_finite(candidate.position);
}

bool Collapser::folds(VertexId v, VertexId skip, const Vec3& position) const {
  const std::span<const RingLink> ring = surface_.ring(v);
  const DVec3 apex(position);
  RingLink last = ring.back();
  for (const RingLink& link : ring) {
    if (last.vertex != skip && link.vertex != skip) {
      const DVec3 normal =
          glm::cross(DVec3(surface_.position(last.vertex)) - apex, DVec3(surface_.position(link.vertex)) - apex);
      const FacePlane& old = surface_.plane(last.face);
      if (old.area > 0.0f && !(glm::dot(normal, DVec3(old.normal)) > 0.0)) return true;
    }
    last = link;
  }
  return false;
}

bool Collapser::take(const Candidate& c) {
  if (folds(c.a, c.b, c.position) || folds(c.b, c.a, c.position)) {
    ++counts_.folded;
    return false;
  }
  Certificate certificate;
  if (!is_outside_faces(surface_, c.a, kInvalidId, c.position, certificate) ||
      !is_outside_faces(surface_, c.b, c.a, c.position, certificate)) {
    ++counts_.refused;
    return false;
  }
  const HullStep step = surface_.collapse_step(c.a, c.b, c.position);
  if (guard_ != nullptr && !guard_->allows(surface_, step)) {
    ++counts_.guarded;
    return false;
  }
  surface_.apply(step);
  if (guard_ != nullptr) guard_->taken(surface_, step);
  certificate_.add(certificate);
  log_.push_back(step);
  return true;
}

/// Places a popped edge again where a face around it has changed; false where it is not the next any more, or gone.
bool Collapser::refresh(Candidate& c) {
  if (born_[c.a] + born_[c.b] != c.born) return false;
  if (touched_[c.a] + touched_[c.b] == c.touched) return true;
  ++counts_.programs;
  const bool placed = place(c.a, c.b, workspace_, c);
  surface_.set_cost(c.a, c.b, placed ? c.cost : -1.0f);
  if (!placed) {
    ++counts_.infeasible;
    return false;
  }
  if (queue_.is_next(c.cost)) return true;
  queue_.push(c);
  return false;
}

Collapser::Outcome Collapser::step() {
  while (!queue_.empty()) {
    edge_ = queue_.pop();
    if (!refresh(edge_)) continue;
    if (!surface_.can_collapse(edge_.a, edge_.b)) {
      ++counts_.linked;
      return Outcome::kLinked;
    }
    if (!take(edge_)) continue;
    offer_around(std::array{edge_.a, edge_.b});
    return Outcome::kCollapsed;
  }
  return Outcome::kExhausted;
}

}  // namespace limn
