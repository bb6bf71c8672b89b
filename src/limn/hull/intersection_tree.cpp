#include "limn/hull/intersection_tree.h"

#include <algorithm>
#include <array>
#include <bit>

#include "limn/base/orient3d.h"

namespace limn {
namespace {

/// Deeper than any tree of 32-bit faces.
constexpr std::size_t kStack = 64;

bool meet(const Bounds& a, const Bounds& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

Bounds joined(const Bounds& a, const Bounds& b) {
  Bounds both = a;
  if (b.empty()) return both;
  both.add(b.low);
  both.add(b.high);
  return both;
}

struct Item {
  DVec3 middle;
  FaceId face;
};

/// Puts the items below a node in the order of its leaves: halved at the median of the longest axis, so that the left
/// half fills its share of leaves.
void order(std::span<Item> items, std::size_t leaves) {
  if (leaves <= 1 || items.size() <= 1) return;
  DVec3 low = items[0].middle, high = low;
  for (const Item& item : items) {
    low = glm::min(low, item.middle);
    high = glm::max(high, item.middle);
  }
  const DVec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = (items.size() + 1) / 2;
  if (half < items.size()) {
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [axis](const Item& a, const Item& b) {
                       return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.face < b.face;
                     });
  }
  order(items.first(half), leaves / 2);
  order(items.subspan(half), leaves / 2);
}

/// Deals ordered items out to leaves as order() halved them.
void deal(std::span<const Item> items, std::size_t first_leaf, std::size_t leaves, std::vector<FaceId>& face_at) {
  if (items.empty()) return;
  if (leaves == 1) {
    face_at[first_leaf] = items[0].face;
    return;
  }
  const std::size_t half = (items.size() + 1) / 2;
  deal(items.first(half), first_leaf, leaves / 2, face_at);
  deal(items.subspan(half), first_leaf + leaves / 2, leaves / 2, face_at);
}

}  // namespace

IntersectionTree::IntersectionTree(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  const std::size_t leaves = std::bit_ceil(std::max<std::size_t>(faces.size(), 1));
  leaf_begin_ = static_cast<std::uint32_t>(leaves);
  std::vector<Item> items(faces.size());
  corners_.resize(faces.size());
  for (FaceId face = 0; face < faces.size(); ++face) {
    for (std::size_t c = 0; c < 3; ++c)
      corners_[face][c] = positions[faces[face][c]];
    const Bounds box = bounds_of(corners_[face]);
    items[face] = {DVec3(box.low) + DVec3(box.high), face};
  }
  order(items, leaves);
  face_at_.assign(leaves, kInvalidId);
  deal(items, 0, leaves, face_at_);
  leaf_of_.resize(faces.size());
  boxes_.resize(2 * leaves);
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
    if (face_at_[leaf] == kInvalidId) continue;
    leaf_of_[face_at_[leaf]] = leaf_begin_ + leaf;
    boxes_[leaf_begin_ + leaf] = bounds_of(corners_[face_at_[leaf]]);
  }
  for (std::uint32_t node = leaf_begin_; node-- > 1;)
    boxes_[node] = joined(boxes_[2 * node], boxes_[2 * node + 1]);
}

/// Calls visit with every face whose box meets this one until it gives false; whether it never did.
template <class Visit>
bool IntersectionTree::visit_boxes(const Bounds& box, Visit visit) const {
  std::array<std::uint32_t, kStack> open;
  std::size_t count = 0;
  if (meet(boxes_[1], box)) open[count++] = 1;
  while (count > 0) {
    const std::uint32_t node = open[--count];
    if (node >= leaf_begin_) {
      if (!visit(face_at_[node - leaf_begin_])) return false;
      continue;
    }
    for (const std::uint32_t below : {2 * node + 1, 2 * node}) {
      if (meet(boxes_[below], box)) open[count++] = below;
    }
  }
  return true;
}

bool IntersectionTree::hits(std::span<const Corners> triangles, std::span<const FaceId> ignored) const {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t j = i + 1; j < triangles.size(); ++j) {
      if (intersect_beyond_shared(triangles[i], triangles[j])) return true;
    }
  }
  for (const Corners& triangle : triangles) {
    const bool clear = visit_boxes(bounds_of(triangle), [&](FaceId face) {
      if (std::find(ignored.begin(), ignored.end(), face) != ignored.end()) return true;
      return !intersect_beyond_shared(triangle, corners_[face]);
    });
    if (!clear) return true;
  }
  return false;
}

bool IntersectionTree::crosses(const Vec3& p, const Vec3& q) const {
  return !visit_boxes(bounds_of(std::array{p, q}), [&](FaceId face) {
    const Corners& t = corners_[face];
    if (orient3d(t[0], t[1], t[2], p) * orient3d(t[0], t[1], t[2], q) >= 0) return true;
    return !segment_meets_triangle(p, q, t);
  });
}

void IntersectionTree::for_each_hit_above(FaceId face, const std::function<void(FaceId)>& visit) const {
  visit_boxes(bounds_of(corners_[face]), [&](FaceId other) {
    if (other > face && intersect_beyond_shared(corners_[face], corners_[other])) visit(other);
    return true;
  });
}

void IntersectionTree::refit(FaceId face, const Bounds& box) {
  std::uint32_t node = leaf_of_[face];
  boxes_[node] = box;
  while (node > 1) {
    node /= 2;
    const Bounds fitted = joined(boxes_[2 * node], boxes_[2 * node + 1]);
    if (fitted.low == boxes_[node].low && fitted.high == boxes_[node].high) return;
    boxes_[node] = fitted;
  }
}

void IntersectionTree::remove(FaceId face) {
  refit(face, Bounds{});
}

void IntersectionTree::update(FaceId face, const Corners& corners) {
  corners_[face] = corners;
  refit(face, bounds_of(corners));
}

}  // namespace limn
