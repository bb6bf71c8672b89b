#include "limn/render/clip/clip_model.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <new>
#include <string>
#include <unordered_map>

#include "limn/mesh/normals.h"
#include "limn/render/clip/hull_shell.h"
#include "limn/render/picture.h"
#include "limn/silhouette/search/leaf_partition.h"

namespace limn {
namespace {

Mesh scaled_mesh(const Mesh& mesh, double scale) {
  Mesh result = mesh;
  if (scale == 1.0) return result;
  for (Vec3& p : result.positions)
    p = scaled(p, scale);
  return result;
}

/// Every face's corners.
std::vector<HullVertex> corners_of(const Mesh& mesh, const CornerAttribute<Vec3>& normals) {
  std::vector<HullVertex> corners(3 * mesh.face_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = static_cast<FaceId>(f);
    for (int c = 0; c < 3; ++c) {
      HullVertex& corner = corners[3 * f + static_cast<std::size_t>(c)];
      corner.position = mesh.positions[mesh.faces[f][static_cast<std::size_t>(c)]];
      corner.normal = mesh.corner(normals, face, c);
      if (!mesh.uvs.empty()) corner.uv = mesh.corner(mesh.uvs, face, c);
      if (!mesh.colors.empty()) corner.color = mesh.corner(mesh.colors, face, c);
      if (!mesh.face_materials.empty()) corner.material = mesh.face_materials[f];
    }
  }
  return corners;
}

/// Equal corners once each, in order of first use.
struct IndexedCorners {
  std::vector<HullVertex> vertices;
  std::vector<std::uint32_t> indices;
};

IndexedCorners index_corners(const std::vector<HullVertex>& corners) {
  struct Hash {
    std::size_t operator()(const std::string& bytes) const { return std::hash<std::string>()(bytes); }
  };
  IndexedCorners result;
  std::unordered_map<std::string, std::uint32_t, Hash> known;
  for (const HullVertex& corner : corners) {
    const std::string key(reinterpret_cast<const char*>(&corner), sizeof(corner));
    const auto [found, added] = known.emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
    if (added) result.vertices.push_back(corner);
    result.indices.push_back(found->second);
  }
  return result;
}

/// Attributes of HullVertex, as clip_surface.vert.glsl reads them.
void attach_surface(const gl::VertexArray& array) {
  const struct {
    unsigned location;
    int components;
    unsigned offset;
  } floats[] = {{0, 3, 0}, {1, 3, 12}, {2, 2, 24}, {3, 4, 32}};
  for (const auto& attribute : floats) {
    glEnableVertexArrayAttrib(array.id(), attribute.location);
    glVertexArrayAttribFormat(array.id(), attribute.location, attribute.components, GL_FLOAT, GL_FALSE,
                              attribute.offset);
    glVertexArrayAttribBinding(array.id(), attribute.location, 0);
  }
  glEnableVertexArrayAttrib(array.id(), 4);
  glVertexArrayAttribIFormat(array.id(), 4, 1, GL_UNSIGNED_INT, 48);
  glVertexArrayAttribBinding(array.id(), 4, 0);
}

void attach_positions(const gl::VertexArray& array) {
  glEnableVertexArrayAttrib(array.id(), 0);
  glVertexArrayAttribFormat(array.id(), 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array.id(), 0, 0);
}

/// Without mip levels: neighbouring tiles belong to faces far apart, and a level coarser than a tile's gutter mixes
/// them, which shows as dots along the hull's edges.
void filter(const gl::Texture& texture) {
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

gl::Texture upload_picture(const Image& image, GLenum format) {
  if (image.rgba.empty()) return {};
  gl::Texture texture = gl::make_texture_2d(format, image.width, image.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  filter(texture);
  return texture;
}

tl::unexpected<Error> not_closed(const std::string& what) {
  return fail(ErrorCode::kUnsuitable, what + " is not closed",
              "clip assets hold closed meshes; limn clip closes what it is given");
}

}  // namespace

Result<void> ClipModel::add_level(const SilhouetteLevel& level) {
  const Mesh mesh = scaled_mesh(level.mesh, unit_scale_);
  const std::string name = "silhouette " + std::to_string(levels_.size());
  if (mesh.faces.empty()) return fail(ErrorCode::kUnsuitable, name + " of the asset has no faces");
  const Topology topology = build_topology(mesh);
  if (!is_closed(topology)) return not_closed(name + " of the asset");
  std::vector<Plane> planes = face_planes(mesh);
  const std::optional<std::vector<LeafCluster>> stored = partition_clusters(level.leaf_of_edge, topology);
  const std::vector<LeafCluster> leaves = stored ? *stored : leaf_clusters(mesh, topology, planes);
  SilhouetteExtractor extractor(mesh, topology, planes, SearchMethod::kAuto, leaves);
  StencilLoopBuilder loops(mesh, topology, planes);
  EdgeOnFaces edge_on(mesh, leaves, planes);
  // Moving a vector keeps its memory, which the extractor refers to.
  auto made = std::make_unique<ClipLevel>(
      ClipLevel{std::move(planes), std::move(extractor), std::move(loops), std::move(edge_on), 0, {}, {}, {}, 0});
  made->error = static_cast<float>(double{level.error} * unit_scale_);
  made->positions = gl::make_buffer_of(std::span<const Vec3>(mesh.positions));
  made->faces = gl::make_buffer_of(std::span<const Triangle>(mesh.faces));
  made->array = gl::make_vertex_array();
  attach_positions(made->array);
  glVertexArrayVertexBuffer(made->array.id(), 0, made->positions.id(), 0, sizeof(Vec3));
  glVertexArrayElementBuffer(made->array.id(), made->faces.id());
  made->face_count = mesh.face_count();
  levels_.push_back(std::move(made));
  if (levels_.size() == 1) original_mesh_ = mesh;
  return {};
}

Result<void> ClipModel::add_hull(const ClipAsset& asset) {
  const Mesh hull = scaled_mesh(asset.hull, unit_scale_);
  if (hull.faces.empty()) return fail(ErrorCode::kUnsuitable, "the asset's hull has no faces");
  const Topology topology = build_topology(hull);
  if (!is_closed(topology)) return not_closed("the asset's hull");
  constexpr float kSmooth = 3.2f;  // all of a vertex in one: what an asset without normals gets
  const std::vector<HullVertex> corners =
      corners_of(hull, hull.normals.empty() ? crease_normals(hull, topology, kSmooth) : hull.normals);
  if (!asset.maps.normals.rgba.empty() && !asset.maps.displacement.empty() && !hull.uvs.empty() &&
      !hull.normals.empty())
    add_shell(hull, corners);
  const IndexedCorners indexed = index_corners(corners);
  hull_vertices_ = gl::make_buffer_of(std::span<const HullVertex>(indexed.vertices));
  hull_indices_ = gl::make_buffer_of(std::span<const std::uint32_t>(indexed.indices));
  hull_index_count_ = indexed.indices.size();
  hull_array_ = gl::make_vertex_array();
  attach_surface(hull_array_);
  glVertexArrayVertexBuffer(hull_array_.id(), 0, hull_vertices_.id(), 0, sizeof(HullVertex));
  glVertexArrayElementBuffer(hull_array_.id(), hull_indices_.id());
  std::vector<std::uint32_t> strips;
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    for (const std::uint32_t corner : {0u, 1u, 2u, 2u, 1u, 3u})
      strips.push_back(4 * e + corner);
  }
  rim_indices_ = gl::make_buffer_of(std::span<const std::uint32_t>(strips));
  rim_array_ = gl::make_vertex_array();
  attach_surface(rim_array_);
  glVertexArrayElementBuffer(rim_array_.id(), rim_indices_.id());
  rim_ = HullRim(topology, face_planes(hull), corners);
  locator_ = EyeLocator(hull, bounds_);
  auto materials = MaterialTable::create(asset.hull);
  if (!materials) return tl::unexpected(materials.error());
  materials_ = std::make_unique<MaterialTable>(std::move(*materials));
  Mesh plain;
  if (!asset.hull.materials.empty()) plain.materials = {asset.hull.materials.front()};
  auto plain_material = MaterialTable::create(plain);
  if (!plain_material) return tl::unexpected(plain_material.error());
  plain_material_ = std::make_unique<MaterialTable>(std::move(*plain_material));
  return {};
}

void ClipModel::add_shell(const Mesh& hull, const std::vector<HullVertex>& corners) {
  shell_.faces = gl::make_buffer_of(std::span<const ShellFace>(shell_faces(hull)));
  shell_.corners = gl::make_buffer_of(std::span<const HullVertex>(corners));
  shell_.array = gl::make_vertex_array();
  attach_surface(shell_.array);
  glVertexArrayVertexBuffer(shell_.array.id(), 0, shell_.corners.id(), 0, sizeof(HullVertex));
  shell_.face_count = hull.face_count();
}

void ClipModel::add_maps(const DetailMaps& maps) {
  normals_ = upload_picture(maps.normals, GL_RGBA8);
  colors_ = upload_picture(maps.colors, GL_SRGB8_ALPHA8);
  if (maps.displacement.empty()) return;
  const int width = maps.displacement_width, height = maps.displacement_height;
  displacement_ = gl::make_texture_2d(GL_R16, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  glTextureSubImage2D(displacement_.id(), 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_SHORT, maps.displacement.data());
  filter(displacement_);
  displacement_low_ = static_cast<float>(double{maps.displacement_low} * unit_scale_);
  displacement_high_ = static_cast<float>(double{maps.displacement_high} * unit_scale_);
}

Result<ClipModel> ClipModel::create(gl::Context& context, const ClipAsset& asset) try {
  context.make_current();
  gl::take_out_of_memory();
  if (asset.levels.empty()) return fail(ErrorCode::kUnsuitable, "the asset has no silhouette");
  ClipModel model;
  const Bounds bounds = asset.bounds.empty() ? face_bounds(asset.levels.front().mesh) : asset.bounds;
  const double size = face_bounds(asset.levels.front().mesh).diagonal();
  model.unit_scale_ = size > 0 ? limn::unit_scale(size) : 1.0;
  model.bounds_.add(scaled(bounds.low, model.unit_scale_));
  model.bounds_.add(scaled(bounds.high, model.unit_scale_));
  for (const SilhouetteLevel& level : asset.levels) {
    if (auto added = model.add_level(level); !added) return tl::unexpected(added.error());
  }
  if (auto added = model.add_hull(asset); !added) return tl::unexpected(added.error());
  model.add_maps(asset.maps);
  model.loop_array_ = gl::make_vertex_array();
  attach_positions(model.loop_array_);
  if (gl::take_out_of_memory()) return fail(ErrorCode::kNoGraphics, "the graphics device has no memory for the asset");
  return model;
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kNoGraphics, "not enough memory for the asset");
}

const ClipOriginal& ClipModel::original() {
  if (original_) return *original_;
  constexpr float kSmooth = 3.2f;
  const Topology topology = build_topology(original_mesh_);
  const std::vector<HullVertex> corners = corners_of(original_mesh_, crease_normals(original_mesh_, topology, kSmooth));
  original_.emplace();
  original_->vertices = gl::make_buffer_of(std::span<const HullVertex>(corners));
  original_->array = gl::make_vertex_array();
  attach_surface(original_->array);
  glVertexArrayVertexBuffer(original_->array.id(), 0, original_->vertices.id(), 0, sizeof(HullVertex));
  original_->vertex_count = corners.size();
  return *original_;
}

std::size_t ClipModel::memory_bytes() const {
  std::size_t sum = 0;
  for (const auto& level : levels_)
    sum += level->extractor.memory_bytes() + level->loops.memory_bytes() + level->edge_on.memory_bytes() +
           level->planes.size() * sizeof(Plane);
  return sum;
}

}  // namespace limn
