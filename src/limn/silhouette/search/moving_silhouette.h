#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "limn/silhouette/search/search_tree.h"

namespace limn {

/// What a query of a moving eye did.
struct MovingCounters {
  std::size_t leaves_tested = 0;  ///< leaves looked at again, gathering included
  std::size_t edges_changed = 0;  ///< edges that came or went
  bool gathered = false;          ///< the leaves near the eye's way were gathered anew
  bool searched = false;          ///< the eye jumped: SearchTree::find() answered
};

/// The silhouettes of one mesh from an eye that moves little from one query to the next.
///
/// The set found last is kept, and for each leaf of the tree near it the way that the eye may go on for before one of
/// the leaf's faces can turn; a query looks at those leaves whose way is used up. Exact always: the set of
/// extract_silhouette_brute(), whatever the motion (docs/search-tree.md has the bound). Jumps ask the tree.
class MovingSilhouette {
 public:
  /// Keeps `tree`, which must outlive it and not be refitted meanwhile. Memory: 18 bytes an edge.
  explicit MovingSilhouette(const SearchTree& tree);

  /// Every silhouette edge once. \return the edges, valid until the next query. Their order depends on the way the eye
  /// came, not on the level nor on threads.
  /// Cost: a leaf test for each leaf whose faces may have turned; every kSteps queries of a steady eye, of several
  /// times the leaves that SearchTree::find() tests. It pays where few faces turn: not at a million triangles and half
  /// a degree a frame (docs/search-tree.md).
  std::span<const EdgeId> find(const Eye& eye, SimdLevel level = best_simd_level());

  /// What the last query did.
  const MovingCounters& counters() const { return counters_; }

  /// How many steps of the present length a gathering lasts.
  static constexpr int kSteps = 6;

 private:
  /// Where the eye is held to go until the leaves are gathered again: each of its steps within a cone about
  /// `direction` whose half angle has the tangent `spread`; or, with direction 0, anywhere.
  struct Course {
    DVec3 direction{0.0};
    double spread = 1.0;
    double limit = 0.0;  ///< of the way
  };

  bool follow(const Eye& eye, const simd::EyeWords& words, SimdLevel level);
  double way_of(const DVec3& step) const;
  void plan(const DVec3& step);
  void gather(const ExactContext& context, SimdLevel level);
  void forget();
  void update(const simd::EyeWords& words, std::size_t count, SimdLevel level);
  void fetch_planes(std::size_t count);
  void apply(const simd::LeafChanges& changes);
  void put(std::size_t place, std::uint32_t slot);

  const SearchTree* tree_;
  SearchScratch scratch_;
  MovingCounters counters_;

  bool started_ = false;   ///< last_ is of the query before
  bool followed_ = false;  ///< the set below is that of last_
  Eye last_;
  DVec3 last_step_{0.0};
  Course course_;
  double way_ = 0.0;                ///< gone since gathering
  LineVector<std::uint32_t> near_;  ///< the leaves gathered, in the tree's order
  LineVector<float> due_;           ///< of each the way at which it is to be looked at again

  std::vector<std::uint16_t> silhouettes_;  ///< of each leaf, a bit an edge
  std::vector<std::uint32_t> place_of_;     ///< of a slot (16 * leaf + edge) in edges_, while it is there
  LineVector<std::uint32_t> edges_, slots_;
  std::size_t size_ = 0;
  LineVector<std::uint32_t> indices_, leaves_, added_, removed_, unsure_, unsure_faces_;
  LineVector<float> safe_;
};

}  // namespace limn
