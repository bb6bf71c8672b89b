#pragma once

#include <span>

#include "limn/silhouette/search/search_tree.h"

namespace limn {

/// The silhouettes of one mesh from an eye that moves little from one query to the next.
///
/// n·p + d changes by no more than p moves, n being of unit length. So leaves all of whose faces are farther from 0
/// than the eye has moved since they were last looked at hold what they held: nothing. The others are kept side by
/// side, and only they are searched, until the eye has used its travel up; then the tree is asked again. Exact always:
/// the set of extract_silhouette_brute(). Jumps, and orthographic eyes that turn, ask the tree.
class MovingSilhouette {
 public:
  /// \param steps  how many steps of the present length the kept leaves should last for
  /// Keeps `tree`, which must outlive it and not be refitted meanwhile.
  explicit MovingSilhouette(const SearchTree& tree, double steps = 6.0) : tree_(&tree), steps_(steps) {}

  /// Every silhouette edge once. \return the edges, valid until the next query
  /// Cost: a leaf test for each leaf kept; now and then that of SearchTree::find and a copy of these leaves.
  std::span<const EdgeId> find(const Eye& eye, SimdLevel level = best_simd_level());

  std::size_t kept_leaves() const { return leaves_.size(); }
  std::size_t rebuilds() const { return rebuilds_; }

 private:
  void gather(const Eye& eye, double travel, SimdLevel level);

  const SearchTree* tree_;
  double steps_;
  bool started_ = false;
  Eye last_;              ///< of the query before
  Eye base_;              ///< where the leaves were gathered
  double travel_ = -1.0;  ///< how far from base_ they serve
  std::size_t rebuilds_ = 0;
  LineVector<simd::Leaf> leaves_;
  std::vector<FaceId> faces_;
  SearchScratch scratch_;
};

}  // namespace limn
