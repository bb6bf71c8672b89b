// Turns a normal as a normal map says, without stored tangents: from how position and texture coordinates change across the
// screen.

/// The mapped normal `mapped` of the tangent frame, brought to eye space about `n`.
///
/// `n` is of unit length, on the side of the face that is seen; `front` is 1 where that is the side the map was made for, -1
/// where the surface is seen from behind (what is a bump from the front is then a dent). `uv` has v downwards.
/// The frame is that of MikkTSpace within a triangle: the tangent is the direction in which u grows along the surface, made
/// perpendicular to n; the bitangent is perpendicular to both, on the side to which v decreases. Gives n where texture
/// coordinates do not change, or change in one direction only.
vec3 turn_normal(vec3 n, float front, vec3 mapped, vec3 at, vec2 uv) {
  vec3 at_x = dFdx(at), at_y = dFdy(at);
  vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
  // To a middling size first, so that products neither vanish nor overflow.
  float size = max(max(abs(uv_x.x), abs(uv_x.y)), max(abs(uv_y.x), abs(uv_y.y)));
  if (!(size > 0.0 && size < 1e30)) return n;
  uv_x /= size;
  uv_y /= size;
  float turn = uv_x.y * uv_y.x - uv_x.x * uv_y.y;  // > 0 where the picture lies unmirrored
  vec3 tangent = at_y * uv_x.y - at_x * uv_y.y;
  tangent *= sign(turn) / max(max(length(at_x), length(at_y)), 1e-30);
  tangent -= n * dot(n, tangent);
  float len = length(tangent);
  if (!(len > 1e-6)) return n;
  tangent /= len;
  vec3 bitangent = cross(n, tangent) * sign(turn);
  vec3 turned = front * (tangent * mapped.x + bitangent * mapped.y) + n * mapped.z;
  float turned_size = length(turned);
  return turned_size > 0.0 ? turned / turned_size : n;
}
