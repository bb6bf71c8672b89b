#pragma once

#include <cmath>
#include <vector>

#include "limn/base/result.h"
#include "limn/base/vec.h"
#include "limn/mesh/mesh.h"

namespace limn::bake_detail {

/// A point of a face: corner 0 · (1 − u − v) + corner 1 · u + corner 2 · v.
struct Barycentric {
  float u = 0, v = 0;
};

/// A face's triangle in the picture, in texels from the picture's top left, y downwards.
class TexelFrame {
 public:
  TexelFrame() = default;
  /// \param corners  in texels; the triangle may wind either way. A triangle without area gives corner 0 everywhere.
  explicit TexelFrame(const glm::dvec2 (&corners)[3]);

  /// The point of the triangle nearest to a place in the picture, measured in texels.
  Barycentric at(float x, float y) const;
  /// Whether the place lies within the triangle, its border included.
  bool holds(float x, float y) const;
  Vec2 middle() const { return corner_ + (edge_1_ + edge_2_) / 3.0f; }
  double area() const;  ///< in square texels

 private:
  Barycentric at_border(Vec2 from) const;

  Vec2 corner_{0}, edge_1_{0}, edge_2_{0};
  Vec2 u_gradient_{0}, v_gradient_{0};
};

/// Which face each texel belongs to, and where on it the texel lies.
struct TexelMap {
  int size_px = 0;
  std::vector<FaceId> owner;       ///< one a texel, row by row from the top; kInvalidId for none
  std::vector<TexelFrame> frames;  ///< one a face
  std::size_t overlapping = 0;     ///< texels whose centre lies within two faces or more
  /// Where the picture repeats: a face that leaves it on one side and comes in on the other is looked up beside it.
  bool wraps = false;

  /// The point of the face nearest to a place in the picture.
  Barycentric at(FaceId face, float x, float y) const {
    const TexelFrame& frame = frames[face];
    return wraps ? frame.at(beside(x, frame.middle().x), beside(y, frame.middle().y)) : frame.at(x, y);
  }

 private:
  /// The repetition of a coordinate that is nearest to `middle`.
  float beside(float at, float middle) const {
    const auto size = static_cast<float>(size_px);
    return at + size * std::round((middle - at) / size);
  }
};

/// The texels of a mesh that has texture coordinates of its own: those whose centre a face covers, then those that a
/// face touches, then `gutter_px` texels around all, each given to a face beside it. Coordinates outside 0 … 1 repeat.
/// Where faces overlap, the one with the lowest id keeps the texel. Cost: linear in texels and faces. Errors:
/// kUnsuitable, naming the face, for coordinates that are not finite or that span more than 8 repetitions in one face.
Result<TexelMap> uv_texels(const Mesh& mesh, int size_px, int gutter_px);

}  // namespace limn::bake_detail
