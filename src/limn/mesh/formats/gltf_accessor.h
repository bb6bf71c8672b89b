#pragma once

#include <cstdint>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/formats/gltf_document.h"

namespace limn::formats::gltf {

/// The number of elements accessors[index] claims. Nothing is known yet about whether they are there.
std::uint64_t accessor_count(Document& document, std::size_t index);

/// The values of an accessor as floats: integers as they are, or brought to [0, 1] or [-1, 1] when normalized; sparse
/// values put in place; zeros without a buffer view. Every byte read lies within its view. Throws Failure on a type
/// that does not fit (`type` is "VEC2", "VEC3"; colours may be VEC3, alpha then being 1). \pre the caller has claimed
/// accessor_count() elements: memory is allocated for as many
std::vector<Vec2> read_vec2(Document& document, std::size_t index);
std::vector<Vec3> read_vec3(Document& document, std::size_t index);
std::vector<Vec4> read_color(Document& document, std::size_t index);
/// Unsigned integers. \pre as above
std::vector<std::uint32_t> read_indices(Document& document, std::size_t index);

/// Whether the accessor stores floats, so that its values are exactly what was written.
bool stores_floats(Document& document, std::size_t index);

}  // namespace limn::formats::gltf
