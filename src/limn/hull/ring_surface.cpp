#include "limn/hull/ring_surface.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_set>

namespace limn {
namespace {

constexpr std::uint32_t kLinks = 8;  // a cache line; most vertices have six neighbours

double power_of_two_scale(std::span<const Vec3> points) {
  double largest = 0.0;
  for (const Vec3& p : points)
    largest = std::max({largest, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
  return largest == 0.0 ? 1.0 : std::ldexp(1.0, -(std::ilogb(largest) + 1));
}

/// The corner after v in the face, in the order that the surface gives it.
VertexId corner_after(const Triangle& face, VertexId v, bool flip) {
  const std::size_t c = face[0] == v ? 0 : face[1] == v ? 1 : 2;
  return face[(c + (flip ? 2 : 1)) % 3];
}

std::size_t after(std::size_t i, std::size_t count) {
  return i + 1 == count ? 0 : i + 1;
}

std::size_t before(std::size_t i, std::size_t count) {
  return i == 0 ? count - 1 : i - 1;
}

}  // namespace

RingSurface::RingSurface(const Shell& shell, bool flip)
    : positions_(shell.positions),
      slots_(shell.positions.size()),
      planes_(shell.faces.size()),
      live_faces_(shell.faces.size()),
      scale_(power_of_two_scale(shell.positions)) {
  link_faces(shell.faces, flip);
  for (VertexId v = 0; v < vertex_count(); ++v)
    sort_ring(v, shell.faces, flip);
  compute_all_planes();
}

void RingSurface::link_faces(const std::vector<Triangle>& faces, bool flip) {
  std::vector<std::uint32_t> degrees(vertex_count(), 0);
  for (const Triangle& face : faces) {
    for (const VertexId v : face)
      ++degrees[v];
  }
  std::uint32_t end = 0;
  for (VertexId v = 0; v < vertex_count(); ++v) {
    slots_[v] = {end, 0, std::max(kLinks, degrees[v])};
    end += slots_[v].capacity;
  }
  links_.resize(end);
  for (FaceId f = 0; f < faces.size(); ++f) {
    for (const VertexId v : faces[f]) {
      Slot& slot = slots_[v];
      links_[slot.begin + slot.degree++] = {corner_after(faces[f], v, flip), f};
    }
  }
}

void RingSurface::sort_ring(VertexId v, const std::vector<Triangle>& faces, bool flip) {
  const std::span<RingLink> links(links_.data() + slots_[v].begin, slots_[v].degree);
  for (std::size_t i = 0; i + 1 < links.size(); ++i) {
    const VertexId next = corner_after(faces[links[i].face], links[i].vertex, flip);
    const auto found = std::find_if(links.begin() + static_cast<std::ptrdiff_t>(i) + 1, links.end(),
                                    [&](const RingLink& link) { return link.vertex == next; });
    assert(found != links.end());
    if (found != links.end()) std::swap(links[i + 1], *found);
  }
}

void RingSurface::compute_all_planes() {
  for (VertexId v = 0; v < vertex_count(); ++v) {
    const std::span<const RingLink> links = ring(v);
    for (std::size_t i = 0; i < links.size(); ++i) {
      const VertexId next = links[after(i, links.size())].vertex;
      if (v < links[i].vertex && v < next) update_plane(v, links[i], next);
    }
  }
}

std::uint32_t RingSurface::find(VertexId v, VertexId neighbour) const {
  const Slot& slot = slots_[v];
  for (std::uint32_t i = 0; i < slot.degree; ++i) {
    if (links_[slot.begin + i].vertex == neighbour) return i;
  }
  return slot.degree;
}

HullStep RingSurface::collapse_step(VertexId kept, VertexId removed, const Vec3& after_collapse) const {
  const std::span<const RingLink> links = ring(kept);
  const std::size_t place = find(kept, removed);
  const RingLink& left = links[after(place, links.size())];
  const RingLink& right = links[before(place, links.size())];
  return {HullStep::Kind::kCollapse, kept,       removed,          left.vertex,   right.vertex,
          links[place].face,         right.face, positions_[kept], after_collapse};
}

HullStep RingSurface::flip_step(VertexId a, VertexId b) const {
  HullStep step = collapse_step(a, b, positions_[a]);
  step.kind = HullStep::Kind::kFlip;
  return step;
}

bool RingSurface::can_collapse(VertexId kept, VertexId removed) const {
  const std::span<const RingLink> a = ring(kept);
  const std::span<const RingLink> b = ring(removed);
  const std::size_t place = find(kept, removed);
  if (degree(a[after(place, a.size())].vertex) <= 3 || degree(a[before(place, a.size())].vertex) <= 3) return false;
  int common = 0;
  for (const RingLink& x : a) {
    for (const RingLink& y : b)
      common += x.vertex == y.vertex ? 1 : 0;
  }
  return common == 2;
}

bool RingSurface::can_flip(VertexId a, VertexId b) const {
  const std::span<const RingLink> links = ring(a);
  const std::size_t place = find(a, b);
  const VertexId left = links[after(place, links.size())].vertex;
  const VertexId right = links[before(place, links.size())].vertex;
  return degree(a) > 3 && degree(b) > 3 && find(left, right) == degree(left);
}

void RingSurface::apply(const HullStep& step) {
  switch (step.kind) {
    case HullStep::Kind::kCollapse:
      collapse(step);
      break;
    case HullStep::Kind::kFlip:
      flip(step);
      break;
    case HullStep::Kind::kCut:
      cut(step);
      break;
    case HullStep::Kind::kFill:
    case HullStep::Kind::kDrop:
      remove_part(step.kept);
      break;
    case HullStep::Kind::kMove:
      positions_[step.kept] = step.after;
      update_planes(step.kept);
      break;
  }
}

void RingSurface::collapse(const HullStep& step) {
  const VertexId a = step.kept;
  const VertexId b = step.removed;
  const std::span<const RingLink> ring_a = ring(a);
  const std::span<const RingLink> ring_b = ring(b);
  // Around the new vertex: a's neighbours from left to right, then b's from right to left.
  scratch_.clear();
  std::size_t i = after(find(a, b), ring_a.size());
  for (; ring_a[i].vertex != step.right; i = after(i, ring_a.size()))
    scratch_.push_back(ring_a[i]);
  i = after(find(b, a), ring_b.size());
  for (; ring_b[i].vertex != step.left; i = after(i, ring_b.size())) {
    scratch_.push_back(ring_b[i]);
    if (ring_b[i].vertex != step.right) link(ring_b[i].vertex, b).vertex = a;
  }
  const RingLink gone = erase(step.left, b);
  link(step.left, a).face = gone.face;
  erase(step.right, b);
  slots_[b].degree = 0;
  store_ring(a, scratch_);
  positions_[a] = step.after;
  live_faces_ -= 2;
  update_planes(a);
}

void RingSurface::flip(const HullStep& step) {
  const VertexId a = step.kept;
  const VertexId b = step.removed;
  erase(a, b);
  link(a, step.right).face = step.face_left;
  erase(b, a);
  link(b, step.left).face = step.face_right;
  insert_after(step.left, a, {step.right, step.face_right});
  insert_after(step.right, b, {step.left, step.face_left});
  update_plane(a, link(a, step.right), step.left);
  update_plane(b, link(b, step.left), step.right);
}

VertexId RingSurface::waist(VertexId a, VertexId b) const {
  const std::span<const RingLink> links = ring(a);
  const std::size_t place = find(a, b);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (i == place || i == after(place, links.size()) || i == before(place, links.size())) continue;
    if (find(b, links[i].vertex) < degree(b)) return links[i].vertex;
  }
  return kInvalidId;
}

HullStep RingSurface::cut_step(VertexId a, VertexId b, VertexId c) const {
  const auto vertices = static_cast<VertexId>(positions_.size());
  const auto faces = static_cast<FaceId>(planes_.size());
  return {HullStep::Kind::kCut, a, b, c, vertices, faces, faces + 1, positions_[a], positions_[a]};
}

void RingSurface::cut(const HullStep& step) {
  for (const VertexId v : {step.kept, step.removed, step.left}) {
    positions_.push_back(positions_[v]);
    slots_.push_back({static_cast<std::uint32_t>(links_.size()), 0, 0});
  }
  planes_.resize(planes_.size() + 2);
  for (int corner = 0; corner < 3; ++corner)
    cut_ring(step, corner);
  update_plane(step.kept, link(step.kept, step.left), step.removed);
  update_plane(step.right, link(step.right, step.right + 1), step.right + 2);
  live_faces_ += 2;
}

/// Parts the ring of one corner of the cut: what lies to the left of the way through it stays.
void RingSurface::cut_ring(const HullStep& step, int corner) {
  const std::array<VertexId, 3> old{step.kept, step.removed, step.left};
  const std::size_t here = static_cast<std::size_t>(corner), next = (here + 1) % 3, last = (here + 2) % 3;
  const VertexId v = old[here];
  const VertexId copy = step.right + static_cast<VertexId>(corner);
  const std::span<const RingLink> links = ring(v);
  std::vector<RingLink> left, right;
  std::size_t i = find(v, old[next]);
  for (; links[i].vertex != old[last]; i = after(i, links.size()))
    left.push_back(links[i]);
  left.push_back({old[last], step.face_left});
  right.push_back({step.right + static_cast<VertexId>(last), links[i].face});
  for (i = after(i, links.size()); links[i].vertex != old[next]; i = after(i, links.size())) {
    right.push_back(links[i]);
    link(links[i].vertex, v).vertex = copy;
  }
  right.push_back({step.right + static_cast<VertexId>(next), step.face_right});
  store_ring(v, left);
  store_ring(copy, right);
}

std::vector<VertexId> RingSurface::part_of(VertexId v) const {
  std::vector<VertexId> part{v};
  std::unordered_set<VertexId> seen{v};
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (const RingLink& link : ring(part[i])) {
      if (seen.insert(link.vertex).second) part.push_back(link.vertex);
    }
  }
  return part;
}

void RingSurface::remove_part(VertexId v) {
  std::size_t corners = 0;
  for (const VertexId gone : part_of(v)) {
    corners += slots_[gone].degree;
    slots_[gone].degree = 0;
  }
  live_faces_ -= corners / 3;
}

RingLink& RingSurface::link(VertexId v, VertexId neighbour) {
  return links_[slots_[v].begin + find(v, neighbour)];
}

RingLink RingSurface::erase(VertexId v, VertexId neighbour) {
  Slot& slot = slots_[v];
  const auto place = links_.begin() + slot.begin + find(v, neighbour);
  const RingLink gone = *place;
  std::copy(place + 1, links_.begin() + slot.begin + slot.degree, place);
  --slot.degree;
  return gone;
}

void RingSurface::insert_after(VertexId v, VertexId neighbour, const RingLink& link) {
  const std::span<const RingLink> links = ring(v);
  scratch_.assign(links.begin(), links.end());
  scratch_.insert(scratch_.begin() + find(v, neighbour) + 1, link);
  store_ring(v, scratch_);
}

void RingSurface::store_ring(VertexId v, std::span<const RingLink> ring) {
  Slot& slot = slots_[v];
  slot.degree = static_cast<std::uint32_t>(ring.size());
  if (slot.degree > slot.capacity) {
    slot.begin = static_cast<std::uint32_t>(links_.size());
    slot.capacity = slot.degree + kLinks / 2;
    links_.resize(links_.size() + slot.capacity);
  }
  std::copy(ring.begin(), ring.end(), links_.begin() + slot.begin);
}

void RingSurface::update_plane(VertexId v, const RingLink& link, VertexId next) {
  const DVec3 origin(positions_[v]);
  const DVec3 normal =
      glm::cross((DVec3(positions_[link.vertex]) - origin) * scale_, (DVec3(positions_[next]) - origin) * scale_);
  const double length = glm::length(normal);
  const double inverse = length > 0.0 ? 1.0 / length : 0.0;
  planes_[link.face] = {Vec3(normal * inverse), static_cast<float>(0.5 * length)};
}

void RingSurface::update_planes(VertexId v) {
  const std::span<const RingLink> links = ring(v);
  for (std::size_t i = 0; i < links.size(); ++i)
    update_plane(v, links[i], links[after(i, links.size())].vertex);
}

std::vector<Triangle> RingSurface::faces(std::vector<FaceId>& ids) const {
  std::vector<Triangle> by_id(planes_.size(), Triangle{kInvalidId, kInvalidId, kInvalidId});
  for (VertexId v = 0; v < vertex_count(); ++v) {
    const std::span<const RingLink> links = ring(v);
    for (std::size_t i = 0; i < links.size(); ++i) {
      const VertexId next = links[after(i, links.size())].vertex;
      if (v < links[i].vertex && v < next) by_id[links[i].face] = {v, links[i].vertex, next};
    }
  }
  ids.clear();
  std::vector<Triangle> live;
  for (FaceId f = 0; f < by_id.size(); ++f) {
    if (by_id[f][0] == kInvalidId) continue;
    ids.push_back(f);
    live.push_back(by_id[f]);
  }
  return live;
}

}  // namespace limn
