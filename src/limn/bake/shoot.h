#pragma once

#include <memory>
#include <span>
#include <vector>

#include "limn/bake/bake.h"
#include "limn/bake/face_tree.h"
#include "limn/base/result.h"
#include "limn/base/vec.h"
#include "limn/mesh/mesh.h"

namespace limn::bake_detail {

/// Moves a mesh's coordinates about its middle and scales them by a power of two so that its diagonal lies between 1
/// and 2: floats are finest there, and thresholds need no units.
struct UnitFrame {
  DVec3 middle{0};
  double scale = 1;

  explicit UnitFrame(const Bounds& bounds);
  Vec3 inside(const Vec3& p) const { return Vec3((DVec3(p) - middle) * scale); }
  Vec3 outside(const Vec3& p) const { return Vec3(DVec3(p) / scale + middle); }
};

/// Probes are answered in batches of so many, together: those of a batch should be neighbours.
inline constexpr std::size_t kProbeBatch = 64;

/// Points of the low mesh and the unit directions in which they look for the high one, in the unit frame.
struct ProbeBatch {
  alignas(64) float x[kProbeBatch], y[kProbeBatch], z[kProbeBatch];
  alignas(64) float normal_x[kProbeBatch], normal_y[kProbeBatch], normal_z[kProbeBatch];
  std::size_t count = 0;

  Vec3 point(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
  void add(const Vec3& point, const Vec3& normal) {
    x[count] = point.x, y[count] = point.y, z[count] = point.z;
    normal_x[count] = normal.x, normal_y[count] = normal.y, normal_z[count] = normal.z;
    ++count;
  }
};

/// What they found.
struct FoundBatch {
  FacePoint place[kProbeBatch];  ///< distance: signed and along the normal for a hit; for a miss the length of the way
  bool hit[kProbeBatch];         ///< by a ray; else the closest point
  std::size_t overruled = 0;     ///< hits that gave way to a closest point; they are hits no longer
};

/// How probes look for their places.
struct FindOptions {
  BakeMethod method = BakeMethod::kShoot;
  float bound = 0;         ///< longest ray, in the unit frame
  float most_stretch = 0;  ///< \see BakeOptions
};

/// A mesh made ready to be found from points beside it. docs/baking.md
class Target {
 public:
  /// Cost: Embree's tree and limn's own, about 0.3 µs a face together on two cores. \pre the mesh has a face
  /// Errors: kUnsuitable when there is no memory for Embree's tree.
  static Result<Target> build(const Mesh& mesh, const UnitFrame& frame);
  Target(Target&&) noexcept;
  Target& operator=(Target&&) noexcept;
  ~Target();

  /// For each probe: the first face along −normal, if it is turned towards the probe; else the first along the normal,
  /// if it is turned away; both no farther than `bound`; else the closest point. With kClosest the closest point
  /// always. Rays begin kTouching behind the point, so that a surface that runs through it is met at a distance of
  /// about 0. Same bits for the same batch. \pre everything finite
  void find(const ProbeBatch& probes, const FindOptions& options, FoundBatch& found) const;

  /// How many of the rays from one origin run for `bound` without meeting a face. \pre at most kProbeBatch directions
  std::size_t count_open(const Vec3& origin, std::span<const Vec3> directions, float bound) const;

  const FaceTree& tree() const;
  bool uses_embree() const;

 private:
  struct Impl;
  explicit Target(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Of the mesh's size (between 1 and 2 in the unit frame).
inline constexpr float kTouching = 1e-5f;

}  // namespace limn::bake_detail
