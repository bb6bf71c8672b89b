#include "limn/silhouette/search/moving_silhouette.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace limn {
namespace {

/// A course so long, in shares of the mesh's size, that hardly a leaf would be left out: a jump.
constexpr double kLongestCourse = 1.0;

/// What the heading's words are off by, times the plane's, what the predicate's error grows by along the way, and what
/// normals of floats are too long by: 1.74 / 2 / 16383 + 1.74 / 2 / 32767 + small change = 0.8e-4, and as much again.
constexpr double kHeadingError = 1.6e-4;
/// Roundings of the kernels' four operations on floats, many times over.
constexpr double kWayShare = 1.0 - 1.0e-5;
/// Ways are kept as floats: what rounding them may hide.
constexpr double kLater = 1.0 + 1.0e-6;
/// Beyond this spread a cone says no more than that the eye goes somewhere.
constexpr double kWidestSpread = 0.5;

std::int16_t heading_word(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * simd::kHeadingWord));
}

/// Value units in a unit of length, rounded up.
double units(const simd::EyeWords& words, const QuantizedFrame& frame, const Eye& eye) {
  const DVec3 at = eye.at;
  const double reach = eye.orthographic ? glm::length(at) : glm::length(at - frame.origin) + frame.scale;
  return words.reach * double{kLargestWord} / reach;
}

}  // namespace

MovingSilhouette::MovingSilhouette(const SearchTree& tree)
    : tree_(&tree), silhouettes_(tree.leaf_count(), std::uint16_t{0}), place_of_(simd::kWidth * tree.leaf_count()) {}

std::span<const EdgeId> MovingSilhouette::find(const Eye& eye, SimdLevel level) {
  counters_ = {};
  if (tree_->leaves_.empty()) return {};
  const ExactContext context{tree_->planes_, eye};
  const simd::EyeWords words = quantize(tree_->frame_, context);
  const bool may_follow = started_ && words.decisive && eye.orthographic == last_.orthographic;
  const DVec3 step = may_follow ? DVec3(eye.at) - DVec3(last_.at) : DVec3(0.0);
  bool current = may_follow && follow(eye, words, level);
  const bool moved = step != DVec3(0.0);
  if (may_follow && moved && (!current || way_ + way_of(step) > course_.limit)) {
    if (!current) forget();
    plan(step);
    current = course_.limit > 0.0;
    if (current) gather(context, level);
  }
  if (!may_follow) last_step_ = DVec3(0.0);
  if (moved) last_step_ = step;
  last_ = eye;
  started_ = words.decisive;
  followed_ = current;
  if (current) return {edges_.data(), size_};
  counters_.searched = true;
  return tree_->find(eye, scratch_, nullptr, level);
}

double MovingSilhouette::way_of(const DVec3& step) const {
  if (course_.direction == DVec3(0.0)) return glm::length(step);
  const double ahead = glm::dot(step, course_.direction);
  const double aside = glm::length(step - ahead * course_.direction);
  // The direction is of unit length but for roundings, which the spread must not hide.
  return aside <= course_.spread * ahead ? ahead * (1.0 + 1.0e-12) : (step == DVec3(0.0) ? 0.0 : HUGE_VAL);
}

/// Brings the set from the last eye to this one, if that was followed and this lies on its course.
bool MovingSilhouette::follow(const Eye& eye, const simd::EyeWords& words, SimdLevel level) {
  if (!followed_) return false;
  if (eye.at == last_.at) return true;
  const double way = way_ + way_of(DVec3(eye.at) - DVec3(last_.at));
  if (!(way <= course_.limit)) return false;
  way_ = way;
  const std::size_t count =
      simd::kernels(level).find_due(due_.data(), near_.size(), static_cast<float>(way_ * kLater), indices_.data());
  update(words, count, level);
  return true;
}

/// Lays the course for an eye that just made this step; limit 0 if it should rather be taken for a jump.
void MovingSilhouette::plan(const DVec3& step) {
  const double length = glm::length(step);
  const bool had_step = last_step_ != DVec3(0.0);
  const DVec3 turn = had_step ? step / length - last_step_ / glm::length(last_step_) : DVec3(0.0);
  course_ = {};
  const double spread = 0.004 + (had_step ? 0.55 * kSteps * glm::length(turn) : kWidestSpread);
  if (spread < kWidestSpread) {
    course_.direction = glm::normalize(step / length + (0.5 * kSteps + 0.5) * turn);
    course_.spread = spread;
  }
  course_.limit = kSteps * 1.02 * length;
  const double size = tree_->frame_.scale * (last_.orthographic ? 0.0 : 1.0);
  const double most = kLongestCourse * (size > 0.0 ? size : glm::length(DVec3(last_.at)));
  if (!(course_.limit < most)) course_.limit = 0.0;
}

/// Finds every leaf that may change along the course. Those left out hold nothing now and to its end.
void MovingSilhouette::gather(const ExactContext& context, SimdLevel level) {
  counters_.gathered = true;
  way_ = 0.0;
  const double travel = course_.limit * (course_.direction == DVec3(0.0) ? 1.0 : 1.0 + course_.spread);
  const simd::EyeWords around = quantize_within(tree_->frame_, context, travel);
  const SearchTree::Entered entered = tree_->enter(tree_->levels_.size() - 1, around, scratch_, nullptr, level);
  near_.resize(entered.count);
  for (std::size_t i = 0; i < entered.count; ++i)
    near_[i] = entered.leaves != nullptr ? entered.leaves[i] : static_cast<std::uint32_t>(i);
  due_.resize(entered.count + simd::kWidth);
  indices_.resize(entered.count + simd::kWidth);
  leaves_.resize(entered.count);
  std::iota(indices_.begin(), indices_.end(), 0u);
  update(quantize(tree_->frame_, context), entered.count, level);
}

/// Empties the set.
void MovingSilhouette::forget() {
  for (std::size_t i = 0; i < size_; ++i)
    silhouettes_[slots_[i] / simd::kWidth] = 0;
  size_ = 0;
}

/// Looks at the near leaves that the first `count` indices name.
void MovingSilhouette::update(const simd::EyeWords& words, std::size_t count, SimdLevel level) {
  const std::size_t room = simd::kWidth * (count + 1);
  if (added_.size() < room) {
    added_.resize(room);
    removed_.resize(room);
    safe_.resize(room / simd::kWidth);
    unsure_.resize(room / simd::kWidth);
    unsure_faces_.resize(room / simd::kWidth);
  }
  for (std::size_t i = 0; i < count; ++i)
    leaves_[i] = near_[indices_[i]];
  const Eye& eye = static_cast<const ExactContext*>(words.context)->eye;
  const double unit = units(words, tree_->frame_, eye);
  simd::Heading heading{};
  heading.x = heading_word(course_.direction.x);
  heading.y = heading_word(course_.direction.y);
  heading.z = heading_word(course_.direction.z);
  heading.along = static_cast<float>(unit / (double{kLargestWord} * simd::kHeadingWord));
  heading.drift = static_cast<float>(unit * (course_.spread + kHeadingError));
  const simd::Kernels& kernels = simd::kernels(level);
  simd::LeafChanges changes{silhouettes_.data(),
                            place_of_.data(),
                            added_.data(),
                            removed_.data(),
                            safe_.data(),
                            unsure_.data(),
                            unsure_faces_.data(),
                            0,
                            0,
                            0};
  kernels.update_leaves(tree_->leaves_.data(), tree_->leaf_faces_.data(), leaves_.data(), count, words, heading,
                        changes);
  for (std::size_t i = 0; i < count; ++i)
    due_[indices_[i]] = static_cast<float>(way_ + kWayShare * safe_[i]);
  fetch_planes(changes.unsure_count);
  apply(changes);

  // Faces in doubt turn at any moment: theirs are due at once, and looked at again with the exact test.
  simd::LeafChanges rest = changes;
  rest.unsure = nullptr;
  kernels.update_leaves(tree_->leaves_.data(), tree_->leaf_faces_.data(), unsure_.data(), changes.unsure_count, words,
                        heading, rest);
  apply(rest);
  counters_.leaves_tested += count;
}

/// Fetches the exact planes of faces in doubt, and makes the numbers of unsure leaves out of their places in leaves_.
void MovingSilhouette::fetch_planes(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    due_[indices_[unsure_[i]]] = static_cast<float>(way_);
    unsure_[i] = leaves_[unsure_[i]];
    const FaceId* const faces = &tree_->leaf_faces_[std::size_t{simd::kWidth} * unsure_[i]];
    for (std::uint32_t left = unsure_faces_[i]; left != 0; left &= left - 1)
      __builtin_prefetch(&tree_->planes_[faces[__builtin_ctz(left)]]);
  }
}

void MovingSilhouette::put(std::size_t place, std::uint32_t slot) {
  slots_[place] = slot;
  edges_[place] = tree_->leaves_[slot / simd::kWidth].edges[slot % simd::kWidth];
  place_of_[slot] = static_cast<std::uint32_t>(place);
}

/// Puts new edges in the places of those that went; the rest at the end, or the last ones into places left over.
void MovingSilhouette::apply(const simd::LeafChanges& changes) {
  counters_.edges_changed += changes.added_count + changes.removed_count;
  const std::size_t most = size_ + changes.added_count;
  if (edges_.size() < most) {
    edges_.resize(most + most / 2);
    slots_.resize(most + most / 2);
  }
  const std::size_t both = std::min(changes.added_count, changes.removed_count);
  for (std::size_t i = 0; i < both; ++i)
    put(place_of_[changes.removed[i]], changes.added[i]);
  for (std::size_t i = both; i < changes.added_count; ++i)
    put(size_++, changes.added[i]);
  for (std::size_t i = both; i < changes.removed_count; ++i) {
    const std::size_t place = place_of_[changes.removed[i]];
    --size_;
    if (place != size_) put(place, slots_[size_]);
  }
}

}  // namespace limn
