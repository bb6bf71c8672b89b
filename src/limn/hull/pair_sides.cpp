#include "limn/hull/pair_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "limn/base/orient3d.h"

namespace limn {
namespace {

/// The side of the face that lies on the edge.
SideId side_at(const Topology& topology, FaceId face, EdgeId edge) {
  const std::array<EdgeId, 3>& edges = topology.face_edges[face];
  const SideId c = edges[0] == edge ? 0 : edges[1] == edge ? 1 : 2;
  return 3 * face + c;
}

bool runs_forward(const Topology& topology, SideId side) {
  return topology.runs_forward(side / 3, static_cast<int>(side % 3));
}

/// The corner across from a side.
VertexId across(const Topology& topology, SideId side) {
  return topology.faces[side / 3][(side + 2 - side / 3 * 3) % 3];
}

/// How many sides run along the edge, less those that run back.
int excess_at(const Topology& topology, const SidePairs& pairs, EdgeId edge) {
  int excess = 0;
  for (const FaceId face : topology.edge_faces(edge)) {
    if (pairs.alive[face] == 0) continue;
    excess += runs_forward(topology, side_at(topology, face, edge)) ? 1 : -1;
  }
  return excess;
}

/// Calls visit(edge, faces) with every set of two faces or more that have the same three vertices, once: at the lowest
/// of their edges.
template <class Visit>
void for_each_stack(const Topology& topology, Visit visit) {
  std::vector<std::pair<VertexId, FaceId>> fan;
  std::vector<FaceId> stack;
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    const std::span<const FaceId> faces = topology.edge_faces(edge);
    if (faces.size() < 2) continue;
    fan.clear();
    for (const FaceId face : faces) {
      const std::array<EdgeId, 3>& edges = topology.face_edges[face];
      if (std::min({edges[0], edges[1], edges[2]}) == edge)
        fan.emplace_back(across(topology, side_at(topology, face, edge)), face);
    }
    if (fan.size() < 2) continue;
    std::sort(fan.begin(), fan.end());
    for (std::size_t i = 0; i < fan.size();) {
      stack.clear();
      const VertexId tip = fan[i].first;
      for (; i < fan.size() && fan[i].first == tip; ++i)
        stack.push_back(fan[i].second);
      if (stack.size() > 1) visit(edge, std::span<const FaceId>(stack));
    }
  }
}

/// Faces of a stack that are turned over take each other out, from the highest down.
std::size_t cancel_stack(const Topology& topology, EdgeId edge, std::span<const FaceId> stack, SidePairs& pairs) {
  std::array<std::vector<FaceId>, 2> by_sense;
  for (const FaceId face : stack)
    by_sense[runs_forward(topology, side_at(topology, face, edge)) ? 1 : 0].push_back(face);
  const std::size_t count = std::min(by_sense[0].size(), by_sense[1].size());
  for (std::vector<FaceId>& faces : by_sense) {
    for (std::size_t i = faces.size() - count; i < faces.size(); ++i)
      pairs.alive[faces[i]] = 0;
  }
  return 2 * count;
}

/// A surface that is there twice all over is left as it is: its winding number is 2. Single copies would leave sides
/// without a partner.
std::size_t drop_copies(const Topology& topology, std::span<const FaceId> stack, SidePairs& pairs) {
  std::vector<FaceId> left;
  for (const FaceId face : stack) {
    if (pairs.alive[face] != 0) left.push_back(face);
  }
  if (left.size() < 2) return 0;
  const std::array<EdgeId, 3>& edges = topology.face_edges[left[0]];
  const bool fits =
      std::all_of(edges.begin(), edges.end(), [&](EdgeId edge) { return excess_at(topology, pairs, edge) == 0; });
  if (fits) return 0;
  for (std::size_t i = 1; i < left.size(); ++i)
    pairs.alive[left[i]] = 0;
  return left.size() - 1;
}

std::string counted_faces(std::size_t count) {
  return count == 1 ? "1 face" : fmt::format("{} faces", count);
}

void take_out(const Topology& topology, SidePairs& pairs) {
  for (const FaceId face : topology.degenerate_faces)
    pairs.alive[face] = 0;
  if (!topology.degenerate_faces.empty()) {
    pairs.notes.push_back("took out " + counted_faces(topology.degenerate_faces.size()) +
                          " of which two corners are one point");
  }
  std::size_t cancelled = 0, copies = 0;
  for_each_stack(topology, [&](EdgeId edge, std::span<const FaceId> stack) {
    cancelled += cancel_stack(topology, edge, stack, pairs);
  });
  for_each_stack(topology,
                 [&](EdgeId, std::span<const FaceId> stack) { copies += drop_copies(topology, stack, pairs); });
  if (cancelled > 0) {
    pairs.notes.push_back(
        fmt::format("took out {} that lie back to back on another with the same corners", counted_faces(cancelled)));
  }
  if (copies > 0) pairs.notes.push_back("took out " + counted_faces(copies) + " that repeat another one");
}

/// A side at an edge where more than two meet.
struct Spoke {
  Vec3 tip;  ///< the corner across from it
  SideId side;
  bool forward;
  int quarter = 0;  ///< 0 along the first spoke, 1 less than half a turn on, 2 across from it, 3 more
};

/// Across the line from low to high; its length is that of the part across.
DVec3 part_across(const DVec3& low, const DVec3& axis, const Vec3& tip) {
  const DVec3 arm = DVec3(tip) - low;
  return arm - axis * glm::dot(arm, axis);
}

/// The sides at the edge in the order of their angles about it, from its lower to its upper vertex. The order is exact:
/// orientation tests tell which of two comes first.
std::vector<Spoke> spokes_at(const Mesh& mesh, const Topology& topology, const SidePairs& pairs, EdgeId edge) {
  const Vec3 low = mesh.positions[topology.edges[edge].v[0]], high = mesh.positions[topology.edges[edge].v[1]];
  const DVec3 axis = glm::normalize(DVec3(high) - DVec3(low));
  std::vector<Spoke> spokes;
  DVec3 along(0.0);  // of the spoke that stands out farthest: one that does not lie on the edge's own line
  Vec3 first = low;
  for (const FaceId face : topology.edge_faces(edge)) {
    if (pairs.alive[face] == 0) continue;
    const SideId side = side_at(topology, face, edge);
    spokes.push_back({mesh.positions[across(topology, side)], side, runs_forward(topology, side)});
    const DVec3 part = part_across(DVec3(low), axis, spokes.back().tip);
    if (glm::dot(part, part) <= glm::dot(along, along)) continue;
    along = part;
    first = spokes.back().tip;
  }
  for (Spoke& spoke : spokes) {
    const int turned = orient3d(low, high, first, spoke.tip);
    const bool back = turned == 0 && glm::dot(part_across(DVec3(low), axis, spoke.tip), along) < 0;
    spoke.quarter = turned > 0 ? 1 : turned < 0 ? 3 : back ? 2 : 0;
  }
  std::sort(spokes.begin(), spokes.end(), [&](const Spoke& a, const Spoke& b) {
    if (a.quarter != b.quarter) return a.quarter < b.quarter;
    const int turned = a.quarter % 2 == 0 ? 0 : orient3d(low, high, a.tip, b.tip);
    return turned != 0 ? turned > 0 : a.side < b.side;
  });
  return spokes;
}

/// Growing angles enter the inside at a face that runs back along the edge and leave it at one that runs forward: two
/// kinds of bracket around a circle. What finds no partner stays on the boundary.
void pair_spokes(std::span<const Spoke> spokes, SidePairs& pairs) {
  std::vector<SideId> entered, left_early;
  const auto join = [&](SideId a, SideId b) {
    pairs.twin[a] = b;
    pairs.twin[b] = a;
  };
  for (const Spoke& spoke : spokes) {
    if (!spoke.forward) {
      entered.push_back(spoke.side);
    } else if (entered.empty()) {
      left_early.push_back(spoke.side);
    } else {
      join(entered.back(), spoke.side);
      entered.pop_back();
    }
  }
  // The circle goes on: what was entered last meets what was left first.
  for (std::size_t i = 0; i < left_early.size() && !entered.empty(); ++i) {
    join(entered.back(), left_early[i]);
    entered.pop_back();
  }
}

/// \param edge  the first such edge
tl::unexpected<Error> no_partner(const Topology& topology, const SidePairs& pairs, EdgeId edge) {
  std::size_t edges = 0;
  for (EdgeId other = edge; other < topology.edge_count(); ++other)
    edges += std::abs(excess_at(topology, pairs, other)) > 1;
  std::string faces;
  std::size_t count = 0;
  for (const FaceId face : topology.edge_faces(edge)) {
    if (pairs.alive[face] == 0) continue;
    if (++count <= 4) faces += fmt::format("{}{}", faces.empty() ? "" : ", ", face);
  }
  const Edge& ends = topology.edges[edge];
  return fail_at(ErrorCode::kUnsuitable, {},
                 fmt::format("edge {}-{} (faces {}{})", ends.v[0], ends.v[1], faces, count > 4 ? ", …" : ""),
                 fmt::format("its faces do not pair up: two or more are left over that run along it the same way, so "
                             "that no inside is defined there ({} like it)",
                             edges == 1 ? "no other edge" : fmt::format("{} more", edges - 1)),
                 "turn faces so that neighbours agree (--repair does where that is possible)");
}

}  // namespace

Result<SidePairs> pair_sides(const Mesh& mesh, const Topology& topology) {
  SidePairs pairs;
  pairs.alive.assign(topology.face_count(), 1);
  pairs.twin.assign(3 * topology.face_count(), kInvalidId);
  take_out(topology, pairs);
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    const EdgeClass kind = topology.edge_class[edge];
    if (kind == EdgeClass::kBoundary) continue;
    const std::span<const FaceId> faces = topology.edge_faces(edge);
    if (kind == EdgeClass::kManifold) {
      if (pairs.alive[faces[0]] == 0 || pairs.alive[faces[1]] == 0) continue;
      const SideId a = side_at(topology, faces[0], edge), b = side_at(topology, faces[1], edge);
      pairs.twin[a] = b;
      pairs.twin[b] = a;
      continue;
    }
    const int excess = excess_at(topology, pairs, edge);
    if (std::abs(excess) > 1) return no_partner(topology, pairs, edge);
    pair_spokes(spokes_at(mesh, topology, pairs, edge), pairs);
  }
  return pairs;
}

}  // namespace limn
