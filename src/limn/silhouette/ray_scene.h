#pragma once

#include <memory>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"

namespace limn {

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

  /// Whether a face lies between the eye and the point at share t of the edge, from v[0] (0) to v[1] (1).
  /// Cost: one ray, about a microsecond. Same answer every time.
  bool hides(const Eye& eye, EdgeId edge, double t) const;

  /// Whether nothing lies behind the point either, along the line of sight and to infinity.
  bool background_behind(const Eye& eye, EdgeId edge, double t) const;

  /// Appends the shares of the edge, in (0, 1), at which it runs through faces that share none of its vertices: only on
  /// self-intersecting meshes. In no order; one may appear twice.
  void piercings(EdgeId edge, std::vector<double>& shares) const;

 private:
  struct Impl;
  explicit RayScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
