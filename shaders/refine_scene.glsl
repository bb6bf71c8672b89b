// The tables of a refinement scene (render/refinement/scene.h), as texels of uints: floats by their bits.
// With FACE_UNIFORMS what belongs to corners and edges comes from uniforms instead, those of the one face that is drawn.
// Work counts faces, edges and vertices over all instances, 256 of one instance at a time; tables count them over objects.

layout(binding = 0) uniform usamplerBuffer instances;         // seven texels each, see below
layout(binding = 1) uniform usamplerBuffer face_vertices;     // three vertices
layout(binding = 2) uniform usamplerBuffer face_edges;        // three edges, kReversed where the face runs along it backwards
layout(binding = 3) uniform usamplerBuffer positions;
layout(binding = 4) uniform usamplerBuffer normals;
layout(binding = 5) uniform usamplerBuffer curves;            // two texels an edge: the inner control points
layout(binding = 6) uniform usamplerBuffer uvs;
layout(binding = 7) uniform usamplerBuffer colors;
layout(binding = 8) uniform usamplerBuffer vertex_materials;
layout(binding = 9) uniform usamplerBuffer face_blocks;       // the instance of each 256 faces
layout(binding = 10) uniform usamplerBuffer vertex_blocks;    // and of each 256 vertices

const uint kReversed = 0x80000000u;
const uint kInvalid = 0xffffffffu;
const int kInstanceTexels = 7;

#ifdef FACE_UNIFORMS
#include "refine_face_uniforms.glsl"
#else
vec3 position_of(uint v) { return uintBitsToFloat(texelFetch(positions, int(v)).xyz); }
vec3 normal_of(uint v) { return uintBitsToFloat(texelFetch(normals, int(v)).xyz); }
vec3 control_point(uint edge, uint end) { return uintBitsToFloat(texelFetch(curves, int(2u * edge + end)).xyz); }

vec2 uv_of(uint v) {
#ifdef HAS_UVS
  return uintBitsToFloat(texelFetch(uvs, int(v)).xy);
#else
  return vec2(0.0);
#endif
}

vec4 color_of(uint v) {
#ifdef HAS_COLORS
  return uintBitsToFloat(texelFetch(colors, int(v)));
#else
  return vec4(1.0);
#endif
}

uint material_of(uint v) {
#ifdef HAS_MATERIALS
  return texelFetch(vertex_materials, int(v)).x;
#else
  return 0u;
#endif
}
#endif

uvec4 instance_texel(uint instance, int n) {
  return texelFetch(instances, int(instance) * kInstanceTexels + n);
}

/// first face of the instance, of its object, how many, first vertex of the instance
uvec4 instance_faces(uint instance) { return instance_texel(instance, 4); }
/// first edge of the instance, of its object, how many, first vertex of the object
uvec4 instance_edges(uint instance) { return instance_texel(instance, 5); }

/// An instance's rows of object to world.
struct Placement {
  vec4 x, y, z;
};

Placement placement_of(uint instance) {
  return Placement(uintBitsToFloat(instance_texel(instance, 0)), uintBitsToFloat(instance_texel(instance, 1)),
                   uintBitsToFloat(instance_texel(instance, 2)));
}

/// A point (w = 1) or a direction (w = 0) of the object in world space; the same bits wherever it is called.
vec3 to_world(Placement at, vec4 p) {
  precise vec3 world = vec3(at.x.x * p.x + at.x.y * p.y + at.x.z * p.z + at.x.w * p.w,
                            at.y.x * p.x + at.y.y * p.y + at.y.z * p.z + at.y.w * p.w,
                            at.z.x * p.x + at.z.y * p.y + at.z.z * p.z + at.z.w * p.w);
  return world;
}

vec3 to_world(uint instance, vec4 p) { return to_world(placement_of(instance), p); }
