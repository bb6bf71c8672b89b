#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"

namespace limn::bench {

/// Whether faces hide points on edges, in double and without a tree: every face is entered into the cells of a picture
/// that its bounding box covers, and all faces of a point's cell are tried. \pre the eye is outside the mesh's box
class LayerOracle {
 public:
  LayerOracle(const Mesh& mesh, const Topology& topology, const Eye& eye);

  /// Whether a face other than those at the edge lies between the eye and the point at share t of the edge.
  bool hides(EdgeId edge, double t) const;

  /// The same; none when the answer differs within `tolerance` to either side along the edge, or an end is that near.
  std::optional<bool> hides_around(EdgeId edge, double t, double tolerance) const;

 private:
  struct Pixel {
    double x, y;
  };
  Pixel pixel(const DVec3& point) const;
  std::size_t cell(double at) const;

  const Mesh& mesh_;
  const Topology& topology_;
  Eye eye_;
  DVec3 right_, up_, forward_, middle_;
  double extent_ = 1;
  std::vector<std::uint32_t> offsets_;
  std::vector<FaceId> items_;
};

}  // namespace limn::bench
