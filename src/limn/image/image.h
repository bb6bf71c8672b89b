#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "limn/base/result.h"

namespace limn {

/// An 8-bit RGBA picture, rows from the top, straight (not premultiplied) alpha, sRGB as it should be shown.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 · width · height values

  Image() = default;
  Image(int w, int h) : width(w), height(h), rgba(4u * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::uint8_t* pixel(int x, int y) { return rgba.data() + 4 * (static_cast<std::size_t>(y) * width + x); }
  const std::uint8_t* pixel(int x, int y) const { return rgba.data() + 4 * (static_cast<std::size_t>(y) * width + x); }
};

/// Writes a PNG whole or not at all; "-" is standard output. Same pixels, same bytes. Errors: kUnwritable.
Result<void> write_png(const Image& image, const std::filesystem::path& path);

/// Reads a PNG (any depth, converted to 8-bit RGBA); "-" is standard input.
/// Checks every chunk's length and checksum and the picture's size before it allocates anything: what a header claims
/// must be possible in a file of that length. Errors: kUnreadable, naming the byte; also for sides beyond 16384.
Result<Image> read_png(const std::filesystem::path& path);

/// As read_png, from memory, PNG or JPEG told apart by content. \param name  stands for the file in messages
Result<Image> decode_image(std::span<const std::byte> bytes, std::string_view name);

/// The pictures side by side, tops aligned, `gap` transparent pixels between them.
Image side_by_side(const std::vector<Image>& images, int gap = 0);

/// How two pictures of one size differ.
struct ImageDifference {
  double failing_share = 0;  ///< pixels with a channel further apart than the tolerance, over all pixels
  int largest = 0;           ///< largest difference of a channel, 0 … 255
  Image picture;             ///< failing pixels in red over a faded copy of the expected picture
};

/// Compares pixel by pixel. Pictures of different sizes fail everywhere. \param tolerance a channel's allowed
/// difference
ImageDifference compare_images(const Image& actual, const Image& expected, int tolerance);

}  // namespace limn
