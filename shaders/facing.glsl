// Whether a face is seen from the front: the twin of silhouette/facing.h, bit for bit.

#include "exact_float.glsl"

// An eye is its coordinates' bits and flags.
const uint kEyeOrthographic = 1u;
const uint kEyeCareful = 2u;  // subnormal numbers are about, in the eye or in the normals of its object

/// n·x + d as a CPU computes it, subnormal numbers included.
double exact_side(uvec4 plane, uvec4 eye) {
  precise double x = round_to_float(exact_value(plane.x) * exact_value(eye.x));
  precise double y = round_to_float(exact_value(plane.y) * exact_value(eye.y));
  precise double z = round_to_float(exact_value(plane.z) * exact_value(eye.z));
  precise double xy = round_to_float(x + y);
  precise double xyz = round_to_float(xy + z);
  return (eye.w & kEyeOrthographic) != 0u ? xyz : round_to_float(xyz + exact_value(plane.w));
}

/// \param plane  bits of nx, ny, nz, d
bool faces_eye(uvec4 plane, uvec4 eye) {
  vec4 p = uintBitsToFloat(plane);
  vec3 at = uintBitsToFloat(eye.xyz);
  precise float side = p.x * at.x + p.y * at.y + p.z * at.z + ((eye.w & kEyeOrthographic) != 0u ? 0.0 : p.w);
  // A product or sum that was flushed to 0 can have changed the sign of a sum as small as this, and of none larger
  // (docs/gpu-extraction.md).
  const float kSmall = 9.094947e-13;  // 2^-40
  bool careful = (eye.w & kEyeCareful) != 0u || abs(side) < kSmall;
  return careful ? exact_side(plane, eye) > 0.0lf : side > 0.0;
}
