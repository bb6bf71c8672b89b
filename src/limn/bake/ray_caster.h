#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "limn/bake/face_tree.h"
#include "limn/base/result.h"
#include "limn/base/vec.h"

namespace limn::bake_detail {

/// Rays as a structure of arrays, 64 at most, in fixed groups of 16.
struct RayBatch {
  static constexpr std::size_t kRoom = 64;
  alignas(64) float origin_x[kRoom], origin_y[kRoom], origin_z[kRoom];
  alignas(64) float direction_x[kRoom], direction_y[kRoom], direction_z[kRoom];
  float far = 0;  ///< of all
  std::size_t count = 0;

  void add(const Vec3& origin, const Vec3& direction) {
    origin_x[count] = origin.x;
    origin_y[count] = origin.y;
    origin_z[count] = origin.z;
    direction_x[count] = direction.x;
    direction_y[count] = direction.y;
    direction_z[count] = direction.z;
    ++count;
  }
};

struct HitBatch {
  FaceId face[RayBatch::kRoom];  ///< kInvalidId: none
  float u[RayBatch::kRoom], v[RayBatch::kRoom];
  float distance[RayBatch::kRoom];
  bool front[RayBatch::kRoom];  ///< whether the face is turned towards the ray's origin
};

/// Casts rays at triangles: with Embree where limn was built with it, else with the tree.
class RayCaster {
 public:
  /// \param tree  must outlive the caster
  static Result<RayCaster> build(const FaceTree& tree, std::span<const Vec3> positions,
                                 std::span<const Triangle> faces);
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  ~RayCaster();

  /// The first hit of each ray.
  void first_hits(const RayBatch& rays, HitBatch& hits) const;
  /// Whether each ray meets anything. \pre blocked.size() >= rays.count
  void blocked(const RayBatch& rays, std::span<bool> blocked) const;

  static bool has_embree();

 private:
  struct Impl;
  explicit RayCaster(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn::bake_detail
