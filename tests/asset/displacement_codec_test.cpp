#include "limn/asset/displacement_codec.h"

#include <cmath>
#include <gtest/gtest.h>

#include "limn/asset/range_coder.h"
#include "limn/base/random.h"

namespace limn::test {
namespace {

using namespace limn::asset;
using Texels = std::vector<std::uint16_t>;

Texels smooth(std::size_t width, std::size_t height) {
  Texels texels;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const double value = std::sin(0.03 * static_cast<double>(x)) * std::cos(0.05 * static_cast<double>(y));
      texels.push_back(static_cast<std::uint16_t>(32768.0 + 30000.0 * value));
    }
  }
  return texels;
}

TEST(DisplacementCodec, KeepsEveryTexel) {
  Random random(11);
  for (const auto& [width, height] :
       {std::pair<std::size_t, std::size_t>{1, 1}, {1, 70}, {70, 1}, {33, 17}, {64, 64}}) {
    Texels noise;
    for (std::size_t i = 0; i < width * height; ++i)
      noise.push_back(static_cast<std::uint16_t>(random.next()));
    for (const Texels& texels : {noise, smooth(width, height), Texels(width * height, 65535)}) {
      const auto read = decode_texels(encode_texels(texels, width), width, height);
      ASSERT_TRUE(read) << width << " x " << height;
      EXPECT_EQ(*read, texels);
    }
  }
}

TEST(DisplacementCodec, IsSmallWhereTheSurfaceIsSmooth) {
  const Texels texels = smooth(256, 256);
  EXPECT_LT(encode_texels(texels, 256).size(), texels.size());  // half of what they take
  const std::vector<std::byte> flat = encode_texels(Texels(256 * 256, 7), 256);
  EXPECT_EQ(most_elements(flat.size()), 256u * 256u);  // no less, so that a reader can believe its size
}

TEST(DisplacementCodec, AnyBytesGiveSoManyTexelsOrNothing) {
  Random random(12);
  const std::vector<std::byte> good = encode_texels(smooth(40, 30), 40);
  for (int round = 0; round < 500; ++round) {
    std::vector<std::byte> bytes = good;
    if (round % 4 == 0) bytes.resize(random.below(bytes.size()));
    for (std::uint64_t n = random.below(4); n > 0 && !bytes.empty(); --n)
      bytes[random.below(bytes.size())] = static_cast<std::byte>(random.next());
    const std::size_t width = 1 + random.below(80), height = 1 + random.below(80);
    const auto read = decode_texels(bytes, width, height);
    if (!read) continue;
    EXPECT_EQ(read->size(), width * height);
  }
  EXPECT_FALSE(decode_texels(good, 1'000'000, 1'000'000));
  EXPECT_FALSE(decode_texels(std::span(good).first(0), 40, 30));
}

}  // namespace
}  // namespace limn::test
