#pragma once

#include <optional>
#include <span>

#include "limn/base/bounds.h"
#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// How often the closed surface winds around a point, exactly: signed crossings of a segment from the point to one
/// outside, by orientation tests on the coordinates as they are. Nothing where the point lies on the surface, or where
/// every segment tried meets an edge. Cost: linear in the faces. \pre every edge's faces run along it in opposite
/// directions
std::optional<int> winding_number(std::span<const Vec3> positions, std::span<const Triangle> faces, const Vec3& point);

/// Whether a box surely keeps clear of a triangle, its border included: apart along an axis, or all of the box strictly
/// on one side of the triangle's plane. Exact; may miss clearances that need an edge's direction.
bool is_clear_of(const Bounds& box, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limn
