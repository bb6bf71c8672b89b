#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "limn/mesh/formats/formats.h"

namespace limn::test {

/// A reader's input from text in memory. `text` must outlive it.
inline formats::Source source_of(std::string_view text, std::filesystem::path folder = {}) {
  return {std::as_bytes(std::span(text.data(), text.size())), "model", std::move(folder), {}};
}

/// The vector's coordinates as bits, for comparisons that tell -0 from 0.
inline std::array<std::uint32_t, 3> bits(const Vec3& v) {
  return {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z)};
}

}  // namespace limn::test
