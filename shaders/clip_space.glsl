// From world space to clip space, the same bits for equal positions in every program: each sum is written out and `precise`,
// so that no compiler orders it differently or contracts it.

#include "camera_block.glsl"

invariant gl_Position;

vec3 to_eye_space(vec3 position) {
  // Relative to the eye first: far from the origin the translation of a matrix would lose the low bits.
  precise vec3 d = position - eye;
  precise vec3 p = rotation[0].xyz * d.x + rotation[1].xyz * d.y + rotation[2].xyz * d.z;
  return p;
}

vec4 to_clip_space(vec3 p) {
  precise vec4 clip = projection[0] * p.x + projection[1] * p.y + projection[2] * p.z + projection[3];
  return clip;
}
