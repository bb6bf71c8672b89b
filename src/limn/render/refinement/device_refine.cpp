#include "limn/render/refinement/device_refine.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <utility>

#include "limn/mesh/topology.h"
#include "limn/render/picture.h"
#include "limn/render/refinement/edge_levels.h"
#include "limn/render/refinement/pattern_buffers.h"
#include "limn/render/refinement/pattern_selection.h"
#include "limn/render/refinement/stored_surface.h"

namespace limn {
namespace {

constexpr float kSameAttribute = 1e-5f;

void scale_positions(Mesh& mesh, double factor) {
  for (Vec3& p : mesh.positions)
    p = scaled(p, factor);
}

View scaled_view(View view, double factor) {
  if (view.eye.orthographic) {
    view.pixels_per_unit = static_cast<float>(double{view.pixels_per_unit} / factor);
  } else {
    view.eye.at = scaled(view.eye.at, factor);
  }
  return view;
}

template <class T>
bool same(const T& a, const T& b) {
  return glm::length(a - b) <= kSameAttribute;
}

/// Gives corners at one point one value where theirs agree. \param point_of  for each value the point it lies at
template <class T>
void share_values(CornerAttribute<T>& attribute, const std::vector<Triangle>& corners,
                  const std::vector<VertexId>& point_of) {
  if (attribute.empty()) return;
  std::vector<std::uint32_t> kept_of(attribute.values.size());
  std::vector<std::uint32_t> first(attribute.values.size(), kInvalidId), next;  // lists of what each point keeps
  std::vector<T> kept;
  for (std::size_t v = 0; v < attribute.values.size(); ++v) {
    std::uint32_t at = first[point_of[v]];
    while (at != kInvalidId && !same(kept[at], attribute.values[v]))
      at = next[at];
    if (at == kInvalidId) {
      at = static_cast<std::uint32_t>(kept.size());
      kept.push_back(attribute.values[v]);
      next.push_back(std::exchange(first[point_of[v]], at));
    }
    kept_of[v] = at;
  }
  attribute.values = std::move(kept);
  attribute.indices.reserve(3 * corners.size());
  for (const Triangle& corner : corners) {
    for (const VertexId v : corner)
      attribute.indices.push_back(kept_of[v]);
  }
}

/// Joins the faces' own vertices by exact position.
void join(Mesh& mesh) {
  const std::vector<VertexId> weld = weld_positions(mesh.positions);
  const std::vector<Triangle> corners = mesh.faces;
  share_values(mesh.normals, corners, weld);
  share_values(mesh.uvs, corners, weld);
  share_values(mesh.colors, corners, weld);
  std::vector<VertexId> name(weld.size(), kInvalidId);
  std::vector<Vec3> positions;
  for (Triangle& face : mesh.faces) {
    for (VertexId& v : face) {
      VertexId& id = name[weld[v]];
      if (id == kInvalidId) {
        id = static_cast<VertexId>(positions.size());
        positions.push_back(mesh.positions[weld[v]]);
      }
      v = id;
    }
  }
  mesh.positions = std::move(positions);
}

void report_levels(const Topology& topology, const std::vector<std::uint16_t>& units, Refinement& result) {
  for (const std::uint16_t level : units)
    result.edge_levels.push_back(static_cast<float>(level) * kLevelUnit);
  for (const auto& edges : topology.face_edges) {
    float largest = 0.0f;
    if (edges[0] != kInvalidId) {
      for (const EdgeId e : edges)
        largest = std::max(largest, result.edge_levels[e]);
    }
    result.face_level.push_back(static_cast<std::uint8_t>(std::ceil(largest)));
    result.refined_faces += largest > 0.0f ? 1 : 0;
  }
}

}  // namespace

Result<Refinement> refine_on_device(gl::Context& context, const Mesh& mesh, const View& view,
                                    const RefineOptions& options) {
  // What the CPU would refuse for its size is refused here too, though it would fit once scaled.
  if (auto fit = check_extent(mesh); !fit) return tl::unexpected(fit.error());
  const double diagonal = face_bounds(mesh).diagonal();
  const double factor = diagonal > 0.0 && std::isfinite(diagonal) ? unit_scale(diagonal) : 1.0;
  Mesh near_unit = mesh;
  scale_positions(near_unit, factor);
  const auto refiner = Refiner::create(std::move(near_unit), options);
  if (!refiner) return tl::unexpected(refiner.error());
  const View unit_view = scaled_view(view, factor);
  LevelOptions levels_asked = options.levels;
  levels_asked.near_distance = static_cast<float>(double{levels_asked.near_distance} * factor);
  levels_asked.far_distance = static_cast<float>(double{levels_asked.far_distance} * factor);
  if (auto good = check_levels(refiner->mesh(), unit_view, levels_asked); !good) return tl::unexpected(good.error());

  auto scene = RefinementScene::create(context, *refiner, {.center = options.center});
  if (!scene) return tl::unexpected(scene.error());
  const auto levels = EdgeLevelPass::create(*scene, levels_asked);
  if (!levels) return tl::unexpected(levels.error());
  const auto patterns = PatternBuffers::create(pattern_table(options.family, levels_asked.max_level), true);
  if (!patterns) return tl::unexpected(patterns.error());
  const auto selection = PatternSelection::create(*scene, options.family, *patterns, levels_asked.max_level);
  if (!selection) return tl::unexpected(selection.error());
  scene->set_view(unit_view);
  levels->run();
  selection->run(*levels, 0);
  const std::uint64_t triangles = selection->triangle_count();
  if (triangles > options.max_triangles) {
    return fail(ErrorCode::kUnsuitable,
                fmt::format("refinement would give {} triangles, more than {}", triangles, options.max_triangles),
                "lower the maximal level or raise the tolerance");
  }
  const auto stored = StoredSurface::create(
      *scene, *patterns, *selection,
      {.family = options.family, .blend = options.blend, .max_triangles = static_cast<std::size_t>(triangles)});
  if (!stored) {
    return fail(ErrorCode::kNoGraphics,
                fmt::format("the graphics device has no room for {} refined triangles", triangles),
                "lower the maximal level, or refine on the CPU");
  }
  stored->run(*levels, *selection);
  Refinement result;
  result.mesh = stored->read(*selection);
  join(result.mesh);
  scale_positions(result.mesh, 1.0 / factor);
  result.mesh.materials = mesh.materials;
  report_levels(refiner->topology(), levels->read(0), result);
  return result;
}

}  // namespace limn
