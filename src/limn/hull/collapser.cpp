#include "limn/hull/collapser.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstdio>
#include <unordered_map>
#include <glm/geometric.hpp>

#include "limn/base/orient3d.h"

namespace limn {
namespace {
double env(const char* n, double d) { const char* s = std::getenv(n); return s ? std::atof(s) : d; }
const double kEps = env("EPS", 0.1);
const double kReach = env("REACH", 1e9);
const bool kCut = env("CUT", 1) != 0;
const bool kPockets = env("POCKETS", 1) != 0;
const double kBump = env("BUMP", 0);
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

/// Whether the surface falls apart when cut along the cycle.
bool Collapser::parts(VertexId a, VertexId b, VertexId c, std::vector<VertexId>* small, int* which) {
  std::vector<VertexId> side[2];
  std::unordered_map<VertexId, int> seen;
  const auto ring = surface_.ring(a);
  const std::uint32_t at_b = surface_.find(a, b), at_c = surface_.find(a, c);
  const auto n = static_cast<std::uint32_t>(ring.size());
  side[0].push_back(ring[(at_b + 1) % n].vertex);
  side[1].push_back(ring[(at_c + 1) % n].vertex);
  seen[side[0][0]] = 0;
  if (seen.count(side[1][0])) return false;
  seen[side[1][0]] = 1;
  std::size_t next[2] = {0, 0};
  while (seen.size() < 20000) {
    for (int s = 0; s < 2; ++s) {
      if (next[s] == side[s].size()) { if (small) { *small = side[s]; *which = s; } return true; }
      for (const RingLink& link : surface_.ring(side[s][next[s]++])) {
        if (link.vertex == a || link.vertex == b || link.vertex == c) continue;
        const auto [it, fresh] = seen.emplace(link.vertex, s);
        if (fresh) side[s].push_back(link.vertex);
        else if (it->second != s) return false;
      }
    }
  }
  return true;
}

double Collapser::part_volume(const std::vector<VertexId>& vs) {
  double volume = 0;
  const DVec3 o(surface_.position(vs[0]));
  for (const VertexId v : vs) {
    const auto ring = surface_.ring(v);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const VertexId x = ring[i].vertex, y = ring[i + 1 == ring.size() ? 0 : i + 1].vertex;
      if (v < x && v < y) volume += glm::dot(DVec3(surface_.position(v)) - o, glm::cross(DVec3(surface_.position(x)) - o, DVec3(surface_.position(y)) - o));
    }
  }
  return volume / 6;
}

bool Collapser::fill_pocket(const std::vector<VertexId>& vs) {
  // kernel
  const double scale = surface_.scale();
  DVec3 low(1e300), high(-1e300);
  for (VertexId v : vs) { low = glm::min(low, DVec3(surface_.position(v))); high = glm::max(high, DVec3(surface_.position(v))); }
  const DVec3 mid = 0.5 * (low + high);
  const double h = glm::length(high - low) * scale;
  planes_.clear();
  for (const VertexId v : vs) {
    const auto ring = surface_.ring(v);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const VertexId x = ring[i].vertex, y = ring[i + 1 == ring.size() ? 0 : i + 1].vertex;
      if (!(v < x && v < y)) continue;
      const FacePlane& p = surface_.plane(ring[i].face);
      if (p.area > 0) planes_.add(DVec3(p.normal), glm::dot(DVec3(p.normal), (DVec3(surface_.position(v)) - mid) * scale) + kFloat * h);
    }
  }
  DVec3 x;
  std::vector<Vec3> tries;
  if (nearest_point(planes_, DVec3(0.0), kTolerance * h, x)) tries.push_back(Vec3(mid + x / scale));
  if (vs.size() < 50) for (const VertexId v : vs) tries.push_back(surface_.position(v));
  double margin = counts_.worst_margin;
  bool good = false;
  for (const Vec3& p : tries) {
    good = true;
    for (const VertexId v : vs) if (!certify(v, kInvalidId, p, margin)) { good = false; break; }
    if (good) break;
  }
  if (!good) return false;
  std::size_t faces = 0;
  for (const VertexId v : vs) faces += surface_.degree(v);
  surface_.kill(vs, faces / 3);
  return true;
}

std::vector<VertexId> Collapser::part_of(VertexId v) {
  std::vector<VertexId> part{v};
  std::unordered_map<VertexId, int> seen;
  seen[v] = 1;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (const RingLink& l : surface_.ring(part[i])) if (seen.emplace(l.vertex, 1).second) part.push_back(l.vertex);
  return part;
}

HullStep Collapser::do_cut(VertexId a, VertexId b, VertexId c) {
  const HullStep cut = surface_.cut_step(a, b, c);
  surface_.apply(cut);
  ++counts_.cuts;
  born_.resize(surface_.vertex_count(), 0);
  touched_.resize(surface_.vertex_count(), 0);
  for (const VertexId v : {a, b, c, cut.right, cut.right + 1, cut.right + 2}) {
    ++born_[v];
    for (const RingLink& link : surface_.ring(v)) ++touched_[link.vertex];
  }
  return cut;
}

void Collapser::resolve(std::vector<VertexId> part) {
  if (part_volume(part) <= 0 && fill_pocket(part)) { ++counts_.filled; return; }
  for (const VertexId v : part) {
    for (const RingLink& l : surface_.ring(v)) {
      const VertexId w = surface_.waist(v, l.vertex);
      if (w == kInvalidId) continue;
      const HullStep cut = do_cut(v, l.vertex, w);
      const auto one = part_of(v), two = part_of(cut.right);
      if (std::find(one.begin(), one.end(), cut.right) != one.end()) { resolve(one); return; }
      resolve(one);
      resolve(two);
      return;
    }
  }
  for (const VertexId v : part) for (const RingLink& l : surface_.ring(v)) if (v < l.vertex) offer(v, l.vertex);
}

bool Collapser::try_cut(VertexId a, VertexId b) {
  if (!kCut) return false;
  const VertexId c = surface_.waist(a, b);
  if (c == kInvalidId) return false;
  std::vector<VertexId> small;
  int which = 0;
  const bool separates = parts(a, b, c, &small, &which);
  if (separates && (small.empty() || !kPockets)) return false;
  if (separates) {
    // volume of the small side with its cap
    std::vector<VertexId> all = small;
    all.insert(all.end(), {a, b, c});
    std::unordered_map<VertexId, int> in;
    for (VertexId v : small) in[v] = 1;
    double volume = 0;
    const DVec3 o(surface_.position(a));
    auto tet = [&](VertexId p, VertexId q, VertexId r) { return glm::dot(DVec3(surface_.position(p)) - o, glm::cross(DVec3(surface_.position(q)) - o, DVec3(surface_.position(r)) - o)); };
    for (VertexId v : small) {
      const auto ring = surface_.ring(v);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const VertexId x = ring[i].vertex, y = ring[i + 1 == ring.size() ? 0 : i + 1].vertex;
        if ((in.count(x) && x < v) || (in.count(y) && y < v)) continue;
        volume += tet(v, x, y);
      }
    }
    if (volume > 0 && volume / 6 * scale3() > kBump) return false;
    if (volume > 0) ++counts_.bumps; else ++counts_.pockets;
  }
  const HullStep cut = do_cut(a, b, c);
  if (separates) {
    if (which == 0) small.insert(small.end(), {a, b, c});
    else small.insert(small.end(), {cut.right, cut.right + 1, cut.right + 2});
    resolve(small);
  }
  for (const VertexId v : {a, b, c, cut.right, cut.right + 1, cut.right + 2}) {
    for (const RingLink& link : surface_.ring(v)) offer(v, link.vertex);
  }
  return true;
}

std::size_t Collapser::rescue(double share, std::vector<HullStep>& done) {
  struct Flip { double cost; VertexId a, b; };
  std::vector<Flip> flips;
  std::size_t edges = 0;
  for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
    for (const RingLink& link : surface_.ring(v)) {
      if (link.vertex < v) continue;
      ++edges;
      if (!surface_.can_flip(v, link.vertex)) continue;
      const HullStep s = surface_.flip_step(v, link.vertex);
      const DVec3 a(surface_.position(v)), b(surface_.position(link.vertex)), l(surface_.position(s.left)), r(surface_.position(s.right));
      const double vol = glm::dot(glm::cross(b - a, l - a), r - a);
      if (vol > 0) flips.push_back({vol, v, link.vertex});
    }
  }
  std::sort(flips.begin(), flips.end(), [](const Flip& x, const Flip& y) { return x.cost < y.cost; });
  const std::size_t most = static_cast<std::size_t>(share * static_cast<double>(edges)) + 1;
  std::size_t n = 0;
  std::vector<char> locked(surface_.vertex_count(), 0);
  for (const Flip& f : flips) {
    if (n >= most) break;
    if (locked[f.a] || locked[f.b]) continue;
    if (!surface_.can_flip(f.a, f.b)) continue;
    const HullStep s = surface_.flip_step(f.a, f.b);
    if (locked[s.left] || locked[s.right]) continue;
    if (orient3d(surface_.position(f.a), surface_.position(f.b), surface_.position(s.left), surface_.position(s.right)) < 0) continue;
    surface_.apply(s);
    done.push_back(s);
    ++n;
    ++counts_.flips;
    for (const VertexId v : {f.a, f.b, s.left, s.right}) { locked[v] = 1; ++born_[v]; ++touched_[v]; }
  }
  fill();
  return n;
}

void Collapser::diagnose() {
  std::size_t edges = 0, inf = 0, link = 0, deg = 0, waists = 0, sep = 0, fold = 0, ok = 0;
  for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
    const auto ring = surface_.ring(v);
    for (const RingLink& l : ring) {
      if (l.vertex < v) continue;
      ++edges;
      Candidate c;
      const bool feas = evaluate(v, l.vertex, c);
      if (!feas) ++inf;
      const bool can = surface_.can_collapse(v, l.vertex);
      if (!can) ++link;
      const VertexId w = surface_.waist(v, l.vertex);
      if (!can && w == kInvalidId) ++deg;
      if (w != kInvalidId) { ++waists; if (parts(v, l.vertex, w)) ++sep; }
      if (feas && can) { if (folds(v, l.vertex, c.position) || folds(l.vertex, v, c.position)) ++fold; else ++ok; }
    }
  }
  std::printf("edges %zu infeasible %zu link %zu degree %zu waists %zu separating %zu folds %zu ok %zu\n", edges, inf, link, deg, waists, sep, fold, ok);
}

bool Collapser::attempt(const Candidate& c, HullStep& done) {
  if (!surface_.can_collapse(c.a, c.b)) { ++counts_.topology; try_cut(c.a, c.b); return false; }
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
