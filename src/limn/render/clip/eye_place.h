#pragma once

#include <span>
#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/render/camera_block.h"

namespace limn {

/// Where a viewer is, as far as the stencil's counting goes.
enum class EyePlace {
  kOutside,  ///< of the convex hull, and neither the near nor the far plane cuts anything off the model in the picture
  kBetween,  ///< perhaps inside the convex hull, but outside the surface that encloses the model; nothing is cut off
  kInside,   ///< inside that surface, or the near or far plane may cut the model
};

/// Tells where viewers are with regard to a surface that encloses a model.
class EyeLocator {
 public:
  EyeLocator() = default;
  /// \param model  the box of what the surface encloses
  /// \pre the surface is closed. Keeps nothing of its arguments. Cost: a pass over its vertices.
  EyeLocator(const Mesh& surface, const Bounds& model);

  /// \param model_to_eye  turns and moves (and may scale alike in all directions): the mesh's space to the eye's
  /// \param eye  in the mesh's space. Conservative: kOutside and kBetween are always true.
  /// Cost: some dozens of products; a pass over the surface's faces where the camera is close.
  EyePlace place(const CameraBlock& camera, float far_distance, const Mat4& model_to_eye, const Vec3& eye) const;

  const Vec3& center() const { return center_; }
  float radius() const { return radius_; }

 private:
  bool outside_convex_hull(const Vec3& eye) const;
  bool model_is_between(const CameraBlock& camera, float far_distance, const Mat4& model_to_eye) const;
  bool is_cut(const CameraBlock& camera, float far_distance, const Mat4& model_to_eye) const;
  bool inside(const Vec3& eye) const;

  std::vector<Vec3> positions_;
  std::vector<Triangle> faces_;
  std::vector<Vec3> directions_;
  Bounds model_;
  std::vector<float> highest_;  ///< of the positions, along each direction
  Vec3 center_{0};
  float radius_ = 0;
};

}  // namespace limn
