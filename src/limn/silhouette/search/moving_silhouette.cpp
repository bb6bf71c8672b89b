#include "limn/silhouette/search/moving_silhouette.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

namespace limn {
namespace {

double distance(const Eye& a, const Eye& b) {
  return glm::length(DVec3(a.at) - DVec3(b.at));
}

/// Whether some face of the leaf may turn within the bound, or some already differ.
bool may_change(const simd::Leaf& leaf, const simd::EyeWords& eye) {
  bool front = false, back = false;
  for (int lane = 0; lane < simd::kWidth; ++lane) {
    const simd::PlaneGroup& p = leaf.planes;
    const std::int32_t value =
        p.xy[2 * lane] * eye.x + p.xy[2 * lane + 1] * eye.y + p.zd[2 * lane] * eye.z + p.zd[2 * lane + 1] * eye.h;
    if (std::abs(value) <= eye.error) return true;
    (value > 0 ? front : back) = true;
  }
  return front && back;
}

}  // namespace

std::span<const EdgeId> MovingSilhouette::find(const Eye& eye, SimdLevel level) {
  const bool same_kind = started_ && eye.orthographic == last_.orthographic;
  const double step = same_kind ? distance(eye, last_) : 0.0;
  if (!same_kind || !(distance(eye, base_) <= travel_)) gather(eye, steps_ * step, level);
  started_ = true;
  last_ = eye;
  const ExactContext context{tree_->planes_, eye};
  const simd::EyeWords words = quantize(tree_->frame_, context);
  const std::size_t room = simd::kWidth * (leaves_.size() + 1);
  if (scratch_.edges.size() < room) scratch_.edges.resize(room);
  const std::size_t found = simd::kernels(level).sweep_leaves(leaves_.data(), faces_.data(), nullptr, leaves_.size(),
                                                              words, scratch_.edges.data());
  return {scratch_.edges.data(), found};
}

void MovingSilhouette::gather(const Eye& eye, double travel, SimdLevel level) {
  ++rebuilds_;
  base_ = eye;
  travel_ = travel;
  const ExactContext context{tree_->planes_, eye};
  simd::EyeWords words = quantize_within(tree_->frame_, context, travel);
  leaves_.clear();
  faces_.clear();
  if (tree_->leaves_.empty()) return;
  const SearchTree::Entered entered = tree_->enter(tree_->levels_.size() - 1, words, scratch_, nullptr, level);
  for (std::size_t i = 0; i < entered.count; ++i) {
    const std::size_t l = entered.leaves != nullptr ? entered.leaves[i] : i;
    if (!may_change(tree_->leaves_[l], words)) continue;
    leaves_.push_back(tree_->leaves_[l]);
    const auto first = tree_->leaf_faces_.begin() + static_cast<std::ptrdiff_t>(simd::kWidth * l);
    faces_.insert(faces_.end(), first, first + simd::kWidth);
  }
}

}  // namespace limn
