#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"

namespace limn {

/// A point on an edge.
struct EdgePoint {
  EdgeId edge = kInvalidId;
  double t = 0;  ///< share of the edge, from v[0] (0) to v[1] (1)
};

/// A mesh made ready for lines of sight to points on its edges. Built once a mesh, asked from any number of threads.
///
/// The faces at the asked edge itself are left out by their ids: they touch the point and never hide it. Whether a face
/// lies in front is decided in double from the mesh's own coordinates; faces that share a vertex with the edge are
/// tested in double throughout, others must be nearer by 4e-7 of the mesh's size, so that surfaces that touch the edge
/// do not hide it. Traversal is Embree's, robust (no gaps between neighbouring faces) in float about the mesh's middle,
/// scaled to unit size. docs/visibility.md
class RayScene {
 public:
  /// Keeps references to both, which must outlive it and stay where they are.
  /// \pre `topology` was built from `mesh`; every coordinate is finite
  /// Cost: Embree's BVH, about 0.1 µs a face on two cores, 100 bytes a face.
  /// Errors: kUnsuitable when limn was built without Embree or Embree is out of memory.
  static Result<RayScene> build(const Mesh& mesh, const Topology& topology);

  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// For each point, whether a face lies between it and the eye: 1 or 0.
  /// Cost: a ray a point, half a microsecond; quickest when neighbours in `points` are neighbours in space. One thread.
  /// A point's answer may depend on the points asked with it only where a ray grazes an edge within float rounding; the
  /// same points in the same order give the same answers. \pre hidden.size() == points.size()
  void hides(const Eye& eye, std::span<const EdgePoint> points, std::span<std::uint8_t> hidden) const;

  /// For each point, whether nothing lies behind it, along the line of sight and to infinity. Otherwise as hides.
  void background_behind(const Eye& eye, std::span<const EdgePoint> points, std::span<std::uint8_t> background) const;

  /// Appends the points within these edges at which they run through faces that share none of their vertices: there are
  /// some only on self-intersecting meshes. Ascending by (edge, t); one may appear twice. Otherwise as hides.
  void piercings(std::span<const EdgeId> edges, std::vector<EdgePoint>& points) const;

 private:
  struct Impl;
  explicit RayScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
