// Float maps to 8 and 16 bits, and the files they go into.
#include "limn/image/deep_image.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <stb/stb_image.h>
#include <string>
#include <vector>

#include "limn/base/random.h"
#include "limn/image/srgb.h"

namespace limn {
namespace {

FloatImage noise(int width, int height, int channels) {
  FloatImage image(width, height, channels);
  Random random(1);
  for (float& value : image.values)
    value = static_cast<float>(random.uniform());
  return image;
}

TEST(DeepImage, RoundsToTheNearestStep) {
  FloatImage image(4, 1, 1);
  image.values = {0.0f, 1.0f, 127.49f / 255.0f, 127.51f / 255.0f};
  const Image eight = to_8_bit(image, kShareCoding);
  EXPECT_EQ(eight.pixel(0, 0)[0], 0);
  EXPECT_EQ(eight.pixel(1, 0)[0], 255);
  EXPECT_EQ(eight.pixel(2, 0)[0], 127);
  EXPECT_EQ(eight.pixel(3, 0)[0], 128);
  // Grey, opaque.
  EXPECT_EQ(eight.pixel(3, 0)[2], 128);
  EXPECT_EQ(eight.pixel(3, 0)[3], 255);
}

TEST(DeepImage, StoresVectorsAsGltfDecodesThem) {
  FloatImage image(1, 1, 3);
  image.values = {-1.0f, 0.0f, 1.0f};
  const Image eight = to_8_bit(image, kVectorCoding);
  EXPECT_EQ(eight.pixel(0, 0)[0], 0);
  EXPECT_EQ(eight.pixel(0, 0)[1], 128);
  EXPECT_EQ(eight.pixel(0, 0)[2], 255);
  const DeepImage sixteen = to_16_bit(image, kVectorCoding);
  EXPECT_EQ(sixteen.values, (std::vector<std::uint16_t>{0, 32768, 65535}));
}

TEST(DeepImage, ClampsWhatLiesOutsideAndTakesNoNumberForTheLowEnd) {
  FloatImage image(5, 1, 1);
  image.values = {-3.0f, 7.0f, std::nanf(""), std::numeric_limits<float>::infinity(), 2.0f};
  EXPECT_EQ(to_16_bit(image, {1.0f, 3.0f, false}).values, (std::vector<std::uint16_t>{0, 65535, 0, 65535, 32768}));
  const ChannelCoding range = range_of(image, 0);
  EXPECT_EQ(range.low, -3.0f);
  EXPECT_EQ(range.high, 7.0f);
  // A range without extent says nothing and divides by nothing.
  EXPECT_EQ(to_16_bit(image, {2.0f, 2.0f, false}).values, std::vector<std::uint16_t>(5, 0));
}

TEST(DeepImage, KeepsEverySrgbByte) {
  FloatImage image(256, 1, 4);
  for (int i = 0; i < 256; ++i) {
    for (int c = 0; c < 3; ++c)
      image.pixel(i, 0)[c] = linear_of_srgb(static_cast<std::uint8_t>(i));
    image.pixel(i, 0)[3] = static_cast<float>(i) / 255.0f;  // alpha is no light
  }
  const Image stored = to_8_bit(image, kColorCoding);
  for (int i = 0; i < 256; ++i) {
    EXPECT_EQ(stored.pixel(i, 0)[1], i);
    EXPECT_EQ(stored.pixel(i, 0)[3], i);
  }
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(PngEncode, GivesBackEightBits) {
  for (const int channels : {3, 4}) {
    const Image image = to_8_bit(noise(37, 19, channels), kShareCoding);
    const auto png = encode_png(image);
    ASSERT_TRUE(png);
    const auto read = decode_image(bytes_of(*png), "test");
    ASSERT_TRUE(read) << format_error(read.error());
    EXPECT_EQ(read->rgba, image.rgba);
  }
}

TEST(PngEncode, GivesBackSixteenBits) {
  for (const int channels : {1, 2, 3, 4}) {
    const DeepImage image = to_16_bit(noise(37, 19, channels), kShareCoding);
    const auto png = encode_png(image);
    ASSERT_TRUE(png);
    int width = 0, height = 0, found = 0;
    stbi_us* const read = stbi_load_16_from_memory(reinterpret_cast<const stbi_uc*>(png->data()), int(png->size()),
                                                   &width, &height, &found, 0);
    ASSERT_NE(read, nullptr);
    EXPECT_EQ(width, 37);
    EXPECT_EQ(height, 19);
    ASSERT_EQ(found, channels);
    EXPECT_EQ(std::memcmp(read, image.values.data(), 2 * image.values.size()), 0);
    stbi_image_free(read);
  }
}

TEST(PngEncode, RefusesAPictureWithoutPixels) {
  const auto png = encode_png(Image());
  ASSERT_FALSE(png);
  EXPECT_EQ(png.error().code, ErrorCode::kUnwritable);
}

/// Reads the file back by the format's description: only what encode_exr() writes.
class ExrReader {
 public:
  explicit ExrReader(const std::string& bytes) : bytes_(bytes) {}

  std::vector<float> read(int width, int height, int channels) {
    EXPECT_EQ(word(0), 20000630u);
    EXPECT_EQ(word(4), 2u);
    std::size_t at = 8;
    while (bytes_[at] != '\0') {
      at = bytes_.find('\0', at) + 1;
      at = bytes_.find('\0', at) + 1;
      at += 4 + word(at);
    }
    ++at;
    std::vector<float> values(static_cast<std::size_t>(width * height * channels));
    for (int first = 0; first < height; first += 16, at += 8)
      read_block(word(at), first, std::min(16, height - first), width, channels, values);
    return values;
  }

 private:
  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at, 4);
    return value;
  }

  void read_block(std::size_t at, int first, int lines, int width, int channels, std::vector<float>& values) {
    EXPECT_EQ(word(at), static_cast<std::uint32_t>(first));
    const std::size_t size = word(at + 4);
    std::string raw(static_cast<std::size_t>(4 * lines * width * channels), '\0');
    if (size == raw.size()) {
      raw = bytes_.substr(at + 8, size);
    } else {
      std::string packed = raw;
      ASSERT_EQ(stbi_zlib_decode_buffer(packed.data(), int(packed.size()), bytes_.data() + at + 8, int(size)),
                int(raw.size()));
      for (std::size_t i = 1; i < packed.size(); ++i)
        packed[i] = static_cast<char>(packed[i] + packed[i - 1] - 128);
      for (std::size_t i = 0; i < raw.size(); ++i)
        raw[i] = packed[i / 2 + (i % 2 == 0 ? 0 : (raw.size() + 1) / 2)];
    }
    std::size_t from = 0;
    for (int y = first; y < first + lines; ++y) {
      // Channels lie by name: A B G R, A Y.
      for (int c = channels - 1; c >= 0; --c) {
        for (int x = 0; x < width; ++x, from += 4)
          std::memcpy(&values[static_cast<std::size_t>((y * width + x) * channels + c)], raw.data() + from, 4);
      }
    }
  }

  const std::string& bytes_;
};

TEST(ExrEncode, KeepsTheBitsOfFloats) {
  for (const int channels : {1, 2, 3, 4}) {
    FloatImage image = noise(33, 21, channels);
    image.values[0] = std::nanf("");
    image.values[1] = -0.0f;
    image.values[2] = 1e-40f;
    // Half of it compresses, noise does not.
    std::fill(image.values.begin() + static_cast<std::ptrdiff_t>(image.values.size() / 2), image.values.end(), 0.5f);
    const auto exr = encode_exr(image);
    ASSERT_TRUE(exr);
    const std::vector<float> read = ExrReader(*exr).read(33, 21, channels);
    EXPECT_EQ(std::memcmp(read.data(), image.values.data(), 4 * read.size()), 0) << channels;
  }
}

}  // namespace
}  // namespace limn
