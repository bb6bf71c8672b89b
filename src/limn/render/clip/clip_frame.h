#pragma once

#include <functional>
#include <string>
#include <vector>

#include "limn/render/camera_block.h"
#include "limn/render/clip/clip_matte.h"
#include "limn/render/clip/clip_model.h"
#include "limn/render/clip/interior_pass.h"
#include "limn/render/clip/stream_buffer.h"
#include "limn/render/targets.h"

namespace limn {

/// How outlines are smoothed.
enum class ClipAntialias {
  kNone,   ///< each sample of a pixel is covered or not: smooth where the targets have several
  kLines,  ///< the silhouette as soft lines in the alpha channel, as published; for targets of one sample
};

/// What shades hulls, for those who want another than ours. It reads what shaders/clip_hull.frag.glsl reads.
struct HullStage {
  std::string fragment = "clip_hull.frag.glsl";
  std::vector<std::string> defines;  ///< beside those of clip_hull.frag.glsl that fit the model's maps
  /// Called before a hull is drawn, with its program in use: sets uniforms and binds textures. May be empty.
  std::function<void(const gl::Program&, const ClipModel&)> prepare;
};

struct ClipDrawOptions {
  ClipAntialias antialias = ClipAntialias::kNone;
  /// The coarsest silhouette is taken whose error is at most so many pixels wide; 0: the original's.
  float level_tolerance_px = 0.25f;
  /// Also draw faces that the rasterizer's grid may turn over, without which a pixel of thousands of pictures differs.
  bool exact = true;
  float line_width_px = 1.0f;  ///< of the lines that smooth outlines, > 0
  InteriorOptions interior;    ///< outlines inside the picture; kLines draws them as the hull has them
  /// sRGB, what the picture is cleared to with kLines, opaque: the alpha channel serves as each model's matte in turn.
  Vec3 background{1, 1, 1};
  /// Wait for the device after each stage, so that ClipDrawn tells their times. Slows frames down.
  bool time_stages = false;
};

/// How one model was drawn.
struct ClipDrawn {
  EyePlace place = EyePlace::kOutside;
  std::size_t level = 0;
  std::size_t silhouette_edges = 0, stencil_triangles = 0, edge_on_faces = 0;
  double extraction_ms = 0;            ///< finding the silhouette, on the CPU
  double loops_ms = 0;                 ///< stringing it into loops and triangles
  double stencil_ms = 0, hull_ms = 0;  ///< with time_stages: until the device was done
};

/// Draws clipped models into a picture, one after the other, among ordinary geometry (Sander et al. 2000, section 6;
/// docs/clipping.md). Keeps what frames share: use one for many.
class ClipFrame {
 public:
  /// Needs a context. Errors: kNoGraphics.
  static Result<ClipFrame> create(gl::Context& context, const HullStage& stage = {});

  /// Begins a picture: clears the targets, whose colour, depth and stencil are drawn to until end(); binds the camera.
  /// \pre the targets have a stencil, and outlive the frame; one sample for kLines; camera.eye != camera.target
  void begin(const RenderTargets& targets, const Camera& camera, const ClipDrawOptions& options = {});

  /// Draws a model; depth as the hull has it, or as the original where the asset has a displacement map. Ordinary
  /// geometry may be drawn before and after with any program: depth test on, stencil test off.
  ///
  /// With one sample or four and antialias kNone, whatever the order, exactly those samples are covered that the
  /// original's own faces would cover, where fewer than 128 layers lie behind one another (256 with kHull). kLines
  /// wants models farther away first. \param to_world  turns, moves, scales alike in all directions  \pre between
  /// begin() and end() Cost: see docs/clipping.md. Errors: kNoGraphics when the device has no memory for the
  /// silhouette.
  Result<ClipDrawn> draw(ClipModel& model, const Mat4& to_world = Mat4(1.0f));

  /// Ends the picture: the GL state is as begin() set it, for ordinary geometry.
  void end();

 private:
  /// A model as this picture sees it.
  struct Placed {
    Mat4 to_world{1.0f};
    Mat4 to_eye{1.0f};
    float scale = 1.0f;  ///< world units a unit of the model's
    Eye eye{};           ///< in the model's space, as are the viewer's place and the three axes of unit length
    Vec3 origin{0};
    Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  };
  /// A rectangle of the picture.
  struct Box {
    int x = 0, y = 0, width = 0, height = 0;
  };

  explicit ClipFrame(gl::Context& context) : context_(&context) {}
  Placed place(const Mat4& to_world) const;
  Box box_of(const Bounds& bounds, const Placed& placed) const;
  std::size_t choose_level(const ClipModel& model, const Placed& placed) const;
  void find_silhouette(ClipLevel& level, const Placed& placed, ClipDrawn& drawn);
  void find_loops(ClipLevel& level, const Placed& placed, ClipDrawn& drawn);
  void find_edge_on(const ClipLevel& level, const Placed& placed);
  float vertex_error_px() const;
  void find_rim(const ClipModel& model, const Placed& placed);
  /// Where in the stream they lie.
  struct Streamed {
    std::size_t corners = 0, segments = 0;
  };
  Result<Streamed> stream(const ClipModel& model);
  Result<void> draw_clipped(ClipModel& model, const Placed& placed, ClipDrawn& drawn);
  bool marches(const ClipModel& model) const;
  void begin_counting(const ClipModel& model, const Placed& placed);
  void count_loops(const ClipModel& model, const Streamed& streamed);
  bool has_lines() const { return options_.antialias == ClipAntialias::kLines; }
  void count_faces(const ClipLevel& level);
  Result<void> draw_hull(const ClipModel& model, const Placed& placed);
  Result<void> draw_interior(const ClipModel& model, const Placed& placed, const gl::Program& plain);
  void draw_original(ClipModel& model, const Placed& placed);
  Result<const gl::Program*> hull_program(const ClipModel& model);

  gl::Context* context_;
  HullStage stage_;
  std::unique_ptr<ClipMatte> matte_;
  const gl::Program* mask_ = nullptr;
  const gl::Program* original_ = nullptr;
  std::array<const gl::Program*, 16> hulls_{};     ///< by which maps a model has, and whether several materials
  std::array<const gl::Program*, 2> interiors_{};  ///< without and with a picture of colours
  CameraBuffer camera_buffer_;
  CameraBlock camera_;
  float far_distance_ = 0;
  ClipDrawOptions options_;
  const RenderTargets* targets_ = nullptr;
  int subpixel_bits_ = 4;
  std::vector<Box> counted_;  ///< where the stencil may not be 0
  StreamBuffer stream_;
  SearchScratch scratch_;
  StencilLoops loops_;
  LineVector<Vec3> edge_on_;
  std::vector<HullVertex> rim_;
  LineVector<MatteSegment> segments_;
};

}  // namespace limn
