#include "limn/mesh/formats/finish.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "limn/base/parallel.h"
#include "limn/mesh/normals.h"

namespace limn::formats {
namespace {

constexpr std::size_t kGrain = 1u << 16;

tl::unexpected<Error> unreadable(const std::string& name, std::string where, std::string message) {
  return fail_at(ErrorCode::kUnreadable, name, std::move(where), std::move(message),
                 "write the file anew with the program it comes from");
}

/// The largest number of a list, 0 for none.
std::uint32_t largest(const std::uint32_t* numbers, std::size_t count) {
  std::atomic<std::uint32_t> result = 0;
  parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
    std::uint32_t here = 0;
    for (std::size_t i = begin; i < end; ++i)
      here = std::max(here, numbers[i]);
    std::uint32_t seen = result.load();
    while (seen < here && !result.compare_exchange_weak(seen, here)) {
    }
  });
  return result;
}

/// Whether all floats of an array are finite.
bool all_finite(const float* numbers, std::size_t count) {
  std::atomic<bool> good = true;
  parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
    bool here = true;
    for (std::size_t i = begin; i < end; ++i)
      here &= std::abs(numbers[i]) <= std::numeric_limits<float>::max();
    if (!here) good = false;
  });
  return good;
}

Result<void> check_faces(const Mesh& mesh, const std::string& name) {
  if (mesh.faces.empty()) return {};
  const std::size_t count = mesh.positions.size();
  if (largest(mesh.faces.front().data(), 3 * mesh.faces.size()) < count) return {};
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const VertexId vertex : mesh.faces[face]) {
      if (vertex < count) continue;
      return unreadable(name, fmt::format("face {}", face),
                        fmt::format("refers to vertex {}, but there are {} (counted from 0)", vertex, count));
    }
  }
  return {};
}

Result<void> check_positions(const Mesh& mesh, const std::string& name) {
  if (mesh.positions.empty() || all_finite(&mesh.positions.front().x, 3 * mesh.positions.size())) return {};
  const auto found = std::find_if_not(mesh.positions.begin(), mesh.positions.end(), is_finite);
  const Vec3 p = *found;
  return fail_at(ErrorCode::kUnsuitable, name, fmt::format("vertex {}", found - mesh.positions.begin()),
                 fmt::format("the coordinates ({}, {}, {}) are not finite 32-bit numbers", p.x, p.y, p.z),
                 "repair or rescale the model in the program it comes from");
}

template <class T>
Result<void> check_attribute(const Mesh& mesh, CornerAttribute<T>& attribute, const char* what,
                             const std::string& name) {
  if (attribute.values.empty() || mesh.faces.empty()) attribute.indices.clear();
  if (attribute.values.empty()) return {};
  if (mesh.faces.empty() && attribute.values.size() != mesh.positions.size()) {
    attribute.values.clear();
    return {};
  }
  const bool by_corner = !attribute.indices.empty();
  const std::size_t found = by_corner ? attribute.indices.size() : attribute.values.size();
  const std::size_t wanted = by_corner ? 3 * mesh.faces.size() : mesh.positions.size();
  if (found != wanted) return unreadable(name, what, fmt::format("there are {}, {} are needed", found, wanted));
  if (!by_corner || largest(attribute.indices.data(), found) < attribute.values.size()) return {};
  const auto culprit = std::find_if(attribute.indices.begin(), attribute.indices.end(),
                                    [&](std::uint32_t index) { return index >= attribute.values.size(); });
  return unreadable(name, fmt::format("face {}", (culprit - attribute.indices.begin()) / 3),
                    fmt::format("refers to number {} of the {}, but there are {} (counted from 0)", *culprit, what,
                                attribute.values.size()));
}

Result<void> check_materials(Mesh& mesh, const std::string& name) {
  if (mesh.face_materials.empty()) return {};
  if (mesh.face_materials.size() != mesh.faces.size()) {
    return unreadable(name, "materials",
                      fmt::format("there are {} for {} faces", mesh.face_materials.size(), mesh.faces.size()));
  }
  const auto culprit = std::find_if(mesh.face_materials.begin(), mesh.face_materials.end(),
                                    [&](std::uint32_t index) { return index >= mesh.materials.size(); });
  if (culprit == mesh.face_materials.end()) return {};
  return unreadable(name, fmt::format("face {}", culprit - mesh.face_materials.begin()),
                    fmt::format("refers to material {}, but there are {}", *culprit, mesh.materials.size()));
}

template <class T>
void drop_if_not_finite(CornerAttribute<T>& attribute, const char* what, std::vector<std::string>& notes) {
  if (attribute.values.empty()) return;
  if (all_finite(&attribute.values.front().x, attribute.values.size() * sizeof(T) / sizeof(float))) return;
  attribute = {};
  notes.push_back(fmt::format("{} left out: some are not finite", what));
}

void check_tags(ImportedMesh& imported) {
  std::vector<float>& tags = imported.mesh.tags;
  if (tags.empty()) return;
  if (tags.size() == imported.mesh.positions.size() && all_finite(tags.data(), tags.size())) return;
  tags.clear();
  imported.notes.emplace_back("tags left out: some are not finite");
}

enum class NormalKind { kUnit, kScaled, kNone };

/// Makes one normal a unit vector; kNone, leaving (0,0,0), when it has no direction.
NormalKind normalize(Vec3& normal) {
  constexpr double kUnitWithin = 2e-6;  // of the squared length: twice as much as of the length
  const DVec3 wide(normal);
  const double squared = wide.x * wide.x + wide.y * wide.y + wide.z * wide.z;
  if (std::abs(squared - 1.0) <= kUnitWithin) return NormalKind::kUnit;
  if (!(squared > 0.0) || !std::isfinite(squared)) {
    normal = Vec3(0.0f);
    return NormalKind::kNone;
  }
  normal = Vec3(wide / std::sqrt(squared));
  return NormalKind::kScaled;
}

/// Normals of no direction take the normal of the first face with area that uses them, or z where there is none.
void replace_missing_normals(Mesh& mesh) {
  const std::vector<Vec3> of_faces = face_normals(mesh);
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      Vec3& normal = mesh.normals.values[mesh.corner_index(mesh.normals, face, corner)];
      if (normal == Vec3(0.0f)) normal = of_faces[face];
    }
  }
  std::replace(mesh.normals.values.begin(), mesh.normals.values.end(), Vec3(0.0f), Vec3(0.0f, 0.0f, 1.0f));
}

void finish_normals(ImportedMesh& imported) {
  std::vector<Vec3>& normals = imported.mesh.normals.values;
  std::atomic<std::size_t> scaled = 0;
  std::atomic<std::size_t> missing = 0;
  parallel_for(normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t scaled_here = 0;
    std::size_t missing_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 before = normals[i];
      const NormalKind kind = normalize(normals[i]);
      // Rounded digits are not worth a note; a normal that was no unit vector is.
      const float change = std::max(
          {std::abs(before.x - normals[i].x), std::abs(before.y - normals[i].y), std::abs(before.z - normals[i].z)});
      scaled_here += kind == NormalKind::kScaled && change > 1e-3f;
      missing_here += kind == NormalKind::kNone;
    }
    scaled += scaled_here;
    missing += missing_here;
  });
  if (scaled > 0) imported.notes.push_back(fmt::format("{} normals scaled to unit length", scaled.load()));
  if (missing == 0) return;
  imported.notes.push_back(fmt::format("{} normals without a direction replaced by their face's", missing.load()));
  replace_missing_normals(imported.mesh);
}

}  // namespace

Result<void> finish(ImportedMesh& imported, const std::string& name) {
  Mesh& mesh = imported.mesh;
  Result<void> good;
  if (mesh.positions.size() >= kInvalidId || mesh.faces.size() > kInvalidId / 3) {
    return unreadable(name, "", "more vertices or corners than 32-bit indices can name");
  }
  if (good = check_faces(mesh, name); !good) return good;
  if (good = check_positions(mesh, name); !good) return good;
  if (good = check_attribute(mesh, mesh.normals, "normals", name); !good) return good;
  if (good = check_attribute(mesh, mesh.uvs, "texture coordinates", name); !good) return good;
  if (good = check_attribute(mesh, mesh.colors, "colours", name); !good) return good;
  if (good = check_materials(mesh, name); !good) return good;
  drop_if_not_finite(mesh.uvs, "texture coordinates", imported.notes);
  drop_if_not_finite(mesh.colors, "colours", imported.notes);
  check_tags(imported);
  finish_normals(imported);
  return {};
}

}  // namespace limn::formats
