#include "limn/hull/sequence.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <numeric>

#include "limn/hull/shell_uvs.h"
#include "limn/hull/step_replay.h"
#include "limn/mesh/normals.h"

namespace limn {
namespace {

/// Steps never make faces: the first place with no more than so many.
std::size_t steps_to(std::span<const std::uint32_t> faces_after, std::size_t faces) {
  const auto found =
      std::partition_point(faces_after.begin(), faces_after.end(), [&](std::uint32_t count) { return count > faces; });
  return std::min(static_cast<std::size_t>(found - faces_after.begin()), faces_after.size() - 1);
}

/// Where a corner of a turned face is on the face itself.
std::uint32_t turned_corner(std::uint32_t corner) {
  return corner % 3 == 1 ? corner + 1 : corner % 3 == 2 ? corner - 1 : corner;
}

bool all_finite(std::span<const Vec2> uvs) {
  return std::all_of(uvs.begin(), uvs.end(), [](const Vec2& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); });
}

}  // namespace

/// Fills a way's tables by going it. Gives the first step that cannot be taken, as an error.
Result<void> HullSequence::go(const Shell& shell, bool inwards, Way& way) {
  StepReplay replay(shell.positions, inwards ? turned_faces(shell.faces) : shell.faces);
  StepChanges changes;
  // Hulls take less than a tenth of this. Steps made to turn one fan of n faces n times would take n² corners.
  const std::size_t most_corners =
      std::min<std::size_t>(0xffffffffu, 64 * (3 * shell.faces.size() + 16 * way.steps.size()));
  way.faces = way.fewest = {static_cast<std::uint32_t>(replay.face_count())};
  way.corner_offsets = way.killed_offsets = way.vanished_offsets = {0};
  for (std::size_t i = 0; i < way.steps.size(); ++i) {
    const HullStep step = inwards ? turned_step(way.steps[i]) : way.steps[i];
    const std::string_view objection = replay.objection(step);
    if (!objection.empty()) {
      return fail_at(ErrorCode::kInvalidArgument, {}, fmt::format("{} step {}", inwards ? "inner" : "outer", i),
                     std::string(objection), "give the steps of this shell, in their order");
    }
    changes.clear();
    replay.apply(step, changes);
    for (const limn::CornerChange& change : changes.corners)
      way.corners.push_back({inwards ? turned_corner(change.corner) : change.corner, change.from, change.to});
    if (way.corners.size() > most_corners) {
      return fail_at(ErrorCode::kInvalidArgument, {}, fmt::format("{} step {}", inwards ? "inner" : "outer", i),
                     "the steps move more corners than steps towards a hull do", "give the steps that a hull took");
    }
    way.killed.insert(way.killed.end(), changes.killed.begin(), changes.killed.end());
    way.vanished.insert(way.vanished.end(), changes.vanished.begin(), changes.vanished.end());
    way.corner_offsets.push_back(static_cast<std::uint32_t>(way.corners.size()));
    way.killed_offsets.push_back(static_cast<std::uint32_t>(way.killed.size()));
    way.vanished_offsets.push_back(static_cast<std::uint32_t>(way.vanished.size()));
    way.faces.push_back(static_cast<std::uint32_t>(replay.face_count()));
    // Parts may be dropped together, and are proved together: what lies between is no hull.
    const bool between = step.kind == HullStep::Kind::kDrop && i + 1 < way.steps.size() &&
                         way.steps[i + 1].kind == HullStep::Kind::kDrop;
    way.fewest.push_back(between ? way.fewest.back() : std::min(way.fewest.back(), way.faces.back()));
    way.cuts += step.kind == HullStep::Kind::kCut;
  }
  return {};
}

Result<HullSequence> HullSequence::make(Shell shell, std::vector<HullStep> outer, std::vector<HullStep> inner,
                                        std::vector<Vec2> uvs) {
  constexpr std::size_t kMostSteps = std::numeric_limits<int>::max();
  HullSequence sequence;
  sequence.shell_ = std::move(shell);
  sequence.outer_.steps = std::move(outer);
  sequence.inner_.steps = std::move(inner);
  sequence.uvs_ = std::move(uvs);
  const std::vector<Vec3>& positions = sequence.shell_.positions;
  if (!is_closed_manifold(positions.size(), sequence.shell_.faces) ||
      !std::all_of(positions.begin(), positions.end(), is_finite)) {
    return fail(ErrorCode::kInvalidArgument, "the shell of a sequence is no closed manifold",
                "make it with make_shell()");
  }
  if ((!sequence.uvs_.empty() && sequence.uvs_.size() != positions.size()) || !all_finite(sequence.uvs_))
    return fail(ErrorCode::kInvalidArgument, "a sequence needs one finite uv a vertex of its shell, or none");
  if (sequence.outer_.steps.size() > kMostSteps || sequence.inner_.steps.size() > kMostSteps)
    return fail(ErrorCode::kInvalidArgument, "too many steps for a sequence");
  return go(sequence.shell_, false, sequence.outer_)
      .and_then([&] { return go(sequence.shell_, true, sequence.inner_); })
      .map([&] { return std::move(sequence); });
}

std::size_t HullSequence::faces_at(int level) const {
  assert(innermost() <= level && level <= outermost());
  return (level < 0 ? inner_ : outer_).faces[static_cast<std::size_t>(std::abs(level))];
}

int HullSequence::outer_level(std::size_t faces) const {
  return static_cast<int>(steps_to(outer_.fewest, faces));
}

int HullSequence::inner_level(std::size_t faces) const {
  return -static_cast<int>(steps_to(inner_.fewest, faces));
}

Mesh HullSequence::mesh_at(int level, std::vector<VertexId>* vertex_ids, std::vector<FaceId>* face_ids) const {
  HullCursor cursor(*this);
  cursor.go_to(level);
  std::vector<VertexId> number(cursor.positions().size(), kInvalidId);
  std::vector<FaceId> live;
  for (FaceId face = 0; face < cursor.faces().size(); ++face) {
    if (!cursor.is_alive(face)) continue;
    live.push_back(face);
    for (const VertexId v : cursor.faces()[face])
      number[v] = 0;
  }
  Mesh mesh;
  std::vector<Vec2> uvs = uvs_;
  if (!uvs.empty()) {
    const std::span<const HullStep> steps = level < 0 ? inner_.steps : outer_.steps;
    carry_uvs(steps.first(static_cast<std::size_t>(std::abs(level))), shell_.positions, uvs);
  }
  std::vector<VertexId> ids;
  for (VertexId v = 0; v < number.size(); ++v) {
    if (number[v] == kInvalidId) continue;
    number[v] = static_cast<VertexId>(ids.size());
    ids.push_back(v);
    mesh.positions.push_back(cursor.positions()[v]);
    if (!uvs.empty()) mesh.uvs.values.push_back(uvs[v]);
  }
  for (const FaceId face : live) {
    const Triangle& t = cursor.faces()[face];
    mesh.faces.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  mesh.normals = crease_normals(mesh, build_topology(mesh), static_cast<float>(std::numbers::pi));
  if (vertex_ids != nullptr) *vertex_ids = std::move(ids);
  if (face_ids != nullptr) *face_ids = std::move(live);
  return mesh;
}

std::vector<VertexId> HullSequence::heirs_at(int level) const {
  assert(innermost() <= level && level <= outermost());
  const Way& way = level < 0 ? inner_ : outer_;
  std::vector<VertexId> heirs(shell_.positions.size() + 3 * way.cuts);
  std::iota(heirs.begin(), heirs.end(), 0u);
  // Backwards, so that an heir's own heir is known when it is asked for.
  for (std::size_t i = static_cast<std::size_t>(std::abs(level)); i-- > 0;) {
    const HullStep& step = way.steps[i];
    if (step.kind == HullStep::Kind::kCollapse) heirs[step.removed] = heirs[step.kept];
    for (std::uint32_t n = way.vanished_offsets[i]; n < way.vanished_offsets[i + 1]; ++n)
      heirs[way.vanished[n]] = kInvalidId;
  }
  heirs.resize(shell_.positions.size());
  return heirs;
}

HullCursor::HullCursor(const HullSequence& sequence)
    : sequence_(&sequence),
      live_faces_(sequence.shell_.faces.size()),
      positions_(sequence.shell_.positions),
      faces_(sequence.shell_.faces),
      alive_(sequence.shell_.faces.size(), 1) {
  const std::size_t cuts = std::max(sequence.outer_.cuts, sequence.inner_.cuts);
  positions_.resize(positions_.size() + 3 * cuts, Vec3(0));
  faces_.resize(faces_.size() + 2 * cuts, Triangle{});
  alive_.resize(faces_.size(), 0);
}

bool HullCursor::step_outwards() {
  if (level_ >= sequence_->outermost()) return false;
  if (level_ < 0) {
    take_back(sequence_->inner_, static_cast<std::size_t>(-level_ - 1));
  } else {
    take(sequence_->outer_, false, static_cast<std::size_t>(level_));
  }
  ++level_;
  return true;
}

bool HullCursor::step_inwards() {
  if (level_ <= sequence_->innermost()) return false;
  if (level_ > 0) {
    take_back(sequence_->outer_, static_cast<std::size_t>(level_ - 1));
  } else {
    take(sequence_->inner_, true, static_cast<std::size_t>(-level_));
  }
  --level_;
  return true;
}

void HullCursor::go_to(int level) {
  assert(sequence_->innermost() <= level && level <= sequence_->outermost());
  while (level_ < level)
    step_outwards();
  while (level_ > level)
    step_inwards();
}

void HullCursor::set_alive(FaceId face, bool alive) {
  alive_[face] = alive ? 1 : 0;
  live_faces_ = alive ? live_faces_ + 1 : live_faces_ - 1;
}

void HullCursor::take(const HullSequence::Way& way, bool inwards, std::size_t number) {
  const HullStep& step = way.steps[number];
  for (std::uint32_t i = way.corner_offsets[number]; i < way.corner_offsets[number + 1]; ++i)
    faces_[way.corners[i].corner / 3][way.corners[i].corner % 3] = way.corners[i].to;
  for (std::uint32_t i = way.killed_offsets[number]; i < way.killed_offsets[number + 1]; ++i)
    set_alive(way.killed[i], false);
  if (step.kind == HullStep::Kind::kCollapse || step.kind == HullStep::Kind::kMove) positions_[step.kept] = step.after;
  if (step.kind != HullStep::Kind::kCut) return;
  positions_[step.right] = positions_[step.kept];
  positions_[step.right + 1] = positions_[step.removed];
  positions_[step.right + 2] = positions_[step.left];
  faces_[step.face_left] = {step.kept, step.left, step.removed};
  faces_[step.face_right] = {step.right, step.right + 1, step.right + 2};
  if (inwards) {
    std::swap(faces_[step.face_left][1], faces_[step.face_left][2]);
    std::swap(faces_[step.face_right][1], faces_[step.face_right][2]);
  }
  set_alive(step.face_left, true);
  set_alive(step.face_right, true);
}

void HullCursor::take_back(const HullSequence::Way& way, std::size_t number) {
  const HullStep& step = way.steps[number];
  if (step.kind == HullStep::Kind::kCut) {
    set_alive(step.face_left, false);
    set_alive(step.face_right, false);
  }
  for (std::uint32_t i = way.corner_offsets[number + 1]; i-- > way.corner_offsets[number];)
    faces_[way.corners[i].corner / 3][way.corners[i].corner % 3] = way.corners[i].from;
  for (std::uint32_t i = way.killed_offsets[number]; i < way.killed_offsets[number + 1]; ++i)
    set_alive(way.killed[i], true);
  if (step.kind == HullStep::Kind::kCollapse || step.kind == HullStep::Kind::kMove) positions_[step.kept] = step.before;
}

}  // namespace limn
