#include <algorithm>
#include <array>
#include <bit>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/image/deep_image.h"
#include "limn/image/deflate.h"

namespace limn {
namespace {

constexpr int kLinesABlock = 16;  // of ZIP compression
constexpr char kZip = 3;
constexpr std::uint32_t kFloat = 2;

/// Everything in the file is little-endian.
template <class Word>
void append(std::string& bytes, Word word) {
  for (std::size_t k = 0; k < sizeof(Word); ++k)
    bytes += static_cast<char>(word >> (8 * k) & 255u);
}

void append_float(std::string& bytes, float value) {
  append(bytes, std::bit_cast<std::uint32_t>(value));
}

void append_attribute(std::string& bytes, std::string_view name, std::string_view type, std::string_view value) {
  bytes.append(name).push_back('\0');
  bytes.append(type).push_back('\0');
  append(bytes, static_cast<std::uint32_t>(value.size()));
  bytes.append(value);
}

/// A channel's name and which of the picture's it is; channels lie in the file by name.
struct Channel {
  char name;
  int index;
};
std::vector<Channel> channels_of(int count) {
  switch (count) {
    case 1:
      return {{'Y', 0}};
    case 2:
      return {{'A', 1}, {'Y', 0}};
    case 3:
      return {{'B', 2}, {'G', 1}, {'R', 0}};
    default:
      return {{'A', 3}, {'B', 2}, {'G', 1}, {'R', 0}};
  }
}

std::string header_of(const FloatImage& image, const std::vector<Channel>& channels) {
  std::string list;
  for (const Channel& channel : channels) {
    list += channel.name;
    list += '\0';
    append(list, kFloat);
    append(list, std::uint32_t{0});
    append(list, std::uint32_t{1});
    append(list, std::uint32_t{1});
  }
  list += '\0';
  std::string window;
  append(window, std::uint64_t{0});
  append(window, static_cast<std::uint32_t>(image.width - 1));
  append(window, static_cast<std::uint32_t>(image.height - 1));
  std::string one, origin;
  append_float(one, 1.0f);
  append(origin, std::uint64_t{0});
  std::string bytes;
  append(bytes, std::uint32_t{20000630});
  append(bytes, std::uint32_t{2});
  append_attribute(bytes, "channels", "chlist", list);
  append_attribute(bytes, "compression", "compression", std::string_view(&kZip, 1));
  append_attribute(bytes, "dataWindow", "box2i", window);
  append_attribute(bytes, "displayWindow", "box2i", window);
  append_attribute(bytes, "lineOrder", "lineOrder", std::string_view("\0", 1));
  append_attribute(bytes, "pixelAspectRatio", "float", one);
  append_attribute(bytes, "screenWindowCenter", "v2f", origin);
  append_attribute(bytes, "screenWindowWidth", "float", one);
  bytes += '\0';
  return bytes;
}

/// First bytes at even places, then those at odd ones; then each less the one before.
std::string predicted(const std::string& raw) {
  std::string result(raw.size(), '\0');
  const std::size_t half = (raw.size() + 1) / 2;
  for (std::size_t i = 0; i < raw.size(); ++i)
    result[i / 2 + (i % 2 == 0 ? 0 : half)] = raw[i];
  for (std::size_t i = result.size(); i-- > 1;)
    result[i] = static_cast<char>(result[i] - result[i - 1] + 128);
  return result;
}

/// A block of lines with its place and length; stored as it is where compression gains nothing.
std::string block_of(const FloatImage& image, const std::vector<Channel>& channels, int first) {
  std::string raw;
  for (int y = first; y < std::min(first + kLinesABlock, image.height); ++y) {
    for (const Channel& channel : channels) {
      for (int x = 0; x < image.width; ++x)
        append_float(raw, image.pixel(x, y)[channel.index]);
    }
  }
  const std::optional<std::string> packed = deflate(predicted(raw));
  const std::string& data = packed && packed->size() < raw.size() ? *packed : raw;
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(first));
  append(bytes, static_cast<std::uint32_t>(data.size()));
  return bytes + data;
}

}  // namespace

Result<std::string> encode_exr(const FloatImage& image) try {
  if (image.width < 1 || image.height < 1) return fail(ErrorCode::kUnwritable, "a picture without pixels");
  const std::vector<Channel> channels = channels_of(image.channels);
  std::vector<std::string> blocks(static_cast<std::size_t>((image.height + kLinesABlock - 1) / kLinesABlock));
  parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      blocks[i] = block_of(image, channels, static_cast<int>(i) * kLinesABlock);
  });
  std::string bytes = header_of(image, channels);
  std::uint64_t offset = bytes.size() + 8 * blocks.size();
  for (const std::string& block : blocks) {
    append(bytes, offset);
    offset += block.size();
  }
  for (const std::string& block : blocks)
    bytes += block;
  return bytes;
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kUnwritable, "not enough memory to encode the picture");
}

}  // namespace limn
