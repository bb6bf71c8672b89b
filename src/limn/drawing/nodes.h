#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace limn::drawing {

/// A point of the page in steps of kPageStepMm. 31 bits are 2 km.
using Steps = glm::ivec2;
using NodeId = std::uint32_t;

/// Points of the page, those within a tolerance of an earlier one taken for it.
///
/// Deterministic: depends on the order of the calls alone. Cost: nine look-ups in a hash table a call.
class Nodes {
 public:
  /// \param tolerance_steps  at least 0  \param expected  how many calls to make room for
  Nodes(double tolerance_steps, std::size_t expected);

  /// The nearest point within the tolerance, the lowest of equals; a new one when there is none.
  NodeId at(const Steps& point);

  const Steps& operator[](NodeId node) const { return points_[node]; }
  std::size_t size() const { return points_.size(); }

 private:
  std::size_t slot_of(const Steps& cell) const;
  void grow();

  double limit_;  ///< the tolerance squared
  std::int32_t cell_size_;
  std::vector<Steps> points_;
  std::vector<NodeId> next_;  ///< beside each point the next of its cell
  struct Slot {
    Steps cell;
    NodeId head;
  };
  std::vector<Slot> table_;  ///< open addressing; a power of two, at most half full
  std::size_t used_ = 0;
};

}  // namespace limn::drawing
