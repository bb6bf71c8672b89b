// Which stored pattern serves a face: the twin of choose_pattern() (refine/patterns/pattern.h). NESTED is 1 or 0.

/// base, whether it is mirrored, and corners 0 and 1 of the pattern as corners of the face, two bits each.
struct PatternChoice {
  uint base;
  bool mirrored;
  uint corners;
};

uint choose_2(uint n) { return n * (n - 1u) / 2u; }
uint choose_3(uint n) { return n * (n - 1u) * (n - 2u) / 6u; }
uint choose_4(uint n) { return choose_3(n) * (n - 3u) / 4u; }

/// Lenz et al. 2009, Fig. 8: three swaps sort the sides; each turns the pattern over the corner that two sides share.
PatternChoice choose_pattern(uint inner, uvec3 s) {
  uvec3 c = uvec3(0u, 1u, 2u);
  bool odd = false;
  if (s.x < s.y) { s = s.yxz; c = c.zyx; odd = !odd; }
  if (s.x < s.z) { s = s.zyx; c = c.xzy; odd = !odd; }
  if (s.y < s.z) { s = s.xzy; c = c.yxz; odd = !odd; }
#if NESTED
  uint base = s.x == 0u ? 0u : choose_4(s.x + 3u) + choose_3(s.x - inner + 2u) + choose_2(s.y - inner + 1u) + (s.z - inner);
#else
  uint base = choose_3(s.x + 2u) + choose_2(s.y + 1u) + s.z;
#endif
  return PatternChoice(base, odd, c.x | c.y << 2);
}

/// Of a face whose edges have these words (refine_levels.glsl), `cut` taken from every level.
PatternChoice choose_pattern_at(uvec3 words, uint cut) {
#if NESTED
  uint largest = max(max(level_own(words.x), level_own(words.y)), level_own(words.z));
  uint inner = level_ceil(level_cut(largest, cut));
  uvec3 sides = uvec3(level_ceil(level_cut(level_around(words.x), cut)), level_ceil(level_cut(level_around(words.y), cut)),
                      level_ceil(level_cut(level_around(words.z), cut)));
  return choose_pattern(inner, sides);
#else
  return choose_pattern(0u, uvec3(level_ceil(level_cut(level_own(words.x), cut)), level_ceil(level_cut(level_own(words.y), cut)),
                                  level_ceil(level_cut(level_own(words.z), cut))));
#endif
}
