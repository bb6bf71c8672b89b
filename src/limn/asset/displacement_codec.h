#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace limn::asset {

/// 16-bit texels, row by row, in few bytes, every bit kept. Same texels, same bytes.
/// \pre texels.size() is a multiple of width
std::vector<std::byte> encode_texels(std::span<const std::uint16_t> texels, std::size_t width);

/// The texels that were encoded; nothing when the bytes are not those of so many.
std::optional<std::vector<std::uint16_t>> decode_texels(std::span<const std::byte> bytes, std::size_t width,
                                                        std::size_t height);

}  // namespace limn::asset
