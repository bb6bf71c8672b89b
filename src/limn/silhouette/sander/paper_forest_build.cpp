#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "limn/base/parallel.h"
#include "limn/silhouette/sander/forest_joins.h"
#include "limn/silhouette/sander/forest_walk.h"
#include "limn/silhouette/sander/paper_forest.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 256;

using Links = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

std::vector<EdgeId> edges_with_two_faces(const Topology& topology) {
  std::vector<EdgeId> edges;
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const EdgeClass edge_class = topology.edge_class[e];
    if (edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent)
      edges.push_back(static_cast<EdgeId>(e));
  }
  return edges;
}

/// Every pair of edges that share a vertex of the mesh.
void link_at_vertices(const Topology& topology, std::span<const EdgeId> edges, Links& links) {
  std::vector<std::pair<VertexId, std::uint32_t>> ends;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const VertexId v : topology.edges[edges[i]].v)
      ends.emplace_back(v, static_cast<std::uint32_t>(i));
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t begin = 0; begin < ends.size();) {
    std::size_t end = begin;
    while (end < ends.size() && ends[end].first == ends[begin].first)
      ++end;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j)
        links.emplace_back(ends[i].second, ends[j].second);
    }
    begin = end;
  }
}

/// Edges apart with similar normals: each with at most eight that follow it among the edges of one cell of normals.
void link_similar_normals(std::span<const FramedPlane> planes, std::span<const JoinEdge> edges, double angle_rad,
                          Links& links) {
  constexpr std::size_t kMostLinks = 8;
  std::map<std::array<int, 3>, std::vector<std::uint32_t>> cells;
  std::vector<DVec3> normals(edges.size(), DVec3(0.0));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const DVec3 sum = planes[edges[e].face[0]].normal + planes[edges[e].face[1]].normal;
    const double length = glm::length(sum);
    if (!(length > 0.0)) continue;
    normals[e] = sum / length;
    const DVec3 cell = glm::floor(normals[e] / angle_rad);
    cells[{static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)}].push_back(
        static_cast<std::uint32_t>(e));
  }
  const double least = std::cos(angle_rad);
  for (const auto& [key, members] : cells) {
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (std::size_t j = i + 1; j < std::min(members.size(), i + 1 + kMostLinks); ++j) {
        if (glm::dot(normals[members[i]], normals[members[j]]) >= least) links.emplace_back(members[i], members[j]);
      }
    }
  }
}

/// What the greedy construction works on.
struct Prepared {
  std::vector<EdgeId> edge_ids;
  std::vector<JoinEdge> edges;
  std::vector<FramedPlane> planes;
  Links links;
};

Prepared prepare(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes, const CullingFrame& frame,
                 const PaperForestOptions& options) {
  Prepared prepared;
  prepared.edge_ids = edges_with_two_faces(topology);
  for (const EdgeId e : prepared.edge_ids) {
    const Edge& edge = topology.edges[e];
    const DVec3 middle = (DVec3(mesh.positions[edge.v[0]]) + DVec3(mesh.positions[edge.v[1]])) * 0.5;
    prepared.edges.push_back({{edge.face[0], edge.face[1]}, (middle - frame.center) * frame.per_unit});
  }
  for (const Plane& plane : planes)
    prepared.planes.push_back(framed_plane(plane, frame));
  link_at_vertices(topology, prepared.edge_ids, prepared.links);
  if (options.similar_normals_rad > 0.0)
    link_similar_normals(prepared.planes, prepared.edges, options.similar_normals_rad, prepared.links);
  std::sort(prepared.links.begin(), prepared.links.end());
  prepared.links.erase(std::unique(prepared.links.begin(), prepared.links.end()), prepared.links.end());
  return prepared;
}

/// Lays the trees out in the order of a walk.
class Layout {
 public:
  Layout(const JoinedForest& joined, const Prepared& prepared, std::span<const Plane> planes, PaperForest& forest)
      : joined_(joined), prepared_(prepared), planes_(planes), forest_(forest) {
    local_.assign(planes.size(), kInvalidId);
  }

  void run() {
    // By hand, not by recursion: chains of adoptions can be deep.
    struct Open {
      std::uint32_t at;          // in the forest
      std::uint32_t next_child;  // in joined_
    };
    std::vector<Open> open;
    for (const std::uint32_t root : joined_.roots) {
      open.push_back({place(root), joined_.nodes[root].first_child});
      while (!open.empty()) {
        const std::uint32_t child = open.back().next_child;
        if (child == JoinNode::kNone) {
          forest_.nodes[open.back().at].skip = static_cast<std::uint32_t>(forest_.nodes.size());
          open.pop_back();
          continue;
        }
        open.back().next_child = joined_.nodes[child].next_sibling;
        open.push_back({place(child), joined_.nodes[child].first_child});
      }
    }
    forest_.root_count = joined_.roots.size();
  }

  /// The edges' middles, beside forest.edges.
  std::span<const DVec3> middles() const { return middles_; }

 private:
  std::uint32_t place(std::uint32_t node) {
    const auto begin = static_cast<std::uint32_t>(forest_.edges.size());
    for (std::uint32_t e = joined_.nodes[node].first_edge; e != JoinNode::kNone; e = joined_.next_edge[e]) {
      const FaceId* faces = prepared_.edges[e].face;
      const std::uint32_t first = local_face(faces[0]);
      forest_.edges.push_back({prepared_.edge_ids[e], {first, local_face(faces[1])}});
      middles_.push_back(prepared_.edges[e].middle);
    }
    forest_.nodes.push_back({{}, begin, static_cast<std::uint32_t>(forest_.edges.size()), 0});
    return static_cast<std::uint32_t>(forest_.nodes.size() - 1);
  }

  std::uint32_t local_face(FaceId face) {
    if (local_[face] == kInvalidId) {
      local_[face] = static_cast<std::uint32_t>(forest_.planes.size());
      forest_.planes.push_back(planes_[face]);
    }
    return local_[face];
  }

  const JoinedForest& joined_;
  const Prepared& prepared_;
  std::span<const Plane> planes_;
  PaperForest& forest_;
  std::vector<std::uint32_t> local_;
  std::vector<DVec3> middles_;
};

/// The cone of one node, from all edges below it.
class NodeCone {
 public:
  NodeCone(const PaperForest& forest, std::span<const FramedPlane> planes, std::span<const DVec3> middles)
      : forest_(forest), planes_(planes), middles_(middles) {}

  StoredCone of(const PaperForestNode& node) {
    const std::uint32_t end = end_of_edges_below(forest_, node);
    faces_.clear();
    DVec3 middle(0.0);
    for (std::uint32_t e = node.edge_begin; e < end; ++e) {
      const PaperForestEdge& edge = forest_.edges[e];
      faces_.insert(faces_.end(), {edge.face[0], edge.face[1]});
      middle += middles_[e];
    }
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
    normals_.clear();
    offsets_.clear();
    for (const std::uint32_t face : faces_) {
      if (!planes_[face].usable) return {};
      normals_.push_back(planes_[face].normal);
      offsets_.push_back(planes_[face].offset);
    }
    const FaceCluster cluster{normals_, offsets_, middle / static_cast<double>(end - node.edge_begin)};
    return stored_cone(anchored_cone(cluster), cluster, forest_.frame);
  }

 private:
  const PaperForest& forest_;
  std::span<const FramedPlane> planes_;  ///< beside forest_.planes
  std::span<const DVec3> middles_;       ///< beside forest_.edges
  std::vector<std::uint32_t> faces_;
  std::vector<DVec3> normals_;
  std::vector<double> offsets_;
};

void make_cones(std::span<const DVec3> middles, PaperForest& forest) {
  std::vector<FramedPlane> planes;
  for (const Plane& plane : forest.planes)
    planes.push_back(framed_plane(plane, forest.frame));
  parallel_for(forest.nodes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    NodeCone cone(forest, planes, middles);
    for (std::size_t i = begin; i < end; ++i)
      forest.nodes[i].cone = cone.of(forest.nodes[i]);
  });
}

Result<void> check(const PaperForestOptions& options) {
  if (!(options.cone_cost > 0.0) || !std::isfinite(options.cone_cost))
    return fail(ErrorCode::kInvalidArgument, "the cost of a cone must be above 0", "use 4/3, the paper's");
  if (!(options.viewpoint_radius >= 1.0))
    return fail(ErrorCode::kInvalidArgument, "the sphere of viewpoints must enclose the mesh", "use 10 radii");
  if (!(options.similar_normals_rad >= 0.0 && options.similar_normals_rad <= 1.0))
    return fail(ErrorCode::kInvalidArgument, "the angle between similar normals must be 0 to 1 rad", "use 0");
  return {};
}

}  // namespace

Result<PaperForest> build_paper_forest(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes,
                                       const PaperForestOptions& options, const Progress& progress) {
  if (Result<void> checked = check(options); !checked) return tl::unexpected(checked.error());
  PaperForest forest;
  forest.frame = culling_frame(mesh, planes);
  const Prepared prepared = prepare(mesh, topology, planes, forest.frame, options);
  Result<JoinedForest> joined = join_forest(prepared.planes, prepared.edges, prepared.links, options, progress);
  if (!joined) return tl::unexpected(joined.error());
  Layout layout(*joined, prepared, planes, forest);
  layout.run();
  make_cones(layout.middles(), forest);
  return forest;
}

}  // namespace limn
