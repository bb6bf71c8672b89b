#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

/// The checksum of PNG's chunks.
std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace limn
