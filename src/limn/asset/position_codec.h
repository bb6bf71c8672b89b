#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/asset/connectivity_codec.h"
#include "limn/asset/range_coder.h"
#include "limn/base/vec.h"

namespace limn::asset {

/// Coordinates as whole numbers whose differences are small where the coordinates lie close.
///
/// Either the bits of the float, in the order of the numbers they stand for; or, where a text gave the coordinates with
/// few digits, what they are times a power of ten: then fewer bits hold them.
class WholeNumbers {
 public:
  static constexpr int kMostDigits = 9;
  /// Beyond it a float's own bits are fewer.
  static constexpr std::int64_t kMostDecimal = std::int64_t{1} << 24;

  /// \param digits  behind the point, 0 to kMostDigits; -1: the floats' bits
  explicit WholeNumbers(int digits);

  /// The fewest digits that give every coordinate back, bit for bit; -1 when none do.
  static int digits_of(std::span<const Vec3> positions);

  int digits() const { return digits_; }
  std::int64_t of(float value) const;
  /// The float; false when there is none.
  bool back(std::int64_t whole, float& value) const;
  /// a + b - c as whole numbers.
  std::int64_t guess(float a, float b, float c) const;

 private:
  bool keeps(float value) const;

  int digits_;
  double scale_;
};

/// Positions as differences from what the faces around them lead to expect.
template <class Coder>
class PositionCodec {
 public:
  PositionCodec(Coder& coder, const WholeNumbers& numbers) : coder_(coder), numbers_(numbers) {}

  /// Codes the positions of all vertices, from or into `positions`; false when a decoder's stream makes no sense.
  bool code(std::vector<Vec3>& positions, const std::vector<Guess>& guesses) {
    if constexpr (Coder::kDecodes) positions.assign(guesses.size(), Vec3(0.0f));
    for (std::size_t v = 0; v < guesses.size(); ++v) {
      if (coder_.failed()) return false;
      const Guess guess = usable(guesses[v], static_cast<VertexId>(v));
      for (int axis = 0; axis < 3; ++axis) {
        if (!code_coordinate(positions, static_cast<VertexId>(v), guess, axis)) return false;
      }
    }
    return true;
  }

 private:
  static constexpr std::size_t kWidths = 36;

  /// A guess from vertices that come before; the one before where there is none.
  static Guess usable(const Guess& guess, VertexId vertex) {
    if (guess.a < vertex && guess.b < vertex && guess.c < vertex) return guess;
    const VertexId before = vertex == 0 ? kInvalidId : vertex - 1;
    return {before, before, before};
  }

  bool code_coordinate(std::vector<Vec3>& positions, VertexId v, const Guess& guess, int axis) {
    const std::int64_t expected =
        guess.a == kInvalidId
            ? 0
            : numbers_.guess(positions[guess.a][axis], positions[guess.b][axis], positions[guess.c][axis]);
    std::int64_t difference = 0;
    if constexpr (!Coder::kDecodes) difference = numbers_.of(positions[v][axis]) - expected;
    const std::uint64_t code = models_[static_cast<std::size_t>(axis)][last_].code(coder_, zigzag(difference));
    if (code >> 40 != 0) return false;
    last_ = std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(code)), kWidths - 1);
    if constexpr (Coder::kDecodes) return numbers_.back(expected + unzigzag(code), positions[v][axis]);
    return true;
  }

  Coder& coder_;
  const WholeNumbers& numbers_;
  std::array<std::array<NumberModel, kWidths>, 3> models_;
  std::size_t last_ = 0;  ///< the size of the difference before
};

}  // namespace limn::asset
