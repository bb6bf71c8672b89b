#pragma once

#include <span>
#include <vector>

#include "limn/base/aligned.h"
#include "limn/base/camera.h"
#include "limn/mesh/mesh.h"
#include "limn/silhouette/facing.h"

namespace limn {

/// How a picture is taken of a mesh, as far as the size of faces in it goes.
struct PictureScale {
  Eye eye{};
  Vec3 forward{0, 0, -1};         ///< of unit length, in the mesh's space: the way the camera looks
  float pixels_per_unit = 1.0f;   ///< at distance 1 (perspective) or anywhere (orthographic)
  float widest_cosine = 1.0f;     ///< of the angle between `forward` and the picture's corner
  float vertex_error_px = 0.004f;  ///< how far a vertex may lie from its exact place once rasterized
};

/// Finds the faces that may be seen from the other side once their vertices have been moved to the rasterizer's grid.
///
/// Rasterizers place vertices on a grid of, say, 1/256 pixel. A face seen so nearly edge on that this turns it over
/// covers, if anything at all, pixels that the silhouette does not count; drawing these few faces as well makes the
/// stencil exact (docs/clipping.md).
class EdgeOnFaces {
 public:
  EdgeOnFaces() = default;
  /// \pre planes from face_planes(mesh). Keeps nothing of its arguments. Cost: one pass; 36 bytes a face.
  EdgeOnFaces(const Mesh& mesh, std::span<const Plane> planes);

  /// The corners of all faces that may turn over, and of few others, three points a face, appended to `points`.
  /// Same result for any number of threads. Cost: 20 bytes of memory traffic a face.
  void find(const PictureScale& scale, LineVector<Vec3>& points) const;

  std::size_t memory_bytes() const;

 private:
  bool may_turn(std::size_t face, const PictureScale& scale) const;
  float bound_of(const PictureScale& scale) const;

  std::vector<Vec3> positions_;
  std::vector<Triangle> faces_;
  LineVector<float> nx_, ny_, nz_, d_;
  LineVector<float> thickness_;  ///< twice the area over the perimeter; 0: look at the face itself in any case
  Vec3 center_{0};
  float radius_ = 0;
  float farthest_ = 0;         ///< of the centre from the origin
  float least_perimeter_ = 0;  ///< of the faces whose thickness is not 0
};

}  // namespace limn
