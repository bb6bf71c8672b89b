#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/hull/hull_step.h"
#include "limn/hull/shell.h"
#include "limn/mesh/mesh.h"

namespace limn {

enum class HullSide : std::uint8_t {
  kOuter,  ///< the hull encloses the mesh
  kInner,  ///< the mesh encloses the hull
};

struct HullOptions {
  std::size_t faces = 500;  ///< stop when no more faces than this are left; at least 4
  HullSide side = HullSide::kOuter;
  /// Refuse steps whose new faces would cross others: an input without self-intersections then stays without.
  bool strict = false;
  bool keep_steps = false;  ///< fill Hull::steps, for a sequence file
  Progress progress = {};
};

/// What was reached, and what is proved of it.
struct HullReport {
  std::size_t faces_before = 0;  ///< of the shell
  std::size_t faces = 0;         ///< of the hull
  bool reached_target = false;   ///< faces <= HullOptions::faces
  double volume_before = 0;      ///< of the shell, by the divergence theorem: its winding number's integral
  double volume = 0;             ///< of the hull
  double volume_ratio = 0;       ///< volume / volume_before; below 1 for inner hulls

  std::size_t collapses = 0;
  std::size_t moves = 0;  ///< vertices moved and edges turned, where no collapse was left
  std::size_t flips = 0;
  std::size_t cuts = 0;     ///< tunnels opened and pockets parted off (HullStep::Kind::kCut)
  std::size_t filled = 0;   ///< cavities filled up (kFill)
  std::size_t dropped = 0;  ///< parts dropped that lay inside others (kDrop)
  /// Orientation tests that make up the certificate: each proved, exactly and on the stored coordinates, that a step
  /// moved no point from inside to outside. Steps that could not be proved were not taken.
  std::size_t certified = 0;
  /// The least distance of a new vertex from the plane of a face that it had to lie outside of, in the mesh's units;
  /// >= 0. Steps of kFlip: of the fourth vertex from the plane.
  double worst_margin = 0;
  std::size_t refused = 0;         ///< placements that the exact test refused
  std::size_t rescued = 0;         ///< times that no collapse was left and the surface was moved on to make room
  std::vector<std::string> notes;  ///< what was changed to make a shell of the mesh; attributes that were dropped
};

/// A coarse mesh that encloses a fine one (or is enclosed by it), with the way that led there.
struct Hull {
  Mesh mesh;  ///< positions, faces, smooth normals; uvs where the mesh's have no seam
  /// One a position of the original mesh: the hull's vertex that it became part of; kInvalidId where no face used it,
  /// and where its part was filled or dropped.
  std::vector<VertexId> vertex_of_original;
  HullReport report;
  /// In the ids of `shell` and its orientation (for inner hulls too: there they move the surface inwards), in order;
  /// empty unless HullOptions::keep_steps.
  std::vector<HullStep> steps;
  Shell shell;                         ///< what the steps start from
  std::vector<VertexId> shell_vertex;  ///< one a vertex of the hull: its id in `shell`
  std::vector<FaceId> shell_face;      ///< one a face of the hull: its id in `shell`
};

/// Simplifies a mesh to a hull (docs/hull.md): every point inside the mesh (where its winding number is positive) is
/// inside the hull.
///
/// Edges collapse, cheapest first, into vertices that lie outside the planes of all faces around them and add the least
/// volume. Every step is proved by exact orientation tests on the float coordinates that the hull holds,
/// so enclosure does not rest on rounding. For an inner hull the same is done with the mesh turned inside out.
/// A target that cannot be reached is success: HullReport::reached_target is then false.
///
/// \pre every index is in range, every position finite (read_mesh and validate see to that)
/// Cost: about 3 µs a face of the mesh on one core. Same input, same bits. Results scale with the mesh: exactly for
/// powers of two. Errors: kUnsuitable where no closed surface can be made of the mesh (make_shell), kInvalidArgument,
/// kCancelled. Sander et al. 2000, section 3.
Result<Hull> build_hull(const Mesh& mesh, const HullOptions& options = {});

/// As above, from a shell; vertex_of_original is left empty, and uvs too.
Result<Hull> build_hull(Shell shell, const HullOptions& options = {});

}  // namespace limn
