#include "limn/asset/build.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "limn/asset/asset_layout.h"
#include "limn/asset/silhouette_levels.h"
#include "limn/image/deep_image.h"
#include "limn/mesh/vertex_mesh.h"

namespace limn {
namespace {

class Clock {
 public:
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(begun_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

bool has_colors(const Mesh& mesh) {
  return !mesh.colors.empty() || std::any_of(mesh.materials.begin(), mesh.materials.end(), [&mesh](const Material& m) {
    return mesh.materials.size() > 1 || !m.base_color_image.empty();
  });
}

Result<BakedMaps> bake_maps(const Mesh& original, const Mesh& hull, const ClipOptions& options) {
  BakeOptions baking;
  baking.maps = {.object_normals = options.maps.normals,
                 .tangent_normals = true,
                 .colors = options.maps.colors && has_colors(original),
                 .displacement = options.maps.displacement};
  baking.layout = BakeLayout::kTiles;  // a hull's own coordinates may overlap
  baking.size_px = options.size_px;
  baking.samples = options.samples;
  baking.progress = options.progress;
  return bake(original, hull, baking);
}

DetailMaps detail_maps(const BakedMaps& baked) {
  DetailMaps maps;
  if (!baked.object_normals.empty()) maps.normals = to_8_bit(baked.object_normals, kVectorCoding);
  if (!baked.colors.empty()) maps.colors = to_8_bit(baked.colors, kColorCoding);
  if (baked.displacement.empty()) return maps;
  const ChannelCoding coding = range_of(baked.displacement, 0);
  maps.displacement = to_16_bit(baked.displacement, coding).values;
  maps.displacement_width = baked.displacement.width;
  maps.displacement_height = baked.displacement.height;
  maps.displacement_low = coding.low;
  maps.displacement_high = coding.high;
  return maps;
}

/// One value a vertex, and texture coordinates that survive being turned upside down and back, as glTF has them.
Mesh as_read_back(const Mesh& mesh) {
  VertexMesh vertices = one_value_per_vertex(mesh);
  Mesh settled;
  settled.positions = std::move(vertices.positions);
  settled.faces = std::move(vertices.faces);
  settled.normals.values = std::move(vertices.normals);
  settled.uvs.values = std::move(vertices.uvs);
  settled.tangents.values = std::move(vertices.tangents);
  for (Vec2& uv : settled.uvs.values)
    uv.y = 1.0f - (1.0f - uv.y);
  settled.materials = mesh.materials;
  return settled;
}

Result<Mesh> dressed_hull(const BakedMaps& baked, const Mesh& original) {
  Result<Mesh> mesh = mesh_with_maps(baked, {.deep = false, .name = "hull"});
  if (!mesh) return mesh;
  Mesh hull = as_read_back(*mesh);
  // Of several materials none is right everywhere: their colours are in the map.
  if (original.materials.size() <= 1 && !hull.materials.empty()) {
    const Material from = original.materials.empty() ? plain_material(original) : original.materials[0];
    if (baked.colors.empty()) hull.materials[0].base_color = from.base_color;
    hull.materials[0].metallic = from.metallic;
    hull.materials[0].roughness = from.roughness;
  }
  return hull;
}

Result<void> check(const ClipOptions& options) {
  if (options.levels < 1 || options.levels > asset::kMostLevels)
    return fail(ErrorCode::kInvalidArgument, "the number of silhouettes must be 1 to 32");
  if (options.faces < 4) return fail(ErrorCode::kInvalidArgument, "a hull has 4 faces at least");
  return {};
}

}  // namespace

Result<BuiltClipAsset> build_clip_asset(const Mesh& original, const ClipOptions& options) {
  if (const Result<void> good = check(options); !good) return tl::unexpected(good.error());
  BuiltClipAsset built;
  Clock clock;
  // Without texture coordinates: the hull's maps have their own, and nobody need hear what became of the original's.
  Mesh surface;
  surface.positions = original.positions;
  surface.faces = original.faces;
  Result<Hull> hull = build_hull(
      surface, {.faces = options.faces, .strict = options.strict, .keep_steps = true, .progress = options.progress});
  if (!hull) return tl::unexpected(hull.error());
  built.report.hull_ms = clock.lap_ms();
  Result<std::vector<SilhouetteLevel>> levels = asset::silhouette_levels(*hull, options.levels, options.progress);
  if (!levels) return tl::unexpected(levels.error());
  built.report.silhouettes_ms = clock.lap_ms();
  for (const SilhouetteLevel& level : *levels) {
    if (!std::isfinite(level.error))
      return fail(ErrorCode::kUnsuitable, "the mesh is too large for its silhouettes' errors to be told",
                  "scale it down");
  }
  const Mesh low = std::move(hull->mesh);
  built.report.hull = std::move(hull->report);
  built.report.notes = built.report.hull.notes;
  hull = Hull{};  // its steps are as large as the original
  const Result<BakedMaps> baked = bake_maps(original, low, options);
  if (!baked) return tl::unexpected(baked.error());
  Result<Mesh> dressed = dressed_hull(*baked, original);
  if (!dressed) return tl::unexpected(dressed.error());
  built.asset.hull = *std::move(dressed);
  built.asset.levels = *std::move(levels);
  built.asset.maps = detail_maps(*baked);
  built.asset.bounds = face_bounds(original);
  built.report.bake = baked->report;
  built.report.maps_ms = clock.lap_ms();
  return built;
}

}  // namespace limn
