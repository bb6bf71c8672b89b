#version 450 core
// Passes a triangle on and gives its corners barycentric coordinates.

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

layout(location = 0) in vec3 v_at[];
layout(location = 1) in vec3 v_shading_normal[];
layout(location = 2) in vec2 v_texture_uv[];
layout(location = 3) in vec4 v_tint[];
layout(location = 4) flat in uint v_material[];

layout(location = 0) out vec3 at;
layout(location = 1) out vec3 shading_normal;
layout(location = 2) out vec2 texture_uv;
layout(location = 3) out vec4 tint;
layout(location = 4) flat out uint material;
layout(location = 5) out vec3 barycentric;

invariant gl_Position;

void main() {
  for (int i = 0; i < 3; ++i) {
    at = v_at[i];
    shading_normal = v_shading_normal[i];
    texture_uv = v_texture_uv[i];
    tint = v_tint[i];
    material = v_material[i];
    barycentric = vec3(i == 0, i == 1, i == 2);
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
}
