#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/gltf_document.h"
#include "limn/mesh/formats/gltf_material.h"
#include "limn/mesh/formats/gltf_primitive.h"
#include "limn/mesh/formats/gltf_scene.h"

namespace limn::formats {
namespace gltf {
namespace {

/// Thrown when the caller asked to stop.
struct Cancelled {};

/// How a placement turns stored vertices into those of the model.
class Mover {
 public:
  explicit Mover(const glm::dmat4& matrix) : matrix_(matrix), still_(matrix == glm::dmat4(1.0)) {
    const DVec3 x(matrix[0]), y(matrix[1]), z(matrix[2]);
    // The inverse transpose but for a positive factor; exists for flattening transforms as well.
    const double determinant = glm::dot(x, glm::cross(y, z));
    mirrored_ = determinant < 0.0;
    const double sign = mirrored_ ? -1.0 : 1.0;
    normal_matrix_ = glm::dmat3(sign * glm::cross(y, z), sign * glm::cross(z, x), sign * glm::cross(x, y));
  }

  bool mirrored() const { return mirrored_; }
  Vec3 position(const Vec3& p) const { return still_ ? p : Vec3(DVec3(matrix_ * glm::dvec4(DVec3(p), 1.0))); }
  Vec3 normal(const Vec3& n) const {
    if (still_) return n;
    const DVec3 turned = normal_matrix_ * DVec3(n);
    const double length = std::sqrt(glm::dot(turned, turned));
    return length > 0.0 && std::isfinite(length) ? Vec3(turned / length) : Vec3(0.0f);
  }

 private:
  glm::dmat4 matrix_;
  glm::dmat3 normal_matrix_{1.0};
  bool still_ = false;
  bool mirrored_ = false;
};

/// Merges primitives into one mesh with one value a vertex. Attributes start when the first primitive brings them.
class Merger {
 public:
  explicit Merger(Document& document) : document_(document) {}

  /// Reports from `done` on, for a share `share` of the work. Throws Cancelled.
  void add_mesh(const Placement& placement, double done, double share);
  Mesh finish();

 private:
  /// The first vertex and the number of vertices that were read for a key.
  using Shared = std::map<VertexKey, std::pair<VertexId, std::size_t>>;

  void add_primitive(const Field& primitive, const Mover& mover, Shared& shared);
  VertexId add_vertices(const Vertices& vertices, const Mover& mover, const Field& primitive);
  void add_triangles(const std::vector<Triangle>& triangles, VertexId first, const Mover& mover,
                     const Field& primitive);
  void note_attributes(const Field& primitive);
  void fill_normals();
  void settle_materials();

  Document& document_;
  Mesh mesh_;
  std::vector<std::pair<std::size_t, std::size_t>> flat_;  ///< ranges of faces without normals
  std::vector<std::uint32_t> materials_of_faces_;
  std::size_t without_uvs_ = 0;
  std::size_t without_colors_ = 0;
  std::size_t other_modes_ = 0;
  std::size_t morphed_ = 0;
  std::set<std::string> left_out_;
};

void Merger::add_mesh(const Placement& placement, double done, double share) {
  const Mover mover(placement.transform);
  const Field primitives = document_["meshes"].at(placement.mesh)["primitives"];
  Shared shared;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(primitives.size());
    if (!report(document_.progress(), "reading", done + share * part)) throw Cancelled{};
    add_primitive(primitives.at(i), mover, shared);
  }
}

void Merger::add_primitive(const Field& primitive, const Mover& mover, Shared& shared) {
  // Counted even when empty: nodes times primitives must stay within bounds, too.
  document_.claim(1, primitive.path());
  const std::uint64_t mode = primitive["mode"].index_or(4);
  if (mode > 6) refuse(primitive["mode"].path(), fmt::format("is {}; 0 to 6 are defined", mode));
  if (mode < 4) {
    ++other_modes_;
    return;
  }
  note_attributes(primitive);
  if (is_draco(primitive)) {
    const Compressed compressed = read_draco(document_, primitive);
    const VertexId first = add_vertices(compressed.vertices, mover, primitive);
    if (compressed.vertices.normals.empty())
      flat_.emplace_back(mesh_.faces.size(), mesh_.faces.size() + compressed.triangles.size());
    add_triangles(compressed.triangles, first, mover, primitive);
    return;
  }
  const VertexKey key = vertex_key(primitive);
  auto known = shared.find(key);
  if (known == shared.end()) {
    const Vertices vertices = read_vertices(document_, primitive);
    const VertexId first = add_vertices(vertices, mover, primitive);
    known = shared.emplace(key, std::pair(first, vertices.positions.size())).first;
  }
  const auto [first, count] = known->second;
  const std::vector<Triangle> triangles = read_triangles(document_, primitive, count);
  if (!primitive["attributes"]["NORMAL"]) flat_.emplace_back(mesh_.faces.size(), mesh_.faces.size() + triangles.size());
  add_triangles(triangles, first, mover, primitive);
}

VertexId Merger::add_vertices(const Vertices& vertices, const Mover& mover, const Field& primitive) {
  const std::size_t first = mesh_.positions.size();
  for (const Vec3& p : vertices.positions) {
    const Vec3 moved = mover.position(p);
    if (!is_finite(moved)) {
      throw Failure{
          primitive.path(),
          fmt::format("vertex {} is not finite once its node's transform is applied", mesh_.positions.size() - first),
          "check the transforms of the nodes", ErrorCode::kUnsuitable};
    }
    mesh_.positions.push_back(moved);
  }
  if (!vertices.normals.empty()) {
    mesh_.normals.values.resize(first, Vec3(0.0f));
    for (const Vec3& n : vertices.normals)
      mesh_.normals.values.push_back(mover.normal(n));
  }
  if (!vertices.uvs.empty()) {
    mesh_.uvs.values.resize(first, Vec2(0.0f));
    for (const Vec2& uv : vertices.uvs)
      mesh_.uvs.values.emplace_back(uv.x, 1.0f - uv.y);
  } else {
    without_uvs_ += vertices.positions.size();
  }
  if (!vertices.colors.empty()) {
    mesh_.colors.values.resize(first, Vec4(1.0f));
    mesh_.colors.values.insert(mesh_.colors.values.end(), vertices.colors.begin(), vertices.colors.end());
  } else {
    without_colors_ += vertices.positions.size();
  }
  return static_cast<VertexId>(first);
}

void Merger::add_triangles(const std::vector<Triangle>& triangles, VertexId first, const Mover& mover,
                           const Field& primitive) {
  const Field material = primitive["material"];
  const std::uint32_t index =
      material ? static_cast<std::uint32_t>(material.index_into(document_["materials"])) : kInvalidId;
  materials_of_faces_.insert(materials_of_faces_.end(), triangles.size(), index);
  for (const Triangle& t : triangles) {
    if (mover.mirrored()) {
      mesh_.faces.push_back({t[0] + first, t[2] + first, t[1] + first});
    } else {
      mesh_.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
}

void Merger::note_attributes(const Field& primitive) {
  for (const std::string& name : primitive["attributes"].keys()) {
    const bool skin = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
    const bool read = name == "POSITION" || name == "NORMAL" || name == "TEXCOORD_0" || name == "COLOR_0";
    if (!skin && !read && left_out_.size() < 16) left_out_.insert(name.substr(0, 40));
  }
  if (primitive["targets"].size() > 0) ++morphed_;
}

/// A primitive without normals is to be drawn flat (glTF 2.0, section 3.7.2.1): its faces' own normals by corner.
void Merger::fill_normals() {
  std::vector<Vec3>& values = mesh_.normals.values;
  std::erase_if(flat_, [](const auto& range) { return range.first == range.second; });
  values.resize(mesh_.positions.size(), Vec3(0.0f));
  if (flat_.empty()) return;
  std::vector<std::uint32_t>& indices = mesh_.normals.indices;
  indices.reserve(3 * mesh_.faces.size());
  for (const Triangle& t : mesh_.faces)
    indices.insert(indices.end(), t.begin(), t.end());
  std::size_t filled = 0;
  for (const auto& [begin, end] : flat_) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle& t = mesh_.faces[f];
      const DVec3 a(mesh_.positions[t[0]]);
      const DVec3 n = glm::cross(DVec3(mesh_.positions[t[1]]) - a, DVec3(mesh_.positions[t[2]]) - a);
      const double length = std::sqrt(glm::dot(n, n));
      std::fill_n(indices.begin() + static_cast<std::ptrdiff_t>(3 * f), 3, static_cast<std::uint32_t>(values.size()));
      values.push_back(length > 0.0 && std::isfinite(length) ? Vec3(n / length) : Vec3(0.0f));
      ++filled;
    }
  }
  document_.note(fmt::format("{} faces without normals given their own", filled));
}

void Merger::settle_materials() {
  mesh_.materials = read_materials(document_);
  const bool any_without =
      std::find(materials_of_faces_.begin(), materials_of_faces_.end(), kInvalidId) != materials_of_faces_.end();
  if (any_without && !mesh_.materials.empty()) {
    const auto added = static_cast<std::uint32_t>(mesh_.materials.size());
    mesh_.materials.push_back(default_material());
    std::replace(materials_of_faces_.begin(), materials_of_faces_.end(), kInvalidId, added);
  }
  const auto is_first = [](std::uint32_t m) { return m == 0; };
  const bool all_first = std::all_of(materials_of_faces_.begin(), materials_of_faces_.end(), is_first);
  if (!mesh_.materials.empty() && !all_first) mesh_.face_materials = std::move(materials_of_faces_);
}

Mesh Merger::finish() {
  const std::size_t count = mesh_.positions.size();
  if (!mesh_.normals.empty()) fill_normals();
  if (!mesh_.uvs.empty()) {
    mesh_.uvs.values.resize(count, Vec2(0.0f));
    if (without_uvs_ != 0)
      document_.note(fmt::format("{} vertices without texture coordinates given (0, 0)", without_uvs_));
  }
  if (!mesh_.colors.empty()) {
    mesh_.colors.values.resize(count, Vec4(1.0f));
    if (without_colors_ != 0) document_.note(fmt::format("{} vertices without a colour given white", without_colors_));
  }
  settle_materials();
  if (other_modes_ != 0) document_.note(fmt::format("{} primitives of points or lines left out", other_modes_));
  if (morphed_ != 0) document_.note(fmt::format("morph targets of {} primitives left out", morphed_));
  std::string names;
  for (const std::string& name : left_out_)
    names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) document_.note("attributes left out: " + names);
  return std::move(mesh_);
}

void note_motion(Document& document) {
  const std::size_t skins = document["skins"].size();
  const std::size_t animations = document["animations"].size();
  if (skins != 0) document.note(fmt::format("{} skins left out: vertices stay as stored", skins));
  if (animations != 0) document.note(fmt::format("{} animations left out", animations));
}

ImportedMesh read(const Source& source) {
  ImportedMesh result;
  Document document(source, result.notes);
  result.format = document.binary() ? MeshFormat::kGlb : MeshFormat::kGltf;
  const std::vector<Placement> placements = place_meshes(document);
  Merger merger(document);
  const double share = 1.0 / static_cast<double>(placements.size());
  for (std::size_t i = 0; i < placements.size(); ++i)
    merger.add_mesh(placements[i], static_cast<double>(i) * share, share);
  result.mesh = merger.finish();
  note_motion(document);
  return result;
}

}  // namespace
}  // namespace gltf

Result<ImportedMesh> read_gltf(const Source& source) try {
  return gltf::read(source);
} catch (const gltf::Failure& failure) {
  return fail_at(failure.code, source.name, failure.where, failure.message, failure.remedy);
} catch (const gltf::Cancelled&) {
  return fail_at(ErrorCode::kCancelled, source.name, {}, "cancelled");
} catch (const std::bad_alloc&) {
  return fail_at(ErrorCode::kUnreadable, source.name, {}, "not enough memory for the model");
} catch (const std::exception& error) {
  return fail_at(ErrorCode::kUnreadable, source.name, {}, error.what());
}

}  // namespace limn::formats
