// A face's corners and edges as uniforms, set anew for every face: the twin of FaceUniforms in render/refinement/published/per_triangle.cpp.
// Vertices and edges of the face are 0, 1 and 2.

#ifdef HAS_COLORS
uniform vec4 face_data[15];
#else
uniform vec4 face_data[12];
#endif

vec3 position_of(uint v) { return face_data[v].xyz; }
vec3 normal_of(uint v) { return face_data[3u + v].xyz; }
vec3 control_point(uint edge, uint end) { return face_data[6u + 2u * edge + end].xyz; }
/// Whether the face runs along the edge backwards.
bool runs_backwards(uint edge) { return face_data[6u + 2u * edge].w != 0.0; }
vec2 uv_of(uint v) { return vec2(face_data[v].w, face_data[3u + v].w); }
uint material_of(uint v) { return uint(face_data[7].w); }

vec4 color_of(uint v) {
#ifdef HAS_COLORS
  return face_data[12u + v];
#else
  return vec4(1.0);
#endif
}
