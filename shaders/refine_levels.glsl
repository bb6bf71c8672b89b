// Levels in the fixed-point form of refine/levels.h, units of 1/4096, one word an edge. Below: the edge's own; above, for
// nested patterns: the largest of all edges of all its faces.

const uint kLevelOne = 4096u;
const float kLevelUnit = 1.0 / 4096.0;

uint level_own(uint word) { return word & 0xffffu; }
uint level_around(uint word) { return word >> 16; }

/// What is left of a level when a budget takes `cut` away.
uint level_cut(uint level, uint cut) { return level > cut ? level - cut : 0u; }

/// The whole number of halvings that a level asks for.
uint level_ceil(uint level) { return (level + (kLevelOne - 1u)) >> 12; }
