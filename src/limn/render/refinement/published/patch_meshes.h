#pragma once

#include <cstddef>

#include "limn/base/result.h"
#include "limn/gl/objects.h"

namespace limn {

/// The pre-tessellated patches P_0 … P_M in the device's memory (Boubekeur and Schlick 2005; Dyken et al. 2008, section
/// 6.4): attribute 0 is a uint, j | k << 10 in segments of 2^-m.
class PatchMeshes {
 public:
  /// Needs a current context. Errors: kNoGraphics when the device cannot hold them. \pre 0 <= max_level <= kMaxLevel
  static Result<PatchMeshes> create(int max_level);

  void bind() const;
  /// Draws P_m, 4^m triangles, with the program in use. \pre bound
  void draw(int m) const;
  std::size_t bytes() const { return bytes_; }

 private:
  gl::Buffer vertices_, indices_;
  gl::VertexArray array_;
  std::size_t bytes_ = 0;
};

}  // namespace limn
