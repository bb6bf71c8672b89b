#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "limn/base/random.h"
#include "limn/hull/shell.h"
#include "limn/hull/step_replay.h"

namespace limn::test {

/// Whether the vertices of an edge and across it are a tetrahedron's, all four of them of three faces.
inline bool is_tetrahedron(const StepReplay& replay, const HullStep& step) {
  std::size_t corners = 0;
  for (FaceId face = 0; face < replay.faces().size(); ++face) {
    if (!replay.is_alive(face)) continue;
    for (const VertexId v : replay.faces()[face])
      corners += v == step.kept || v == step.removed || v == step.left || v == step.right;
  }
  return corners == 12 && replay.corner_running(step.left, step.right) != kInvalidId;
}

/// A cut along the side that starts at a corner, where three edges allow one.
inline std::optional<HullStep> some_cut(StepReplay& replay, std::uint32_t corner) {
  if (!replay.is_alive(corner / 3)) return std::nullopt;
  for (VertexId third = 0; third < replay.positions().size(); ++third) {
    const auto step = replay.cut_at(corner, third);
    if (step && replay.objection(*step).empty()) return step;
  }
  return std::nullopt;
}

/// Steps as those of an inner hull are given.
inline std::vector<HullStep> turned_steps(std::vector<HullStep> steps) {
  for (HullStep& step : steps)
    step = turned_step(step);
  return steps;
}

/// Steps of all kinds that fit the shell one after another, most of them collapses; they move the surface anywhere.
inline std::vector<HullStep> random_steps(const Shell& shell, std::size_t faces_left, std::uint64_t seed,
                                          bool inwards = false) {
  Random random(seed);
  StepReplay replay(shell.positions, inwards ? turned_faces(shell.faces) : shell.faces);
  StepChanges changes;
  std::vector<HullStep> steps;
  for (std::size_t tries = 0; replay.face_count() > faces_left && tries < 60 * shell.faces.size(); ++tries) {
    const auto corner = static_cast<std::uint32_t>(random.below(3 * replay.faces().size()));
    const VertexId v = replay.faces()[corner / 3][corner % 3];
    const Vec3 after = replay.positions()[v] + 0.01f * random.direction();
    const std::uint64_t kind = random.below(32);
    auto step = replay.step_at(HullStep::Kind::kCollapse, corner, after);
    if (kind < 4) step = replay.step_of(HullStep::Kind::kMove, v, after);
    if (kind >= 4 && kind < 8) step = replay.step_at(HullStep::Kind::kFlip, corner, after);
    if (kind == 8) step = some_cut(replay, corner);
    if (step && kind == 9 && replay.face_count() > 4 && is_tetrahedron(replay, *step))
      step = replay.step_of(random.below(2) == 0 ? HullStep::Kind::kFill : HullStep::Kind::kDrop, v, after);
    if (!step || !replay.objection(*step).empty()) continue;
    replay.apply(*step, changes);
    steps.push_back(*step);
  }
  return inwards ? turned_steps(std::move(steps)) : steps;
}

}  // namespace limn::test
