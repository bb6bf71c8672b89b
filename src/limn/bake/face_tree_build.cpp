#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "limn/bake/face_tree.h"
#include "limn/base/parallel.h"

namespace limn::bake_detail {
namespace {

constexpr std::size_t kLeafFaces = 4;
constexpr int kBins = 16;
/// Ranges of at most this many faces, or of a 64th of all, are built as tasks of their own.
constexpr std::size_t kTaskFaces = 2048;

struct Box {
  Vec3 low{std::numeric_limits<float>::max()};
  Vec3 high{std::numeric_limits<float>::lowest()};

  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  void add(const Vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  Vec3 middle() const { return low * 0.5f + high * 0.5f; }
  /// Half its surface; 0 for an empty box.
  float area() const {
    const Vec3 d = high - low;
    return d.x < 0.0f ? 0.0f : d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

struct Item {
  Box box;
  FaceId face;
};

/// Items begin … end-1 and what encloses them.
struct Range {
  std::size_t begin = 0, end = 0;
  Box box;

  std::size_t size() const { return end - begin; }
};

/// Where a range is cut: between bins along an axis.
struct Cut {
  int axis = -1;
  int bin = 0;
  float cost = std::numeric_limits<float>::max();
};

/// Numbers the bin along an axis that a middle falls into.
struct Binning {
  float low = 0, scale = 0;

  Binning(const Box& middles, int axis) : low(middles.low[axis]) {
    const float extent = middles.high[axis] - middles.low[axis];
    scale = extent > 0.0f ? static_cast<float>(kBins) * 0.9999f / extent : 0.0f;
  }
  bool useful() const { return scale > 0.0f && scale < std::numeric_limits<float>::max(); }
  int bin_of(float middle) const { return std::clamp(static_cast<int>((middle - low) * scale), 0, kBins - 1); }
};

Cut best_cut(std::span<const Item> items, const Box& middles) {
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const Binning binning(middles, axis);
    if (!binning.useful()) continue;
    std::array<Box, kBins> boxes;
    std::array<std::size_t, kBins> counts{};
    for (const Item& item : items) {
      const auto bin = static_cast<std::size_t>(binning.bin_of(item.box.middle()[axis]));
      boxes[bin].add(item.box);
      ++counts[bin];
    }
    std::array<float, kBins> above{};
    Box box;
    std::size_t count = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      box.add(boxes[bin]);
      count += counts[bin];
      above[bin] = box.area() * static_cast<float>(count);
    }
    box = {};
    count = 0;
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      box.add(boxes[bin - 1]);
      count += counts[bin - 1];
      const float cost = box.area() * static_cast<float>(count) + above[bin];
      if (count > 0 && count < items.size() && cost < best.cost) best = {axis, static_cast<int>(bin), cost};
    }
  }
  return best;
}

}  // namespace

class FaceTreeBuilder {
 public:
  explicit FaceTreeBuilder(FaceTree& tree) : tree_(tree) {}

  void build() {
    gather();
    std::vector<Task> tasks;
    Subtree top;
    Range all{0, items_.size(), {}};
    for (const Item& item : items_)
      all.box.add(item.box);
    task_faces_ = std::max(kTaskFaces, items_.size() / 64);
    add_node(all, top, &tasks);
    parallel_for(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        add_node(tasks[i].range, tasks[i].subtree, nullptr);
    });
    tree_.nodes_ = std::move(top.nodes);
    tree_.leaves_ = std::move(top.leaves);
    for (const Task& task : tasks)
      append(task);
  }

 private:
  struct Subtree {
    std::vector<FaceTree::Node> nodes;
    std::vector<FaceTree::Leaf> leaves;
  };
  /// A range to be built apart, and the place of the child that it becomes.
  struct Task {
    Range range;
    std::size_t node;
    std::size_t child;
    Subtree subtree;
  };

  void gather() {
    items_.resize(tree_.faces_.size());
    parallel_for(items_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        Item item;
        item.face = static_cast<FaceId>(f);
        for (const VertexId v : tree_.faces_[f])
          item.box.add(tree_.positions_[v]);
        items_[f] = item;
      }
    });
  }

  Range range_of(std::size_t begin, std::size_t end) const {
    Range range{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i)
      range.box.add(items_[i].box);
    return range;
  }

  /// Into two that are not empty.
  std::array<Range, 2> split(const Range& range) {
    const std::span<Item> items(items_.data() + range.begin, range.size());
    Box middles;
    for (const Item& item : items)
      middles.add(item.box.middle());
    const Cut cut = best_cut(items, middles);
    std::size_t middle = range.begin + range.size() / 2;
    if (cut.axis >= 0) {
      const Binning binning(middles, cut.axis);
      const auto second = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return binning.bin_of(item.box.middle()[cut.axis]) < cut.bin;
      });
      middle = range.begin + static_cast<std::size_t>(second - items.begin());
    }
    return {range_of(range.begin, middle), range_of(middle, range.end)};
  }

  /// Cuts the range into up to four, the one that costs most first.
  std::vector<Range> children_of(const Range& range) {
    std::vector<Range> children{range};
    while (children.size() < 4) {
      std::size_t worst = children.size();
      float most = -1.0f;
      for (std::size_t i = 0; i < children.size(); ++i) {
        const float cost = children[i].box.area() * static_cast<float>(children[i].size());
        if (children[i].size() > kLeafFaces && cost > most) {
          worst = i;
          most = cost;
        }
      }
      if (worst == children.size()) break;
      const auto [first, second] = split(children[worst]);
      children[worst] = first;
      children.insert(children.begin() + static_cast<std::ptrdiff_t>(worst) + 1, second);
    }
    return children;
  }

  /// With `tasks`, ranges small enough become tasks instead of nodes.
  std::uint32_t add_node(const Range& range, Subtree& out, std::vector<Task>* tasks) {
    const std::vector<Range> children = children_of(range);
    const std::size_t index = out.nodes.size();
    out.nodes.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) {
      const bool present = c < children.size() && children[c].size() > 0;
      for (int axis = 0; axis < 3; ++axis) {
        out.nodes[index].low[axis][c] = present ? children[c].box.low[axis] : std::numeric_limits<float>::infinity();
        out.nodes[index].high[axis][c] = present ? children[c].box.high[axis] : -std::numeric_limits<float>::infinity();
      }
      std::uint32_t child = FaceTree::kLeafBit;
      if (present && children[c].size() <= kLeafFaces) {
        child = FaceTree::kLeafBit | add_leaf(children[c], out);
      } else if (present && tasks != nullptr && children[c].size() <= task_faces_) {
        tasks->push_back({children[c], index, c, {}});
      } else if (present) {
        child = add_node(children[c], out, tasks);
      }
      out.nodes[index].child[c] = child;
    }
    return static_cast<std::uint32_t>(index);
  }

  std::uint32_t add_leaf(const Range& range, Subtree& out) const {
    FaceTree::Leaf leaf;
    for (std::size_t i = 0; i < kLeafFaces; ++i) {
      const FaceId face = items_[range.begin + std::min(i, range.size() - 1)].face;
      const Triangle& t = tree_.faces_[face];
      const Vec3 a = tree_.positions_[t[0]];
      const Vec3 edge_1 = tree_.positions_[t[1]] - a;
      const Vec3 edge_2 = tree_.positions_[t[2]] - a;
      for (int axis = 0; axis < 3; ++axis) {
        leaf.corner[axis][i] = a[axis];
        leaf.edge_1[axis][i] = edge_1[axis];
        leaf.edge_2[axis][i] = edge_2[axis];
      }
      leaf.face[i] = face;
    }
    out.leaves.push_back(leaf);
    return static_cast<std::uint32_t>(out.leaves.size() - 1);
  }

  void append(const Task& task) {
    const auto nodes = static_cast<std::uint32_t>(tree_.nodes_.size());
    const auto leaves = static_cast<std::uint32_t>(tree_.leaves_.size());
    tree_.nodes_[task.node].child[task.child] = nodes;
    for (FaceTree::Node node : task.subtree.nodes) {
      for (std::uint32_t& child : node.child)
        child += (child & FaceTree::kLeafBit) != 0 ? leaves : nodes;
      tree_.nodes_.push_back(node);
    }
    tree_.leaves_.insert(tree_.leaves_.end(), task.subtree.leaves.begin(), task.subtree.leaves.end());
  }

  FaceTree& tree_;
  std::vector<Item> items_;
  std::size_t task_faces_ = 0;
};

FaceTree::FaceTree(std::span<const Vec3> positions, std::span<const Triangle> faces)
    : positions_(positions.begin(), positions.end()), faces_(faces.begin(), faces.end()) {
  FaceTreeBuilder(*this).build();
}

}  // namespace limn::bake_detail
