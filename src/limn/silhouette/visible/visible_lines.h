#pragma once

#include <span>
#include <vector>

#include "limn/silhouette/facing.h"
#include "limn/silhouette/lines.h"
#include "limn/silhouette/visible/visibility.h"

namespace limn {

/// Edges that are drawn wherever the mesh is seen from, by class; see classes.h. What is empty is not drawn.
struct FeatureEdges {
  std::vector<EdgeId> boundary;
  std::vector<EdgeId> crease;
  std::vector<EdgeId> non_manifold;
};

/// All of them. \pre normals is face_normals() of the mesh; 0 <= crease_angle_rad <= π. Cost: three passes over the
/// edges.
FeatureEdges feature_edges(const Topology& topology, std::span<const Vec3> normals, float crease_angle_rad);

struct VisibleLinesOptions {
  bool silhouette = true;  ///< draw silhouettes
  bool hidden = true;      ///< keep hidden parts, as polylines of their own
  bool outer = false;      ///< tell which polylines belong to the outer outline; costs more rays
};

/// A part of an edge that is visible, or hidden, all along.
struct EdgeInterval {
  EdgeId edge = kInvalidId;
  float begin = 0;  ///< share of the edge, from v[0] (0) to v[1] (1)
  float end = 1;
  LineClass line_class = LineClass::kSilhouette;
  bool visible = true;
  bool outer = false;
};

struct VisibleLines {
  Polylines polylines;
  /// Every drawn edge, hidden parts too whatever the options, ascending by (edge, begin); those of an edge cover it.
  std::vector<EdgeInterval> intervals;
};

/// Chains of the silhouette and of the features: no edge twice, an edge that is a silhouette from here drawn as that.
/// \pre planes is face_planes() of the scene's mesh
LineChains collect_lines(const VisibilityScene& scene, std::span<const Plane> planes, const Eye& eye,
                         std::span<const EdgeId> silhouette, const FeatureEdges& features, bool draw_silhouette = true);

/// The polylines of lines whose visibility is known: joined along chains as long as class, visibility and outline stay
/// the same, closed where that is all around. No point equals the one before it, and none lies within an edge but where
/// visibility changes. Ordered by chain. \param hidden  whether to keep hidden ones
Polylines join_pieces(const Mesh& mesh, const LineChains& lines, std::span<const LinePiece> pieces, bool hidden);

/// The lines of a mesh, visible and hidden, as a drawing needs them.
/// \param silhouette  all silhouette edges from this eye, whatever found them; any order
/// \pre planes is face_planes() of the scene's mesh
/// Same bits for any number of threads. Cost: find_visibility's. docs/visibility.md
VisibleLines visible_lines(const VisibilityScene& scene, std::span<const Plane> planes, const Eye& eye,
                           std::span<const EdgeId> silhouette, const FeatureEdges& features = {},
                           const VisibleLinesOptions& options = {}, VisibilityReport* report = nullptr);

}  // namespace limn
