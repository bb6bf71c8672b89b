#include "limn/refine/tessellate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <utility>

#include "limn/base/parallel.h"
#include "limn/refine/attributes.h"
#include "limn/refine/grid.h"
#include "limn/refine/patterns/table.h"

namespace limn {
namespace {

constexpr std::size_t kFaceGrain = 512;
constexpr std::size_t kEdgeGrain = 2048;
constexpr std::size_t kFacesPerReport = 1 << 17;

/// The patterns that occur, each made once.
class PatternCache {
 public:
  explicit PatternCache(PatternFamily family) : family_(family), patterns_(pattern_count(family, kMaxPatternLevel)) {}

  void prepare(std::uint32_t base) {
    if (!patterns_[base]) patterns_[base] = std::make_unique<const Pattern>(find_pattern(family_, base));
  }
  /// \pre base was prepared
  const Pattern& at(std::uint32_t base) const { return *patterns_[base]; }

 private:
  PatternFamily family_;
  std::vector<std::unique_ptr<const Pattern>> patterns_;
};

/// How much of everything there will be, and where each edge's and face's share begins.
struct Plan {
  explicit Plan(PatternFamily family) : patterns(family) {}

  PatternCache patterns;
  std::vector<PatternChoice> choices;        ///< one a face
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

std::uint8_t rounded_up(float level) {
  return static_cast<std::uint8_t>(std::ceil(level));
}

void choose_levels(const Topology& topology, std::span<const float> levels, PatternFamily family, Plan& plan) {
  plan.face_level.assign(topology.face_count(), 0);
  plan.edge_level.assign(topology.edge_count(), 0);
  parallel_for(topology.face_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (!takes_part(topology, f)) continue;
      for (const EdgeId e : topology.face_edges[f])
        plan.face_level[f] = std::max(plan.face_level[f], rounded_up(levels[e]));
    }
  });
  parallel_for(topology.edge_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      if (family == PatternFamily::kMinimal) {
        plan.edge_level[e] = rounded_up(levels[e]);
        continue;
      }
      for (const FaceId f : topology.edge_faces(static_cast<EdgeId>(e))) {
        plan.edge_level[e] = std::max(plan.edge_level[e], plan.face_level[f]);
      }
    }
  });
}

void choose_patterns(const Topology& topology, PatternFamily family, Plan& plan) {
  plan.choices.resize(topology.face_count());
  parallel_for(topology.face_count(), kEdgeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (!takes_part(topology, f)) continue;
      PatternConfig config{plan.face_level[f], {}};
      for (std::size_t c = 0; c < 3; ++c)
        config.sides[c] = plan.edge_level[topology.face_edges[f][c]];
      plan.choices[f] = choose_pattern(family, config);
    }
  });
}

Plan make_plan(const Topology& topology, std::span<const float> levels, PatternFamily family) {
  Plan plan(family);
  choose_levels(topology, levels, family, plan);
  choose_patterns(topology, family, plan);
  plan.corner_vertex.assign(topology.weld.size(), kInvalidId);
  plan.face_vertices.assign(topology.face_count() + 1, 0);
  plan.triangles.assign(topology.face_count() + 1, 0);
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    plan.face_vertices[f + 1] = plan.face_vertices[f];
    plan.triangles[f + 1] = plan.triangles[f];
    if (!takes_part(topology, f)) continue;
    plan.patterns.prepare(plan.choices[f].base);
    const Pattern& pattern = plan.patterns.at(plan.choices[f].base);
    plan.face_vertices[f + 1] += pattern.vertices.size() - pattern.border();
    plan.triangles[f + 1] += pattern.triangles.size();
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

class Tessellator {
 public:
  Tessellator(const Mesh& mesh, const Topology& topology, std::span<const EdgeCurve> curves,
              std::span<const float> levels, const TessellateOptions& options, Plan plan)
      : mesh_(mesh), topology_(topology), curves_(curves), levels_(levels), options_(options), plan_(std::move(plan)) {}

  Result<Refinement> run();

 private:
  struct Scratch {
    std::vector<Vec3> patch_points, surface_points;  ///< at the vertices of the face's grid
    std::vector<Vec3> side_curve, side_surface;      ///< along one side
    std::vector<Corner> corners;                     ///< at the vertices of the face's pattern
    std::vector<PatternVertex> inside;               ///< the pattern's vertices inside, by their weights on the face
  };
  struct Attributes {
    AttributeTessellator<Vec3> normals;
    AttributeTessellator<Vec2> uvs;
    AttributeTessellator<Vec4> colors;
  };

  void place_corners();
  void fill_edge(EdgeId edge, std::vector<Vec3>& curve, std::vector<Vec3>& surface);
  void fill_face(FaceId face, Scratch& scratch);
  void name_corners(FaceId face, const Pattern& pattern, std::vector<Corner>& corners) const;
  void sample_side(FaceId face, int c, const Grid& grid, Scratch& scratch) const;
  void sample_inside(FaceId face, const Pattern& pattern, Scratch& scratch);
  Corner corner_of_face(FaceId face, int c) const;
  Corner corner_on_side(FaceId face, int c, int q) const;
  Corner corner_inside(FaceId face, std::size_t n) const;
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

/// The n-th of the pattern's points inside.
Corner Tessellator::corner_inside(FaceId face, std::size_t n) const {
  Corner corner;
  corner.position = static_cast<std::uint32_t>(plan_.face_base() + plan_.face_vertices[face] + n);
  if (!attributes_.normals.empty()) corner.normal = attributes_.normals.interior(face, n);
  if (!attributes_.uvs.empty()) corner.uv = attributes_.uvs.interior(face, n);
  if (!attributes_.colors.empty()) corner.color = attributes_.colors.interior(face, n);
  return corner;
}

/// The output corner of every vertex of the face's pattern.
void Tessellator::name_corners(FaceId face, const Pattern& pattern, std::vector<Corner>& corners) const {
  const PatternChoice& choice = plan_.choices[face];
  const std::uint8_t* const corner_of = kCornerOf[choice.permutation];
  corners.clear();
  for (int b = 0; b < 3; ++b)
    corners.push_back(corner_of_face(face, corner_of[b]));
  for (int b = 0; b < 3; ++b) {
    const int n = 1 << pattern.config.sides[static_cast<std::size_t>(b)];
    // A mirrored pattern's side runs against the face's, which starts where the pattern's ends.
    const int c = choice.mirrored ? corner_of[(b + 1) % 3] : corner_of[b];
    for (int q = 1; q < n; ++q)
      corners.push_back(corner_on_side(face, c, choice.mirrored ? n - q : q));
  }
  for (std::size_t n = 0; n < pattern.vertices.size() - pattern.border(); ++n)
    corners.push_back(corner_inside(face, n));
}

/// The face's grid along side c: the edge's own points where it has as many, else points between them.
void Tessellator::sample_side(FaceId face, int c, const Grid& grid, Scratch& scratch) const {
  const EdgeId id = topology_.face_edges[face][static_cast<std::size_t>(c)];
  const Edge& edge = topology_.edges[id];
  const int n = grid.segments();
  const int t = plan_.edge_level[id];
  scratch.side_curve.resize(static_cast<std::size_t>(n) + 1);
  scratch.side_surface.resize(static_cast<std::size_t>(n) + 1);
  if (t < grid.level) {
    sample_edge(mesh_.positions[edge.v[0]], curves_[id], mesh_.positions[edge.v[1]], levels_[id], grid.level,
                options_.blend, scratch.side_curve, scratch.side_surface);
  } else {
    const std::uint64_t inner = plan_.edge_vertices[id];
    for (int q = 0; q <= n; ++q) {
      const auto at = static_cast<std::size_t>(q);
      scratch.side_curve[at] = scratch.side_surface[at] = mesh_.positions[edge.v[q == 0 ? 0 : 1]];
      if (q == 0 || q == n) continue;
      const std::uint64_t k = inner + (static_cast<std::uint64_t>(q) << (t - grid.level)) - 1;
      scratch.side_curve[at] = edge_curve_points_[k];
      scratch.side_surface[at] = out_.mesh.positions[plan_.edge_base() + k];
    }
  }
  const bool forward = topology_.runs_forward(face, c);
  for (int q = 0; q < n; ++q) {
    const auto at = static_cast<std::size_t>(forward ? q : n - q);
    scratch.patch_points[grid.on_side(c, q)] = scratch.side_curve[at];
    scratch.surface_points[grid.on_side(c, q)] = scratch.side_surface[at];
  }
}

/// Samples the face's grid from the edges' points around it, and keeps what the pattern uses.
void Tessellator::sample_inside(FaceId face, const Pattern& pattern, Scratch& scratch) {
  const Grid& grid = grids_[plan_.face_level[face]];
  scratch.patch_points.resize(grid.vertices.size());
  scratch.surface_points.resize(grid.vertices.size());
  float largest = 0.0f;
  for (int c = 0; c < 3; ++c) {
    largest = std::max(largest, levels_[topology_.face_edges[face][static_cast<std::size_t>(c)]]);
    sample_side(face, c, grid, scratch);
  }
  sample_interior(grid, make_patch(mesh_, topology_, curves_, face, options_.center), largest, options_.blend,
                  scratch.patch_points, scratch.surface_points);
  scratch.inside.clear();
  for (std::size_t n = pattern.border(); n < pattern.vertices.size(); ++n) {
    const PatternVertex v = on_face(pattern.vertices[n], plan_.choices[face].permutation);
    const int finer = v.level - grid.level;
    out_.mesh.positions[scratch.corners[n].position] = scratch.surface_points[grid.index(v.j >> finer, v.k >> finer)];
    scratch.inside.push_back(v);
  }
  attributes_.normals.fill_interior(face, scratch.inside);
  attributes_.uvs.fill_interior(face, scratch.inside);
  attributes_.colors.fill_interior(face, scratch.inside);
}

void Tessellator::fill_face(FaceId face, Scratch& scratch) {
  const PatternChoice& choice = plan_.choices[face];
  const Pattern& pattern = plan_.patterns.at(choice.base);
  name_corners(face, pattern, scratch.corners);
  if (pattern.vertices.size() > pattern.border()) sample_inside(face, pattern, scratch);
  std::uint64_t out = plan_.triangles[face];
  for (const auto& [a, b, c] : pattern.triangles) {
    const Corner& second = scratch.corners[choice.mirrored ? c : b];
    const Corner& third = scratch.corners[choice.mirrored ? b : c];
    put(out++, face, scratch.corners[a], second, third);
  }
  assert(out == plan_.triangles[face + 1]);
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
  Plan plan = make_plan(topology, levels, options.family);
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
