#pragma once

#include <span>
#include <vector>

#include "limn/bake/face_tree.h"
#include "limn/bake/picture_pyramid.h"
#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn::bake_detail {

/// The normals of a mesh, ready to be interpolated: its own, else such as crease_normals() gives. What is zero or not
/// finite is replaced by the face's normal, and for a face without area by (0, 0, 1).
CornerAttribute<Vec3> usable_normals(const Mesh& mesh, float crease_angle_rad);

/// What of the high mesh is sampled into maps.
class Surface {
 public:
  /// \param colors  whether color() will be asked: then pictures are decoded
  /// Errors: kUnsuitable, naming the material, for a picture that cannot be decoded.
  static Result<Surface> build(const Mesh& mesh, bool colors);

  /// The interpolated normals, of unit length, at up to 64 places.
  void normals(std::span<const FacePoint> places, Vec3* normals) const;

  /// Linear RGBA: the material's colour, times its picture, times the vertex colour.
  /// \param footprint  how wide a texel of the map is on the surface, in the mesh's units: pictures are read from the
  /// mip level whose pixels are about as large
  Vec4 color(const FacePoint& at, float footprint) const;

  /// The point itself, in the mesh's own coordinates.
  Vec3 position(const FacePoint& at) const;

 private:
  struct Corners {
    Vec3 normal[3];
  };

  const Mesh* mesh_ = nullptr;
  std::vector<Corners> normals_;          ///< one a face
  std::vector<PicturePyramid> pictures_;  ///< one a material
  std::vector<float> picture_density_;    ///< one a face: pixels of its picture a unit of length
};

}  // namespace limn::bake_detail
