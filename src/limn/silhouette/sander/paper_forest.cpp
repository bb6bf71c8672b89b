#include "limn/silhouette/sander/paper_forest.h"

#include "limn/silhouette/sander/forest_walk.h"

namespace limn {

SearchCounts extract_silhouette_forest(const PaperForest& forest, const Eye& eye, std::vector<EdgeId>& edges) {
  const FramedEye framed = framed_eye(eye, forest.frame);
  return walk_forest(forest, eye, edges,
                     [&](std::uint32_t node) { return framed.cullable && culls(forest.nodes[node].cone, framed); });
}

}  // namespace limn
