#pragma once

#include <cstddef>
#include <span>

namespace limn::formats {

inline constexpr std::size_t kStlHeaderSize = 84;
inline constexpr std::size_t kStlFacetSize = 50;

enum class StlKind { kBinary, kText, kNeither };

/// Tells binary from text STL. Many binary files begin with "solid" too: a size that fits the count in the header
/// decides, then whether "facet" or "endsolid" follows "solid" soon. kNeither: looks like neither; may be a damaged
/// binary file.
StlKind stl_kind_of(std::span<const std::byte> bytes);

/// The number of facets a binary header claims. \pre bytes.size() >= kStlHeaderSize
std::size_t stl_facet_count(std::span<const std::byte> bytes);

}  // namespace limn::formats
