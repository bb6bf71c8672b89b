#include "limn/asset/displacement_codec.h"

#include <algorithm>
#include <array>

#include "limn/asset/range_coder.h"

namespace limn::asset {
namespace {

constexpr std::size_t kWidths = 18;

/// What the texels to the left (a), above (b) and between (c) lead to expect: a plane through them, unless an edge runs
/// between (the median predictor of LOCO-I, Weinberger et al. 2000).
std::int32_t expect(std::int32_t a, std::int32_t b, std::int32_t c) {
  if (c >= std::max(a, b)) return std::min(a, b);
  if (c <= std::min(a, b)) return std::max(a, b);
  return a + b - c;
}

std::size_t size_of(std::uint64_t code) {
  return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(code)), kWidths - 1);
}

template <class Coder>
bool code_texels(Coder& coder, std::vector<std::uint16_t>& texels, std::size_t width, std::size_t height) {
  std::vector<NumberModel> models(kWidths * kWidths);
  std::vector<std::size_t> above(width + 1, 0);  // sizes of the differences in the row above
  for (std::size_t y = 0; y < height; ++y) {
    std::size_t last = 0;
    for (std::size_t x = 0; x < width; ++x) {
      if (coder.failed()) return false;
      const std::size_t at = y * width + x;
      const std::int32_t up = y > 0 ? texels[at - width] : 0;
      const std::int32_t left = x > 0 ? texels[at - 1] : up;
      const std::int32_t between = x > 0 && y > 0 ? texels[at - width - 1] : up;
      const std::int32_t expected = expect(left, y > 0 ? up : left, y > 0 ? between : left);
      std::int32_t difference = 0;
      if constexpr (!Coder::kDecodes) difference = texels[at] - expected;
      const std::uint64_t code = models[kWidths * last + above[x]].code(coder, zigzag(difference));
      last = size_of(code);
      above[x] = last;
      if constexpr (Coder::kDecodes) {
        if (code > 0x1ffffu) return false;
        const std::int64_t texel = expected + unzigzag(code);
        if (texel < 0 || texel > 0xffff) return false;
        texels.push_back(static_cast<std::uint16_t>(texel));
      }
    }
  }
  return true;
}

}  // namespace

std::vector<std::byte> encode_texels(std::span<const std::uint16_t> texels, std::size_t width) {
  RangeEncoder coder;
  std::vector<std::uint16_t> copy(texels.begin(), texels.end());
  if (width > 0) code_texels(coder, copy, width, texels.size() / width);
  std::vector<std::byte> bytes = coder.finish();
  pad(bytes, texels.size());
  return bytes;
}

std::optional<std::vector<std::uint16_t>> decode_texels(std::span<const std::byte> bytes, std::size_t width,
                                                        std::size_t height) {
  if (height != 0 && width > most_elements(bytes.size()) / height) return std::nullopt;
  RangeDecoder coder(bytes);
  std::vector<std::uint16_t> texels;
  if (!code_texels(coder, texels, width, height) || coder.failed()) return std::nullopt;
  return texels;
}

}  // namespace limn::asset
