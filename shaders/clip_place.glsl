// A clipped model's space to the world's, written out and `precise` as in clip_space.glsl: without turning or moving it gives
// the same bits back, so that the silhouette lands where the model itself would.

uniform vec4 to_world_rows[3];

vec3 to_world(vec4 p) {
  precise vec3 world = vec3(
      to_world_rows[0].x * p.x + to_world_rows[0].y * p.y + to_world_rows[0].z * p.z + to_world_rows[0].w * p.w,
      to_world_rows[1].x * p.x + to_world_rows[1].y * p.y + to_world_rows[1].z * p.z + to_world_rows[1].w * p.w,
      to_world_rows[2].x * p.x + to_world_rows[2].y * p.y + to_world_rows[2].z * p.z + to_world_rows[2].w * p.w);
  return world;
}
