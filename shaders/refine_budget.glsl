// A budget of triangles is kept by taking one cut from every level, found in two rounds of sixteen: frame[0] is the cut so
// far, frame[3] the budget.

const uint kSteps = 16u;
const uint kSums = 8u;  // in `frame`, two words a step

uniform uint step_units;  // of a round, in units of a level

uint cut_of(uint step) { return frame[0] + step * step_units; }
