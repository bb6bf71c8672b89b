// What a corner of a face brings along for hardware tessellation: its own values and those of the side that begins at it.

#ifdef POSITIONS_ONLY
#define CORNER_ATTRIBUTES
#else
#define CORNER_ATTRIBUTES vec3 normal; vec2 uv; vec4 color; uint material;
#endif
// point; the side's inner control points from here on; its level, kBackwards where its own order is the other one;
// the face, counted over instances
#define CORNER { vec3 point, near, far; uint side; uint face; CORNER_ATTRIBUTES }

const uint kBackwards = 0x80000000u;
const uint kNoPatch = 0xffffffffu;  // of a degenerate face's sides
