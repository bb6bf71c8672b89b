#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#include <string>
#include <vector>

#include "limn/base/file.h"
#include "limn/image/crc32.h"
#include "limn/image/image.h"

namespace limn {
namespace {

constexpr int kLargestSide = 16384;
constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kChunkOverheadBytes = 12;  // length, type, checksum

using Bytes = std::span<const std::byte>;

tl::unexpected<Error> unreadable(std::string_view name, std::string where, std::string message,
                                 std::string remedy = {}) {
  return fail_at(ErrorCode::kUnreadable, std::string(name), std::move(where), std::move(message), std::move(remedy));
}

std::string at_byte(std::size_t offset) {
  return "byte " + std::to_string(offset);
}

std::uint32_t big_endian_32(Bytes bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
  return value;
}

bool starts_with(Bytes bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

bool is_png(Bytes bytes) {
  return starts_with(bytes, std::string_view("\x89PNG\r\n\x1a\n", 8));
}
bool is_jpeg(Bytes bytes) {
  return starts_with(bytes, "\xff\xd8\xff");
}

Result<void> check_sides(std::string_view name, std::uint64_t width, std::uint64_t height) {
  if (width >= 1 && height >= 1 && width <= kLargestSide && height <= kLargestSide) return {};
  return unreadable(name, {}, "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
                    "sides from 1 to " + std::to_string(kLargestSide) + " are read");
}

/// The size of the filtered rows that a PNG's header promises; interlacing adds a little, which the caller allows for.
std::uint64_t promised_bytes(std::uint64_t width, std::uint64_t height, unsigned depth, unsigned color_type) {
  const unsigned channels = color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1;
  return ((width * channels * depth + 7) / 8 + 1) * height;
}

/// What is allowed beyond promised sizes: some encoders add a row, and the seven passes of an interlaced picture have
/// rows of their own, each rounded up and with its filter.
constexpr std::uint64_t kSlackBytes = std::uint64_t{1} << 16;

struct PngHeader {
  std::uint64_t promised = 0;
  std::vector<char> compressed;  ///< the data of all IDAT chunks
};

Result<std::uint64_t> read_png_header(Bytes bytes, std::string_view name, std::size_t data) {
  const std::uint64_t width = big_endian_32(bytes, data);
  const std::uint64_t height = big_endian_32(bytes, data + 4);
  if (auto sides = check_sides(name, width, height); !sides) return tl::unexpected(sides.error());
  return promised_bytes(width, height, std::to_integer<unsigned>(bytes[data + 8]),
                        std::to_integer<unsigned>(bytes[data + 9]));
}

/// Walks the chunks, so that the decoder after it meets no truncated or altered file.
Result<PngHeader> check_png_chunks(Bytes bytes, std::string_view name) {
  PngHeader header;
  std::size_t at = kSignatureBytes;
  for (bool first = true;; first = false) {
    if (bytes.size() - at < kChunkOverheadBytes) {
      return unreadable(name, at_byte(at), "the file ends within a PNG chunk", "it was cut short: fetch it again");
    }
    const std::size_t length = big_endian_32(bytes, at);
    if (length > bytes.size() - at - kChunkOverheadBytes) {
      return unreadable(name, at_byte(at),
                        "a PNG chunk claims " + std::to_string(length) + " bytes, more than the file holds",
                        "it was cut short: fetch it again");
    }
    const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + at + 4, 4);
    if (crc32(bytes.subspan(at + 4, 4 + length)) != big_endian_32(bytes, at + 8 + length)) {
      return unreadable(name, at_byte(at), "a PNG chunk does not match its checksum",
                        "the file is damaged: fetch it again");
    }
    if (first != (type == "IHDR") || (first && length != 13)) {
      return unreadable(name, at_byte(at), "a PNG must begin with its one header of 13 bytes");
    }
    if (first) {
      auto promised = read_png_header(bytes, name, at + 8);
      if (!promised) return tl::unexpected(promised.error());
      header.promised = *promised;
    }
    const char* const data = type.data() + type.size();
    if (type == "IDAT") header.compressed.insert(header.compressed.end(), data, data + length);
    if (type == "CgBI") {
      return unreadable(name, at_byte(at), "a PNG packed for iPhones, which other programs cannot read",
                        "save it as an ordinary PNG");
    }
    if (type == "IEND") return header;
    at += kChunkOverheadBytes + length;
  }
}

/// The decoder makes room for whatever the data inflates to, up to a thousand times the file: this makes sure before
/// that it is what the picture needs.
Result<void> check_inflated_size(const PngHeader& header, std::string_view name) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
  const std::uint64_t room = header.promised + kSlackBytes;
  if (room > kMost) return unreadable(name, "IHDR", "pictures whose rows take 2 GiB and more are not read");
  const std::unique_ptr<char[]> rows(new char[static_cast<std::size_t>(room)]);
  if (stbi_zlib_decode_buffer(rows.get(), static_cast<int>(room), header.compressed.data(),
                              static_cast<int>(header.compressed.size())) >= 0) {
    return {};
  }
  return unreadable(name, "IDAT", "the data is damaged, or holds far more than the picture that the header promises");
}

/// Deflate packs at most 1032 to 1 and, written sensibly, never grows by an eighth: outside of that a header lies, and
/// the decoder would allocate what the file cannot fill, or inflate far more than the picture needs.
Result<void> check_png(Bytes bytes, std::string_view name) {
  const auto header = check_png_chunks(bytes, name);
  if (!header) return tl::unexpected(header.error());
  constexpr std::uint64_t kDeflateBound = 1032;
  if (header->promised > header->compressed.size() * kDeflateBound + kSlackBytes) {
    return unreadable(name, "IHDR", "the header promises more pixels than the file's data can hold");
  }
  if (header->compressed.size() > header->promised + header->promised / 8 + kSlackBytes) {
    return unreadable(name, "IDAT", "the file holds far more data than the picture its header promises");
  }
  return check_inflated_size(*header, name);
}

/// A JPEG spends at least a bit on a block, so one byte holds a few hundred pixels at best.
Result<void> check_jpeg(Bytes bytes, std::string_view name) {
  int width = 0, height = 0, channels = 0;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (stbi_info_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels) == 0) {
    return unreadable(name, {}, std::string("not a readable JPEG: ") + stbi_failure_reason());
  }
  if (auto sides = check_sides(name, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)); !sides)
    return sides;
  constexpr std::uint64_t kPixelsPerByte = 1024;
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > kPixelsPerByte * bytes.size()) {
    return unreadable(name, {}, "the header promises more pixels than the file's data can hold");
  }
  return {};
}

struct FreePixels {
  void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

Result<Image> decode_checked(Bytes bytes, std::string_view name) {
  int width = 0, height = 0, channels = 0;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const std::unique_ptr<stbi_uc, FreePixels> pixels(
      stbi_load_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels, 4));
  if (!pixels) return unreadable(name, {}, std::string("cannot be decoded: ") + stbi_failure_reason());
  Image image(width, height);
  std::memcpy(image.rgba.data(), pixels.get(), image.rgba.size());
  return image;
}

void append(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

Result<Image> decode_image(Bytes bytes, std::string_view name) try {
  if (!is_png(bytes) && !is_jpeg(bytes)) return unreadable(name, {}, "neither a PNG nor a JPEG file");
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return unreadable(name, {}, "pictures of 2 GiB and more are not read");
  }
  const Result<void> checked = is_png(bytes) ? check_png(bytes, name) : check_jpeg(bytes, name);
  if (!checked) return tl::unexpected(checked.error());
  return decode_checked(bytes, name);
} catch (const std::bad_alloc&) {
  return unreadable(name, {}, "not enough memory for the picture");
}

Result<Image> read_png(const std::filesystem::path& path) {
  const auto file = FileBytes::open(path);
  if (!file) return tl::unexpected(file.error());
  const std::string name = path == "-" ? "standard input" : path.string();
  if (!is_png(file->bytes())) return unreadable(name, "byte 0", "not a PNG file", "save the picture as PNG");
  return decode_image(file->bytes(), name);
}

Result<void> write_png(const Image& image, const std::filesystem::path& path) try {
  std::string bytes;
  const int stride = 4 * image.width;
  const bool encoded =
      image.width > 0 && image.height > 0 &&
      stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.rgba.data(), stride) != 0;
  if (!encoded) {
    return fail_at(ErrorCode::kUnwritable, path.string(), {},
                   "a picture without pixels, or too large for a PNG encoder");
  }
  return write_file(path, bytes);
} catch (const std::bad_alloc&) {
  return fail_at(ErrorCode::kUnwritable, path.string(), {}, "not enough memory to encode the picture");
}

}  // namespace limn
