#pragma once

#include <span>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn::test {

/// Every edge, by the ids of its ends, has exactly two faces that run along it in opposite directions; every vertex is
/// used and has one fan of faces; no face has a vertex twice. Slow and plain.
bool is_closed_manifold(std::span<const Vec3> positions, std::span<const Triangle> faces);

/// The winding number as a sum of solid angles over 4π: whole up to rounding off a closed surface.
double solid_angle_winding(std::span<const Vec3> positions, std::span<const Triangle> faces, const DVec3& point);

}  // namespace limn::test
