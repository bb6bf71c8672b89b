#pragma once

#include "limn/base/vec.h"

namespace limn {

/// On which side of the plane through a, b, c the point d lies: 1 on the side that (b − a) × (c − a) points to, where
/// the triangle is seen counter-clockwise; -1 on the other; 0 in the plane, or where a, b, c lie on one line.
///
/// The exact sign, whatever the coordinates: a product of three differences of floats is a multiple of 2^-447 below
/// 2^390, so that nothing under- or overflows in double. \pre all coordinates are finite
/// Cost: about 5 ns where double arithmetic decides; about 0.5 µs in or very near the plane, where expansions do.
/// Shewchuk 1997, Adaptive precision floating-point arithmetic and fast robust geometric predicates.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace limn
