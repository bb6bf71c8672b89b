#include "limn/silhouette/search/node_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kWidth = simd::kWidth;
constexpr double kUnit = 1.0 / kLargestWord;

/// What decides a node's anchor and the middle of its normals; adds up from child to parent. In the frame's units:
/// lengths are shares of its scale, from its origin.
struct NodeSums {
  glm::dmat3 normals{0.0};  ///< of n nᵀ
  DVec3 offsets{0.0};       ///< of n d
  DVec3 normal{0.0};
  double faces = 0.0;
};

/// A ball of normals: where it is, how wide.
struct NormalBall {
  DVec3 center{0.0};
  double radius = 0.0;
};

struct Node {
  NodeSums sums;
  NormalBall ball;
  DVec3 anchor{0.0};
};

struct UnitPlane {
  DVec3 normal;
  double offset;
};

UnitPlane plane_at(const simd::Leaf& leaf, std::size_t lane) {
  const simd::PlaneGroup& p = leaf.planes;
  return {DVec3(p.xy[2 * lane], p.xy[2 * lane + 1], p.zd[2 * lane]) * kUnit, p.zd[2 * lane + 1] * kUnit};
}

void add(NodeSums& sums, const NodeSums& more) {
  sums.normals += more.normals;
  sums.offsets += more.offsets;
  sums.normal += more.normal;
  sums.faces += more.faces;
}

/// The point nearest to the planes in the sense of least squares, drawn a little to where the mean plane passes nearest
/// to the origin: where all planes pass close by, offsets there spread little and |p - c| is what counts.
DVec3 anchor_of(const NodeSums& sums) {
  constexpr double kPull = 1e-3;
  const double weight = kPull * std::max(sums.faces, 1.0);
  // The foot of the mean plane, as long as there is one.
  const double length2 = std::max(glm::dot(sums.normal, sums.normal), 1e-3 * sums.faces * sums.faces);
  const double offset = glm::dot(sums.offsets, sums.normal) / length2;
  const DVec3 start = sums.normal * (-offset * sums.faces / length2);
  glm::dmat3 system = sums.normals;
  for (int k = 0; k < 3; ++k)
    system[k][k] += weight;
  const DVec3 anchor = glm::inverse(system) * (start * weight - sums.offsets);
  const double length = glm::length(anchor);
  if (!(length <= 1e6)) return DVec3(0.0);
  return length > 1.0 ? anchor / length : anchor;
}

/// Moves a ball's center step by step towards what sticks out most (Bădoiu and Clarkson 2003).
template <class Farthest>
DVec3 middle_of(DVec3 center, const Farthest& farthest) {
  constexpr int kSteps = 20;
  for (int i = 1; i <= kSteps; ++i)
    center += (farthest(center) - center) / (i + 1.0);
  return center;
}

/// A node's bound in words, grown from the planes under it.
class NodeBound {
 public:
  NodeBound(const DVec3& normal, const DVec3& anchor) : anchor_(anchor) {
    for (int k = 0; k < 3; ++k)
      words_[static_cast<std::size_t>(k)] = std::lround(std::clamp(normal[k], -1.0, 1.0) * kLargestWord);
    normal_ =
        DVec3(static_cast<double>(words_[0]), static_cast<double>(words_[1]), static_cast<double>(words_[2])) * kUnit;
  }

  void include(const simd::Leaf& leaf) {
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const UnitPlane plane = plane_at(leaf, lane);
      const DVec3 off = plane.normal - normal_;
      radius2_ = std::max(radius2_, glm::dot(off, off));
      const double offset = glm::dot(off, anchor_) + plane.offset;
      low_ = std::min(low_, offset);
      high_ = std::max(high_, offset);
    }
  }

  double radius() const { return std::sqrt(radius2_); }

  void write(simd::NodeGroup& group, std::size_t lane) const {
    const double middle =
        std::clamp(std::round(0.5 * (low_ + high_) * kLargestWord), -double{kLargestWord}, double{kLargestWord});
    // The leaves' words are themselves rounded: by less than a unit in the normal, and less than three in the offset.
    const double r = std::ceil(radius() * kLargestWord) + 2.0;
    const double h = std::ceil(std::max(high_ * kLargestWord - middle, middle - low_ * kLargestWord)) + 4.0;
    if (!(r <= kLargestWord && h <= kLargestWord)) {
      put(group, lane, {0, 0, 0, 0}, kLargestWord, kLargestWord);  // always entered
      return;
    }
    put(group, lane, {words_[0], words_[1], words_[2], static_cast<long>(middle)}, static_cast<long>(r),
        static_cast<long>(h));
  }

  /// Never entered: h and the reach add up to at least half of the largest eye word, so that the slack is below 0.
  static void write_unused(simd::NodeGroup& group, std::size_t lane) {
    put(group, lane, {0, 0, 0, 0}, -kLargestWord, -kLargestWord);
  }

 private:
  static void put(simd::NodeGroup& group, std::size_t lane, const std::array<long, 4>& plane, long r, long h) {
    group.planes.xy[2 * lane] = static_cast<std::int16_t>(plane[0]);
    group.planes.xy[2 * lane + 1] = static_cast<std::int16_t>(plane[1]);
    group.planes.zd[2 * lane] = static_cast<std::int16_t>(plane[2]);
    group.planes.zd[2 * lane + 1] = static_cast<std::int16_t>(plane[3]);
    group.rh[2 * lane] = static_cast<std::int16_t>(r);
    group.rh[2 * lane + 1] = static_cast<std::int16_t>(h);
  }

  std::array<long, 3> words_{};
  DVec3 normal_{0.0};
  DVec3 anchor_;
  double radius2_ = 0.0;
  double low_ = 1e300, high_ = -1e300;
};

Node leaf_node(const simd::Leaf& leaf) {
  Node node;
  std::array<DVec3, kWidth> normals;
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    const UnitPlane plane = plane_at(leaf, lane);
    normals[lane] = plane.normal;
    node.sums.normals += glm::outerProduct(plane.normal, plane.normal);
    node.sums.offsets += plane.normal * plane.offset;
    node.sums.normal += plane.normal;
  }
  node.sums.faces = kWidth;
  node.ball.center = middle_of(node.sums.normal / double{kWidth}, [&](const DVec3& center) {
    return *std::max_element(normals.begin(), normals.end(), [&](const DVec3& a, const DVec3& b) {
      return glm::dot(a - center, a - center) < glm::dot(b - center, b - center);
    });
  });
  node.anchor = anchor_of(node.sums);
  return node;
}

Node parent_node(std::span<const Node> children) {
  Node node;
  for (const Node& child : children)
    add(node.sums, child.sums);
  node.ball.center = middle_of(node.sums.normal / node.sums.faces, [&](const DVec3& center) {
    double most = -1.0;
    DVec3 point = center;
    for (const Node& child : children) {
      const DVec3 off = child.ball.center - center;
      const double distance = glm::length(off);
      if (distance + child.ball.radius <= most) continue;
      most = distance + child.ball.radius;
      point = distance > 0.0 ? child.ball.center + off * (child.ball.radius / distance) : center;
    }
    return point;
  });
  node.anchor = anchor_of(node.sums);
  return node;
}

/// The ball around the anchors of a group's nodes.
void write_reach(std::span<const Node> nodes, simd::NodeGroup& group) {
  DVec3 low(1e300), high(-1e300);
  for (const Node& node : nodes) {
    low = glm::min(low, node.anchor);
    high = glm::max(high, node.anchor);
  }
  DVec3 middle = 0.5 * (low + high);
  double radius = 0.0;
  for (const Node& node : nodes)
    radius = std::max(radius, glm::length(node.anchor - middle));
  // Anchors lie in the unit ball; within twice that the reach fits its 16 bits.
  if (glm::length(middle) + radius > 1.9) {
    middle = DVec3(0.0);
    radius = 1.0;
  }
  for (int k = 0; k < 3; ++k)
    group.center[k] = static_cast<float>(middle[k]);
  // Above what the rounding of the center loses; that of the eye's distance is below the unit the kernels add.
  group.radius = static_cast<float>(radius * (1.0 + 0x1.0p-20) + 0x1.0p-20);
}

}  // namespace

void quantize_leaves(std::span<const FaceId> leaf_faces, std::span<const Plane> planes, const QuantizedFrame& frame,
                     LineVector<simd::Leaf>& leaves) {
  parallel_for(leaves.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l) {
      simd::PlaneGroup& group = leaves[l].planes;
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        const QuantizedPlane plane = quantize(frame, planes[leaf_faces[kWidth * l + lane]]);
        group.xy[2 * lane] = plane[0];
        group.xy[2 * lane + 1] = plane[1];
        group.zd[2 * lane] = plane[2];
        group.zd[2 * lane + 1] = plane[3];
      }
    }
  });
}

std::vector<LineVector<simd::NodeGroup>> bound_nodes(std::span<const simd::Leaf> leaves) {
  std::vector<LineVector<simd::NodeGroup>> levels;
  if (leaves.empty()) return levels;
  std::vector<Node> nodes(leaves.size());
  parallel_for(leaves.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l)
      nodes[l] = leaf_node(leaves[l]);
  });
  for (std::size_t leaves_per_node = 1;; leaves_per_node *= kWidth) {
    LineVector<simd::NodeGroup> groups((nodes.size() + kWidth - 1) / kWidth);
    parallel_for(nodes.size(), std::max<std::size_t>(1, 512 / leaves_per_node),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t n = begin; n < end; ++n) {
                     NodeBound bound(nodes[n].ball.center, nodes[n].anchor);
                     const std::size_t first = n * leaves_per_node;
                     for (std::size_t l = first; l < std::min(first + leaves_per_node, leaves.size()); ++l)
                       bound.include(leaves[l]);
                     nodes[n].ball.radius = bound.radius();
                     bound.write(groups[n / kWidth], n % kWidth);
                   }
                 });
    std::vector<Node> parents(groups.size());
    parallel_for(groups.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) {
        const auto children =
            std::span<const Node>(nodes).subspan(kWidth * g, std::min(kWidth, nodes.size() - kWidth * g));
        parents[g] = parent_node(children);
        write_reach(children, groups[g]);
        for (std::size_t lane = children.size(); lane < kWidth; ++lane)
          NodeBound::write_unused(groups[g], lane);
      }
    });
    levels.push_back(std::move(groups));
    if (parents.size() == 1) return levels;
    nodes = std::move(parents);
  }
}

}  // namespace limn
