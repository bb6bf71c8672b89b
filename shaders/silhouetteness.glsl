// How nearly an edge is a silhouette: the twin of silhouette/silhouetteness.h.

#include "exact_float.glsl"

/// α of equation (2): 1 on the silhouette (f <= 0), falling linearly to 0 at f = β.
float silhouetteness(float f, float beta) {
  if (f <= 0.0) return 1.0;
  precise float alpha = 1.0 - f / beta;
  return f <= beta ? alpha : 0.0;
}

/// d of equation (1), in double so that neither huge nor tiny meshes lose it.
vec3 unit_direction(dvec3 from, dvec3 to) {
  dvec3 d = to - from;
  precise double squared = d.x * d.x + d.y * d.y + d.z * d.z;
  double len = sqrt(squared);
  return len > 0.0lf ? vec3(d / len) : vec3(0.0);
}

/// f of equation (1). \param d  from the eye to the edge's midpoint, of unit length
float silhouette_product(vec3 d, vec3 ns, vec3 nt) {
  precise float s = d.x * ns.x + d.y * ns.y + d.z * ns.z;
  precise float t = d.x * nt.x + d.y * nt.y + d.z * nt.z;
  precise float f = s * t;
  return f;
}
