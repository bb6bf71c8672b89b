#pragma once

#include <array>
#include <span>
#include <vector>

#include "limn/base/aligned.h"
#include "limn/base/camera.h"
#include "limn/mesh/mesh.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/edge_clusters.h"

namespace limn {

/// How a picture is taken of a mesh, as far as the size of faces in it goes.
struct PictureScale {
  Eye eye{};
  Vec3 forward{0, 0, -1};            ///< the camera's axes in the mesh's space, of unit length: the way it looks,
  Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< and across
  float pixels_per_unit = 1.0f;      ///< at distance 1 (perspective) or anywhere (orthographic)
  float widest_cosine = 1.0f;        ///< of the angle between `forward` and the picture's corner
  float vertex_error_px = 0.004f;    ///< how far a vertex may lie from its exact place once rasterized
  /// Where the axis of view meets the picture, from a pixel's corner: with one sample a pixel, faces between the
  /// samples are left out. Negative: there are several samples, no face is left out.
  Vec2 axis_px{-1.0f};
  Vec3 origin{0};  ///< orthographic: a point of the mesh's space on that axis
};

/// Finds the faces that may be seen from the other side once their vertices have been moved to the rasterizer's grid,
/// and then cover a sample.
///
/// Rasterizers place vertices on a grid of, say, 1/256 pixel. A face seen so nearly edge on that this turns it over
/// covers, if anything at all, pixels that the silhouette does not count; drawing these few faces as well makes the
/// stencil exact (docs/clipping.md).
class EdgeOnFaces {
 public:
  EdgeOnFaces() = default;
  /// \param leaves  from leaf_clusters(): which faces lie together; any list will do, at a cost in speed
  /// \pre planes from face_planes(mesh). Keeps nothing of its arguments. Cost: a few passes; 65 bytes a face.
  EdgeOnFaces(const Mesh& mesh, std::span<const LeafCluster> leaves, std::span<const Plane> planes);

  /// The corners of all faces that may turn over, and of few others, three points a face, appended to `points`.
  /// Same result for any number of threads. Cost: 2.3 bytes of memory traffic a face, and 20 for one in ten or so.
  void find(const PictureScale& scale, LineVector<Vec3>& points) const;

  std::size_t memory_bytes() const;

 private:
  static constexpr std::size_t kGroup = 16;
  struct Query;
  /// Faces close to each other that look nearly the same way.
  struct alignas(64) Group {
    std::array<float, kGroup> nx, ny, nz, d;
    std::array<float, kGroup> thickness;  ///< twice the area over the perimeter, of a face; 0: look at it in any case
    std::uint32_t count;
    Vec3 center;
    float radius;  ///< of a ball about the centre that holds the faces
  };
  /// Of a group at least |axis·(p - center)| - spread |p - center| - offset is every plane's distance from p.
  struct Bounding {
    void add(const Mesh& mesh, std::span<const FaceId> faces, std::span<const Plane> planes,
             std::span<const float> thickness);
    /// Whether each of sixteen from `first` on may hold faces that turn over; false where none does.
    bool test(std::size_t first, const Query& query, std::array<bool, kGroup>& may) const;
    void pad();
    LineVector<float> cx, cy, cz, ax, ay, az, spread, offset, thickness;
  };
  void add_group(const Mesh& mesh, std::span<const FaceId> faces, std::span<const Plane> planes,
                 std::span<const float> thickness);
  void test_group(std::size_t group, const Query& query, LineVector<Vec3>& points) const;
  bool may_turn(const std::array<Vec3, 3>& corners, const PictureScale& scale) const;
  float bound_of(const PictureScale& scale, const Vec3& center, float radius) const;

  using Corners = std::array<std::array<Vec3, 3>, kGroup>;
  LineVector<Group> groups_;
  LineVector<Corners> corners_;  ///< of each group
  Bounding bounds_;              ///< of each group
  Bounding outer_bounds_;        ///< of each sixteen groups
  Vec3 center_{0};
  float radius_ = 0;
  float farthest_ = 0;         ///< of the centre from the origin
  float least_perimeter_ = 0;  ///< of the faces whose thickness is not 0
};

}  // namespace limn
