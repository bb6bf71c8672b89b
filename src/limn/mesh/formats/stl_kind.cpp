#include "limn/mesh/formats/stl_kind.h"

#include <cctype>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace limn::formats {

std::size_t stl_facet_count(std::span<const std::byte> bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeaderSize - sizeof count, sizeof count);
  return count;
}

StlKind stl_kind_of(std::span<const std::byte> bytes) {
  constexpr std::size_t kLookedAt = 4096;
  if (bytes.size() >= kStlHeaderSize && bytes.size() == kStlHeaderSize + stl_facet_count(bytes) * kStlFacetSize) {
    return StlKind::kBinary;
  }
  std::string start(reinterpret_cast<const char*>(bytes.data()), bytes.size() < kLookedAt ? bytes.size() : kLookedAt);
  for (char& c : start)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::string_view text(start);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || !text.substr(first).starts_with("solid")) return StlKind::kNeither;
  if (text.find('\0') != std::string_view::npos) return StlKind::kNeither;
  const bool has_body = text.find("facet") != std::string_view::npos || text.find("endsolid") != std::string_view::npos;
  return has_body ? StlKind::kText : StlKind::kNeither;
}

}  // namespace limn::formats
