#pragma once

#include <string>
#include <vector>

#include "limn/base/bounds.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"

namespace limn {

/// What a mesh is like, counted.
struct MeshReport {
  std::size_t vertices = 0;         ///< as stored
  std::size_t welded_vertices = 0;  ///< distinct positions that faces use
  std::size_t unused_vertices = 0;  ///< stored, used by no face
  std::size_t faces = 0;
  std::size_t edges = 0;
  std::size_t boundary_edges = 0;
  std::size_t boundary_loops = 0;  ///< connected pieces of the boundary
  std::size_t inconsistent_edges = 0;
  std::size_t non_manifold_edges = 0;
  std::size_t non_manifold_vertices = 0;  ///< whose faces form more than one fan
  std::size_t degenerate_faces = 0;       ///< two corners are one vertex
  std::size_t zero_area_faces = 0;        ///< three distinct collinear corners
  std::size_t duplicate_faces = 0;        ///< same three vertices as an earlier face, in any order
  std::size_t components = 0;             ///< connected through edges
  long euler_characteristic = 0;          ///< of the welded surface, stray vertices and degenerate faces left out
  double volume = 0;                      ///< signed; meaningful when closed
  double area = 0;
  Bounds bounds;
  bool closed = false;  ///< every edge manifold, at least one face
  bool has_normals = false, has_uvs = false, has_colors = false;
};

/// Whether one technique can run on the mesh, and why not.
struct Suitability {
  std::string technique;  ///< "silhouette", "refine", "hull", "clip"
  bool can_run = false;
  std::vector<std::string> reasons;  ///< what prevents it, or, when it can run, what to expect; with counts
};

/// Counts everything above. Cost: a few linear passes. Same result for any number of threads.
MeshReport validate(const Mesh& mesh, const Topology& topology);

/// What silhouette and refine need, held against the report. For hull and clip: solid_suitability (hull/suitability.h).
std::vector<Suitability> suitability(const MeshReport& report);

}  // namespace limn
