#pragma once

#include <cstddef>
#include <functional>

#include "limn/gl/objects.h"
#include "limn/gl/program.h"

namespace limn {

/// How a hull shows the outlines that lie inside a model's picture.
enum class ClipInterior {
  kHull,   ///< as the hull has them, as published: polygons
  kMarch,  ///< as the original has them: lines of sight are followed through the shell below the hull
};

struct InteriorOptions {
  /// kMarch needs an asset with object-space normals and a displacement; without them it is kHull.
  ClipInterior way = ClipInterior::kMarch;
  float texels_a_step = 4;  ///< what a step may pass over: what is narrower may be missed; > 0
  int steps = 24;           ///< at most; what is not decided by then counts as met; >= 1
};

/// What the march of one model reads on the device.
struct ShellBuffers {
  gl::Buffer faces;    ///< ShellFace (hull_shell.h), one a face of the hull
  gl::Buffer corners;  ///< HullVertex, three a face
  gl::VertexArray array;
  std::size_t face_count = 0;  ///< 0: the model cannot be marched through
};

/// Draws a hull where the stencil holds a count: what lines of sight meet below it, and what lies behind where they
/// meet nothing. A pixel in which no layer of the hull is met shows the hull as published, so that what is covered is
/// what the stencil says. docs/interior-silhouettes.md
class InteriorPass {
 public:
  static constexpr unsigned kCounts = 0x7f;  ///< the stencil's bits that count
  static constexpr unsigned kDone = 0x80;    ///< something was drawn

  /// Programs with their uniforms set, and what draws the hull's front faces and its rim with the program in use.
  struct Draws {
    const gl::Program* march = nullptr;  ///< clip_interior.*, for `shell`
    const gl::Program* mask = nullptr;   ///< places only
    const gl::Program* plain = nullptr;  ///< the hull as published
    std::function<void()> shell, hull, rim;
  };

  /// \pre the stencil's kCounts hold the count and kDone is 0 within the scissor; stencil and depth test are on
  /// Leaves the stencil changed, and its mask.
  static void draw(const Draws& draws);
};

}  // namespace limn
