#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "limn/mesh/ids.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// What the faces around an edge make of it.
enum class EdgeClass : std::uint8_t {
  kManifold,      ///< two faces, which run along it in opposite directions
  kBoundary,      ///< one face
  kInconsistent,  ///< two faces that run along it in the same direction: one of them is flipped
  kNonManifold,   ///< three faces or more
};

/// One undirected edge. v[0] < v[1]; face[0] is the one that runs from v[0] to v[1] where there is one (for
/// kNonManifold: the two lowest faces; all of them through Topology::edge_faces). A boundary edge has face[1] ==
/// kInvalidId.
struct Edge {
  VertexId v[2];
  FaceId face[2];
};

/// Connectivity by position: vertices of equal coordinates are one vertex, named by its lowest index.
///
/// Faces two of whose corners are one vertex (`degenerate_faces`) take no part: their face_edges are kInvalidId.
/// Immutable once built; edges are sorted by (v[0], v[1]).
struct Topology {
  std::vector<VertexId> weld;   ///< position index → lowest index of an equal position
  std::vector<Triangle> faces;  ///< as Mesh::faces, welded
  std::vector<Edge> edges;
  std::vector<EdgeClass> edge_class;                ///< one an edge
  std::vector<std::array<EdgeId, 3>> face_edges;    ///< edge c runs from corner c to corner (c+1) % 3
  std::vector<FaceId> degenerate_faces;             ///< ascending
  std::vector<EdgeId> non_manifold_edges;           ///< ascending
  std::vector<std::uint32_t> non_manifold_offsets;  ///< into non_manifold_faces; one more than non_manifold_edges
  std::vector<FaceId> non_manifold_faces;           ///< ascending within an edge

  std::size_t face_count() const { return faces.size(); }
  std::size_t edge_count() const { return edges.size(); }

  /// Whether corner c of the face starts its edge at the edge's v[0]. \pre the face is not degenerate
  bool runs_forward(FaceId face, int c) const {
    return faces[face][static_cast<std::size_t>(c)] == edges[face_edges[face][static_cast<std::size_t>(c)]].v[0];
  }

  /// Every face at the edge, ascending for kNonManifold, face[0] first otherwise. Valid while the topology lives.
  std::span<const FaceId> edge_faces(EdgeId edge) const;
};

/// How positions are joined.
struct WeldOptions {
  /// Positions up to this far apart become one vertex (chains of near vertices are joined as well); 0 joins equal
  /// coordinates only, which is what every limn algorithm assumes unless told otherwise. Moves no coordinate.
  float tolerance = 0.0f;
};

/// For each position the lowest index of an equal one (-0 equals 0). Cost: one pass over a hash table, or
/// a sort where positions crowd its slots. Same result for any number of threads. \pre every position is finite
std::vector<VertexId> weld_positions(std::span<const Vec3> positions, const WeldOptions& options = {});

/// Builds the connectivity of a mesh. Cost: a few linear passes. Same result for any number of threads.
/// \pre every index is below positions.size(), every position finite (read_mesh and validate see to that)
Topology build_topology(const Mesh& mesh, const WeldOptions& options = {});

}  // namespace limn
