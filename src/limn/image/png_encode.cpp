#include <array>
#include <cstdlib>
#include <new>
#include <span>
#include <string>

#include "limn/image/crc32.h"
#include "limn/image/deep_image.h"
#include "limn/image/deflate.h"

namespace limn {
namespace {

void append_big_endian(std::string& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(word >> shift & 255u);
}

void append_chunk(std::string& bytes, const char* type, const std::string& data) {
  append_big_endian(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = bytes.size();
  bytes += type;
  bytes += data;
  append_big_endian(bytes, crc32(std::as_bytes(std::span(bytes).subspan(begin))));
}

/// The rows of a picture, `pixel` bytes each, big-endian.
struct Rows {
  int width = 0, height = 0, channels = 0, depth = 8;
  std::string bytes;

  std::size_t pixel() const { return static_cast<std::size_t>(channels * depth / 8); }
  std::size_t stride() const { return pixel() * static_cast<std::size_t>(width); }
};

int paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int a = std::abs(guess - left), b = std::abs(guess - above), c = std::abs(guess - corner);
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

/// A byte less what PNG's filter 0 … 4 predicts of it.
std::uint8_t filtered(int filter, int value, int left, int above, int corner) {
  const int predicted = filter == 0   ? 0
                        : filter == 1 ? left
                        : filter == 2 ? above
                        : filter == 3 ? (left + above) / 2
                                      : paeth(left, above, corner);
  return static_cast<std::uint8_t>(value - predicted);
}

/// Each row by the filter that leaves the smallest sum of magnitudes, as the PNG specification advises.
std::string filter_rows(const Rows& rows) {
  std::string result;
  result.reserve((rows.stride() + 1) * static_cast<std::size_t>(rows.height));
  const std::string nothing(rows.stride(), '\0');
  std::array<std::string, 5> tries;
  for (int y = 0; y < rows.height; ++y) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(rows.bytes.data()) + rows.stride() * std::size_t(y);
    const auto* above = y > 0 ? row - rows.stride() : reinterpret_cast<const std::uint8_t*>(nothing.data());
    std::size_t best = 0;
    long least = 0;
    for (std::size_t filter = 0; filter < tries.size(); ++filter) {
      std::string& line = tries[filter];
      line.resize(rows.stride());
      long sum = 0;
      for (std::size_t i = 0; i < rows.stride(); ++i) {
        const bool inside = i >= rows.pixel();
        const std::uint8_t value = filtered(int(filter), row[i], inside ? row[i - rows.pixel()] : 0, above[i],
                                            inside ? above[i - rows.pixel()] : 0);
        line[i] = static_cast<char>(value);
        sum += std::abs(int{static_cast<std::int8_t>(value)});
      }
      if (filter == 0 || sum < least) {
        best = filter;
        least = sum;
      }
    }
    result += static_cast<char>(best);
    result += tries[best];
  }
  return result;
}

Result<std::string> encode(const Rows& rows) {
  if (rows.width < 1 || rows.height < 1) return fail(ErrorCode::kUnwritable, "a picture without pixels");
  constexpr std::array<std::uint8_t, 5> kColorType{0, 0, 4, 2, 6};
  const std::optional<std::string> data = deflate(filter_rows(rows));
  if (!data) return fail(ErrorCode::kUnwritable, "a picture too large for a PNG encoder", "take a smaller size");
  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(rows.width));
  append_big_endian(header, static_cast<std::uint32_t>(rows.height));
  header += static_cast<char>(rows.depth);
  header += static_cast<char>(kColorType[static_cast<std::size_t>(rows.channels)]);
  header += std::string(3, '\0');
  std::string bytes = "\x89PNG\r\n\x1a\n";
  append_chunk(bytes, "IHDR", header);
  append_chunk(bytes, "IDAT", *data);
  append_chunk(bytes, "IEND", {});
  return bytes;
}

Result<std::string> no_memory() {
  return fail(ErrorCode::kUnwritable, "not enough memory to encode the picture");
}

}  // namespace

Result<std::string> encode_png(const Image& image) try {
  bool opaque = true;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    opaque = opaque && image.rgba[i] == 255;
  Rows rows{image.width, image.height, opaque ? 3 : 4, 8, {}};
  rows.bytes.reserve(rows.stride() * static_cast<std::size_t>(image.height));
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (!opaque || i % 4 != 3) rows.bytes += static_cast<char>(image.rgba[i]);
  }
  return encode(rows);
} catch (const std::bad_alloc&) {
  return no_memory();
}

Result<std::string> encode_png(const DeepImage& image) try {
  Rows rows{image.width, image.height, image.channels, 16, {}};
  rows.bytes.reserve(2 * image.values.size());
  for (const std::uint16_t value : image.values) {
    rows.bytes += static_cast<char>(value >> 8);
    rows.bytes += static_cast<char>(value & 255u);
  }
  return encode(rows);
} catch (const std::bad_alloc&) {
  return no_memory();
}

}  // namespace limn
