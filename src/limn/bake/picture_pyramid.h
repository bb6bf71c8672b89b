#pragma once

#include <vector>

#include "limn/base/vec.h"
#include "limn/image/image.h"

namespace limn::bake_detail {

/// A base colour picture with its mip levels, read in linear light as a texture that repeats.
class PicturePyramid {
 public:
  PicturePyramid() = default;
  /// Levels halve, rounding down, to one pixel; each averages in linear light and is stored in 8 bits again.
  explicit PicturePyramid(Image picture);

  bool empty() const { return levels_.empty(); }
  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }

  /// Linear RGBA: bilinear within the two levels around `level` (0 the picture itself), linear between them.
  /// \param uv  v upwards from the bottom of the picture \pre !empty()
  Vec4 sample(const Vec2& uv, float level) const;

 private:
  std::vector<Image> levels_;
};

}  // namespace limn::bake_detail
