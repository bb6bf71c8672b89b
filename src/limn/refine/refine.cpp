#include "limn/refine/refine.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "limn/mesh/normals.h"

namespace limn {

Result<void> check_extent(const Mesh& mesh) {
  if (mesh.faces.empty()) return {};
  constexpr float kLargest = 1e37f;
  const Bounds bounds = face_bounds(mesh);
  const Vec3 largest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  if (std::max({largest.x, largest.y, largest.z}) <= kLargest) return {};
  return fail(ErrorCode::kUnsuitable, "coordinates beyond 1e37 leave no room for curves", "scale the mesh down");
}

Result<Refiner> Refiner::create(Mesh mesh, const RefineOptions& options) {
  if (mesh.faces.empty()) {
    return fail(ErrorCode::kUnsuitable, "the mesh has no faces", "give a mesh with at least one triangle");
  }
  if (!(options.crease_angle_rad >= 0.0f)) {
    return fail(ErrorCode::kInvalidArgument, "the crease angle is negative or not a number", "choose 0 to 180 degrees");
  }
  Refiner refiner;
  refiner.mesh_ = std::move(mesh);
  refiner.options_ = {options.blend, options.center, options.family, options.max_triangles, options.progress};
  if (!report(options.progress, "topology", 0.0)) return fail(ErrorCode::kCancelled, "cancelled");
  refiner.topology_ = build_topology(refiner.mesh_);
  if (refiner.topology_.edges.empty()) {
    return fail(ErrorCode::kUnsuitable, "every face of the mesh is degenerate", "give a mesh whose faces have area");
  }
  if (const Result<void> fit = check_extent(refiner.mesh_); !fit) return tl::unexpected(fit.error());
  if (!report(options.progress, "curves", 0.0)) return fail(ErrorCode::kCancelled, "cancelled");
  refiner.face_normals_ = face_normals(refiner.mesh_);
  if (std::all_of(refiner.face_normals_.begin(), refiner.face_normals_.end(),
                  [](const Vec3& n) { return n == Vec3(0); })) {
    return fail(ErrorCode::kUnsuitable, "no face of the mesh has area", "give a mesh whose faces have area");
  }
  if (options.recompute_normals || refiner.mesh_.normals.empty()) {
    refiner.mesh_.normals = crease_normals(refiner.mesh_, refiner.topology_, options.crease_angle_rad);
  }
  refiner.curves_ = edge_curves(refiner.mesh_, refiner.topology_);
  return refiner;
}

Result<Refinement> Refiner::refine(const View& view, const LevelOptions& levels) const {
  const Result<std::vector<float>> chosen = edge_levels(mesh_, topology_, face_normals_, curves_, view, levels);
  if (!chosen) return tl::unexpected(chosen.error());
  return refine_with(*chosen);
}

Result<Refinement> Refiner::refine_with(std::span<const float> levels) const {
  return tessellate(mesh_, topology_, curves_, levels, options_);
}

Result<Refinement> refine(const Mesh& mesh, const View& view, const RefineOptions& options) {
  const Result<Refiner> refiner = Refiner::create(mesh, options);
  if (!refiner) return tl::unexpected(refiner.error());
  return refiner->refine(view, options.levels);
}

}  // namespace limn
