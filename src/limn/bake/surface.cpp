#include "limn/bake/surface.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/mesh/face_area.h"
#include "limn/mesh/normals.h"

namespace limn::bake_detail {
namespace {

constexpr float kCreaseRad = 1.0471976f;  // 60°, as refinement takes it

template <class T>
T interpolated(const T& a, const T& b, const T& c, const FacePoint& at) {
  using Scalar = typename T::value_type;
  const Scalar u = at.u, v = at.v;
  return a * (Scalar(1) - u - v) + b * u + c * v;
}

bool usable(const Vec3& normal) {
  const float length = glm::dot(normal, normal);
  return length > 1e-12f && std::isfinite(length);
}

Vec3 face_normal(const Mesh& mesh, FaceId face) {
  const DVec3 area = twice_area_vector(mesh, face);
  const double length = glm::length(area);
  return length > 0.0 && std::isfinite(length) ? Vec3(area / length) : Vec3(0, 0, 1);
}

/// The material of a face; -1 for none.
int material_of(const Mesh& mesh, FaceId face) {
  if (mesh.materials.empty()) return -1;
  const std::uint32_t material = mesh.face_materials.empty() ? 0 : mesh.face_materials[face];
  return material < mesh.materials.size() ? static_cast<int>(material) : -1;
}

float density(const Mesh& mesh, FaceId face, const PicturePyramid& picture) {
  const glm::dvec2 size(picture.width(), picture.height());
  const glm::dvec2 a = glm::dvec2(mesh.corner(mesh.uvs, face, 0)) * size;
  const glm::dvec2 e1 = glm::dvec2(mesh.corner(mesh.uvs, face, 1)) * size - a;
  const glm::dvec2 e2 = glm::dvec2(mesh.corner(mesh.uvs, face, 2)) * size - a;
  const double area = glm::length(twice_area_vector(mesh, face));
  const double pixels = std::abs(e1.x * e2.y - e1.y * e2.x);
  return area > 0.0 ? static_cast<float>(std::sqrt(pixels / area)) : 0.0f;
}

}  // namespace

CornerAttribute<Vec3> usable_normals(const Mesh& mesh, float crease_angle_rad) {
  CornerAttribute<Vec3> normals =
      mesh.normals.empty() ? crease_normals(mesh, build_topology(mesh), crease_angle_rad) : mesh.normals;
  std::vector<std::uint32_t> indices = normals.indices;
  bool changed = false;
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t index = mesh.corner_index(normals, face, c);
      if (usable(normals.values[index])) continue;
      if (!changed && indices.empty()) {
        for (const Triangle& t : mesh.faces)
          indices.insert(indices.end(), t.begin(), t.end());
      }
      changed = true;
      indices[3 * std::size_t{face} + static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(normals.values.size());
      normals.values.push_back(face_normal(mesh, face));
    }
  }
  if (changed) normals.indices = std::move(indices);
  return normals;
}

Result<Surface> Surface::build(const Mesh& mesh, bool colors) {
  Surface surface;
  surface.mesh_ = &mesh;
  const CornerAttribute<Vec3> normals = usable_normals(mesh, kCreaseRad);
  surface.normals_.resize(mesh.faces.size());
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (int c = 0; c < 3; ++c)
      surface.normals_[face].normal[c] = mesh.corner(normals, face, c);
  }
  if (!colors) return surface;
  surface.pictures_.resize(mesh.materials.size());
  for (std::size_t m = 0; m < mesh.materials.size() && !mesh.uvs.empty(); ++m) {
    const Material& material = mesh.materials[m];
    if (material.base_color_image.empty()) continue;
    Result<Image> picture = decode_image(material.base_color_image, "material \"" + material.name + "\"");
    if (!picture) {
      picture.error().code = ErrorCode::kUnsuitable;
      return tl::unexpected(picture.error());
    }
    surface.pictures_[m] = PicturePyramid(std::move(*picture));
  }
  surface.picture_density_.assign(mesh.faces.size(), 0.0f);
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    const int material = material_of(mesh, face);
    if (material < 0 || surface.pictures_[static_cast<std::size_t>(material)].empty()) continue;
    surface.picture_density_[face] = density(mesh, face, surface.pictures_[static_cast<std::size_t>(material)]);
  }
  return surface;
}

void Surface::normals(std::span<const FacePoint> places, Vec3* normals) const {
  constexpr std::size_t kRoom = 64;
  assert(places.size() <= kRoom);
  float x[kRoom], y[kRoom], z[kRoom], length[kRoom];
  // Places are anywhere in memory: all are on their way before the first is needed.
  for (const FacePoint& at : places)
    __builtin_prefetch(&normals_[at.face]);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Corners& corners = normals_[places[i].face];
    const float u = places[i].u, v = places[i].v, w = 1.0f - u - v;
    x[i] = corners.normal[0].x * w + corners.normal[1].x * u + corners.normal[2].x * v;
    y[i] = corners.normal[0].y * w + corners.normal[1].y * u + corners.normal[2].y * v;
    z[i] = corners.normal[0].z * w + corners.normal[1].z * u + corners.normal[2].z * v;
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    length[i] = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
  for (std::size_t i = 0; i < places.size(); ++i)
    normals[i] = length[i] > 1e-6f ? Vec3(x[i], y[i], z[i]) * (1.0f / length[i]) : face_normal(*mesh_, places[i].face);
}

Vec4 Surface::color(const FacePoint& at, float footprint) const {
  Vec4 color(1.0f);
  const int material = material_of(*mesh_, at.face);
  if (material >= 0) {
    color = mesh_->materials[static_cast<std::size_t>(material)].base_color;
    const PicturePyramid& picture = pictures_[static_cast<std::size_t>(material)];
    if (!picture.empty()) {
      const Vec2 uv = interpolated(mesh_->corner(mesh_->uvs, at.face, 0), mesh_->corner(mesh_->uvs, at.face, 1),
                                   mesh_->corner(mesh_->uvs, at.face, 2), at);
      const float pixels = footprint * picture_density_[at.face];
      color *= picture.sample(uv, pixels > 1.0f ? std::log2(pixels) : 0.0f);
    }
  }
  if (!mesh_->colors.empty()) {
    color *= interpolated(mesh_->corner(mesh_->colors, at.face, 0), mesh_->corner(mesh_->colors, at.face, 1),
                          mesh_->corner(mesh_->colors, at.face, 2), at);
  }
  return color;
}

Vec3 Surface::position(const FacePoint& at) const {
  const Triangle& t = mesh_->faces[at.face];
  return Vec3(
      interpolated(DVec3(mesh_->positions[t[0]]), DVec3(mesh_->positions[t[1]]), DVec3(mesh_->positions[t[2]]), at));
}

}  // namespace limn::bake_detail
