// How every stage that places a surface's vertices hands one to the fragments (face.frag.glsl). With WIREFRAME the geometry
// stage wire.geom.glsl stands between.

#include "clip_space.glsl"

#ifdef WIREFRAME
#define SURFACE_OUT(name) v_##name
#else
#define SURFACE_OUT(name) name
#endif

layout(location = 0) out vec3 SURFACE_OUT(at);              // eye space
layout(location = 1) out vec3 SURFACE_OUT(shading_normal);  // eye space; 0: use the face's
layout(location = 2) out vec2 SURFACE_OUT(texture_uv);      // v downwards, as pictures are stored
layout(location = 3) out vec4 SURFACE_OUT(tint);
layout(location = 4) flat out uint SURFACE_OUT(material);

/// A vertex in world space; v upwards.
void emit_surface(vec3 position, vec3 normal, vec2 uv, vec4 color, uint material_id) {
  vec3 p = to_eye_space(position);
  SURFACE_OUT(at) = p;
  SURFACE_OUT(shading_normal) = mat3(rotation) * normal;
  SURFACE_OUT(texture_uv) = vec2(uv.x, 1.0 - uv.y);
  SURFACE_OUT(tint) = color;
  SURFACE_OUT(material) = material_id;
  gl_Position = to_clip_space(p);
}
