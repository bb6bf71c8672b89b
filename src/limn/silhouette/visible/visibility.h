#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/contours.h"
#include "limn/silhouette/eye.h"
#include "limn/silhouette/lines.h"
#include "limn/silhouette/visible/ray_scene.h"

namespace limn {

/// What the visibility of any lines of a mesh needs, for any eye: rays, the faces around each vertex, and the edges at
/// which the number of layers may change wherever they are seen from. Built once a mesh; safe to use from many threads.
class VisibilityScene {
 public:
  /// Keeps references to both, which must outlive it and stay where they are.
  /// \param many_views  look now, at every edge, where the mesh intersects itself, rather than at the lines of each
  ///                    view: two to four times as long to build, and saves a ray a line's edge in each view
  /// Cost: RayScene's, and two passes over the faces. Errors: RayScene's. \pre as for RayScene
  static Result<VisibilityScene> build(const Mesh& mesh, const Topology& topology, bool many_views = false);

  const Mesh& mesh() const { return *mesh_; }
  const Topology& topology() const { return *topology_; }
  const RayScene& rays() const { return rays_; }
  std::span<const FaceId> faces_around(VertexId vertex) const {
    return {star_faces_.data() + star_offsets_[vertex], star_faces_.data() + star_offsets_[vertex + 1]};
  }
  /// Boundary and non-manifold edges, ascending.
  std::span<const EdgeId> open_edges() const { return open_edges_; }
  /// Where edges run through faces, ascending by (edge, t); none unless built for many views.
  const std::optional<std::vector<EdgePoint>>& piercings() const { return piercings_; }

 private:
  VisibilityScene(const Mesh& mesh, const Topology& topology, RayScene rays, bool many_views);
  void find_piercings();

  const Mesh* mesh_;
  const Topology* topology_;
  RayScene rays_;
  std::vector<std::uint32_t> star_offsets_;
  std::vector<FaceId> star_faces_;
  std::vector<EdgeId> open_edges_;
  std::optional<std::vector<EdgePoint>> piercings_;
};

/// Chains of several classes together. \see collect_lines (visible_lines.h)
struct LineChains {
  Chains chains;
  std::vector<LineClass> classes;  ///< one a chain
};

/// A part of one step of a chain; the pieces of a step follow each other and cover it.
struct LinePiece {
  std::uint32_t step = 0;  ///< index into Chains::steps
  double begin = 0;        ///< share of the step from `from` (0) to `to` (1)
  double end = 1;
  bool visible = true;
  bool outer = false;  ///< visible, and the background is seen past it; found only when asked for
};

/// What finding visibility took.
struct VisibilityReport {
  std::size_t crossings = 0;  ///< in the picture, where the number of layers may change
  std::size_t piercings = 0;  ///< of lines through faces
  std::size_t turns = 0;      ///< vertices of chains at which the faces around them may hide one side: cusps and ties
  std::size_t rays = 0;
  double crossings_ms = 0, piercings_ms = 0, turns_ms = 0, rays_ms = 0;
};

/// Tells for every part of the lines whether the mesh hides it from the eye.
///
/// The number of layers in front of a point (its quantitative invisibility, Appel 1967) is followed along chains: it
/// can change only where a fold, boundary or non-manifold edge in front crosses in the picture, where the line runs
/// through a face, and at vertices where one of the faces around hides part of the chain (cusps: Markosian et al.
/// 1997, section 3). Lines are cut at all of these; between cuts one line of sight, to the middle of the longest part,
/// decides. Whole surroundings of the eye count: nothing is clipped, and lines beside and behind the eye are treated
/// like those before it. Right for open and self-intersecting meshes too. docs/visibility.md
///
/// \param silhouette  all silhouette edges from this eye, whether or not they are among the lines; any order
/// \param outer       also tell which parts the background is seen past; costs further rays
/// \param report      filled when given
/// \pre chains of class kSilhouette hold silhouette edges from this eye; no other chain does
/// Ascending by (step, begin); neighbours on a step differ in visible or outer. Same bits for any number of threads.
/// Cost: near linear in the lines and their crossings; about a ray a crossing and turn.
std::vector<LinePiece> find_visibility(const VisibilityScene& scene, const LineChains& lines,
                                       std::span<const EdgeId> silhouette, const Eye& eye, bool outer = false,
                                       VisibilityReport* report = nullptr);

}  // namespace limn
