#include "limn/mesh/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <numeric>

#include "limn/mesh/face_area.h"

namespace limn {
namespace {

/// Disjoint sets over 0 … count-1; the lowest member names its set.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool is_degenerate(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

void count_vertices(const Mesh& mesh, const Topology& topology, MeshReport& report) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0), welded(mesh.positions.size(), 0);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (std::size_t c = 0; c < 3; ++c) {
      used[mesh.faces[face][c]] = 1;
      welded[topology.faces[face][c]] = 1;
    }
  }
  report.vertices = mesh.positions.size();
  report.unused_vertices = report.vertices - static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  report.welded_vertices = static_cast<std::size_t>(std::count(welded.begin(), welded.end(), 1));
}

void count_edges(const Topology& topology, MeshReport& report) {
  report.edges = topology.edge_count();
  for (const EdgeClass kind : topology.edge_class) {
    report.boundary_edges += kind == EdgeClass::kBoundary;
    report.inconsistent_edges += kind == EdgeClass::kInconsistent;
    report.non_manifold_edges += kind == EdgeClass::kNonManifold;
  }
  report.closed =
      report.edges > 0 && report.boundary_edges + report.inconsistent_edges + report.non_manifold_edges == 0;
}

/// Corners of faces joined across the edges at their vertex: each set is a fan. Crossing an edge joins the two corners
/// at either end. Across a non-manifold edge all of its faces are joined: the edge itself is what is reported then.
Sets fans_of(const Topology& topology) {
  Sets fans(3 * topology.face_count());
  const auto corner_at = [&](FaceId face, VertexId v) {
    const Triangle& t = topology.faces[face];
    const std::uint32_t c = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    return 3 * face + c;
  };
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    const std::span<const FaceId> faces = topology.edge_faces(edge);
    for (std::size_t i = 1; i < faces.size(); ++i) {
      for (const VertexId v : topology.edges[edge].v)
        fans.join(corner_at(faces[0], v), corner_at(faces[i], v));
    }
  }
  return fans;
}

void count_non_manifold_vertices(const Topology& topology, Sets& fans, MeshReport& report) {
  constexpr std::uint32_t kSeveral = kInvalidId - 1;
  std::vector<std::uint32_t> fan_at(topology.weld.size(), kInvalidId);
  for (std::size_t face = 0; face < topology.face_count(); ++face) {
    const Triangle& t = topology.faces[face];
    if (is_degenerate(t)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t fan = fans.find(static_cast<std::uint32_t>(3 * face + c));
      std::uint32_t& seen = fan_at[t[c]];
      if (seen == kInvalidId) seen = fan;
      if (seen == fan || seen == kSeveral) continue;
      seen = kSeveral;
      ++report.non_manifold_vertices;
    }
  }
}

/// Connected pieces of the boundary. Where several fans share a vertex, their boundaries pass it apart: edges are
/// joined within a fan only.
void count_boundary_loops(const Topology& topology, Sets& fans, MeshReport& report) {
  Sets loops(topology.edge_count());
  std::vector<EdgeId> edge_at(3 * topology.face_count(), kInvalidId);
  for (std::size_t face = 0; face < topology.face_count(); ++face) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (const std::size_t side : {c, (c + 2) % 3}) {  // the two that meet in corner c
        const EdgeId edge = topology.face_edges[face][side];
        if (edge == kInvalidId || topology.edge_class[edge] != EdgeClass::kBoundary) continue;
        EdgeId& met = edge_at[fans.find(static_cast<std::uint32_t>(3 * face + c))];
        if (met == kInvalidId) met = edge;
        loops.join(met, edge);
      }
    }
  }
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    report.boundary_loops += topology.edge_class[edge] == EdgeClass::kBoundary && loops.find(edge) == edge;
  }
}

/// Pieces connected through edges of any class. A degenerate face is no piece.
void count_components(const Topology& topology, MeshReport& report) {
  Sets pieces(topology.face_count());
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    const std::span<const FaceId> faces = topology.edge_faces(edge);
    for (std::size_t i = 1; i < faces.size(); ++i)
      pieces.join(faces[0], faces[i]);
  }
  for (FaceId face = 0; face < topology.face_count(); ++face) {
    report.components += !is_degenerate(topology.faces[face]) && pieces.find(face) == face;
  }
}

/// Faces of the same vertices share all their edges: they are looked for at the lowest one only.
void count_duplicates(const Topology& topology, MeshReport& report) {
  std::vector<VertexId> opposite;
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    opposite.clear();
    const Edge& ends = topology.edges[edge];
    for (const FaceId face : topology.edge_faces(edge)) {
      const std::array<EdgeId, 3>& sides = topology.face_edges[face];
      if (*std::min_element(sides.begin(), sides.end()) != edge) continue;
      const Triangle& t = topology.faces[face];
      opposite.push_back(t[0] ^ t[1] ^ t[2] ^ ends.v[0] ^ ends.v[1]);
    }
    std::sort(opposite.begin(), opposite.end());
    report.duplicate_faces += static_cast<std::size_t>(opposite.end() - std::unique(opposite.begin(), opposite.end()));
  }
}

/// Sums in double, in the order of the faces. Volumes are taken about the box's middle, so that a mesh far from the
/// origin keeps its digits.
void measure(const Mesh& mesh, const Topology& topology, MeshReport& report) {
  report.bounds = face_bounds(mesh);
  if (report.bounds.empty()) return;
  const DVec3 middle = (DVec3(report.bounds.low) + DVec3(report.bounds.high)) * 0.5;
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    if (is_degenerate(topology.faces[face])) continue;
    const DVec3 across = twice_area_vector(mesh, face);
    report.zero_area_faces += across == DVec3(0.0);
    report.area += 0.5 * glm::length(across);
    report.volume += glm::dot(DVec3(mesh.positions[mesh.faces[face][0]]) - middle, across) / 6;
  }
}

/// Vertices, edges and faces of the surface that the faces which are not degenerate make.
long euler_of(const Topology& topology, const MeshReport& report) {
  std::vector<std::uint8_t> used(topology.weld.size(), 0);
  for (const Triangle& t : topology.faces) {
    if (is_degenerate(t)) continue;
    for (const VertexId v : t)
      used[v] = 1;
  }
  const auto vertices = static_cast<long>(std::count(used.begin(), used.end(), 1));
  return vertices - static_cast<long>(report.edges) +
         static_cast<long>(topology.face_count() - topology.degenerate_faces.size());
}

/// "1 edge", "2 edges".
std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::size_t usable_faces(const MeshReport& report) {
  return report.faces - report.degenerate_faces - report.zero_area_faces;
}

std::string no_faces(const MeshReport& report) {
  if (report.faces == 0) return "the mesh has no faces";
  return fmt::format("none of the {} has any area", counted(report.faces, "face", "faces"));
}

/// What a technique that takes any surface should expect of this one.
void expect_of_any(const MeshReport& report, std::vector<std::string>& reasons) {
  if (report.inconsistent_edges > 0) {
    reasons.push_back(counted(report.inconsistent_edges, "edge lies", "edges lie") +
                      " between faces that wind in opposite senses, so that front and back are mixed up there; "
                      "--repair turns the faces where that is possible");
  }
  const std::size_t without_area = report.degenerate_faces + report.zero_area_faces;
  if (without_area > 0) {
    reasons.push_back(counted(without_area, "face has", "faces have") +
                      " no area and no normal; --repair removes them");
  }
  if (report.duplicate_faces > 0) {
    reasons.push_back(counted(report.duplicate_faces, "face repeats", "faces repeat") +
                      " another one; --repair removes exact copies");
  }
}

Suitability for_silhouette(const MeshReport& report) {
  Suitability result{"silhouette", usable_faces(report) > 0, {}};
  if (!result.can_run) {
    result.reasons.push_back(no_faces(report));
    return result;
  }
  if (report.boundary_edges > 0) {
    result.reasons.push_back(counted(report.boundary_edges, "boundary edge is", "boundary edges are") +
                             " a class of their own, part of the outline from any side");
  }
  if (report.non_manifold_edges > 0) {
    result.reasons.push_back(counted(report.non_manifold_edges, "edge has", "edges have") +
                             " three faces or more and never count as silhouette");
  }
  expect_of_any(report, result.reasons);
  return result;
}

Suitability for_refine(const MeshReport& report) {
  Suitability result{"refine", usable_faces(report) > 0, {}};
  if (!result.can_run) {
    result.reasons.push_back(no_faces(report));
    return result;
  }
  if (!report.has_normals) {
    result.reasons.push_back(
        "the mesh has no normals; they are computed and split where faces meet at more than --crease-angle");
  }
  if (report.boundary_edges > 0) {
    result.reasons.push_back(counted(report.boundary_edges, "boundary edge is", "boundary edges are") +
                             " kept, and rounded like the surface beside them");
  }
  if (report.non_manifold_edges > 0) {
    result.reasons.push_back(counted(report.non_manifold_edges, "edge has", "edges have") +
                             " three faces or more and stay straight");
  }
  expect_of_any(report, result.reasons);
  return result;
}

}  // namespace

MeshReport validate(const Mesh& mesh, const Topology& topology) {
  MeshReport report;
  report.faces = mesh.faces.size();
  report.degenerate_faces = topology.degenerate_faces.size();
  report.has_normals = !mesh.normals.empty();
  report.has_uvs = !mesh.uvs.empty();
  report.has_colors = !mesh.colors.empty();
  count_vertices(mesh, topology, report);
  count_edges(topology, report);
  Sets fans = fans_of(topology);
  count_non_manifold_vertices(topology, fans, report);
  if (report.boundary_edges > 0) count_boundary_loops(topology, fans, report);
  count_components(topology, report);
  count_duplicates(topology, report);
  measure(mesh, topology, report);
  report.euler_characteristic = euler_of(topology, report);
  return report;
}

std::vector<Suitability> suitability(const MeshReport& report) {
  return {for_silhouette(report), for_refine(report)};
}

}  // namespace limn
