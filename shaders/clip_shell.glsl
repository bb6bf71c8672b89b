// The shell between a hull and the surface that was baked into it, and the way of a line of sight through it.
//
// Every place in the shell is X = P(b) - depth * N(b): P and N interpolate the corners of a hull's face at barycentric
// coordinates (1 - b.x - b.y, b.x, b.y). N is not of unit length; what lies at distance d along the unit normal has
// depth d / |N|. Faces share corners and normals, so the shell's prisms meet without gaps, and a ray that leaves one
// enters the next. docs/interior-silhouettes.md; render/clip/hull_shell.h fills the buffer.

struct ShellFace {
  vec4 corner[3];     // xyz: place; w: u
  vec4 direction[3];  // xyz: unit normal; w: v, downwards as pictures are stored
  uvec4 across;       // of edge c, from corner c to the next: the face beyond, times 4, plus which of its edges it is
};

layout(std430, binding = 8) readonly buffer ShellFaces {
  ShellFace shell_faces[];
};
layout(binding = 8) uniform sampler2D shell_displacement;  // 0 … 1 from `low` to `high`, along the unit normal
uniform vec2 shell_range;                                  // low, high

struct ShellPlace {
  uint face;
  vec2 b;
  float depth;
};

/// What X does when b and depth change: its derivatives, and X itself.
struct ShellFrame {
  vec3 at, by_b1, by_b2, by_depth;
  float determinant;
  float flat_determinant;  // the same at depth 0: where the two part by much, normals cross and places are no longer unique
  vec2 uv, uv_by_b1, uv_by_b2;
};

ShellFrame shell_frame(ShellFace f, ShellPlace place) {
  vec4 e1 = f.corner[1] - f.corner[0], e2 = f.corner[2] - f.corner[0];
  vec4 m1 = f.direction[1] - f.direction[0], m2 = f.direction[2] - f.direction[0];
  vec4 p = f.corner[0] + e1 * place.b.x + e2 * place.b.y;
  vec4 n = f.direction[0] + m1 * place.b.x + m2 * place.b.y;
  ShellFrame frame;
  frame.at = p.xyz - place.depth * n.xyz;
  frame.by_b1 = e1.xyz - place.depth * m1.xyz;
  frame.by_b2 = e2.xyz - place.depth * m2.xyz;
  frame.by_depth = -n.xyz;
  frame.determinant = dot(frame.by_b1, cross(frame.by_b2, frame.by_depth));
  frame.flat_determinant = dot(e1.xyz, cross(e2.xyz, frame.by_depth));
  frame.uv = vec2(p.w, n.w);
  frame.uv_by_b1 = vec2(e1.w, m1.w);
  frame.uv_by_b2 = vec2(e2.w, m2.w);
  return frame;
}

bool is_regular(ShellFrame frame) {
  return frame.determinant / frame.flat_determinant > 0.05;
}

/// The change of (b1, b2, depth) that changes X by `change`, to first order. \pre is_regular
vec3 shell_change(ShellFrame frame, vec3 change) {
  return vec3(dot(change, cross(frame.by_b2, frame.by_depth)), dot(change, cross(frame.by_depth, frame.by_b1)),
              dot(change, cross(frame.by_b1, frame.by_b2))) / frame.determinant;
}

/// How deep below the hull the surface lies there, in lengths.
float surface_depth(vec2 uv) {
  return -mix(shell_range.x, shell_range.y, textureLod(shell_displacement, uv, 0.0).r);
}

/// Moves to the same place within the face beyond the edge that b lies outside of most. False where there is none.
bool cross_edge(inout ShellPlace place, inout ShellFace f) {
  vec3 w = vec3(1.0 - place.b.x - place.b.y, place.b);
  // The corner of lowest weight faces the edge: corner c faces edge (c + 1) % 3.
  int corner = w.x <= w.y ? (w.x <= w.z ? 0 : 2) : (w.y <= w.z ? 1 : 2);
  int edge = (corner + 1) % 3;
  uint beyond = f.across[edge];
  if (beyond == 0xffffffffu) return false;
  float along = clamp(w[(edge + 1) % 3] / max(w[edge] + w[(edge + 1) % 3], 1e-6), 0.0, 1.0);  // from corner `edge` to the next
  int entered = int(beyond & 3u);
  vec3 there = vec3(0.0);
  there[entered] = along;  // the face beyond runs along the edge the other way
  there[(entered + 1) % 3] = 1.0 - along;
  place.face = beyond >> 2;
  place.b = there.yz;
  f = shell_faces[place.face];
  return true;
}

/// Moves the place towards X = target by one of Newton's steps from its frame, over an edge where the step leads there;
/// then by a second within the face beyond, lest what is read there be read beside the place. False where that is not
/// possible.
bool step_to(inout ShellPlace place, inout ShellFace f, ShellFrame frame, vec3 target) {
  vec3 change = shell_change(frame, target - frame.at);
  place.b += change.xy;
  place.depth += change.z;
  for (int i = 0; i < 3; ++i) {
    if (max(max(-place.b.x, -place.b.y), place.b.x + place.b.y - 1.0) <= 1e-3) return true;
    if (!cross_edge(place, f)) return false;
    ShellFrame beyond = shell_frame(f, place);
    if (!is_regular(beyond)) return false;
    change = shell_change(beyond, target - beyond.at);
    place.b += change.xy;
    place.depth += change.z;
  }
  return true;
}

const int kSurfaceMet = 0;    // place is on the surface
const int kHullLeft = 1;      // the ray left the hull without meeting the surface
const int kShellUnclear = 2;  // normals cross, or too many steps: place is where the march stopped

/// Follows the ray from `origin`, a place on the hull, until it meets the surface or leaves the hull.
/// `direction` is of unit length; `grain` a length that cannot be seen; `texels` the picture's size, `texels_a_step` how many
/// of them a step may pass over.
int march_shell(inout ShellPlace place, vec3 origin, vec3 direction, float grain, vec2 texels, float texels_a_step,
                int steps) {
  ShellFace f = shell_faces[place.face];
  float t = 0.0, t_before = 0.0, gap_before = 0.0;
  for (int i = 0; i < steps; ++i) {
    ShellFrame frame = shell_frame(f, place);
    if (!is_regular(frame)) return kShellUnclear;
    float height = length(frame.by_depth);
    float gap = surface_depth(frame.uv) - place.depth * height;
    if (gap <= 0.0) {
      if (gap_before > 0.0) {  // where a line between the last two gaps falls to 0
        t = t_before + (t - t_before) * gap_before / (gap_before - gap);
        step_to(place, f, frame, origin + direction * t);
      }
      return kSurfaceMet;
    }
    if (place.depth * height < -grain) return kHullLeft;
    vec3 rate = shell_change(frame, direction);
    float texel_rate = length((frame.uv_by_b1 * rate.x + frame.uv_by_b2 * rate.y) * texels);
    float dt = texels_a_step / max(texel_rate, 1e-6);
    if (rate.z > 0.0) dt = min(dt, (gap + grain) / (rate.z * height));
    t_before = t;
    gap_before = gap;
    t += dt;
    if (!step_to(place, f, frame, origin + direction * t)) return kShellUnclear;
  }
  return kShellUnclear;
}
