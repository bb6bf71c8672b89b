#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limn/render/refinement/scene.h"

namespace limn {

/// What a pass over a surface writes.
enum class SurfaceStage {
  kShaded,     ///< lit fragments
  kPositions,  ///< depth alone, or nothing with rasterization off: shadow maps, the cost of geometry
};

struct SurfacePass {
  SurfaceStage stage = SurfaceStage::kShaded;
  bool flat_normals = false;
  bool wireframe = false;  ///< kShaded only
  /// What transform feedback shall catch (refine_emit.glsl): the caller begins and ends it. Empty: nothing.
  std::vector<std::string> captured = {};

  bool operator==(const SurfacePass&) const = default;
};

/// A way to draw a scene refined. A frame is refine() once, then draw() for each view of it: the camera and what casts
/// shadows may see the same refinement. A view that is frozen is one that refine() is not called for.
class RefinementMethod {
 public:
  virtual ~RefinementMethod() = default;

  /// Decides what will be drawn, seen from a view in world space.
  virtual Result<void> refine(const View& view) = 0;

  /// Draws it into whatever is bound. \pre the camera (CameraBuffer) and, for shaded passes, the materials
  /// (MaterialTable of the scene's meshes) are bound; refine() was called. Leaves program, vertex array and textures
  /// changed. Errors: kNoGraphics when a program is first used and does not compile.
  virtual Result<void> draw(const SurfacePass& pass) = 0;

  /// Triangles that draw() draws, those of unrefined faces included; may wait for the device.
  virtual std::uint64_t triangle_count() const = 0;

  /// Bytes on the device beyond the meshes' vertices and faces.
  virtual std::size_t device_bytes() const = 0;
};

/// The program of a method's vertex stage for a pass, with the scene's HAS_… and the method's own definitions; its
/// flags are set.
struct SurfaceProgram {
  std::string vertex;
  std::string tessellation_control = {}, tessellation_evaluation = {}, geometry = {};
  std::vector<std::string> defines = {};
};
Result<const gl::Program*> surface_program(const RefinementScene& scene, const SurfaceProgram& stages,
                                           const SurfacePass& pass);

}  // namespace limn
