#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/vec.h"

namespace limn::formats {

/// Appends the corners.size() - 2 triangles of a polygon to `triangles`, as indices into `corners`, its winding kept.
///
/// Convex polygons become a fan about corner 0. Others are cut by ears in the plane of their Newell normal; where no
/// ear is left (the polygon crosses itself) or the polygon has more than 256 corners, what remains becomes a fan. Never
/// fails and adds no vertex. \pre corners.size() >= 3. Cost: linear when convex, else about quadratic.
void triangulate(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace limn::formats
