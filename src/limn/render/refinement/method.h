#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
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
  /// What transform feedback shall catch (refine_emit.glsl), and what begins and ends it around each draw, once its
  /// program is in use. Empty: nothing.
  std::vector<std::string> captured = {};
  std::function<void()> before_draw = {};
  std::function<void()> after_draw = {};
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

/// A method's program for each kind of pass, made when first asked for and kept: a frame asks for it anew.
class SurfacePrograms {
 public:
  explicit SurfacePrograms(SurfaceProgram stages) : stages_(std::move(stages)) {}

  /// In use from now on. Errors: as surface_program().
  Result<const gl::Program*> use(const RefinementScene& scene, const SurfacePass& pass);

 private:
  struct Made {
    SurfaceStage stage;
    bool flat_normals, wireframe;
    std::vector<std::string> captured;
    const gl::Program* program;
  };
  SurfaceProgram stages_;
  std::vector<Made> made_;
};

/// Draws, with the pass's hooks around.
template <class Draw>
void draw_hooked(const SurfacePass& pass, const Draw& draw) {
  if (pass.before_draw) pass.before_draw();
  draw();
  if (pass.after_draw) pass.after_draw();
}

}  // namespace limn
