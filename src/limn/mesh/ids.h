#pragma once

#include <array>
#include <cstdint>

namespace limn {

/// Indices into a mesh and its topology. 32 bits: a mesh has fewer than 2^32 corners.
using VertexId = std::uint32_t;
using FaceId = std::uint32_t;
using EdgeId = std::uint32_t;

/// Three vertices, counter-clockwise seen from the front.
using Triangle = std::array<VertexId, 3>;

inline constexpr std::uint32_t kInvalidId = 0xffffffffu;

}  // namespace limn
