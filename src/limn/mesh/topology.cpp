#include "limn/mesh/topology.h"

#include <algorithm>
#include <cassert>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 8192;

/// A face's side, seen from its lower vertex.
struct HalfEdge {
  VertexId high;
  std::uint32_t corner;  ///< 3 * face + side
};

bool is_degenerate(const Triangle& face) {
  return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// The half edges in one run a lower vertex: offsets[v] … offsets[v + 1].
struct Buckets {
  std::vector<std::uint32_t> offsets;
  std::vector<HalfEdge> half_edges;
};

Buckets bucket_by_lower_vertex(std::span<const Triangle> faces, std::size_t vertex_count) {
  Buckets buckets;
  buckets.offsets.assign(vertex_count + 2, 0);
  // Counts land two places on, so that after the prefix sum offsets[v + 1] is where v's run begins, and after the
  // scatter, which advances it, where it ends.
  for (const Triangle& face : faces) {
    if (is_degenerate(face)) continue;
    for (std::size_t c = 0; c < 3; ++c)
      ++buckets.offsets[std::min(face[c], face[(c + 1) % 3]) + 2];
  }
  for (std::size_t v = 2; v < buckets.offsets.size(); ++v)
    buckets.offsets[v] += buckets.offsets[v - 1];
  buckets.half_edges.resize(buckets.offsets.back());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (is_degenerate(faces[f])) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId a = faces[f][c];
      const VertexId b = faces[f][(c + 1) % 3];
      buckets.half_edges[buckets.offsets[std::min(a, b) + 1]++] = {std::max(a, b),
                                                                   static_cast<std::uint32_t>(3 * f + c)};
    }
  }
  buckets.offsets.pop_back();
  return buckets;
}

/// Sorts each run by upper vertex, then corner, and counts the distinct upper vertices: edges_before[v + 1] for v's
/// run.
std::vector<std::uint32_t> sort_runs(Buckets& buckets) {
  const std::size_t vertex_count = buckets.offsets.size() - 1;
  std::vector<std::uint32_t> edges_before(vertex_count + 1, 0);
  parallel_for(vertex_count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      HalfEdge* const first = buckets.half_edges.data() + buckets.offsets[v];
      HalfEdge* const last = buckets.half_edges.data() + buckets.offsets[v + 1];
      std::sort(first, last, [](const HalfEdge& a, const HalfEdge& b) {
        return a.high != b.high ? a.high < b.high : a.corner < b.corner;
      });
      for (const HalfEdge* h = first; h != last; ++h)
        edges_before[v + 1] += h == first || h->high != (h - 1)->high;
    }
  });
  for (std::size_t v = 0; v < vertex_count; ++v)
    edges_before[v + 1] += edges_before[v];
  return edges_before;
}

/// The half edges of one edge become the edge.
void fill_edge(Topology& topology, EdgeId id, VertexId low, std::span<const HalfEdge> sides) {
  const auto runs_forward = [&](const HalfEdge& side) {
    return topology.faces[side.corner / 3][side.corner % 3] == low;
  };
  for (const HalfEdge& side : sides)
    topology.face_edges[side.corner / 3][side.corner % 3] = id;
  Edge& edge = topology.edges[id];
  edge = {{low, sides[0].high}, {sides[0].corner / 3, sides.size() > 1 ? sides[1].corner / 3 : kInvalidId}};
  if (sides.size() == 1) {
    topology.edge_class[id] = EdgeClass::kBoundary;
  } else if (sides.size() > 2) {
    topology.edge_class[id] = EdgeClass::kNonManifold;
  } else if (runs_forward(sides[0]) == runs_forward(sides[1])) {
    topology.edge_class[id] = EdgeClass::kInconsistent;
  } else {
    topology.edge_class[id] = EdgeClass::kManifold;
    if (!runs_forward(sides[0])) std::swap(edge.face[0], edge.face[1]);
  }
}

void list_non_manifold(Topology& topology, const Buckets& buckets, std::span<const std::uint32_t> edges_before) {
  topology.non_manifold_offsets.push_back(0);
  for (std::size_t v = 0; v + 1 < edges_before.size(); ++v) {
    EdgeId id = edges_before[v];
    for (std::uint32_t h = buckets.offsets[v]; h < buckets.offsets[v + 1]; ++id) {
      const std::uint32_t first = h;
      while (h < buckets.offsets[v + 1] && buckets.half_edges[h].high == buckets.half_edges[first].high)
        ++h;
      if (h - first < 3) continue;
      topology.non_manifold_edges.push_back(id);
      for (std::uint32_t i = first; i < h; ++i) {
        topology.non_manifold_faces.push_back(buckets.half_edges[i].corner / 3);
      }
      topology.non_manifold_offsets.push_back(static_cast<std::uint32_t>(topology.non_manifold_faces.size()));
    }
  }
}

}  // namespace

std::span<const FaceId> Topology::edge_faces(EdgeId edge) const {
  if (edge_class[edge] != EdgeClass::kNonManifold) {
    return {edges[edge].face, edge_class[edge] == EdgeClass::kBoundary ? 1u : 2u};
  }
  const auto found = std::lower_bound(non_manifold_edges.begin(), non_manifold_edges.end(), edge);
  const auto i = static_cast<std::size_t>(found - non_manifold_edges.begin());
  return std::span(non_manifold_faces)
      .subspan(non_manifold_offsets[i], non_manifold_offsets[i + 1] - non_manifold_offsets[i]);
}

Topology build_topology(const Mesh& mesh, const WeldOptions& options) {
  assert(mesh.faces.size() < kInvalidId / 3);
  Topology topology;
  topology.weld = weld_positions(mesh.positions, options);
  topology.faces.resize(mesh.faces.size());
  parallel_for(mesh.faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      for (std::size_t c = 0; c < 3; ++c)
        topology.faces[f][c] = topology.weld[mesh.faces[f][c]];
    }
  });
  for (std::size_t f = 0; f < topology.faces.size(); ++f) {
    if (is_degenerate(topology.faces[f])) topology.degenerate_faces.push_back(static_cast<FaceId>(f));
  }

  Buckets buckets = bucket_by_lower_vertex(topology.faces, mesh.positions.size());
  const std::vector<std::uint32_t> edges_before = sort_runs(buckets);
  topology.edges.resize(edges_before.back());
  topology.edge_class.resize(edges_before.back());
  topology.face_edges.assign(mesh.faces.size(), {kInvalidId, kInvalidId, kInvalidId});
  parallel_for(mesh.positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      EdgeId id = edges_before[v];
      for (std::uint32_t h = buckets.offsets[v]; h < buckets.offsets[v + 1]; ++id) {
        const std::uint32_t first = h;
        while (h < buckets.offsets[v + 1] && buckets.half_edges[h].high == buckets.half_edges[first].high)
          ++h;
        fill_edge(topology, id, static_cast<VertexId>(v), std::span(buckets.half_edges).subspan(first, h - first));
      }
    }
  });
  list_non_manifold(topology, buckets, edges_before);
  return topology;
}

}  // namespace limn
