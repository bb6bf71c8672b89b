#include "limn/hull/step_replay.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace limn {
namespace {

std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

bool same_bits(const Vec3& a, const Vec3& b) {
  const auto bits = [](const Vec3& v) {
    return std::array{std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y),
                      std::bit_cast<std::uint32_t>(v.z)};
  };
  return bits(a) == bits(b);
}

/// One run along an edge, seen from its lower end.
struct Run {
  VertexId high;
  std::uint32_t corner;
  bool forward;
};

/// The runs in one piece a lower vertex, each piece sorted by upper vertex. \pre indices in range
void sort_runs(std::size_t vertices, std::span<const Triangle> faces, std::vector<std::uint32_t>& begin,
               std::vector<Run>& runs) {
  begin.assign(vertices + 2, 0);
  for (const Triangle& t : faces) {
    for (std::size_t c = 0; c < 3; ++c)
      ++begin[std::min(t[c], t[(c + 1) % 3]) + 2];
  }
  for (std::size_t v = 2; v < begin.size(); ++v)
    begin[v] += begin[v - 1];
  runs.resize(begin.back());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId a = faces[f][c], b = faces[f][(c + 1) % 3];
      runs[begin[std::min(a, b) + 1]++] = {std::max(a, b), static_cast<std::uint32_t>(3 * f + c), a < b};
    }
  }
  begin.pop_back();
  for (std::size_t v = 0; v < vertices; ++v) {
    std::sort(runs.begin() + begin[v], runs.begin() + begin[v + 1],
              [](const Run& a, const Run& b) { return a.high != b.high ? a.high < b.high : a.corner < b.corner; });
  }
}

/// The corner at the same vertex in the face across each corner's side; empty where the sides do not pair up.
std::vector<std::uint32_t> across_sides(std::size_t vertices, std::span<const Triangle> faces) {
  std::vector<std::uint32_t> begin;
  std::vector<Run> runs;
  sort_runs(vertices, faces, begin, runs);
  std::vector<std::uint32_t> across(3 * faces.size(), kInvalidId);
  for (std::size_t v = 0; v < vertices; ++v) {
    if ((begin[v + 1] - begin[v]) % 2 != 0) return {};
    for (std::uint32_t i = begin[v]; i < begin[v + 1]; i += 2) {
      const Run &a = runs[i], &b = runs[i + 1];
      if (a.high != b.high || a.forward == b.forward) return {};
      if (i + 2 < begin[v + 1] && runs[i + 2].high == a.high) return {};
      across[a.corner] = next_corner(b.corner);
      across[b.corner] = next_corner(a.corner);
    }
  }
  return across;
}

}  // namespace

bool is_closed_manifold(std::size_t vertices, std::span<const Triangle> faces) {
  if (vertices >= kInvalidId || faces.size() >= kInvalidId / 3) return false;
  for (const Triangle& t : faces) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
    if (t[0] >= vertices || t[1] >= vertices || t[2] >= vertices) return false;
  }
  const std::vector<std::uint32_t> across = across_sides(vertices, faces);
  if (across.size() != 3 * faces.size()) return false;
  std::vector<std::uint32_t> corners(vertices, 0);
  std::vector<std::uint32_t> first(vertices, kInvalidId);
  for (std::uint32_t corner = 0; corner < across.size(); ++corner) {
    const VertexId v = faces[corner / 3][corner % 3];
    ++corners[v];
    first[v] = corner;
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    if (corners[v] == 0) return false;
    std::uint32_t corner = first[v], count = 0;
    do {
      corner = across[corner];
      ++count;
    } while (corner != first[v]);
    if (count != corners[v]) return false;
  }
  return true;
}

std::vector<Triangle> turned_faces(std::span<const Triangle> faces) {
  std::vector<Triangle> turned(faces.begin(), faces.end());
  for (Triangle& t : turned)
    std::swap(t[1], t[2]);
  return turned;
}

HullStep turned_step(const HullStep& step) {
  HullStep turned = step;
  if (step.kind != HullStep::Kind::kCollapse && step.kind != HullStep::Kind::kFlip) return turned;
  std::swap(turned.left, turned.right);
  std::swap(turned.face_left, turned.face_right);
  return turned;
}

StepReplay::StepReplay(std::vector<Vec3> positions, std::vector<Triangle> faces)
    : positions_(std::move(positions)),
      faces_(std::move(faces)),
      alive_(faces_.size(), 1),
      live_faces_(faces_.size()),
      first_(positions_.size(), kInvalidId),
      next_(3 * faces_.size()),
      previous_(3 * faces_.size()),
      mark_(positions_.size(), 0) {
  for (std::uint32_t corner = 0; corner < next_.size(); ++corner)
    link(corner, faces_[corner / 3][corner % 3]);
}

std::optional<HullStep> StepReplay::step_at(HullStep::Kind kind, std::uint32_t corner, const Vec3& after) const {
  if (corner / 3 >= faces_.size() || !is_alive(corner / 3)) return std::nullopt;
  HullStep step;
  step.kind = kind;
  step.face_left = corner / 3;
  const Triangle& t = faces_[step.face_left];
  step.kept = t[corner % 3];
  step.removed = t[(corner + 1) % 3];
  step.left = t[(corner + 2) % 3];
  // At some corner of `removed` begins the run back.
  std::uint32_t other = first_[step.removed];
  do {
    const Triangle& beyond = faces_[other / 3];
    if (beyond[(other + 1) % 3] == step.kept) {
      step.face_right = other / 3;
      step.right = beyond[(other + 2) % 3];
    }
    other = next_[other];
  } while (other != first_[step.removed]);
  step.before = positions_[step.kept];
  step.after = kind == HullStep::Kind::kCollapse ? after : step.before;
  return step;
}

std::optional<HullStep> StepReplay::cut_at(std::uint32_t corner, VertexId third) const {
  if (corner / 3 >= faces_.size() || !is_alive(corner / 3)) return std::nullopt;
  HullStep step;
  step.kind = HullStep::Kind::kCut;
  step.kept = faces_[corner / 3][corner % 3];
  step.removed = faces_[corner / 3][(corner + 1) % 3];
  step.left = third;
  step.right = static_cast<VertexId>(positions_.size());
  step.face_left = static_cast<FaceId>(faces_.size());
  step.face_right = step.face_left + 1;
  step.before = step.after = positions_[step.kept];
  return step;
}

std::optional<HullStep> StepReplay::step_of(HullStep::Kind kind, VertexId vertex, const Vec3& after) const {
  if (vertex >= positions_.size() || first_[vertex] == kInvalidId) return std::nullopt;
  HullStep step;
  step.kind = kind;
  step.kept = vertex;
  step.before = positions_[vertex];
  step.after = kind == HullStep::Kind::kDrop ? step.before : after;
  return step;
}

bool StepReplay::runs(FaceId face, VertexId a, VertexId b, VertexId c) const {
  if (face >= faces_.size() || alive_[face] == 0) return false;
  const Triangle& t = faces_[face];
  return t == Triangle{a, b, c} || t == Triangle{b, c, a} || t == Triangle{c, a, b};
}

std::string_view StepReplay::objection(const HullStep& step) {
  if (step.kept >= positions_.size() || first_[step.kept] == kInvalidId) return "its vertex is not there";
  if (!same_bits(step.before, positions_[step.kept])) return "its vertex is somewhere else";
  if (!is_finite(step.after)) return "its vertex would have no place";
  switch (step.kind) {
    case HullStep::Kind::kMove:
      return {};
    case HullStep::Kind::kFill:
    case HullStep::Kind::kDrop:
      return faces_of_part(step.kept) == live_faces_ ? "nothing would be left" : std::string_view{};
    case HullStep::Kind::kCollapse:
    case HullStep::Kind::kFlip:
      return edge_objection(step);
    case HullStep::Kind::kCut:
      return cut_objection(step);
  }
  return "it is of no known kind";
}

std::string_view StepReplay::edge_objection(const HullStep& step) {
  if (step.removed >= positions_.size() || first_[step.removed] == kInvalidId) return "its edge is not there";
  if (!runs(step.face_left, step.kept, step.removed, step.left) ||
      !runs(step.face_right, step.removed, step.kept, step.right) || step.left == step.right)
    return "its faces are not at its edge";
  if (step.kind == HullStep::Kind::kFlip) {
    if (degree(step.kept) < 4 || degree(step.removed) < 4) return "turning its edge would leave a vertex of two faces";
    if (are_joined(step.left, step.right)) return "turning its edge would double another";
    return {};
  }
  if (common_neighbours(step.kept, step.removed) != 2) return "its collapse would double an edge";
  if (degree(step.left) < 4 || degree(step.right) < 4) return "its collapse would flatten a tetrahedron";
  return {};
}

std::uint32_t StepReplay::corner_running(VertexId a, VertexId b) const {
  std::uint32_t corner = first_[a];
  do {
    if (faces_[corner / 3][next_corner(corner) % 3] == b) return corner;
    corner = next_[corner];
  } while (corner != first_[a]);
  return kInvalidId;
}

std::string_view StepReplay::cut_objection(const HullStep& step) const {
  const std::array<VertexId, 3> corners{step.kept, step.removed, step.left};
  for (const VertexId v : corners) {
    if (v >= positions_.size() || first_[v] == kInvalidId) return "its edges are not there";
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexId a = corners[i], b = corners[(i + 1) % 3], c = corners[(i + 2) % 3];
    if (a == b) return "its edges are not there";
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
      const std::uint32_t corner = corner_running(from, to);
      if (corner == kInvalidId) return "its edges are not there";
      if (faces_[corner / 3][(corner + 2) % 3] == c) return "it would cut off a single face";
    }
  }
  constexpr std::size_t kMostFaces = kInvalidId / 3 - 2;
  if (step.right != positions_.size() || step.face_left != faces_.size() || step.face_right != step.face_left + 1 ||
      faces_.size() > kMostFaces)
    return "its new vertices or faces do not continue the others";
  return {};
}

std::size_t StepReplay::common_neighbours(VertexId a, VertexId b) {
  ++marks_;
  std::uint32_t corner = first_[a];
  do {
    mark_[faces_[corner / 3][(corner + 1) % 3]] = marks_;
    corner = next_[corner];
  } while (corner != first_[a]);
  std::size_t count = 0;
  corner = first_[b];
  do {
    count += mark_[faces_[corner / 3][(corner + 1) % 3]] == marks_;
    corner = next_[corner];
  } while (corner != first_[b]);
  return count;
}

std::size_t StepReplay::degree(VertexId v) const {
  std::size_t count = 0;
  std::uint32_t corner = first_[v];
  do {
    ++count;
    corner = next_[corner];
  } while (corner != first_[v]);
  return count;
}

bool StepReplay::are_joined(VertexId a, VertexId b) const {
  return corner_running(a, b) != kInvalidId;
}

void StepReplay::link(std::uint32_t corner, VertexId v) {
  std::uint32_t& first = first_[v];
  if (first == kInvalidId) {
    first = next_[corner] = previous_[corner] = corner;
    return;
  }
  next_[corner] = first;
  previous_[corner] = previous_[first];
  next_[previous_[first]] = corner;
  previous_[first] = corner;
}

void StepReplay::unlink(std::uint32_t corner, VertexId v) {
  next_[previous_[corner]] = next_[corner];
  previous_[next_[corner]] = previous_[corner];
  if (first_[v] == corner) first_[v] = next_[corner] == corner ? kInvalidId : next_[corner];
}

void StepReplay::give(std::uint32_t corner, VertexId to, StepChanges& changes) {
  VertexId& vertex = faces_[corner / 3][corner % 3];
  if (vertex == to) return;
  changes.corners.push_back({corner, vertex, to});
  unlink(corner, vertex);
  vertex = to;
  link(corner, to);
}

void StepReplay::kill(FaceId face, StepChanges& changes) {
  for (std::uint32_t c = 0; c < 3; ++c)
    unlink(3 * face + c, faces_[face][c]);
  alive_[face] = 0;
  --live_faces_;
  changes.killed.push_back(face);
}

void StepReplay::apply(const HullStep& step, StepChanges& changes) {
  switch (step.kind) {
    case HullStep::Kind::kMove:
      positions_[step.kept] = step.after;
      break;
    case HullStep::Kind::kFlip:
      flip(step, changes);
      break;
    case HullStep::Kind::kCollapse:
      collapse(step, changes);
      break;
    case HullStep::Kind::kCut:
      cut(step, changes);
      break;
    case HullStep::Kind::kFill:
    case HullStep::Kind::kDrop:
      remove_part(step.kept, changes);
      break;
  }
}

void StepReplay::flip(const HullStep& step, StepChanges& changes) {
  const Triangle left{step.kept, step.right, step.left}, right{step.removed, step.left, step.right};
  for (std::uint32_t c = 0; c < 3; ++c) {
    give(3 * step.face_left + c, left[c], changes);
    give(3 * step.face_right + c, right[c], changes);
  }
}

void StepReplay::collapse(const HullStep& step, StepChanges& changes) {
  kill(step.face_left, changes);
  kill(step.face_right, changes);
  while (first_[step.removed] != kInvalidId)
    give(first_[step.removed], step.kept, changes);
  positions_[step.kept] = step.after;
}

/// At each corner of the cut, the faces from the way out, counter-clockwise to the way in, go to the corner's copy.
void StepReplay::cut(const HullStep& step, StepChanges& changes) {
  const std::array<VertexId, 3> old{step.kept, step.removed, step.left};
  std::vector<std::uint32_t> right_of_it[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexId v = old[i];
    for (VertexId next = old[(i + 2) % 3]; next != old[(i + 1) % 3];) {
      const std::uint32_t corner = corner_running(v, next);
      right_of_it[i].push_back(corner);
      next = faces_[corner / 3][(corner + 2) % 3];
    }
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    const VertexId copy = step.right + i;
    positions_.push_back(positions_[old[i]]);
    first_.push_back(kInvalidId);
    mark_.push_back(0);
    for (const std::uint32_t corner : right_of_it[i])
      give(corner, copy, changes);
  }
  faces_.push_back({step.kept, step.left, step.removed});
  faces_.push_back({step.right, step.right + 1, step.right + 2});
  for (const FaceId face : {step.face_left, step.face_right}) {
    alive_.push_back(1);
    ++live_faces_;
    for (std::uint32_t c = 0; c < 3; ++c) {
      next_.push_back(0);
      previous_.push_back(0);
      link(3 * face + c, faces_[face][c]);
    }
  }
}

/// Everything that hangs together with the vertex.
void StepReplay::remove_part(VertexId vertex, StepChanges& changes) {
  std::vector<VertexId>& part = changes.vanished;
  const std::size_t begin = part.size();
  ++marks_;
  const auto meet = [&](VertexId v) {
    if (mark_[v] == marks_) return;
    mark_[v] = marks_;
    part.push_back(v);
  };
  meet(vertex);
  for (std::size_t i = begin; i < part.size(); ++i) {
    while (first_[part[i]] != kInvalidId) {
      const FaceId face = first_[part[i]] / 3;
      for (const VertexId v : faces_[face])
        meet(v);
      kill(face, changes);
    }
  }
}

/// How many faces hang together with the vertex.
std::size_t StepReplay::faces_of_part(VertexId vertex) {
  std::vector<VertexId> part{vertex};
  std::size_t corners = 0;
  mark_[vertex] = ++marks_;
  for (std::size_t i = 0; i < part.size(); ++i) {
    std::uint32_t corner = first_[part[i]];
    do {
      ++corners;
      const VertexId next = faces_[corner / 3][(corner + 1) % 3];
      if (mark_[next] != marks_) {
        mark_[next] = marks_;
        part.push_back(next);
      }
      corner = next_[corner];
    } while (corner != first_[part[i]]);
  }
  return corners / 3;
}

}  // namespace limn
