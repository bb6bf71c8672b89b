#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "limn/mesh/formats/formats.h"

namespace limn::formats {

enum class PlyScalar : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Bytes a scalar takes in a binary file.
std::size_t size_of(PlyScalar type);
inline bool is_real(PlyScalar type) {
  return type >= PlyScalar::kFloat32;
}

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::kFloat32;  ///< of the value, or of each value of a list
  bool list = false;
  PlyScalar count_type = PlyScalar::kUint8;  ///< of a list's count
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_list() const;
  /// Bytes of one item in a binary file when every list is empty: its size when it has no lists.
  std::size_t smallest_size() const;
};

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;           ///< bytes up to the first item
  std::size_t lines = 0;          ///< lines up to the first item
  bool carriage_returns = false;  ///< lines end in CR alone

  const PlyElement* find(std::string_view name) const;
};

/// Reads the header. Line ends may be LF, CR LF or CR. Claims are not held against the file's size here.
/// Errors: kUnreadable, naming the line.
Result<PlyHeader> parse_ply_header(const Source& source);

}  // namespace limn::formats
