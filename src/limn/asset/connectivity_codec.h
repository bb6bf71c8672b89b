#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "limn/asset/cut_border.h"
#include "limn/asset/range_coder.h"

namespace limn::asset {

/// Three vertices from which a fourth is guessed as a + b - c; kInvalidId where there is no guess.
struct Guess {
  VertexId a = kInvalidId, b = kInvalidId, c = kInvalidId;
};

/// Faces as steps of a CutBorder: what the third vertex at each gate is.
template <class Coder>
class ConnectivityCodec {
 public:
  ConnectivityCodec(Coder& coder, std::size_t vertices) : coder_(coder), border_(vertices), guesses_(vertices) {}

  /// Codes `count` faces, from or into `faces`; false when a decoder's stream makes no sense.
  bool code(std::vector<Triangle>& faces, std::size_t count);

  /// How each vertex was met: across which edge from which other face.
  const std::vector<Guess>& guesses() const { return guesses_; }

 private:
  enum Step : std::uint32_t { kNew, kBefore, kAfter, kNamed, kNoFace };

  bool code_face(Triangle& face);
  bool code_apart(Triangle& face);
  Step step_at_gate(const Triangle& face, std::uint32_t& corner) const;
  bool code_name(VertexId& vertex);
  void meet(VertexId vertex, const Guess& guess);

  Coder& coder_;
  CutBorder border_;
  std::vector<Guess> guesses_;
  VertexId next_ = 0;  ///< the lowest vertex not met in order
  std::array<std::array<SymbolModel<3>, 10>, 10> steps_;
  SymbolModel<2> corners_;
  std::array<Probability, 3> apart_new_;
  NumberModel names_;
};

template <class Coder>
bool ConnectivityCodec<Coder>::code(std::vector<Triangle>& faces, std::size_t count) {
  for (std::size_t f = 0; f < count; ++f) {
    Triangle face = Coder::kDecodes ? Triangle{} : faces[f];
    if (!code_face(face)) return false;
    if constexpr (Coder::kDecodes) faces.push_back(face);
  }
  return true;
}

template <class Coder>
bool ConnectivityCodec<Coder>::code_face(Triangle& face) {
  while (border_.has_gate()) {
    if (coder_.failed()) return false;
    std::uint32_t corner = 0;
    Step step = Coder::kDecodes ? kNoFace : step_at_gate(face, corner);
    const auto context = [this](VertexId v) { return std::min<std::uint32_t>(border_.face_count(v), 9); };
    step = static_cast<Step>(steps_[context(border_.from())][context(border_.to())].code(coder_, step));
    if (step > kNoFace) return false;
    if (step == kNoFace) {
      border_.close();
      continue;
    }
    VertexId third = Coder::kDecodes ? 0 : face[(corner + 2) % 3];
    if (step == kNew) third = next_;
    if (step == kBefore) third = border_.before();
    if (step == kAfter) third = border_.after();
    if (step == kNamed && !code_name(third)) return false;
    if (third >= guesses_.size()) return false;
    corner = corners_.code(coder_, corner);
    if (corner > 2) return false;
    if (step == kNew) meet(third, {border_.from(), border_.to(), border_.opposite()});
    face[corner] = border_.from();
    face[(corner + 1) % 3] = border_.to();
    face[(corner + 2) % 3] = third;
    border_.attach(third);
    return true;
  }
  return code_apart(face);
}

template <class Coder>
typename ConnectivityCodec<Coder>::Step ConnectivityCodec<Coder>::step_at_gate(const Triangle& face,
                                                                               std::uint32_t& corner) const {
  for (corner = 0; corner < 3; ++corner) {
    if (face[corner] != border_.from() || face[(corner + 1) % 3] != border_.to()) continue;
    const VertexId third = face[(corner + 2) % 3];
    if (third == next_) return kNew;
    if (third == border_.before()) return kBefore;
    return third == border_.after() ? kAfter : kNamed;
  }
  return kNoFace;
}

/// A face with no gate: each corner is the next vertex, or named.
template <class Coder>
bool ConnectivityCodec<Coder>::code_apart(Triangle& face) {
  for (std::size_t c = 0; c < 3; ++c) {
    const bool is_new = coder_.bit(apart_new_[c], face[c] == next_);
    if (is_new) face[c] = next_;
    if (!is_new && !code_name(face[c])) return false;
    if (face[c] >= guesses_.size()) return false;
    if (is_new && c > 0) meet(next_, {face[c - 1], face[c - 1], face[c - 1]});
    if (is_new && c == 0) meet(next_, {});
  }
  border_.begin(face);
  return !coder_.failed();
}

/// Any vertex, by how far it lies before the next one.
template <class Coder>
bool ConnectivityCodec<Coder>::code_name(VertexId& vertex) {
  const std::int64_t back = std::int64_t{next_} - std::int64_t{vertex};
  const std::int64_t read = unzigzag(names_.code(coder_, zigzag(back)));
  const std::int64_t most = static_cast<std::int64_t>(guesses_.size());
  if (read > most || read < -most || std::int64_t{next_} - read < 0) return false;
  vertex = static_cast<VertexId>(std::int64_t{next_} - read);
  return true;
}

template <class Coder>
void ConnectivityCodec<Coder>::meet(VertexId vertex, const Guess& guess) {
  guesses_[vertex] = guess;
  ++next_;
}

}  // namespace limn::asset
