#include "limn/hull/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "limn/hull/fill_loop.h"
#include "limn/hull/pair_sides.h"
#include "limn/mesh/topology.h"

namespace limn {
namespace {

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// A face whose three sides all found no partner would only be closed by its own back.
std::size_t drop_lone_faces(SidePairs& pairs) {
  std::size_t count = 0;
  for (FaceId face = 0; face < pairs.alive.size(); ++face) {
    const SideId side = 3 * face;
    if (pairs.alive[face] == 0) continue;
    if (pairs.twin[side] != kInvalidId || pairs.twin[side + 1] != kInvalidId || pairs.twin[side + 2] != kInvalidId)
      continue;
    pairs.alive[face] = 0;
    ++count;
  }
  return count;
}

/// The shell while it is made. Its vertices are fans of the mesh's corners.
class ShellMaker {
 public:
  ShellMaker(const Mesh& mesh, const Topology& topology, SidePairs pairs)
      : mesh_(mesh), topology_(topology), pairs_(std::move(pairs)) {}

  Shell make() {
    shell_.notes = std::move(pairs_.notes);
    if (const std::size_t lone = drop_lone_faces(pairs_); lone > 0) {
      shell_.notes.push_back("took out " + counted(lone, "face that hangs", "faces that hang") + " on no other");
    }
    find_fans();
    number_vertices();
    copy_faces();
    close_boundaries();
    part_double_edges();
    return std::move(shell_);
  }

 private:
  bool is_boundary(SideId side) const { return pairs_.twin[side] == kInvalidId; }
  VertexId start_of(SideId side) const { return vertex_[side]; }
  VertexId end_of(SideId side) const { return vertex_[next_side(side)]; }

  /// Corners that are reached from one another across paired sides get one number, ascending with their lowest side.
  void find_fans() {
    vertex_.assign(3 * pairs_.alive.size(), kInvalidId);
    for (SideId first = 0; first < vertex_.size(); ++first) {
      if (pairs_.alive[first / 3] == 0 || vertex_[first] != kInvalidId) continue;
      SideId side = first;
      do {
        vertex_[side] = fans_;
        side = is_boundary(side) ? kInvalidId : next_side(pairs_.twin[side]);
      } while (side != kInvalidId && side != first);
      if (side == kInvalidId) {  // an open fan: the other way round as well
        for (side = previous_side(first); !is_boundary(side); side = previous_side(side)) {
          side = pairs_.twin[side];
          vertex_[side] = fans_;
        }
      }
      fan_source_.push_back(topology_.faces[first / 3][first % 3]);
      ++fans_;
    }
  }

  /// Vertices in the order of the mesh's positions, so that what lies together stays together.
  void number_vertices() {
    std::vector<VertexId> begin(mesh_.positions.size() + 1, 0);
    for (const VertexId source : fan_source_)
      ++begin[source + 1];
    std::size_t several = 0;
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      several += begin[v + 1] > 1;
      begin[v + 1] += begin[v];
    }
    if (several > 0) {
      shell_.notes.push_back("parted " + counted(several, "vertex where sheets of the surface touch",
                                                 "vertices where sheets of the surface touch"));
    }
    std::vector<VertexId> number(fans_);
    shell_.positions.resize(fans_);
    shell_.source_vertex.resize(fans_);
    for (std::uint32_t fan = 0; fan < fans_; ++fan) {
      number[fan] = begin[fan_source_[fan]]++;
      shell_.positions[number[fan]] = mesh_.positions[fan_source_[fan]];
      shell_.source_vertex[number[fan]] = fan_source_[fan];
    }
    for (VertexId& v : vertex_) {
      if (v != kInvalidId) v = number[v];
    }
  }

  void copy_faces() {
    for (FaceId face = 0; face < pairs_.alive.size(); ++face) {
      if (pairs_.alive[face] == 0) continue;
      shell_.faces.push_back({vertex_[3 * face], vertex_[3 * face + 1], vertex_[3 * face + 2]});
      shell_.source_face.push_back(face);
    }
  }

  /// Every fan has at most one side that leaves it on the boundary: loops are simple, and meet nowhere.
  void close_boundaries() {
    std::vector<SideId> leaving(shell_.positions.size(), kInvalidId);
    for (SideId side = 0; side < vertex_.size(); ++side) {
      if (pairs_.alive[side / 3] != 0 && is_boundary(side)) leaving[start_of(side)] = side;
    }
    std::size_t loops = 0, sides = 0;
    const std::size_t before = shell_.faces.size();
    for (SideId first = 0; first < vertex_.size(); ++first) {
      if (pairs_.alive[first / 3] == 0 || !is_boundary(first) || leaving[start_of(first)] != first) continue;
      std::vector<SideId> loop;
      for (SideId side = first; side != kInvalidId; side = leaving[end_of(side)]) {
        loop.push_back(side);
        leaving[start_of(side)] = kInvalidId;
      }
      ++loops;
      sides += loop.size();
      close(loop);
    }
    if (loops == 0) return;
    shell_.notes.push_back(fmt::format("closed {} of {} with {}", counted(loops, "boundary", "boundaries"),
                                       counted(sides, "edge", "edges"),
                                       counted(shell_.faces.size() - before, "face", "faces")));
  }

  void close(const std::vector<SideId>& loop) {
    // Against the boundary's sense, as its other side.
    std::vector<VertexId> ring;
    std::vector<Vec3> corners;
    for (std::size_t i = loop.size(); i-- > 0;) {
      ring.push_back(end_of(loop[i]));
      corners.push_back(shell_.positions[ring.back()]);
    }
    const LoopFilling filling = fill_loop(corners, joined_already(loop, ring));
    if (filling.has_middle) {
      ring.push_back(static_cast<VertexId>(shell_.positions.size()));
      shell_.positions.push_back(filling.middle);
      shell_.source_vertex.push_back(kInvalidId);
    }
    for (const auto& [a, b, c] : filling.triangles) {
      shell_.faces.push_back({ring[a], ring[b], ring[c]});
      shell_.source_face.push_back(kInvalidId);
    }
  }

  /// Pairs of the ring's corners that an edge of the mesh joins, but for those the loop itself runs along.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_already(const std::vector<SideId>& loop,
                                                                      const std::vector<VertexId>& ring) {
    std::unordered_map<VertexId, std::uint32_t> place;
    for (std::uint32_t i = 0; i < ring.size(); ++i)
      place.emplace(ring[i], i);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> joined;
    const auto count = static_cast<std::uint32_t>(ring.size());
    for (const SideId first : loop) {
      const std::uint32_t here = place.at(start_of(first));
      // Round the fan, from the side that leaves it on the boundary to the one that enters there.
      for (SideId side = previous_side(first); !is_boundary(side); side = previous_side(pairs_.twin[side])) {
        const auto there = place.find(start_of(side));
        if (there == place.end()) continue;
        const auto [low, high] = std::minmax(here, there->second);
        if (high - low == 1 || high - low == count - 1) continue;
        joined.emplace_back(low, high);
      }
    }
    std::sort(joined.begin(), joined.end());
    joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
    return joined;
  }

  void part_double_edges();
  void split_faces(const std::unordered_map<std::uint64_t, VertexId>& middles);

  const Mesh& mesh_;
  const Topology& topology_;
  SidePairs pairs_;
  Shell shell_;
  std::vector<VertexId> vertex_;  ///< one a side of the mesh: the fan its corner belongs to, later the shell's vertex
  std::vector<VertexId> fan_source_;
  std::uint32_t fans_ = 0;
};

std::uint64_t key_of(VertexId a, VertexId b) {
  return (std::uint64_t{a} << 32) | b;
}

/// The middle where float can hold it exactly; else one of the ends: no point off the edge, so that no face moves.
Vec3 point_on(const Vec3& a, const Vec3& b) {
  const DVec3 middle = (DVec3(a) + DVec3(b)) * 0.5;
  const Vec3 rounded(middle);
  return DVec3(rounded) == middle ? rounded : a;
}

/// Two sheets may touch along an edge and hang together at both of its ends: they share the edge's two vertices then,
/// and four faces meet at it. All pairs of sides but the first get a vertex of their own in the middle.
void ShellMaker::part_double_edges() {
  // Shell faces are in the order of the mesh's: where each went, for the few that matter.
  std::unordered_map<std::uint64_t, std::vector<SideId>> by_ends;
  for (const EdgeId edge : topology_.non_manifold_edges) {
    for (const FaceId face : topology_.edge_faces(edge)) {
      if (pairs_.alive[face] == 0) continue;
      for (SideId side = 3 * face; side < 3 * face + 3; ++side) {
        if (topology_.face_edges[face][side % 3] != edge) continue;
        const SideId twin = pairs_.twin[side];
        if (twin != kInvalidId && twin < side) continue;  // one side of each pair
        by_ends[key_of(std::min(start_of(side), end_of(side)), std::max(start_of(side), end_of(side)))].push_back(side);
      }
    }
  }
  std::unordered_map<std::uint64_t, VertexId> middles;  // of mesh sides: face and side
  std::size_t parted = 0;
  for (const EdgeId edge : topology_.non_manifold_edges) {
    for (const FaceId face : topology_.edge_faces(edge)) {
      if (pairs_.alive[face] == 0) continue;
      for (SideId side = 3 * face; side < 3 * face + 3; ++side) {
        if (topology_.face_edges[face][side % 3] != edge || pairs_.twin[side] == kInvalidId) continue;
        const auto& sharing =
            by_ends.at(key_of(std::min(start_of(side), end_of(side)), std::max(start_of(side), end_of(side))));
        const SideId twin = pairs_.twin[side];
        // A boundary's side, which its filling continues, comes first if there is one; then the lowest.
        const auto keeps = std::min_element(sharing.begin(), sharing.end(), [&](SideId a, SideId b) {
          return is_boundary(a) != is_boundary(b) ? is_boundary(a) : a < b;
        });
        if (side > twin || side == *keeps) continue;
        const auto middle = static_cast<VertexId>(shell_.positions.size());
        shell_.positions.push_back(point_on(shell_.positions[start_of(side)], shell_.positions[end_of(side)]));
        shell_.source_vertex.push_back(kInvalidId);
        middles[side] = middle;
        middles[twin] = middle;
        ++parted;
      }
    }
  }
  if (parted == 0) return;
  split_faces(middles);
  shell_.notes.push_back("parted " + counted(parted, "edge", "edges") +
                         " where sheets of the surface touch, with a vertex in the middle");
}

void ShellMaker::split_faces(const std::unordered_map<std::uint64_t, VertexId>& middles) {
  const std::size_t count = shell_.faces.size();
  for (std::size_t i = 0; i < count; ++i) {
    const FaceId source = shell_.source_face[i];
    if (source == kInvalidId) continue;
    const Triangle face = shell_.faces[i];
    std::array<VertexId, 3> middle{kInvalidId, kInvalidId, kInvalidId};
    int splits = 0, turn = 0;
    for (int c = 0; c < 3; ++c) {
      const auto found = middles.find(3 * source + static_cast<SideId>(c));
      if (found == middles.end()) continue;
      middle[static_cast<std::size_t>(c)] = found->second;
      ++splits;
    }
    if (splits == 0) continue;
    // Turned so that the split sides come first, and the others last.
    const auto split_at = [&](int c) { return middle[static_cast<std::size_t>(c % 3)] != kInvalidId; };
    while (splits < 3 && !(split_at(turn) && !split_at(turn + 2)))
      ++turn;
    const auto corner = [&](int c) { return face[static_cast<std::size_t>((c + turn) % 3)]; };
    const auto half = [&](int c) { return middle[static_cast<std::size_t>((c + turn) % 3)]; };
    const auto add = [&](const Triangle& part) {
      shell_.faces.push_back(part);
      shell_.source_face.push_back(source);
    };
    if (splits == 1) {
      shell_.faces[i] = {corner(0), half(0), corner(2)};
      add({half(0), corner(1), corner(2)});
    } else if (splits == 2) {
      shell_.faces[i] = {corner(0), half(0), half(1)};
      add({half(0), corner(1), half(1)});
      add({corner(0), half(1), corner(2)});
    } else {
      shell_.faces[i] = {half(0), half(1), half(2)};
      add({corner(0), half(0), half(2)});
      add({corner(1), half(1), half(0)});
      add({corner(2), half(2), half(1)});
    }
  }
}

/// The volume enclosed, and the sum of the sizes of what it is made of: a ten-millionth of a millionth of that is
/// rounding.
struct Volume {
  double sum = 0, size = 0;
  void add(double part) {
    sum += part;
    size += std::abs(part);
  }
  bool is_nothing() const { return std::abs(sum) <= 1e-13 * size; }
};

/// The lowest vertex of each vertex's part.
std::vector<VertexId> parts_of(const Shell& shell) {
  std::vector<VertexId> part(shell.positions.size());
  std::iota(part.begin(), part.end(), 0u);
  const auto root = [&](VertexId v) {
    while (part[v] != v)
      v = part[v] = part[part[v]];
    return v;
  };
  for (const Triangle& face : shell.faces) {
    for (const VertexId v : {face[1], face[2]}) {
      const VertexId a = root(face[0]), b = root(v);
      part[std::max(a, b)] = std::min(a, b);
    }
  }
  for (VertexId v = 0; v < part.size(); ++v)
    part[v] = root(v);
  return part;
}

struct Volumes {
  Volume whole;
  std::size_t outwards = 0, inwards = 0;  ///< parts of positive and of negative volume
};

Volumes volumes_of(const Shell& shell) {
  DVec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
  for (const Vec3& p : shell.positions) {
    low = glm::min(low, DVec3(p));
    high = glm::max(high, DVec3(p));
  }
  const DVec3 middle = (low + high) * 0.5;
  const std::vector<VertexId> part = parts_of(shell);
  Volumes volumes;
  std::vector<Volume> of_part(shell.positions.size());
  for (const Triangle& face : shell.faces) {
    const DVec3 a = DVec3(shell.positions[face[0]]) - middle;
    const DVec3 b = DVec3(shell.positions[face[1]]) - middle;
    const DVec3 c = DVec3(shell.positions[face[2]]) - middle;
    const double signed_part = glm::dot(a, glm::cross(b, c)) / 6;
    volumes.whole.add(signed_part);
    of_part[part[face[0]]].add(signed_part);
  }
  for (const Volume& one : of_part) {
    volumes.outwards += !one.is_nothing() && one.sum > 0;
    volumes.inwards += !one.is_nothing() && one.sum < 0;
  }
  return volumes;
}

}  // namespace

Result<Shell> make_shell(const Mesh& mesh) {
  if (mesh.faces.empty())
    return fail(ErrorCode::kUnsuitable, "the mesh has no faces", "give a mesh that encloses a volume");
  const Topology topology = build_topology(mesh);
  Result<SidePairs> pairs = pair_sides(mesh, topology);
  if (!pairs) return tl::unexpected(std::move(pairs.error()));
  Shell shell = ShellMaker(mesh, topology, std::move(*pairs)).make();
  const Volumes volumes = volumes_of(shell);
  if (volumes.inwards > 0 && (volumes.outwards == 0 || (volumes.whole.sum < 0 && !volumes.whole.is_nothing()))) {
    return fail(ErrorCode::kUnsuitable,
                fmt::format("the surface is inside out: its volume is {:.6g}", volumes.whole.sum),
                "turn its faces (--repair turns closed parts that wind inwards)");
  }
  if (volumes.outwards == 0)
    return fail(ErrorCode::kUnsuitable, "the surface encloses no volume", "give a mesh that encloses one");
  if (volumes.inwards > 0) {
    shell.notes.push_back(counted(volumes.inwards, "part winds", "parts wind") +
                          " inwards: the wall of a cavity, or inside out (--repair turns those that lie in no other)");
  }
  return shell;
}

}  // namespace limn
