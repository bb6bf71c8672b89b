#include "limn/bake/bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <new>
#include <numeric>

#include "limn/bake/shoot.h"
#include "limn/bake/surface.h"
#include "limn/bake/tangent_space.h"
#include "limn/bake/texel_pass.h"
#include "limn/bake/tiles.h"
#include "limn/mesh/face_area.h"

namespace limn {
namespace {

using namespace bake_detail;
using Clock = std::chrono::steady_clock;

constexpr float kAllSmooth = 4.0f;  // beyond π: no crease splits the normals that rays follow

double since_ms(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

tl::unexpected<Error> out_of_range(std::string message, std::string remedy) {
  return fail(ErrorCode::kInvalidArgument, std::move(message), std::move(remedy));
}

Result<void> check_options(const BakeOptions& options) {
  if (options.size_px < 4 || options.size_px > 16384)
    return out_of_range(fmt::format("a size of {} texels", options.size_px), "sizes from 4 to 16384 are baked");
  if (options.samples != 1 && options.samples != 4 && options.samples != 16)
    return out_of_range(fmt::format("{} samples a texel", options.samples), "take 1, 4 or 16");
  if (options.clean_mip_level < -1 || options.clean_mip_level > 8)
    return out_of_range(fmt::format("mip level {}", options.clean_mip_level), "take -1 (automatic) to 8");
  if (options.gutter_px < 0 || options.gutter_px > 1024)
    return out_of_range(fmt::format("a gutter of {} texels", options.gutter_px), "take 0 to 1024");
  if (!(options.most_stretch == 0.0 || options.most_stretch >= 1.0))
    return out_of_range(fmt::format("a stretch of {}", options.most_stretch), "take 0, or 1 and more");
  if (!(options.max_distance >= 0.0) || !(options.occlusion_distance >= 0.0))
    return out_of_range("a negative distance", "take 0 for no bound");
  if (options.occlusion_rays < 1 || options.occlusion_rays > 65536)
    return out_of_range(fmt::format("{} occlusion rays", options.occlusion_rays), "take 1 to 65536");
  return {};
}

Result<void> check_mesh(const Mesh& mesh, const char* which) {
  if (mesh.faces.empty())
    return fail(ErrorCode::kUnsuitable, fmt::format("the {} mesh has no faces", which), "give a triangle mesh");
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (const VertexId v : mesh.faces[face]) {
      if (is_finite(mesh.positions[v])) continue;
      return fail_at(ErrorCode::kUnsuitable, {}, fmt::format("face {}", face),
                     fmt::format("a coordinate of the {} mesh is not finite", which), "repair the mesh");
    }
  }
  return {};
}

/// The mesh that maps are drawn on: coordinates chosen, normals made.
Result<TexelMap> lay_out(const BakeOptions& options, BakedMaps& maps) {
  Mesh& mesh = maps.mesh;
  const bool own = options.layout == BakeLayout::kOwnUvs || (options.layout == BakeLayout::kAuto && !mesh.uvs.empty());
  if (own && mesh.uvs.empty()) {
    return fail(ErrorCode::kUnsuitable, "the low mesh has no texture coordinates", "let tiles be made for it");
  }
  if (own) {
    Result<TexelMap> texels = uv_texels(mesh, options.size_px, options.gutter_px);
    if (texels) maps.report.overlapping_texels = texels->overlapping;
    return texels;
  }
  const Result<TileLayout> layout = plan_tiles(mesh.faces.size(), options.size_px, options.clean_mip_level);
  if (!layout) return tl::unexpected(layout.error());
  mesh.uvs = tile_uvs(mesh, *layout);
  maps.report.tile_px = layout->tile_px;
  maps.report.leg_px = layout->leg_px;
  maps.report.clean_mip_level = layout->clean_mip_level;
  return tile_texels(mesh, mesh.uvs, *layout);
}

std::vector<LowFace> low_faces(const BakedMaps& maps, const TexelMap& texels, const UnitFrame& frame) {
  const Mesh& mesh = maps.mesh;
  std::vector<LowFace> faces(mesh.faces.size());
  for (FaceId f = 0; f < faces.size(); ++f) {
    LowFace& face = faces[f];
    for (int c = 0; c < 3; ++c) {
      const auto corner = static_cast<std::size_t>(c);
      face.position[c] = frame.inside(mesh.positions[mesh.faces[f][corner]]);
      face.normal[c] = mesh.corner(mesh.normals, f, c);
      if (!maps.tangents.empty()) face.tangent[c] = maps.tangents[3 * std::size_t{f} + corner];
    }
    const double texel_area = texels.frames[f].area();
    const double area = 0.5 * glm::length(twice_area_vector(mesh, f));
    face.footprint = texel_area > 0.0 ? static_cast<float>(std::sqrt(area / texel_area)) : 0.0f;
  }
  return faces;
}

FloatImage filled(int size_px, std::initializer_list<float> value) {
  FloatImage image(size_px, size_px, static_cast<int>(value.size()));
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = value.begin()[i % value.size()];
  return image;
}

void make_room(const BakeOptions& options, BakedMaps& maps) {
  const int size = options.size_px;
  if (options.maps.object_normals) maps.object_normals = filled(size, {0, 0, 1});
  if (options.maps.tangent_normals) maps.tangent_normals = filled(size, {0, 0, 1});
  if (options.maps.colors) maps.colors = filled(size, {0, 0, 0, 0});
  if (options.maps.displacement) maps.displacement = filled(size, {0});
  if (options.maps.occlusion) maps.occlusion = filled(size, {1});
  if (options.maps.positions) maps.positions = filled(size, {0, 0, 0});
}

UnitFrame frame_of(const Mesh& high, const Mesh& low) {
  Bounds bounds = face_bounds(high);
  const Bounds others = face_bounds(low);
  bounds.add(others.low);
  bounds.add(others.high);
  return UnitFrame(bounds);
}

Result<BakedMaps> bake_checked(const Mesh& high, const Mesh& low, const BakeOptions& options) {
  BakedMaps maps;
  maps.mesh = low;
  maps.mesh.materials.clear();
  maps.mesh.face_materials.clear();
  maps.mesh.colors = {};
  maps.mesh.tags.clear();
  Result<TexelMap> texels = lay_out(options, maps);
  if (!texels) return tl::unexpected(texels.error());
  maps.mesh.normals = usable_normals(low, kAllSmooth);
  if (options.maps.tangent_normals) maps.tangents = mikk_tangents(maps.mesh, maps.mesh.normals);
  make_room(options, maps);

  if (!report(options.progress, "preparing", 0.0)) return fail(ErrorCode::kCancelled, "baking was stopped");
  auto begun = Clock::now();
  const UnitFrame frame = frame_of(high, low);
  const Result<Target> target = Target::build(high, frame);
  if (!target) return tl::unexpected(target.error());
  const Result<Surface> surface = Surface::build(high, options.maps.colors);
  if (!surface) return tl::unexpected(surface.error());
  maps.report.build_ms = since_ms(begun);
  maps.report.embree = target->uses_embree();

  begun = Clock::now();
  const std::vector<LowFace> faces = low_faces(maps, *texels, frame);
  const Result<void> done = fill_texels({frame, *target, *surface, *texels, faces, options}, maps);
  if (!done) return tl::unexpected(done.error());
  maps.report.shoot_ms = since_ms(begun);
  maps.owner = std::move(texels->owner);
  return maps;
}

}  // namespace

Result<BakedMaps> bake(const Mesh& high, const Mesh& low, const BakeOptions& options) try {
  if (Result<void> good = check_options(options); !good) return tl::unexpected(good.error());
  if (Result<void> good = check_mesh(high, "high"); !good) return tl::unexpected(good.error());
  if (Result<void> good = check_mesh(low, "low"); !good) return tl::unexpected(good.error());
  return bake_checked(high, low, options);
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kUnsuitable, "not enough memory for the maps", "take a smaller size");
}

Result<Mesh> mesh_with_maps(const BakedMaps& maps, const BakedMaterialOptions& options) {
  Mesh mesh = maps.mesh;
  if (!maps.tangents.empty()) {
    mesh.tangents.values = maps.tangents;
    mesh.tangents.indices.resize(maps.tangents.size());
    std::iota(mesh.tangents.indices.begin(), mesh.tangents.indices.end(), 0u);
  }
  Material material;
  material.name = options.name;
  const auto attach = [&](const FloatImage& map, const ChannelCoding& coding, std::vector<std::byte>& image,
                          std::string& mime) -> Result<void> {
    if (map.empty()) return {};
    const Result<std::string> png =
        options.deep ? encode_png(to_16_bit(map, coding)) : encode_png(to_8_bit(map, coding));
    if (!png) return tl::unexpected(png.error());
    const auto bytes = std::as_bytes(std::span(png->data(), png->size()));
    image.assign(bytes.begin(), bytes.end());
    mime = "image/png";
    return {};
  };
  if (auto done = attach(maps.tangent_normals, kVectorCoding, material.normal_image, material.normal_image_mime); !done)
    return tl::unexpected(done.error());
  if (auto done = attach(maps.colors, kColorCoding, material.base_color_image, material.base_color_image_mime); !done)
    return tl::unexpected(done.error());
  if (!maps.colors.empty()) material.base_color = Vec4(1.0f);
  mesh.materials = {std::move(material)};
  mesh.face_materials.clear();
  return mesh;
}

}  // namespace limn
