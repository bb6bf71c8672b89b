#include "limn/hull/part_surgery.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "limn/base/orient3d.h"
#include "limn/hull/placement.h"
#include "limn/hull/winding.h"

namespace limn {
namespace {

constexpr std::size_t kFollowed = 1 << 14;   // vertices that a waist's sides are followed over
constexpr std::size_t kFillable = 512;       // faces of a cavity that is tried to fill at once
constexpr std::size_t kCornerTries = 32;     // vertices of a cavity that are tried as the point it is seen from
constexpr std::size_t kSmallPart = 128;      // faces of a part that may go together with others
constexpr std::size_t kGroup = 64;           // parts that go together
constexpr std::size_t kBoxTests = 20000000;  // of one cleaning

double volume_of(const std::vector<Triangle>& faces, const RingSurface& surface) {
  double volume = 0.0;
  const DVec3 origin(surface.position(faces.front()[0]));
  for (const Triangle& face : faces) {
    const DVec3 a = DVec3(surface.position(face[0])) - origin;
    const DVec3 b = DVec3(surface.position(face[1])) - origin;
    const DVec3 c = DVec3(surface.position(face[2])) - origin;
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

template <class Body>
void for_each_face(const RingSurface& surface, VertexId v, const Body& body) {
  const std::span<const RingLink> ring = surface.ring(v);
  VertexId last = ring.back().vertex;
  for (const RingLink& link : ring) {
    body(last, link.vertex);
    last = link.vertex;
  }
}

}  // namespace

PartSurgery::PartSurgery(RingSurface& surface, std::vector<HullStep>& log, Certificate& certificate)
    : surface_(surface), log_(log), certificate_(certificate), marks_(surface.vertex_count(), 0) {}

/// Follows both sides of the triangle at once until the smaller ends or they meet.
PartSurgery::Beyond PartSurgery::beyond(VertexId a, VertexId b, VertexId c) {
  marks_.resize(surface_.vertex_count(), 0);
  const std::uint32_t right = mark_ += 2;  // marks of the left side are odd
  const std::span<const RingLink> ring = surface_.ring(a);
  const auto next_to = [&](VertexId v) { return ring[(surface_.find(a, v) + 1) % ring.size()].vertex; };
  std::array<std::vector<VertexId>, 2> side{std::vector<VertexId>{next_to(c)}, std::vector<VertexId>{next_to(b)}};
  if (side[0] == side[1]) return {};
  for (const VertexId v : {a, b, c})
    marks_[v] = 0;
  for (std::uint32_t s = 0; s < 2; ++s)
    marks_[side[s][0]] = right + s;
  for (std::size_t i = 0; i < kFollowed; ++i) {
    for (std::uint32_t s = 0; s < 2; ++s) {
      if (i == side[s].size()) return {true, s == 1, std::move(side[s])};
      for (const RingLink& link : surface_.ring(side[s][i])) {
        const VertexId v = link.vertex;
        if (v == a || v == b || v == c) continue;
        if (marks_[v] == right + 1 - s) return {};
        if (marks_[v] == right + s) continue;
        marks_[v] = right + s;
        side[s].push_back(v);
      }
    }
  }
  return {true, false, {}};
}

/// Of the smaller side, closed by the triangle.
double PartSurgery::volume_beyond(const Beyond& side, const Triangle& waist) const {
  std::vector<Triangle> faces;
  const std::uint32_t mark = marks_[side.vertices.front()];
  for (const VertexId v : side.vertices) {
    for_each_face(surface_, v, [&](VertexId x, VertexId y) {
      // Once a face: by the lowest of its vertices on this side.
      if ((marks_[x] == mark && x < v) || (marks_[y] == mark && y < v)) return;
      faces.push_back({v, x, y});
    });
  }
  faces.push_back(side.left ? Triangle{waist[0], waist[2], waist[1]} : waist);
  return volume_of(faces, surface_);
}

HullStep PartSurgery::cut(VertexId a, VertexId b, VertexId c, std::vector<VertexId>& changed) {
  const HullStep step = surface_.cut_step(a, b, c);
  surface_.apply(step);
  log_.push_back(step);
  ++cuts_;
  changed.insert(changed.end(), {a, b, c, step.right, step.right + 1, step.right + 2});
  return step;
}

bool PartSurgery::cut_waist(VertexId a, VertexId b, std::vector<VertexId>& changed) {
  const VertexId c = surface_.waist(a, b);
  if (c == kInvalidId) return false;
  const Beyond side = beyond(a, b, c);
  if (side.parts && (side.vertices.empty() || volume_beyond(side, {a, b, c}) > 0.0)) return false;
  const HullStep step = cut(a, b, c, changed);
  if (side.parts) dissolve(side.left ? a : step.right, changed);
  return true;
}

/// Fills a pocket that was parted off, or cuts it at its own waists and fills what can be.
void PartSurgery::dissolve(VertexId pocket, std::vector<VertexId>& changed) {
  std::vector<VertexId> open{pocket};
  while (!open.empty()) {
    const VertexId v = open.back();
    open.pop_back();
    if (!surface_.alive(v)) continue;
    const Part part = make_part(surface_.part_of(v));
    changed.insert(changed.end(), part.vertices.begin(), part.vertices.end());
    if (!fill(part)) cut_somewhere(part.vertices, open, changed);
  }
}

bool PartSurgery::cut_somewhere(const std::vector<VertexId>& part, std::vector<VertexId>& ends,
                                std::vector<VertexId>& changed) {
  for (const VertexId a : part) {
    for (const RingLink& link : surface_.ring(a)) {
      const VertexId b = link.vertex;
      const VertexId c = surface_.waist(a, b);
      if (c == kInvalidId) continue;
      const HullStep step = cut(a, b, c, changed);
      ends.insert(ends.end(), {step.right, a});
      return true;
    }
  }
  return false;
}

PartSurgery::Part PartSurgery::make_part(std::vector<VertexId> vertices) const {
  Part part{std::move(vertices)};
  for (const VertexId v : part.vertices) {
    for_each_face(surface_, v, [&](VertexId x, VertexId y) {
      if (v < x && v < y) part.faces.push_back({v, x, y});
    });
  }
  if (part.vertices.size() == 4) {
    const auto& [a, b, c] = part.faces.front();
    VertexId d = a;
    for (const VertexId v : part.vertices) {
      if (v != a && v != b && v != c) d = v;
    }
    part.positive_tetrahedron =
        orient3d(surface_.position(a), surface_.position(b), surface_.position(c), surface_.position(d)) < 0;
  }
  return part;
}

bool PartSurgery::is_star_from(const Part& part, const Vec3& point, Certificate& certificate) const {
  return std::all_of(part.faces.begin(), part.faces.end(), [&](const Triangle& face) {
    return is_outside_face(surface_.position(face[0]), surface_.position(face[1]), surface_.position(face[2]), point,
                           certificate);
  });
}

/// Where the whole inside of a cavity may be seen from.
std::vector<Vec3> PartSurgery::star_centers(const Part& part) const {
  std::vector<Vec3> centers;
  Bounds box;
  for (const VertexId v : part.vertices)
    box.add(surface_.position(v));
  const double size = box.diagonal();
  if (size > 0.0) {
    const DVec3 middle(box.center());
    PlacementPlanes planes;
    for (const Triangle& face : part.faces) {
      const DVec3 a(surface_.position(face[0]));
      const DVec3 normal = glm::cross(DVec3(surface_.position(face[1])) - a, DVec3(surface_.position(face[2])) - a);
      const double length = glm::length(normal);
      if (!(length > 0.0)) continue;
      planes.add(Vec3(normal / length), static_cast<float>(glm::dot(normal / length, (a - middle) / size) + 1e-6));
    }
    DVec3 x;
    if (nearest_point(planes, DVec3(0.0), x)) centers.emplace_back(middle + x * size);
  }
  for (std::size_t i = 0; i < std::min(part.vertices.size(), kCornerTries); ++i)
    centers.push_back(surface_.position(part.vertices[i]));
  return centers;
}

bool PartSurgery::fill(const Part& part) {
  if (part.faces.size() > kFillable || volume_of(part.faces, surface_) > 0.0) return false;
  for (const Vec3& center : star_centers(part)) {
    Certificate certificate;
    if (!is_star_from(part, center, certificate)) continue;
    certificate_.add(certificate);
    go(part, HullStep::Kind::kFill, center);
    ++filled_;
    return true;
  }
  return false;
}

void PartSurgery::go(const Part& part, HullStep::Kind kind, const Vec3& witness) {
  HullStep step;
  step.kind = kind;
  step.kept = part.vertices.front();
  step.before = surface_.position(step.kept);
  step.after = witness;
  surface_.apply(step);
  log_.push_back(step);
}

std::vector<PartSurgery::Part> PartSurgery::find_parts() {
  std::vector<Part> parts;
  marks_.resize(surface_.vertex_count(), 0);
  mark_ += 2;
  for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
    if (!surface_.alive(v) || marks_[v] == mark_) continue;
    std::vector<VertexId> vertices{v};
    marks_[v] = mark_;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (const RingLink& link : surface_.ring(vertices[i])) {
        if (marks_[link.vertex] == mark_) continue;
        marks_[link.vertex] = mark_;
        vertices.push_back(link.vertex);
      }
    }
    parts.push_back(make_part(std::move(vertices)));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.faces.size() < b.faces.size(); });
  return parts;
}

/// The part and what small parts lie about it, when the winding number of all the others is positive all over the box
/// around them; else none. Tetrahedra that wind outwards may be left out of account: they only raise it.
std::vector<std::size_t> PartSurgery::hidden_group(std::size_t first, const std::vector<Part>& parts) const {
  std::vector<std::size_t> group{first};
  std::vector<std::uint8_t> is_in(parts.size(), 0);
  is_in[first] = 1;
  Bounds box;
  for (std::size_t done = 0; done < group.size(); ++done) {
    for (const VertexId v : parts[group[done]].vertices)
      box.add(surface_.position(v));
    if (done + 1 < group.size()) continue;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& other = parts[i];
      if (is_in[i] != 0 || other.positive_tetrahedron || is_clear(box, other)) continue;
      if (other.faces.size() > kSmallPart || group.size() == kGroup) return {};
      is_in[i] = 1;
      group.push_back(i);
    }
  }
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (is_in[i] == 0 && !parts[i].positive_tetrahedron)
      faces.insert(faces.end(), parts[i].faces.begin(), parts[i].faces.end());
  }
  const VertexId v = parts[first].vertices.front();
  const std::optional<int> winding = winding_number(surface_.positions(), faces, surface_.position(v));
  if (!winding.has_value() || *winding <= 0) return {};
  return group;
}

bool PartSurgery::is_clear(const Bounds& box, const Part& part) const {
  return std::all_of(part.faces.begin(), part.faces.end(), [&](const Triangle& face) {
    return is_clear_of(box, surface_.position(face[0]), surface_.position(face[1]), surface_.position(face[2]));
  });
}

bool PartSurgery::clean(std::vector<VertexId>& changed) {
  std::vector<Part> parts = find_parts();
  const std::size_t steps = log_.size();
  const auto forget = [&](Part& part) {
    changed.insert(changed.end(), part.vertices.begin(), part.vertices.end());
    part.faces.clear();
    part.vertices.clear();
  };
  std::size_t tests = 0;
  for (std::size_t i = 0; i + 1 < parts.size() && tests < kBoxTests; ++i) {
    tests += surface_.live_faces();
    if (parts[i].faces.empty()) continue;
    if (fill(parts[i])) {
      forget(parts[i]);
      continue;
    }
    for (const std::size_t k : hidden_group(i, parts)) {
      go(parts[k], HullStep::Kind::kDrop, surface_.position(parts[k].vertices.front()));
      ++dropped_;
      forget(parts[k]);
    }
  }
  return log_.size() > steps;
}

}  // namespace limn
