#include <cstring>
#include <gtest/gtest.h>
#include <stb/stb_image_write.h>
#include <string>

#include "limn/base/random.h"
#include "limn/image/image.h"

#include "support/temp_folder.h"

namespace limn {
namespace {

Image noise(int width, int height, std::uint64_t seed) {
  Image image(width, height);
  Random random(seed);
  for (std::uint8_t& channel : image.rgba)
    channel = static_cast<std::uint8_t>(random.below(256));
  return image;
}

std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<char>(value >> shift & 0xffu));
  return bytes;
}

/// The textbook checksum, bit by bit.
std::uint32_t slow_crc(const std::string& bytes) {
  std::uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xedb88320u : crc >> 1;
  }
  return ~crc;
}

std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(slow_crc(type + data));
}

std::string png_with(std::uint32_t width, std::uint32_t height, const std::string& idat) {
  return std::string("\x89PNG\r\n\x1a\n", 8) +
         chunk("IHDR", big_endian(width) + big_endian(height) + std::string("\x08\x06\0\0\0", 5)) +
         chunk("IDAT", idat) + chunk("IEND", "");
}

std::string encoded(const Image& image) {
  const test::TempFolder folder;
  EXPECT_TRUE(write_png(image, folder / "a.png"));
  return test::slurp(folder / "a.png");
}

TEST(Png, ComesBackPixelForPixel) {
  const test::TempFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 7}, {257, 64}}) {
    const Image image = noise(width, height, static_cast<std::uint64_t>(width));
    ASSERT_TRUE(write_png(image, folder / "noise.png"));
    const auto read = read_png(folder / "noise.png");
    ASSERT_TRUE(read) << format_error(read.error());
    EXPECT_EQ(read->width, width);
    EXPECT_EQ(read->height, height);
    EXPECT_EQ(read->rgba, image.rgba);
  }
}

TEST(Png, SamePixelsGiveTheSameBytes) {
  EXPECT_EQ(encoded(noise(31, 17, 4)), encoded(noise(31, 17, 4)));
}

TEST(Png, WritingAPictureWithoutPixelsLeavesNoFile) {
  const test::TempFolder folder;
  const auto written = write_png(Image(), folder / "none.png");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kUnwritable);
  EXPECT_FALSE(std::filesystem::exists(folder / "none.png"));
}

TEST(Png, WritingIntoAMissingFolderSaysSo) {
  const test::TempFolder folder;
  const auto written = write_png(noise(1, 1, 1), folder / "no/such/a.png");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kUnwritable);
}

TEST(HostilePng, EveryTruncationIsAnError) {
  const std::string whole = encoded(noise(5, 5, 2));
  ASSERT_TRUE(decode_image(as_bytes(whole), "whole"));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto read = decode_image(as_bytes(whole.substr(0, length)), "cut.png");
    ASSERT_FALSE(read) << length;
    EXPECT_EQ(read.error().code, ErrorCode::kUnreadable);
    EXPECT_EQ(read.error().file, "cut.png");
  }
}

TEST(HostilePng, EveryFlippedBitIsAnError) {
  const std::string whole = encoded(noise(4, 4, 3));
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    EXPECT_FALSE(decode_image(as_bytes(damaged), "damaged.png")) << "bit " << bit;
  }
}

TEST(HostilePng, GarbageBehindValidChecksumsIsAnError) {
  Random random(9);
  for (int round = 0; round < 200; ++round) {
    std::string data = std::string("\x78\x9c", 2);
    for (std::uint64_t i = 0, n = random.below(64); i < n; ++i)
      data.push_back(static_cast<char>(random.below(256)));
    EXPECT_FALSE(decode_image(as_bytes(png_with(64, 64, data)), "garbage.png"));
  }
}

TEST(HostilePng, AHugeHeaderIsRefusedBeforeAnyAllocation) {
  for (const auto& [width, height] : {std::pair{0x7fffffffu, 0x7fffffffu}, {16385u, 1u}, {0u, 4u}, {16384u, 16384u}}) {
    const auto read = decode_image(as_bytes(png_with(width, height, "0123456789")), "huge.png");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kUnreadable);
  }
}

TEST(HostilePng, DataFarBeyondThePictureIsRefused) {
  const auto read = decode_image(as_bytes(png_with(1, 1, std::string(1 << 20, '\0'))), "bomb.png");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().where, "IDAT");
}

/// A zlib stream of one literal 0 and then runs of 258 more, 13 bits each.
std::string packed_zeros(std::size_t runs) {
  std::string stream("\x78\x9c", 2);
  std::uint32_t bits = 0;
  int held = 0;
  const auto put = [&](std::uint32_t value, int count) {
    bits |= value << held;
    for (held += count; held >= 8; held -= 8, bits >>= 8)
      stream.push_back(static_cast<char>(bits & 0xffu));
  };
  put(0b011, 3);       // the last block, with the fixed codes
  put(0b00001100, 8);  // 0; Huffman codes are sent from their highest bit
  for (std::size_t i = 0; i < runs; ++i)
    put(0b10100011, 13);  // 258 bytes, from one byte back
  put(0, 7 + 7);          // the end, and the rest of a byte
  return stream + std::string(4, '\0');
}

TEST(HostilePng, DataThatInflatesFarBeyondThePictureIsRefused) {
  constexpr std::size_t kSide = 512;
  constexpr std::size_t kRowsBytes = (4 * kSide + 1) * kSide;
  const auto fitting = decode_image(as_bytes(png_with(kSide, kSide, packed_zeros(kRowsBytes / 258 + 1))), "good.png");
  ASSERT_TRUE(fitting) << format_error(fitting.error());
  EXPECT_EQ(fitting->rgba, std::vector<std::uint8_t>(4 * kSide * kSide, 0));
  for (const std::size_t times : {2u, 100u}) {
    const auto read =
        decode_image(as_bytes(png_with(kSide, kSide, packed_zeros(times * kRowsBytes / 258))), "bomb.png");
    ASSERT_FALSE(read) << times;
    EXPECT_EQ(read.error().where, "IDAT");
  }
}

TEST(Png, InterlacedRowsMayTakeMoreThanPlainOnes) {
  // Plain, 3 x 16384 pixels of one bit take 16384 rows of two bytes; the passes take 28672.
  const std::string header = big_endian(3) + big_endian(16384) + std::string("\x01\0\0\0\x01", 5);
  const auto read = decode_image(as_bytes(std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", header) +
                                          chunk("IDAT", packed_zeros(57344 / 258 + 1)) + chunk("IEND", "")),
                                 "interlaced.png");
  ASSERT_TRUE(read) << format_error(read.error());
  EXPECT_EQ(read->height, 16384);
}

TEST(HostilePng, DataPackedForPhonesIsRefused) {
  std::string whole = encoded(noise(4, 4, 3));
  whole.insert(33, chunk("CgBI", std::string(4, '\0')));  // behind the header
  const auto read = decode_image(as_bytes(whole), "phone.png");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().where, "byte 33");
}

TEST(HostilePng, AChunkThatClaimsMoreThanTheFileNamesItsByte) {
  std::string whole = encoded(noise(4, 4, 3));
  whole.replace(33, 4, big_endian(0x7fffffff));
  const auto read = decode_image(as_bytes(whole), "claim.png");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().where, "byte 33");
}

TEST(ReadPng, OtherFilesAndFoldersAreErrors) {
  const test::TempFolder folder;
  const auto text = read_png(folder.write("a.png", "P6 1 1 255 abc"));
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::kUnreadable);
  EXPECT_FALSE(read_png(folder.write("empty.png", "")));
  EXPECT_FALSE(read_png(folder.path()));
  EXPECT_FALSE(read_png(folder / "missing.png"));
}

/// A zlib stream that stores its data as it is; few decoders look at the checksum behind it, and none here.
std::string stored(const std::string& data) {
  const auto length = static_cast<unsigned>(data.size());
  std::string stream("\x78\x01\x01", 3);
  for (const unsigned value : {length, ~length}) {
    stream.push_back(static_cast<char>(value & 0xffu));
    stream.push_back(static_cast<char>(value >> 8 & 0xffu));
  }
  return stream + data + std::string(4, '\0');
}

std::string png_of_kind(std::uint32_t width, char depth, char color_type, const std::string& rows,
                        const std::string& extra_chunk = {}) {
  const std::string header = big_endian(width) + big_endian(1) + depth + color_type + std::string(3, '\0');
  return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", header) + extra_chunk + chunk("IDAT", stored(rows)) +
         chunk("IEND", "");
}

void expect_pixels(const std::string& file, const std::vector<std::uint8_t>& rgba) {
  const auto image = decode_image(as_bytes(file), "kind.png");
  ASSERT_TRUE(image) << format_error(image.error());
  EXPECT_EQ(image->rgba, rgba);
}

TEST(DecodeImage, EveryKindOfPngBecomesEightBitRgba) {
  const std::string no_filter(1, '\0');
  expect_pixels(png_of_kind(2, 16, 0, no_filter + std::string("\x80\x00\xff\xff", 4)),
                {128, 128, 128, 255, 255, 255, 255, 255});
  expect_pixels(png_of_kind(3, 1, 0, no_filter + "\xa0"), {255, 255, 255, 255, 0, 0, 0, 255, 255, 255, 255, 255});
  expect_pixels(png_of_kind(1, 8, 2, no_filter + "\x01\x02\x03"), {1, 2, 3, 255});
  expect_pixels(png_of_kind(1, 8, 4, no_filter + "\x07\x09"), {7, 7, 7, 9});
  expect_pixels(png_of_kind(2, 8, 3, no_filter + std::string("\x01\x00", 2), chunk("PLTE", "\x0a\x0b\x0c\x14\x15\x16")),
                {20, 21, 22, 255, 10, 11, 12, 255});
}

TEST(DecodeImage, ReadsAJpegNearlyAsItWas) {
  Image image(16, 24);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 16; ++x) {
      const std::uint8_t color[4] = {static_cast<std::uint8_t>(10 * x), static_cast<std::uint8_t>(9 * y), 60, 255};
      std::memcpy(image.pixel(x, y), color, 4);
    }
  }
  std::string file;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  ASSERT_NE(stbi_write_jpg_to_func(append, &file, 16, 24, 4, image.rgba.data(), 95), 0);
  const auto read = decode_image(as_bytes(file), "a.jpg");
  ASSERT_TRUE(read) << format_error(read.error());
  EXPECT_LT(compare_images(*read, image, 24).failing_share, 0.01);
  for (std::size_t length = 0; length < 200; ++length) {
    EXPECT_FALSE(decode_image(as_bytes(file.substr(0, length)), "cut.jpg")) << length;
  }
}

TEST(DecodeImage, AJpegHeaderAloneIsAnError) {
  EXPECT_FALSE(decode_image(as_bytes(std::string("\xff\xd8\xff\xe0\0\x10JFIF", 10)), "a.jpg"));
}

}  // namespace
}  // namespace limn
