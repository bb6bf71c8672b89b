#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <string>
#include <string_view>

#include "limn/mesh/formats/ply_header.h"
#include "limn/mesh/formats/text.h"

/// One way to walk the items of a PLY file, whatever its encoding: begin_item, a read or skip for each value, end_item.
/// A call that gives false has left the cause in problem(); where() says where.
namespace limn::formats {

/// Loads a T from any address. \param swap  whether its bytes are in the other order
template <class T>
T load(const std::byte* from, bool swap) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Calls visit with a value of the C++ type that stands for a PLY type.
template <class Visit>
auto visit_scalar(PlyScalar type, Visit&& visit) {
  switch (type) {
    case PlyScalar::kInt8:
      return visit(std::int8_t{});
    case PlyScalar::kUint8:
      return visit(std::uint8_t{});
    case PlyScalar::kInt16:
      return visit(std::int16_t{});
    case PlyScalar::kUint16:
      return visit(std::uint16_t{});
    case PlyScalar::kInt32:
      return visit(std::int32_t{});
    case PlyScalar::kUint32:
      return visit(std::uint32_t{});
    case PlyScalar::kFloat32:
      return visit(float{});
    case PlyScalar::kFloat64:
      break;
  }
  return visit(double{});
}

inline bool needs_swap(PlyEncoding encoding) {
  return (encoding == PlyEncoding::kBigEndian) != (std::endian::native == std::endian::big);
}

class PlyBinaryCursor {
 public:
  PlyBinaryCursor(std::span<const std::byte> bytes, std::size_t offset, bool swap)
      : bytes_(bytes), offset_(offset), swap_(swap) {}

  bool begin_item() { return true; }
  bool end_item() { return true; }

  bool read_real(PlyScalar type, float& value) {
    if (!has(1, size_of(type))) return false;
    visit_scalar(type, [&](auto example) { value = static_cast<float>(take<decltype(example)>()); });
    return true;
  }

  bool read_whole(PlyScalar type, std::int64_t& value) {
    if (!has(1, size_of(type))) return false;
    double wide = 0;
    visit_scalar(type, [&](auto example) {
      if constexpr (std::is_floating_point_v<decltype(example)>) {
        wide = static_cast<double>(take<decltype(example)>());
      } else {
        value = static_cast<std::int64_t>(take<decltype(example)>());
      }
    });
    if (!is_real(type)) return true;
    if (!(std::abs(wide) < 9e18) || wide != std::trunc(wide)) {
      problem_ = fmt::format("{} is no whole number", wide);
      return false;
    }
    value = static_cast<std::int64_t>(wide);
    return true;
  }

  bool skip(PlyScalar type, std::uint64_t count) {
    if (!has(count, size_of(type))) return false;
    offset_ += static_cast<std::size_t>(count) * size_of(type);
    return true;
  }

  /// Whether `count` values can still be there; asked before a list is read.
  bool has(std::uint64_t count, std::size_t size) {
    if (count <= (bytes_.size() - offset_) / size) return true;
    problem_ = count == 1
                   ? fmt::format("the file ends here: {} of {} bytes are left", bytes_.size() - offset_, size)
                   : fmt::format("a list of {} values, but the file has {} bytes left", count, bytes_.size() - offset_);
    truncated_ = true;
    return false;
  }
  bool has_values(std::uint64_t count, PlyScalar type) { return has(count, size_of(type)); }

  std::string where() const { return fmt::format("byte {}", offset_); }
  const std::string& problem() const { return problem_; }
  void set_problem(std::string problem) { problem_ = std::move(problem); }
  bool truncated() const { return truncated_; }
  std::size_t offset() const { return offset_; }
  std::size_t bytes_left() const { return bytes_.size() - offset_; }
  /// How many triangles can be left at most, by the size of each.
  std::uint64_t most_triangles(const PlyProperty& list) const {
    return bytes_left() / (size_of(list.count_type) + 3 * size_of(list.type));
  }
  const std::byte* data() const { return bytes_.data() + offset_; }
  /// Goes on behind `size` bytes that were read elsewhere. \pre they are there
  void advance(std::size_t size) { offset_ += size; }
  bool swap() const { return swap_; }

 private:
  template <class T>
  T take() {
    const T value = load<T>(bytes_.data() + offset_, swap_);
    offset_ += sizeof(T);
    return value;
  }

  std::span<const std::byte> bytes_;
  std::size_t offset_;
  bool swap_;
  bool truncated_ = false;
  std::string problem_;
};

/// An item is a line, as the format's description has it: that finds counts that are wrong where they go wrong.
class PlyTextCursor {
 public:
  PlyTextCursor(std::string_view text, std::size_t lines_before) : text_(text, lines_before) {}

  bool begin_item() {
    if (text_.advance()) return true;
    problem_ = "the file ends here";
    truncated_ = true;
    return false;
  }

  bool end_item() {
    if (text_.line_done()) return true;
    problem_ = fmt::format("{} is more than the header declares for this line", in_quotes(text_.peek()));
    return false;
  }

  bool read_real(PlyScalar, float& value) { return text_.real(value) || not_a_number(); }
  bool read_whole(PlyScalar, std::int64_t& value) { return text_.whole(value) || not_a_number(); }

  bool skip(PlyScalar, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (text_.token().empty()) return not_a_number();
    }
    return true;
  }

  /// A value takes two characters at least.
  bool has_values(std::uint64_t count, PlyScalar) {
    if (count <= text_.bytes_left()) return true;
    problem_ = fmt::format("a list of {} values, but the file has {} bytes left", count, text_.bytes_left());
    truncated_ = true;
    return false;
  }

  std::string where() const { return fmt::format("line {}", text_.line()); }
  const std::string& problem() const { return problem_; }
  void set_problem(std::string problem) { problem_ = std::move(problem); }
  bool truncated() const { return truncated_; }
  std::uint64_t most_triangles(const PlyProperty&) const { return text_.rest().size() / sizeof("3 0 1 2"); }
  TextLines& lines() { return text_; }

 private:
  bool not_a_number() {
    problem_ = text_.line_done() ? "fewer values on the line than the header declares"
                                 : in_quotes(text_.peek()) + " is no number of the declared kind";
    return false;
  }

  TextLines text_;
  bool truncated_ = false;
  std::string problem_;
};

}  // namespace limn::formats
