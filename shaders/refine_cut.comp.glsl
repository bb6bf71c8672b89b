#version 450 core
// Takes the smallest cut of a round whose triangles fit the budget. A round that is not the last leaves the largest one that
// does not fit, from which the next goes on; where even the deepest does not fit, that is taken.

#include "refine_selection.glsl"
#include "refine_budget.glsl"

uniform bool last_round;

bool fits(uint step) {
  uint high = frame[kSums + 2u * step];
  uint low = frame[kSums + 2u * step + 1u];
  high += low >> 12;
  return high < frame[3] >> 12 || (high == frame[3] >> 12 && (low & 4095u) <= (frame[3] & 4095u));
}

void main() {
  if (invocation_index() != 0u) return;
  uint step = 0u;
  while (step < kSteps && !fits(step))
    ++step;
  // In the last round step 15 of 16 is one short of the next coarse cut, which may be the one that fits.
  uint taken = last_round || step == 0u ? step : step - 1u;
  frame[0] += taken * step_units;
  for (uint i = 0u; i < 2u * kSteps; ++i)
    frame[kSums + i] = 0u;
}
