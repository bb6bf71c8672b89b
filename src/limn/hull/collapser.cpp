#include "limn/hull/collapser.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "limn/base/orient3d.h"

namespace limn {
namespace {
double env(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; }
const double kEps = env("EPS", 0.1);
const double kReach = env("REACH", 1e9);
const double kShape = env("SHAPE", 0);
constexpr double kTolerance = 1e-7;
constexpr double kFloat = 4e-7;
}  // namespace

Collapser::Collapser(RingSurface& surface) : surface_(surface), born_(surface.vertex_count(), 0), touched_(surface.vertex_count(), 0) {}

void Collapser::fill() {
  for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
    for (const RingLink& link : surface_.ring(v)) {
      if (v < link.vertex) offer(v, link.vertex);
    }
  }
}

void Collapser::offer(VertexId a, VertexId b) {
  Candidate candidate;
  if (evaluate(a, b, candidate)) queue_.push(candidate);
}

bool Collapser::evaluate(VertexId a, VertexId b, Candidate& candidate) {
  ++counts_.programs;
  const double scale = surface_.scale();
  const DVec3 pa(surface_.position(a)), pb(surface_.position(b));
  const DVec3 middle = 0.5 * (pa + pb);
  const DVec3 half = (pb - pa) * (0.5 * scale);
  const double h = 2.0 * glm::length(half);
  const DVec3 ulp = (glm::max(glm::abs(pa), glm::abs(pb)) * scale + 4.0 * h) * 0x1.0p-24 + scale * 0x1.0p-149;
  planes_.clear();
  weights_.clear();
  base_.clear();
  DVec3 gradient(0.0);
  const auto add = [&](const FacePlane& plane, const DVec3& point) {
    const DVec3 n(plane.normal);
    const double base = glm::dot(n, point);
    gradient += n * double{plane.area};
    if (plane.area > 0.0f) planes_.add(n, base + glm::dot(glm::abs(n), ulp) + kFloat * h);
    else return;
    weights_.push_back(plane.area);
    base_.push_back(base);
  };
  FaceId left = kInvalidId, right = kInvalidId;
  const auto ring_a = surface_.ring(a);
  for (std::size_t i = 0; i < ring_a.size(); ++i) {
    add(surface_.plane(ring_a[i].face), -half);
    if (ring_a[i].vertex == b) {
      left = ring_a[i].face;
      right = ring_a[i == 0 ? ring_a.size() - 1 : i - 1].face;
    }
  }
  for (const RingLink& link : surface_.ring(b)) {
    if (link.face != left && link.face != right) add(surface_.plane(link.face), half);
  }
  const double g = glm::length(gradient);
  if (!(g > 0.0)) return false;
  DVec3 x;
  if (!nearest_point(planes_, gradient * (-h / (kEps * g)), kTolerance * h, x)) {
    ++counts_.infeasible;
    return false;
  }
  if (glm::dot(x, x) > kReach * kReach * h * h) return false;
  double cost = 0.0;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const DVec3 n = planes_.normal(i);
    cost += weights_[i] * std::max(0.0, glm::dot(n, x) - base_[i]);
  }
  cost += kShape * h * h * h;
  candidate = {a, b, born_[a] + born_[b], touched_[a] + touched_[b], Vec3(middle + x / scale), static_cast<float>(cost / 3.0)};
  return is_finite(candidate.position);
}

bool Collapser::certify(VertexId v, VertexId skip, const Vec3& position, double& margin) {
  const auto ring = surface_.ring(v);
  const Vec3 pv = surface_.position(v);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const VertexId x = ring[i].vertex, y = ring[i + 1 == ring.size() ? 0 : i + 1].vertex;
    if (x == skip || y == skip) continue;
    const Vec3 px = surface_.position(x), py = surface_.position(y);
    if (orient3d(pv, px, py, position) < 0) return false;
    ++counts_.certified;
    const DVec3 n = glm::cross(DVec3(px) - DVec3(pv), DVec3(py) - DVec3(pv));
    const double l = glm::length(n);
    if (l > 0) margin = std::min(margin, glm::dot(n, DVec3(position) - DVec3(pv)) / l);
  }
  return true;
}

bool Collapser::folds(VertexId v, VertexId skip, const Vec3& position) {
  const auto ring = surface_.ring(v);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const VertexId x = ring[i].vertex, y = ring[i + 1 == ring.size() ? 0 : i + 1].vertex;
    if (x == skip || y == skip) continue;
    const DVec3 n = glm::cross(DVec3(surface_.position(x)) - DVec3(position), DVec3(surface_.position(y)) - DVec3(position));
    if (!(glm::dot(n, DVec3(surface_.plane(ring[i].face).normal)) > 0)) return true;
  }
  return false;
}

bool Collapser::attempt(const Candidate& c, HullStep& done) {
  if (!surface_.can_collapse(c.a, c.b)) { ++counts_.topology; return false; }
  if (folds(c.a, c.b, c.position) || folds(c.b, c.a, c.position)) { ++counts_.folds; return false; }
  double margin = counts_.worst_margin;
  if (!certify(c.a, kInvalidId, c.position, margin) || !certify(c.b, c.a, c.position, margin)) { ++counts_.refused; return false; }
  counts_.worst_margin = margin;
  done = surface_.collapse_step(c.a, c.b, c.position);
  surface_.apply(done);
  ++born_[c.a];
  ++touched_[c.a];
  for (const RingLink& link : surface_.ring(c.a))
    ++touched_[link.vertex];
  return true;
}

bool Collapser::step(HullStep& done) {
  while (!queue_.empty()) {
    Candidate c = queue_.pop();
    ++counts_.popped;
    if (!surface_.alive(c.a) || !surface_.alive(c.b) || born_[c.a] + born_[c.b] != c.born) continue;
    if (touched_[c.a] + touched_[c.b] != c.touched) {
      ++counts_.stale;
      if (!evaluate(c.a, c.b, c)) continue;
      if (!queue_.is_next(c.cost)) { queue_.push(c); continue; }
    }
    if (!attempt(c, done)) continue;
    for (const RingLink& link : surface_.ring(c.a))
      offer(c.a, link.vertex);
    return true;
  }
  return false;
}

}  // namespace limn
