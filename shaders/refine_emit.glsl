// Hands a vertex of an instance to the fragments, or, with POSITIONS_ONLY, its place alone. With CAPTURED the place in the
// object's space can be caught by transform feedback.

// A file is included once, whatever the preprocessor then makes of it: not from within a condition alone.
#include "clip_space.glsl"
#ifndef POSITIONS_ONLY
#include "surface_vertex.glsl"
#endif
#ifdef CAPTURED
out vec3 captured_position;
out uvec2 captured_source;  // the face, counted over instances; weights 1 and 2 of the corner, 12 bits each, and their level
#endif

void place_vertex(vec3 position) {
  gl_Position = to_clip_space(to_eye_space(position));
}

/// Puts all vertices of a triangle in one place, where it covers nothing.
void collapse_vertex() {
#ifndef POSITIONS_ONLY
  emit_surface(eye, vec3(0.0), vec2(0.0), vec4(0.0), 0u);
#endif
#ifdef CAPTURED
  captured_position = vec3(0.0);
  captured_source = uvec2(0xfffffffeu, 0u);
#endif
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
}
