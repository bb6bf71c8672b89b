#pragma once

#include "limn/base/vec.h"
#include "limn/gl/context.h"
#include "limn/gl/objects.h"
#include "limn/render/clip/stencil_loops.h"

namespace limn {

/// Two points of the silhouette.
struct MatteSegment {
  Vec3 from, to;
};

/// The alpha channel as a matte for one clipped model: 1 where the stencil counts, fading out across its silhouette
/// (Sander et al. 2000, section 6, "Antialiasing"). Needs a current context for everything.
class ClipMatte {
 public:
  /// The stencil's bit that says where lines are; the count is in those below.
  static constexpr unsigned kLineBit = 0x80, kCountBits = 0x7f;

  /// Errors: kNoGraphics.
  static Result<ClipMatte> create(gl::Context& context);

  /// Clears alpha within the scissor, draws lines of `buffer` into it and their bit into the stencil.
  /// \param rows  the three rows of the model's placement  \pre the camera is bound
  void draw_lines(unsigned buffer, std::size_t offset_bytes, std::size_t count, std::span<const Vec4> rows,
                  float width_px) const;

  /// Makes alpha 1 where the count is not 0.
  void transfer() const;

 private:
  const gl::Program* lines_ = nullptr;
  const gl::Program* fill_ = nullptr;
  gl::VertexArray array_, none_;
};

/// The edges of all loops. \param segments  overwritten
void segments_of(const StencilLoops& loops, LineVector<MatteSegment>& segments);

}  // namespace limn
