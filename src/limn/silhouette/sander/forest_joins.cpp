#include "limn/silhouette/sander/forest_joins.h"

#include <algorithm>
#include <queue>

#include "limn/base/parallel.h"
#include "limn/silhouette/sander/anchored_cone.h"
#include "limn/silhouette/sander/viewpoint_volume.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 1024;
constexpr std::size_t kJoinsPerReport = 4096;

enum class JoinKind : std::uint8_t { kParent, kAdopt, kAdopted, kMerge };

/// A candidate: the best of the joins of two roots.
struct Join {
  double gain = 0.0;  ///< predicted decrease of the forest's cost
  std::uint32_t a = 0, b = 0;
  JoinKind kind = JoinKind::kMerge;

  /// Of equal gains the oldest roots come first: the order is total, whatever the heap does.
  bool operator<(const Join& other) const {
    if (gain != other.gain) return gain < other.gain;
    return std::pair(a, b) > std::pair(other.a, other.b);
  }
};

/// Faces that decided the cone: they probably decide that of a union as well.
struct Deciding {
  std::array<FaceId, 4> face{};
  int count = 0;
};

/// A root of the forest, or what was one until it was joined.
struct Cluster {
  std::vector<FaceId> faces;  ///< ascending; empty when there is no cone
  Deciding axis, front, back;
  DVec3 middle_sum{0.0};  ///< of the edges' middles
  double edge_count = 0;
  double probability = 1.0;  ///< P(r)
  double work = 0.0;         ///< ke|E| + ka|C| of the root itself
  bool has_cone = false;
  std::uint32_t node = 0;
};

/// The faces of one or two clusters, gathered for anchored_cone().
class Gathered {
 public:
  void add_face(const FramedPlane& plane, FaceId face) {
    normals_.push_back(plane.normal);
    offsets_.push_back(plane.offset);
    faces_.push_back(face);
  }
  void clear() {
    normals_.clear();
    offsets_.clear();
    faces_.clear();
  }
  std::size_t size() const { return faces_.size(); }
  FaceId face(std::uint32_t i) const { return faces_[i]; }
  FaceCluster cluster() const { return {.normals = normals_, .offsets = offsets_}; }

 private:
  std::vector<DVec3> normals_;
  std::vector<double> offsets_;
  std::vector<FaceId> faces_;
};

class Joiner {
 public:
  Joiner(std::span<const FramedPlane> planes, std::span<const JoinEdge> edges, const PaperForestOptions& options)
      : planes_(planes), edges_(edges), options_(options) {}

  Result<JoinedForest> run(std::span<const std::pair<std::uint32_t, std::uint32_t>> links, const Progress& progress) {
    make_roots();
    make_links(links);
    make_candidates(links);
    const std::size_t most = edges_.size();
    for (std::size_t joins = 0; !heap_.empty(); ++joins) {
      if (joins % kJoinsPerReport == 0 &&
          !report(progress, "joining clusters", static_cast<double>(joins) / static_cast<double>(most)))
        return fail(ErrorCode::kCancelled, "building the search forest was cancelled");
      if (!apply_next()) break;
    }
    return finish();
  }

 private:
  void make_roots() {
    const std::size_t count = edges_.size();
    clusters_.resize(count);
    nodes_.resize(count);
    next_edge_.assign(count, JoinNode::kNone);
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      Gathered scratch;
      for (std::size_t e = begin; e < end; ++e) {
        const auto id = static_cast<std::uint32_t>(e);
        nodes_[e].first_edge = nodes_[e].last_edge = id;
        make_root(id, scratch);
      }
    });
    owner_.resize(count);
    for (std::size_t e = 0; e < count; ++e)
      owner_[e] = static_cast<std::uint32_t>(e);
  }

  void make_root(std::uint32_t id, Gathered& scratch) {
    const JoinEdge& edge = edges_[id];
    Cluster& cluster = clusters_[id];
    cluster.node = id;
    cluster.middle_sum = edge.middle;
    cluster.edge_count = 1;
    cluster.work = 1.0;
    if (!planes_[edge.face[0]].usable || !planes_[edge.face[1]].usable) return;
    cluster.faces = {std::min(edge.face[0], edge.face[1]), std::max(edge.face[0], edge.face[1])};
    scratch.clear();
    for (const FaceId face : cluster.faces)
      scratch.add_face(planes_[face], face);
    FaceCluster faces = scratch.cluster();
    faces.near = edge.middle;
    settle(cluster, anchored_cone(faces), scratch);
  }

  void settle(Cluster& cluster, const AnchoredCone& cone, const Gathered& scratch) const {
    cluster.has_cone = cone.exists;
    cluster.probability = survival_probability(cone, options_.viewpoint_radius);
    if (!cone.exists) cluster.faces = {};
    cluster.axis = named(cone.axis_faces, scratch);
    cluster.front = named(cone.front_faces, scratch);
    cluster.back = named(cone.back_faces, scratch);
  }

  static Deciding named(const DecidingFaces& faces, const Gathered& scratch) {
    Deciding deciding;
    deciding.count = faces.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(faces.count); ++i)
      deciding.face[i] = scratch.face(faces.index[i]);
    return deciding;
  }

  void make_links(std::span<const std::pair<std::uint32_t, std::uint32_t>> links) {
    links_.resize(edges_.size());
    for (const auto& [a, b] : links) {
      links_[a].push_back(b);
      links_[b].push_back(a);
    }
  }

  void make_candidates(std::span<const std::pair<std::uint32_t, std::uint32_t>> links) {
    std::vector<Join> candidates(links.size());
    parallel_for(links.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Gathered scratch;
      for (std::size_t i = begin; i < end; ++i)
        candidates[i] = best_join(links[i].first, links[i].second, scratch);
    });
    std::erase_if(candidates, [](const Join& join) { return !(join.gain > 0.0); });
    heap_ = std::priority_queue<Join>(std::less<Join>(), std::move(candidates));
  }

  void gather(const Deciding& deciding, Gathered& scratch) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(deciding.count); ++i)
      scratch.add_face(planes_[deciding.face[i]], deciding.face[i]);
  }

  AnchoredCone union_cone(const Cluster& a, const Cluster& b, Gathered& scratch) const {
    if (!a.has_cone || !b.has_cone) return {};
    scratch.clear();
    gather(a.axis, scratch);
    gather(b.axis, scratch);
    const std::size_t axis_end = scratch.size();
    gather(a.front, scratch);
    gather(b.front, scratch);
    const std::size_t front_end = scratch.size();
    gather(a.back, scratch);
    gather(b.back, scratch);
    const std::size_t back_end = scratch.size();
    for (const Cluster* cluster : {&a, &b}) {
      for (const FaceId face : cluster->faces)
        scratch.add_face(planes_[face], face);
    }
    FaceCluster faces = scratch.cluster();
    faces.near = (a.middle_sum + b.middle_sum) / (a.edge_count + b.edge_count);
    faces.axis_end = axis_end;
    faces.front_end = front_end;
    faces.back_end = back_end;
    return anchored_cone(faces);
  }

  Join best_join(std::uint32_t a, std::uint32_t b, Gathered& scratch) const {
    const double p = survival_probability(union_cone(clusters_[a], clusters_[b], scratch), options_.viewpoint_radius);
    const double ka = options_.cone_cost;
    const double of_a = clusters_[a].probability * clusters_[a].work;
    const double of_b = clusters_[b].probability * clusters_[b].work;
    Join best{ka - p * 2 * ka, a, b, JoinKind::kParent};
    const auto consider = [&](double gain, JoinKind kind) {
      if (gain > best.gain) best = {gain, a, b, kind};
    };
    consider(ka + of_a - p * (clusters_[a].work + ka), JoinKind::kAdopt);
    consider(ka + of_b - p * (clusters_[b].work + ka), JoinKind::kAdopted);
    consider(ka + of_a + of_b - p * (clusters_[a].work + clusters_[b].work), JoinKind::kMerge);
    return best;
  }

  /// Does the best join that is left. \returns false when none is
  bool apply_next() {
    while (!heap_.empty()) {
      const Join join = heap_.top();
      heap_.pop();
      if (owner_[join.a] != join.a || owner_[join.b] != join.b) continue;
      apply(join);
      return true;
    }
    return false;
  }

  void apply(const Join& join) {
    const auto id = static_cast<std::uint32_t>(clusters_.size());
    Cluster joined = united(clusters_[join.a], clusters_[join.b]);
    join_trees(join, joined);
    for (const std::uint32_t old : {join.a, join.b}) {
      clusters_[old].faces = {};
      owner_[old] = id;
    }
    owner_.push_back(id);
    clusters_.push_back(std::move(joined));
    update_links(join, id);
  }

  Cluster united(const Cluster& a, const Cluster& b) {
    Cluster joined;
    joined.middle_sum = a.middle_sum + b.middle_sum;
    joined.edge_count = a.edge_count + b.edge_count;
    const AnchoredCone cone = union_cone(a, b, scratch_);
    if (cone.exists) {
      joined.faces.reserve(a.faces.size() + b.faces.size());
      std::set_union(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), std::back_inserter(joined.faces));
    }
    settle(joined, cone, scratch_);
    return joined;
  }

  void join_trees(const Join& join, Cluster& joined) {
    const Cluster& a = clusters_[join.a];
    const Cluster& b = clusters_[join.b];
    const double ka = options_.cone_cost;
    switch (join.kind) {
      case JoinKind::kParent:
        joined.node = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        add_child(joined.node, a.node);
        add_child(joined.node, b.node);
        joined.work = 2 * ka;
        break;
      case JoinKind::kAdopt:
        joined.node = a.node;
        add_child(a.node, b.node);
        joined.work = a.work + ka;
        break;
      case JoinKind::kAdopted:
        joined.node = b.node;
        add_child(b.node, a.node);
        joined.work = b.work + ka;
        break;
      case JoinKind::kMerge:
        joined.node = a.node;
        merge_nodes(a.node, b.node);
        joined.work = a.work + b.work;
        break;
    }
  }

  void add_child(std::uint32_t parent, std::uint32_t child) {
    JoinNode& node = nodes_[parent];
    if (node.first_child == JoinNode::kNone) {
      node.first_child = child;
    } else {
      nodes_[node.last_child].next_sibling = child;
    }
    node.last_child = child;
  }

  void merge_nodes(std::uint32_t into, std::uint32_t from) {
    JoinNode& a = nodes_[into];
    const JoinNode& b = nodes_[from];
    if (b.first_edge != JoinNode::kNone) {
      if (a.first_edge == JoinNode::kNone) {
        a.first_edge = b.first_edge;
      } else {
        next_edge_[a.last_edge] = b.first_edge;
      }
      a.last_edge = b.last_edge;
    }
    if (b.first_child != JoinNode::kNone) {
      if (a.first_child == JoinNode::kNone) {
        a.first_child = b.first_child;
      } else {
        nodes_[a.last_child].next_sibling = b.first_child;
      }
      a.last_child = b.last_child;
    }
  }

  std::uint32_t root_of(std::uint32_t cluster) {
    while (owner_[cluster] != cluster) {
      owner_[cluster] = owner_[owner_[cluster]];
      cluster = owner_[cluster];
    }
    return cluster;
  }

  /// The links of both roots become those of the new one, each once, with new candidates.
  void update_links(const Join& join, std::uint32_t id) {
    std::vector<std::uint32_t> links;
    links.reserve(links_[join.a].size() + links_[join.b].size());
    for (const std::uint32_t old : {join.a, join.b}) {
      for (const std::uint32_t link : links_[old]) {
        const std::uint32_t root = root_of(link);
        if (root != id) links.push_back(root);
      }
      links_[old] = {};
    }
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    for (const std::uint32_t link : links) {
      const Join candidate = best_join(link, id, scratch_);
      if (candidate.gain > 0.0) heap_.push(candidate);
    }
    links_.push_back(std::move(links));
  }

  JoinedForest finish() {
    JoinedForest forest;
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      if (owner_[c] == c) forest.roots.push_back(clusters_[c].node);
    }
    std::sort(forest.roots.begin(), forest.roots.end());
    forest.nodes = std::move(nodes_);
    forest.next_edge = std::move(next_edge_);
    return forest;
  }

  std::span<const FramedPlane> planes_;
  std::span<const JoinEdge> edges_;
  PaperForestOptions options_;
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> owner_;  ///< of a root itself, of others a cluster that it was joined into
  std::vector<std::vector<std::uint32_t>> links_;
  std::vector<JoinNode> nodes_;
  std::vector<std::uint32_t> next_edge_;
  std::priority_queue<Join> heap_;
  Gathered scratch_;
};

}  // namespace

Result<JoinedForest> join_forest(std::span<const FramedPlane> planes, std::span<const JoinEdge> edges,
                                 std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
                                 const PaperForestOptions& options, const Progress& progress) {
  return Joiner(planes, edges, options).run(links, progress);
}

}  // namespace limn
