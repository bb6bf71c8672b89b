#pragma once

#include <vector>

#include "limn/silhouette/sander/paper_forest.h"

namespace limn {

/// The conservative constant-time test of Johannsen and Carter 1998, "Clustered Backface Culling", for one cluster.
///
/// The normals lie in a box, the faces' planes between two values at a point amid the faces. Whoever stands behind the
/// eight half-spaces that the corners of the box and the greater value make is behind every face; in front likewise. A
/// test costs what one face's costs: each coordinate picks one bound of the box by its sign.
struct JohannsenCarterBound {
  Vec3 origin{0.0f};          ///< in the culling frame
  Vec3 low{-1.0f};            ///< of the normals
  Vec3 high{1.0f};            ///< of the normals
  float front_offset = 0.0f;  ///< the least of n·x + offset at `origin`
  float back_offset = 0.0f;   ///< the greatest
};

/// Whether all faces of the cluster are certainly seen from one side. \pre eye.cullable
inline bool culls(const JohannsenCarterBound& bound, const FramedEye& eye) {
  double least = eye.is_point * double{bound.front_offset};
  double most = eye.is_point * double{bound.back_offset};
  for (int axis = 0; axis < 3; ++axis) {
    const double q = eye.at[axis] - eye.is_point * double{bound.origin[axis]};
    least += q * double{q > 0.0 ? bound.low[axis] : bound.high[axis]};
    most += q * double{q > 0.0 ? bound.high[axis] : bound.low[axis]};
  }
  return least > 0.0 || most < 0.0;
}

/// The bound of each node of a forest, from all faces below it. Bounds are widened so that culling is right in spite
/// of rounding. Nodes with faces without area get a bound that never culls.
/// Cost: one pass over the edges below each node. Same bits for any number of threads.
std::vector<JohannsenCarterBound> johannsen_carter_bounds(const PaperForest& forest, const Mesh& mesh,
                                                          const Topology& topology);

/// extract_silhouette_forest() with these bounds in place of the anchored cones. \pre bounds are those of this forest
SearchCounts extract_silhouette_johannsen_carter(const PaperForest& forest,
                                                 const std::vector<JohannsenCarterBound>& bounds, const Eye& eye,
                                                 std::vector<EdgeId>& edges);

}  // namespace limn
