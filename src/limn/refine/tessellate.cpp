#include "limn/refine/tessellate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "limn/base/parallel.h"
#include "limn/refine/attributes.h"
#include "limn/refine/grid.h"

namespace limn {
namespace {

constexpr std::size_t kFaceGrain = 512;
constexpr std::size_t kEdgeGrain = 2048;
constexpr std::size_t kFacesPerReport = 1 << 17;

/// How much of everything there will be, and where each edge's and face's share begins.
struct Plan {
  std::vector<std::uint8_t> face_level;      ///< m
  std::vector<std::uint8_t> edge_level;      ///< t
  std::vector<std::uint32_t> corner_vertex;  ///< welded vertex → output vertex
  std::vector<std::uint64_t> edge_vertices;  ///< before each edge, of edges' inner vertices
  std::vector<std::uint64_t> face_vertices;  ///< before each face, of faces' inner vertices
  std::vector<std::uint64_t> triangles;      ///< before each face
  std::uint64_t corners = 0;                 ///< output vertices that are input vertices

  std::uint64_t edge_base() const { return corners; }
  std::uint64_t face_base() const { return corners + edge_vertices.back(); }
  std::uint64_t vertices() const { return face_base() + face_vertices.back(); }
};

bool takes_part(const Topology& topology, std::size_t face) {
  return topology.face_edges[face][0] != kInvalidId;
}

void choose_levels(const Topology& topology, std::span<const float> levels, Plan& plan) {
  plan.face_level.assign(topology.face_count(), 0);
  plan.edge_level.assign(topology.edge_count(), 0);
  parallel_for(topology.face_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (!takes_part(topology, f)) continue;
      float largest = 0.0f;
      for (const EdgeId e : topology.face_edges[f])
        largest = std::max(largest, levels[e]);
      plan.face_level[f] = static_cast<std::uint8_t>(std::ceil(largest));
    }
  });
  parallel_for(topology.edge_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      for (const FaceId f : topology.edge_faces(static_cast<EdgeId>(e))) {
        plan.edge_level[e] = std::max(plan.edge_level[e], plan.face_level[f]);
      }
    }
  });
}

std::uint64_t triangles_of(const Topology& topology, const Plan& plan, std::size_t face) {
  const int m = plan.face_level[face];
  std::uint64_t count = std::uint64_t{1} << (2 * m);
  // Each point a finer neighbour puts on a side cuts one triangle more.
  for (const EdgeId e : topology.face_edges[face])
    count += (1u << plan.edge_level[e]) - (1u << m);
  return count;
}

Plan make_plan(const Topology& topology, std::span<const float> levels) {
  Plan plan;
  choose_levels(topology, levels, plan);
  plan.corner_vertex.assign(topology.weld.size(), kInvalidId);
  plan.face_vertices.assign(topology.face_count() + 1, 0);
  plan.triangles.assign(topology.face_count() + 1, 0);
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    plan.face_vertices[f + 1] = plan.face_vertices[f];
    plan.triangles[f + 1] = plan.triangles[f];
    if (!takes_part(topology, f)) continue;
    const std::uint64_t n = std::uint64_t{1} << plan.face_level[f];
    plan.face_vertices[f + 1] += n > 1 ? (n - 1) * (n - 2) / 2 : 0;
    plan.triangles[f + 1] += triangles_of(topology, plan, f);
    for (const VertexId v : topology.faces[f])
      plan.corner_vertex[v] = 0;
  }
  for (std::uint32_t& vertex : plan.corner_vertex) {
    if (vertex != kInvalidId) vertex = static_cast<std::uint32_t>(plan.corners++);
  }
  plan.edge_vertices.assign(topology.edge_count() + 1, 0);
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    plan.edge_vertices[e + 1] = plan.edge_vertices[e] + (std::uint64_t{1} << plan.edge_level[e]) - 1;
  }
  return plan;
}

/// One corner of an output triangle: its position and the values of its attributes.
struct Corner {
  std::uint32_t position = 0, normal = 0, uv = 0, color = 0;
};

/// Points that a finer neighbour has put between the ends of a border triangle's side.
struct Side {
  int c = 0;      ///< which side of the face
  int first = 0;  ///< at its first end, in segments of the edge
  int count = 1;  ///< segments; 1: none were put
};

class Tessellator {
 public:
  Tessellator(const Mesh& mesh, const Topology& topology, std::span<const EdgeCurve> curves,
              std::span<const float> levels, const TessellateOptions& options, Plan plan)
      : mesh_(mesh), topology_(topology), curves_(curves), levels_(levels), options_(options), plan_(std::move(plan)) {}

  Result<Refinement> run();

 private:
  struct Scratch {
    std::vector<Vec3> patch_points, surface_points;
    std::vector<Corner> corners;
  };
  struct Attributes {
    AttributeTessellator<Vec3> normals;
    AttributeTessellator<Vec2> uvs;
    AttributeTessellator<Vec4> colors;
  };

  void place_corners();
  void fill_edge(EdgeId edge, std::vector<Vec3>& curve, std::vector<Vec3>& surface);
  void fill_face(FaceId face, Scratch& scratch);
  void sample_face(FaceId face, const Grid& grid, Scratch& scratch);
  void name_corners(FaceId face, const Grid& grid, std::vector<Corner>& corners) const;
  Corner corner_of_face(FaceId face, int c) const;
  Corner corner_on_side(FaceId face, int c, int q) const;
  void cut(FaceId face, std::uint64_t& out, const Corner (&p)[3], const Side (&sides)[3]);
  void put(std::uint64_t out, FaceId face, const Corner& a, const Corner& b, const Corner& c);

  const Mesh& mesh_;
  const Topology& topology_;
  std::span<const EdgeCurve> curves_;
  std::span<const float> levels_;
  const TessellateOptions& options_;
  Plan plan_;
  std::vector<Grid> grids_;
  std::vector<Vec3> edge_curve_points_;  ///< F at the edges' inner vertices, in the order of their output vertices
  Attributes attributes_{
      {mesh_, topology_, mesh_.normals, plan_.edge_level, plan_.face_vertices, plan_.triangles.back()},
      {mesh_, topology_, mesh_.uvs, plan_.edge_level, plan_.face_vertices, plan_.triangles.back()},
      {mesh_, topology_, mesh_.colors, plan_.edge_level, plan_.face_vertices, plan_.triangles.back()}};
  Refinement out_;
};

/// Fills edges and corners first, then the faces' insides, which read them.
Result<Refinement> Tessellator::run() {
  const int deepest =
      plan_.face_level.empty() ? 0 : *std::max_element(plan_.face_level.begin(), plan_.face_level.end());
  for (int m = 0; m <= deepest; ++m)
    grids_.push_back(make_grid(m));
  out_.mesh.positions.resize(plan_.vertices());
  out_.mesh.faces.resize(plan_.triangles.back());
  out_.source_face.resize(plan_.triangles.back());
  out_.mesh.materials = mesh_.materials;
  if (!mesh_.face_materials.empty()) out_.mesh.face_materials.resize(plan_.triangles.back());
  place_corners();

  edge_curve_points_.resize(plan_.edge_vertices.back());
  parallel_for(topology_.edge_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3> curve, surface;
    for (std::size_t e = begin; e < end; ++e)
      fill_edge(static_cast<EdgeId>(e), curve, surface);
  });
  for (std::size_t first = 0; first < topology_.face_count(); first += kFacesPerReport) {
    const double done = static_cast<double>(first) / static_cast<double>(topology_.face_count());
    if (!report(options_.progress, "tessellate", done)) return fail(ErrorCode::kCancelled, "cancelled");
    const std::size_t count = std::min(kFacesPerReport, topology_.face_count() - first);
    parallel_for(count, kFaceGrain, [&](std::size_t begin, std::size_t end) {
      Scratch scratch;
      for (std::size_t f = first + begin; f < first + end; ++f) {
        if (takes_part(topology_, f)) fill_face(static_cast<FaceId>(f), scratch);
      }
    });
  }
  report(options_.progress, "tessellate", 1.0);

  out_.mesh.normals = attributes_.normals.take();
  out_.mesh.uvs = attributes_.uvs.take();
  out_.mesh.colors = attributes_.colors.take();
  out_.edge_levels.assign(levels_.begin(), levels_.end());
  out_.face_level = plan_.face_level;
  out_.refined_faces = static_cast<std::size_t>(
      std::count_if(plan_.face_level.begin(), plan_.face_level.end(), [](std::uint8_t m) { return m > 0; }));
  return std::move(out_);
}

void Tessellator::place_corners() {
  parallel_for(plan_.corner_vertex.size(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (plan_.corner_vertex[v] != kInvalidId) out_.mesh.positions[plan_.corner_vertex[v]] = mesh_.positions[v];
    }
  });
}

void Tessellator::fill_edge(EdgeId id, std::vector<Vec3>& curve, std::vector<Vec3>& surface) {
  const int t = plan_.edge_level[id];
  if (t == 0) return;
  const Edge& edge = topology_.edges[id];
  const std::size_t n = std::size_t{1} << t;
  curve.resize(n + 1);
  surface.resize(n + 1);
  sample_edge(mesh_.positions[edge.v[0]], curves_[id], mesh_.positions[edge.v[1]], levels_[id], t, options_.blend,
              curve, surface);
  const std::uint64_t offset = plan_.edge_vertices[id];
  std::copy(curve.begin() + 1, curve.end() - 1, edge_curve_points_.begin() + static_cast<std::ptrdiff_t>(offset));
  std::copy(surface.begin() + 1, surface.end() - 1,
            out_.mesh.positions.begin() + static_cast<std::ptrdiff_t>(plan_.edge_base() + offset));
  attributes_.normals.fill_edge(id);
  attributes_.uvs.fill_edge(id);
  attributes_.colors.fill_edge(id);
}

Corner Tessellator::corner_of_face(FaceId face, int c) const {
  Corner corner;
  corner.position = plan_.corner_vertex[topology_.faces[face][static_cast<std::size_t>(c)]];
  if (!attributes_.normals.empty()) corner.normal = attributes_.normals.corner(face, c);
  if (!attributes_.uvs.empty()) corner.uv = attributes_.uvs.corner(face, c);
  if (!attributes_.colors.empty()) corner.color = attributes_.colors.corner(face, c);
  return corner;
}

/// The point q of 2^t segments along side c: t the edge's level, not the face's.
Corner Tessellator::corner_on_side(FaceId face, int c, int q) const {
  const EdgeId id = topology_.face_edges[face][static_cast<std::size_t>(c)];
  const int n = 1 << plan_.edge_level[id];
  if (q == 0) return corner_of_face(face, c);
  if (q == n) return corner_of_face(face, (c + 1) % 3);
  const int k = topology_.runs_forward(face, c) ? q : n - q;
  Corner corner;
  corner.position =
      static_cast<std::uint32_t>(plan_.edge_base() + plan_.edge_vertices[id] + static_cast<std::uint64_t>(k) - 1);
  if (!attributes_.normals.empty()) corner.normal = attributes_.normals.on_side(face, c, q);
  if (!attributes_.uvs.empty()) corner.uv = attributes_.uvs.on_side(face, c, q);
  if (!attributes_.colors.empty()) corner.color = attributes_.colors.on_side(face, c, q);
  return corner;
}

/// The output corner of every grid vertex.
void Tessellator::name_corners(FaceId face, const Grid& grid, std::vector<Corner>& corners) const {
  const int n = grid.segments();
  corners.resize(grid.vertices.size());
  for (int c = 0; c < 3; ++c) {
    const EdgeId id = topology_.face_edges[face][static_cast<std::size_t>(c)];
    const int step = 1 << (plan_.edge_level[id] - grid.level);
    for (int q = 0; q < n; ++q)
      corners[grid.on_side(c, q)] = corner_on_side(face, c, q * step);
  }
  for (std::size_t i = 0; i < grid.interior.size(); ++i) {
    Corner& corner = corners[grid.interior[i]];
    corner.position = static_cast<std::uint32_t>(plan_.face_base() + plan_.face_vertices[face] + i);
    if (!attributes_.normals.empty()) corner.normal = attributes_.normals.interior(face, i);
    if (!attributes_.uvs.empty()) corner.uv = attributes_.uvs.interior(face, i);
    if (!attributes_.colors.empty()) corner.color = attributes_.colors.interior(face, i);
  }
}

/// Samples the patch inside, from the edges' points around it.
void Tessellator::sample_face(FaceId face, const Grid& grid, Scratch& scratch) {
  scratch.patch_points.resize(grid.vertices.size());
  scratch.surface_points.resize(grid.vertices.size());
  float largest = 0.0f;
  for (int c = 0; c < 3; ++c) {
    const EdgeId id = topology_.face_edges[face][static_cast<std::size_t>(c)];
    largest = std::max(largest, levels_[id]);
    for (int q = 0; q < grid.segments(); ++q) {
      const std::uint32_t v = grid.on_side(c, q);
      const std::uint32_t position = scratch.corners[v].position;
      scratch.surface_points[v] = out_.mesh.positions[position];
      scratch.patch_points[v] = q == 0 ? scratch.surface_points[v]
                                       : edge_curve_points_[position - static_cast<std::uint32_t>(plan_.edge_base())];
    }
  }
  sample_interior(grid, make_patch(mesh_, topology_, curves_, face, options_.center), largest, options_.blend,
                  scratch.patch_points, scratch.surface_points);
  for (const std::uint32_t v : grid.interior) {
    out_.mesh.positions[scratch.corners[v].position] = scratch.surface_points[v];
  }
  attributes_.normals.fill_interior(face, grid);
  attributes_.uvs.fill_interior(face, grid);
  attributes_.colors.fill_interior(face, grid);
}

void Tessellator::fill_face(FaceId face, Scratch& scratch) {
  const Grid& grid = grids_[plan_.face_level[face]];
  const int n = grid.segments();
  name_corners(face, grid, scratch.corners);
  if (!grid.interior.empty()) sample_face(face, grid, scratch);

  int step[3];  // segments of each side's edge to one of the face's
  for (std::size_t c = 0; c < 3; ++c) {
    step[c] = 1 << (plan_.edge_level[topology_.face_edges[face][c]] - grid.level);
  }
  std::uint64_t out = plan_.triangles[face];
  for (const auto& t : grid.triangles) {
    const Corner p[3] = {scratch.corners[t[0]], scratch.corners[t[1]], scratch.corners[t[2]]};
    const GridVertex& first = grid.vertices[t[0]];
    const bool upward = grid.vertices[t[1]].k == first.k;
    Side sides[3];
    // Only triangles that point the way the whole does have sides on the border.
    if (upward && first.k == 0) sides[0] = {0, first.j * step[0], step[0]};
    if (upward && first.j + first.k == n - 1) sides[1] = {1, first.k * step[1], step[1]};
    if (upward && first.j == 0) sides[2] = {2, (n - 1 - first.k) * step[2], step[2]};
    cut(face, out, p, sides);
  }
  assert(out == plan_.triangles[face + 1]);
}

/// Puts the triangle, fanned where its sides have points: from the corner opposite the first such side; what is left of
/// the other two sides falls to the fan's first and last triangle.
void Tessellator::cut(FaceId face, std::uint64_t& out, const Corner (&p)[3], const Side (&sides)[3]) {
  for (std::size_t c = 0; c < 3; ++c) {
    const Side& side = sides[c];
    if (side.count == 1) continue;
    const Corner& opposite = p[(c + 2) % 3];
    Corner from = p[c];
    for (int i = 0; i < side.count; ++i) {
      const bool last = i + 1 == side.count;
      const Corner to = last ? p[(c + 1) % 3] : corner_on_side(face, side.c, side.first + i + 1);
      const Corner part[3] = {from, to, opposite};
      const Side part_sides[3] = {Side{}, last ? sides[(c + 1) % 3] : Side{}, i == 0 ? sides[(c + 2) % 3] : Side{}};
      cut(face, out, part, part_sides);
      from = to;
    }
    return;
  }
  put(out++, face, p[0], p[1], p[2]);
}

void Tessellator::put(std::uint64_t out, FaceId face, const Corner& a, const Corner& b, const Corner& c) {
  out_.mesh.faces[out] = {a.position, b.position, c.position};
  out_.source_face[out] = face;
  if (!mesh_.face_materials.empty()) out_.mesh.face_materials[out] = mesh_.face_materials[face];
  const Corner* const corners[3] = {&a, &b, &c};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!attributes_.normals.empty()) attributes_.normals.set_index(3 * out + i, corners[i]->normal);
    if (!attributes_.uvs.empty()) attributes_.uvs.set_index(3 * out + i, corners[i]->uv);
    if (!attributes_.colors.empty()) attributes_.colors.set_index(3 * out + i, corners[i]->color);
  }
}

}  // namespace

Result<Refinement> tessellate(const Mesh& mesh, const Topology& topology, std::span<const EdgeCurve> curves,
                              std::span<const float> levels, const TessellateOptions& options) {
  assert(!mesh.normals.empty());
  assert(curves.size() == topology.edge_count() && levels.size() == topology.edge_count());
  Plan plan = make_plan(topology, levels);
  // Values of attributes are numbered with 32 bits: three a triangle of the input and three of the result at most.
  const std::uint64_t most = std::min<std::uint64_t>(options.max_triangles, kInvalidId / 6);
  if (plan.triangles.back() > most) {
    return fail(ErrorCode::kUnsuitable,
                fmt::format("refinement would give {} triangles, more than {}", plan.triangles.back(), most),
                "lower the maximal level or raise the tolerance");
  }
  return Tessellator(mesh, topology, curves, levels, options, std::move(plan)).run();
}

}  // namespace limn
