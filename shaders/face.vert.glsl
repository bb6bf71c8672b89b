#version 450 core
// A mesh's vertices in eye space and clip space.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;

uniform mat4 rotation;    // world to eye space without its translation
uniform vec3 eye;
uniform mat4 projection;

// With WIREFRAME a geometry shader stands between this and the fragments.
#ifdef WIREFRAME
#define OUT(name) v_##name
#else
#define OUT(name) name
#endif

layout(location = 0) out vec3 OUT(at);
layout(location = 1) out vec3 OUT(shading_normal);
layout(location = 2) out vec2 OUT(texture_uv);
layout(location = 3) out vec4 OUT(tint);

invariant gl_Position;

void main() {
  // Relative to the eye first: far from the origin the translation of a matrix would lose the low bits.
  vec3 p = (rotation * vec4(position - eye, 0.0)).xyz;
  OUT(at) = p;
  OUT(shading_normal) = (rotation * vec4(normal, 0.0)).xyz;
  OUT(texture_uv) = vec2(uv.x, 1.0 - uv.y);
  OUT(tint) = color;
  gl_Position = projection * vec4(p, 1.0);
}
