#pragma once

#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A closed, oriented surface in which every edge has exactly two faces that run along it in opposite directions, and
/// every vertex one fan of faces: what hulls are made from. It may have several parts and may intersect itself; its
/// inside is where the winding number is positive (Sander et al. 2000, section 3).
struct Shell {
  std::vector<Vec3> positions;  ///< used by faces all; two vertices have equal coordinates where a fan was split
  std::vector<Triangle> faces;  ///< indices into positions; no face twice the same vertex
  std::vector<VertexId> source_vertex;  ///< index into Mesh::positions; kInvalidId for vertices that closing added
  std::vector<FaceId> source_face;      ///< index into Mesh::faces; kInvalidId for faces that closing added
  /// One line for each thing that was changed to get here: boundaries closed, duplicate faces taken out, fans split.
  std::vector<std::string> notes;
};

/// Makes a shell of a mesh: welds by position, takes out faces of which two corners are one point and pairs of faces
/// that cancel, parts non-manifold edges and vertices into manifold fans, closes boundaries (docs/hull-input.md). Faces
/// whose corners lie on a line stay: they hold their neighbours together. Where the mesh is closed (at every edge as
/// many faces run one way as the other), the winding number of the shell equals the mesh's everywhere off the surface.
/// Moves no vertex.
///
/// \pre every index is in range, every position finite (read_mesh and validate see to that)
/// Cost: a few linear passes. Same bits for any number of threads.
/// Errors: kUnsuitable, naming the edge or the volume and the remedy, where no such surface exists (an edge at which
/// two faces or more are left over, all running the same way), nothing encloses a volume, or the whole is inside out.
Result<Shell> make_shell(const Mesh& mesh);

}  // namespace limn
