#pragma once

#include <vector>

#include "limn/base/random.h"
#include "limn/hull/shell.h"
#include "limn/hull/step_replay.h"

namespace limn::test {

/// Steps of all kinds that fit the shell one after another, most of them collapses; they move the surface anywhere.
inline std::vector<HullStep> random_steps(const Shell& shell, std::size_t faces_left, std::uint64_t seed) {
  Random random(seed);
  StepReplay replay(shell.positions, shell.faces);
  std::vector<CornerChange> changes;
  std::vector<HullStep> steps;
  for (std::size_t tries = 0; replay.face_count() > faces_left && tries < 100 * shell.faces.size(); ++tries) {
    const auto corner = static_cast<std::uint32_t>(random.below(3 * shell.faces.size()));
    const VertexId v = replay.faces()[corner / 3][corner % 3];
    const Vec3 after = replay.positions()[v] + 0.01f * random.direction();
    const std::uint64_t kind = random.below(8);
    const auto step = kind == 0   ? replay.move_of(v, after)
                      : kind == 1 ? replay.step_at(HullStep::Kind::kFlip, corner, after)
                                  : replay.step_at(HullStep::Kind::kCollapse, corner, after);
    if (!step || !replay.objection(*step).empty()) continue;
    replay.apply(*step, changes);
    steps.push_back(*step);
  }
  return steps;
}

}  // namespace limn::test
