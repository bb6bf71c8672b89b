// The materials of all that is drawn (render/materials.h makes them and says where they are bound).

struct Material {
  vec3 base_color;        // linear
  float metallic;
  float roughness;
  int base_color_layer;   // of base_color_pictures, -1 for none
  int normal_layer;       // of normal_pictures, -1 for none
  float normal_scale;
};

layout(std430, binding = 7) readonly buffer Materials { Material materials[]; };
layout(binding = 14) uniform sampler2DArray base_color_pictures;
layout(binding = 15) uniform sampler2DArray normal_pictures;

/// The material of this number. With SINGLE_MATERIAL all that is drawn has one, which comes from a uniform
/// (MaterialTable::set_single): some devices read the table a number at a time.
#ifdef SINGLE_MATERIAL
uniform Material single_material;
Material material_of(uint id) { return single_material; }
#else
Material material_of(uint id) { return materials[id]; }
#endif

// A picture is looked up only where there is one. All fragments of a quad belong to one triangle and so take the same way,
// which is what derivatives need.

vec3 base_color_of(Material m, vec2 uv) {
  if (m.base_color_layer < 0) return m.base_color;
  return m.base_color * texture(base_color_pictures, vec3(uv, m.base_color_layer)).rgb;
}

/// In the frame of u, v (upwards in the picture) and the surface's normal; not of unit length.
vec3 mapped_normal(Material m, vec2 uv) {
  vec3 n = texture(normal_pictures, vec3(uv, m.normal_layer)).xyz * 2.0 - 1.0;
  return n * vec3(m.normal_scale, m.normal_scale, 1.0);
}
