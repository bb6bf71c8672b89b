#include "limn/mesh/repair.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "limn/mesh/face_area.h"
#include "limn/mesh/orient.h"
#include "limn/mesh/topology.h"

namespace limn {
namespace {

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// Keeps the marked faces, in their order, with all that belongs to them.
void keep_faces(Mesh& mesh, const std::vector<std::uint8_t>& keep) {
  const auto keep_indices = [&](std::vector<std::uint32_t>& indices) {
    if (indices.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (keep[i / 3]) indices[kept++] = indices[i];
    }
    indices.resize(kept);
  };
  keep_indices(mesh.normals.indices);
  keep_indices(mesh.uvs.indices);
  keep_indices(mesh.colors.indices);
  keep_indices(mesh.tangents.indices);
  std::size_t kept = 0;
  for (std::size_t face = 0; face < keep.size(); ++face) {
    if (!keep[face]) continue;
    if (!mesh.face_materials.empty()) mesh.face_materials[kept] = mesh.face_materials[face];
    mesh.faces[kept++] = mesh.faces[face];
  }
  mesh.faces.resize(kept);
  if (!mesh.face_materials.empty()) mesh.face_materials.resize(kept);
}

/// Sorts ids and leaves each once.
void sort_once(std::vector<std::uint32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Takes faces without area off a surface, in rounds: all that are loose at once, then those that this has made loose.
/// Only the neighbours of what went can have become so, so that the rounds together look at each edge a few times.
class Peeling {
 public:
  explicit Peeling(const Mesh& mesh) : mesh_(mesh), topology_(build_topology(mesh)), keep_(mesh.faces.size(), 1) {
    for (const FaceId face : topology_.degenerate_faces)
      keep_[face] = 0;
    faces_at_.reserve(topology_.edge_count());
    for (EdgeId edge = 0; edge < topology_.edge_count(); ++edge)
      faces_at_.push_back(static_cast<std::uint32_t>(topology_.edge_faces(edge).size()));
  }

  /// Which faces stay.
  std::vector<std::uint8_t> peel() {
    std::vector<FaceId> loose;
    for (FaceId face = 0; face < keep_.size(); ++face) {
      if (keep_[face] && is_loose_sliver(face)) loose.push_back(face);
    }
    while (!loose.empty()) {
      remove(loose);
      loose = loosened_by(loose);
    }
    return std::move(keep_);
  }

 private:
  /// Whether a face of three distinct corners has no area and leaves no gap when it goes: one whose three edges each
  /// hold on to one other face stays, since without it the faces around it would no longer be connected.
  bool is_loose_sliver(FaceId face) const {
    const std::array<EdgeId, 3>& edges = topology_.face_edges[face];
    return std::any_of(edges.begin(), edges.end(), [this](EdgeId edge) { return faces_at_[edge] != 2; }) &&
           twice_area_vector(mesh_, face) == DVec3(0.0);
  }

  void remove(const std::vector<FaceId>& faces) {
    for (const FaceId face : faces) {
      keep_[face] = 0;
      for (const EdgeId edge : topology_.face_edges[face])
        --faces_at_[edge];
    }
  }

  /// An edge lets its last sliver go when one face is left. Where more than two are left none is a sliver: those went
  /// with the first round.
  std::vector<FaceId> loosened_by(const std::vector<FaceId>& removed) const {
    std::vector<EdgeId> open;
    for (const FaceId face : removed) {
      for (const EdgeId edge : topology_.face_edges[face]) {
        if (faces_at_[edge] == 1) open.push_back(edge);
      }
    }
    sort_once(open);
    std::vector<FaceId> loose;
    for (const EdgeId edge : open) {
      const std::span<const FaceId> around = topology_.edge_faces(edge);
      const auto left = std::find_if(around.begin(), around.end(), [this](FaceId face) { return keep_[face] != 0; });
      if (is_loose_sliver(*left)) loose.push_back(*left);
    }
    sort_once(loose);
    return loose;
  }

  const Mesh& mesh_;
  Topology topology_;
  std::vector<std::uint8_t> keep_;
  std::vector<std::uint32_t> faces_at_;  ///< one an edge: how many of its faces stay
};

/// Takes away faces without area until no more of them are loose. Returns how many.
std::size_t remove_faces_without_area(Mesh& mesh) {
  const std::vector<std::uint8_t> keep = Peeling(mesh).peel();
  const auto useless = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 0));
  if (useless > 0) keep_faces(mesh, keep);
  return useless;
}

/// The face's vertices, the lowest first, in the order it winds.
Triangle rotated(const Triangle& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}

/// Takes away faces that wind around the same vertices in the same sense as an earlier one. Returns how many.
std::size_t remove_copies(Mesh& mesh) {
  const std::vector<VertexId> weld = weld_positions(mesh.positions);
  std::vector<std::pair<Triangle, FaceId>> sorted;
  sorted.reserve(mesh.faces.size());
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    const Triangle& t = mesh.faces[face];
    sorted.emplace_back(rotated({weld[t[0]], weld[t[1]], weld[t[2]]}), face);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint8_t> keep(mesh.faces.size(), 1);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) keep[sorted[i].second] = 0;
  }
  const auto copies = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 0));
  if (copies > 0) keep_faces(mesh, keep);
  return copies;
}

/// Gives every corner an index of its own into an attribute that had one value a vertex.
template <class T>
void index_corners(const Mesh& mesh, CornerAttribute<T>& attribute) {
  if (attribute.empty() || !attribute.indices.empty()) return;
  for (const Triangle& t : mesh.faces)
    attribute.indices.insert(attribute.indices.end(), t.begin(), t.end());
}

/// Normals that point behind the face they belong to, after it was turned, are turned as well.
void turn_normals(Mesh& mesh, const std::vector<std::uint8_t>& turn) {
  if (mesh.normals.empty()) return;
  std::vector<std::uint32_t> opposite(mesh.normals.values.size(), kInvalidId);
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    if (!turn[face]) continue;
    const DVec3 front = twice_area_vector(mesh, face);
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t index = mesh.corner_index(mesh.normals, face, c);
      if (!(glm::dot(DVec3(mesh.normals.values[index]), front) < 0)) continue;
      if (opposite[index] == kInvalidId) {
        opposite[index] = static_cast<std::uint32_t>(mesh.normals.values.size());
        const Vec3 turned = -mesh.normals.values[index];
        mesh.normals.values.push_back(turned);
      }
      index_corners(mesh, mesh.normals);
      mesh.normals.indices[3 * static_cast<std::size_t>(face) + static_cast<std::size_t>(c)] = opposite[index];
    }
  }
}

void turn_faces(Mesh& mesh, const std::vector<std::uint8_t>& turn) {
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (!turn[face]) continue;
    std::swap(mesh.faces[face][1], mesh.faces[face][2]);
    for (std::vector<std::uint32_t>* indices : {&mesh.normals.indices, &mesh.uvs.indices, &mesh.colors.indices}) {
      if (!indices->empty()) std::swap((*indices)[3 * face + 1], (*indices)[3 * face + 2]);
    }
  }
  turn_normals(mesh, turn);
  // Those of a turned face would point to the wrong side.
  if (std::find(turn.begin(), turn.end(), 1) != turn.end()) mesh.tangents = {};
}

/// Takes away what belongs to vertices that are not marked, and keeps the order of the rest.
template <class T>
void keep_marked(std::vector<T>& values, const std::vector<std::uint8_t>& marked) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (marked[i]) values[kept++] = values[i];
  }
  values.resize(kept);
}

std::size_t remove_unused_vertices(Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.faces) {
    for (const VertexId v : t)
      used[v] = 1;
  }
  std::vector<VertexId> number(used.size());
  VertexId next = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    number[v] = next;
    next += used[v];
  }
  const std::size_t unused = used.size() - next;
  if (unused == 0) return 0;
  const auto keep_values = [&](auto& attribute) {
    if (attribute.indices.empty() && !attribute.empty()) keep_marked(attribute.values, used);
  };
  keep_values(mesh.normals);
  keep_values(mesh.uvs);
  keep_values(mesh.colors);
  keep_values(mesh.tangents);
  if (!mesh.tags.empty()) keep_marked(mesh.tags, used);
  keep_marked(mesh.positions, used);
  for (Triangle& t : mesh.faces)
    t = {number[t[0]], number[t[1]], number[t[2]]};
  return unused;
}

}  // namespace

Repair repair(const Mesh& mesh) {
  Repair result{mesh, {}};
  std::vector<std::string>& changes = result.changes;
  if (const std::size_t count = remove_faces_without_area(result.mesh); count > 0) {
    changes.push_back(fmt::format("removed {} without area", counted(count, "face", "faces")));
  }
  if (const std::size_t count = remove_copies(result.mesh); count > 0) {
    changes.push_back(fmt::format("removed {} of other faces", counted(count, "copy", "copies")));
  }
  const Orientation orientation = find_orientation(result.mesh, build_topology(result.mesh));
  turn_faces(result.mesh, orientation.turn);
  if (orientation.to_agree > 0) {
    changes.push_back(
        fmt::format("turned {} to agree with their neighbours", counted(orientation.to_agree, "face", "faces")));
  }
  if (orientation.outwards > 0) {
    changes.push_back(fmt::format("turned {} of {} outwards", counted(orientation.outwards, "face", "faces"),
                                  counted(orientation.outwards_components, "closed component", "closed components")));
  }
  if (const std::size_t count = remove_unused_vertices(result.mesh); count > 0) {
    changes.push_back(fmt::format("removed {}", counted(count, "unused vertex", "unused vertices")));
  }
  return result;
}

}  // namespace limn
