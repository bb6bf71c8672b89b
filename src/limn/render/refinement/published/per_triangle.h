#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "limn/gl/objects.h"
#include "limn/refine/patterns/table.h"
#include "limn/render/refinement/method.h"
#include "limn/render/refinement/published/pattern_store.h"

namespace limn {

/// Draws a scene's only object a face at a time: the face's data are uniforms, set from memory of the CPU for every
/// face, and a draw call puts one of some stored patterns on it. What refinement by patterns was before instancing
/// (Boubekeur and Schlick 2005 and 2008).
class PerTriangleDraws {
 public:
  static constexpr std::uint32_t kNotDrawn = std::numeric_limits<std::uint32_t>::max();

  /// \param table  the patterns as they lie on faces. 192 bytes a face on the CPU, 240 with colours.
  /// Errors: kNoGraphics when the device cannot hold the patterns. \pre the scene has one instance and outlives this
  static Result<PerTriangleDraws> create(const RefinementScene& scene, const PatternTable& table);

  /// Two calls a face: its uniforms, its triangles. \param chosen  a pattern a face, or kNotDrawn
  Result<void> draw(const SurfacePass& pass, std::span<const std::uint32_t> chosen);

  std::uint64_t triangle_count(std::span<const std::uint32_t> chosen) const;
  const PatternStore& patterns() const { return patterns_; }

 private:
  void pack_faces();
  void draw_faces(const gl::Program& program, bool captured, std::span<const std::uint32_t> chosen) const;
  const RefinementScene* scene_ = nullptr;
  PatternStore patterns_;
  SurfacePrograms programs_{{.vertex = "refine_per_triangle.vert.glsl", .defines = {"FACE_UNIFORMS 1", "NESTED 0"}}};
  gl::VertexArray array_;
  std::size_t stride_ = 0;
  std::vector<Vec4> faces_;
};

}  // namespace limn
