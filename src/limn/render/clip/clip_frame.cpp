#include "limn/render/clip/clip_frame.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

constexpr float kRimHalfWidth_px = 0.0625f;

template <class T>
std::span<const std::byte> bytes_of(const T& values) {
  return std::as_bytes(std::span(values.data(), values.size()));
}

std::array<Vec4, 3> rows_of(const Mat4& to_world) {
  const Mat4 rows = glm::transpose(to_world);
  return {rows[0], rows[1], rows[2]};
}

void set_place(const gl::Program& program, const Mat4& to_world) {
  program.set("to_world_rows[0]", std::span<const Vec4>(rows_of(to_world)));
}

Vec3 linear(const Vec3& srgb) {
  Vec3 result;
  for (int c = 0; c < 3; ++c)
    result[c] = srgb[c] <= 0.04045f ? srgb[c] / 12.92f : std::pow((srgb[c] + 0.055f) / 1.055f, 2.4f);
  return result;
}

}  // namespace

Result<ClipFrame> ClipFrame::create(gl::Context& context, const HullStage& stage) {
  context.make_current();
  ClipFrame frame(context);
  frame.stage_ = stage;
  const auto mask = context.program({"clip_mask.vert.glsl", "", "clip_mask.frag.glsl", {}});
  if (!mask) return tl::unexpected(mask.error());
  frame.mask_ = *mask;
  const auto original = context.program({"clip_surface.vert.glsl", "", "face.frag.glsl", {}});
  if (!original) return tl::unexpected(original.error());
  frame.original_ = *original;
  auto matte = ClipMatte::create(context);
  if (!matte) return tl::unexpected(matte.error());
  frame.matte_ = std::make_unique<ClipMatte>(std::move(*matte));
  glGetIntegerv(GL_SUBPIXEL_BITS, &frame.subpixel_bits_);
  frame.subpixel_bits_ = std::max(frame.subpixel_bits_, 4);
  return frame;
}

void ClipFrame::begin(const RenderTargets& targets, const Camera& camera, const ClipDrawOptions& options) {
  assert(targets.has_stencil());
  context_->make_current();
  targets_ = &targets;
  options_ = options;
  far_distance_ = camera.far_distance;
  camera_ = make_camera_block(camera, targets.width(), targets.height());
  camera_buffer_.update(camera_);
  camera_buffer_.bind();
  targets.begin_faces();
  counted_.clear();
  if (!has_lines()) return;
  const Vec4 background(linear(options.background), 1.0f);
  glClearBufferfv(GL_COLOR, 0, &background.x);
}

void ClipFrame::end() {
  if (has_lines()) {  // what was a matte is full again
    const GLfloat opaque[4] = {1, 1, 1, 1};
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, opaque);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  targets_ = nullptr;
}

ClipFrame::Placed ClipFrame::place(const Mat4& to_world) const {
  Placed placed;
  placed.to_world = to_world;
  placed.scale = glm::length(Vec3(to_world[0]));
  const glm::dmat4 inverse = glm::inverse(glm::dmat4(to_world));
  Mat4 from_eye(1.0f);
  from_eye[3] = Vec4(-camera_.eye, 1.0f);
  placed.to_eye = camera_.rotation * from_eye * to_world;
  const glm::dmat3 turn_back(inverse);
  const glm::dmat3 axes = glm::transpose(glm::dmat3(camera_.rotation));
  placed.right = Vec3(glm::normalize(turn_back * axes[0]));
  placed.up = Vec3(glm::normalize(turn_back * axes[1]));
  placed.forward = Vec3(glm::normalize(turn_back * -axes[2]));
  placed.origin = Vec3(inverse * glm::dvec4(DVec3(camera_.eye), 1.0));
  placed.eye.orthographic = camera_.orthographic != 0;
  placed.eye.at = placed.eye.orthographic ? -placed.forward : placed.origin;
  return placed;
}

ClipFrame::Box ClipFrame::box_of(const Bounds& bounds, const Placed& placed) const {
  const Box all{0, 0, targets_->width(), targets_->height()};
  Vec2 low(1e30f), high(-1e30f);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? bounds.high.x : bounds.low.x, (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
                 (corner & 4) != 0 ? bounds.high.z : bounds.low.z);
    const Vec4 clip = camera_.projection * (placed.to_eye * Vec4(p, 1.0f));
    if (!(clip.w > 1e-6f)) return all;
    const Vec2 window = (Vec2(clip) / clip.w * 0.5f + 0.5f) * camera_.size_px;
    low = glm::min(low, window);
    high = glm::max(high, window);
  }
  const float margin = 2.0f + options_.level_tolerance_px + (has_lines() ? options_.line_width_px : 0.0f);
  low = glm::clamp(low - margin, Vec2(0.0f), camera_.size_px);
  high = glm::clamp(high + margin, Vec2(0.0f), camera_.size_px);
  Box box;
  box.x = static_cast<int>(std::floor(low.x));
  box.y = static_cast<int>(std::floor(low.y));
  box.width = static_cast<int>(std::ceil(high.x)) - box.x;
  box.height = static_cast<int>(std::ceil(high.y)) - box.y;
  return box;
}

std::size_t ClipFrame::choose_level(const ClipModel& model, const Placed& placed) const {
  const float radius = static_cast<float>(0.5 * model.bounds().diagonal());
  const Vec3 middle = model.bounds().center();
  float nearest = 1.0f;
  if (!placed.eye.orthographic) nearest = placed.scale * (glm::length(middle - placed.eye.at) - radius);
  if (!(nearest > 0.0f)) return 0;
  const float tolerance = options_.level_tolerance_px * camera_.pixel_size * nearest / placed.scale;
  std::size_t level = 0;
  while (level + 1 < model.levels_.size() && model.levels_[level + 1]->error <= tolerance && tolerance > 0.0f)
    ++level;
  return level;
}

float ClipFrame::vertex_error_px() const {
  const float grid = std::ldexp(1.0f, -subpixel_bits_);
  return 0.7072f * grid + std::ldexp(std::max(camera_.size_px.x, camera_.size_px.y), -21);
}

void ClipFrame::find_silhouette(ClipLevel& level, const Placed& placed, ClipDrawn& drawn) {
  // One after the other: together they take less than another thread does to wake and to fall asleep again.
  find_loops(level, placed, drawn);
  if (options_.exact) find_edge_on(level, placed);
  drawn.silhouette_edges = loops_.edge_count;
  drawn.stencil_triangles = loops_.triangle_count();
  drawn.edge_on_faces = edge_on_.size() / 3;
}

void ClipFrame::find_loops(ClipLevel& level, const Placed& placed, ClipDrawn& drawn) {
  const Clock::time_point begun = Clock::now();
  const std::span<const EdgeId> edges = level.extractor.find(placed.eye, scratch_);
  drawn.extraction_ms = ms_since(begun);
  const Clock::time_point found = Clock::now();
  level.loops.build(edges, placed.eye, loops_);
  drawn.loops_ms = ms_since(found);
}

void ClipFrame::find_edge_on(const ClipLevel& level, const Placed& placed) {
  const float diagonal = 0.5f * camera_.pixel_size * glm::length(camera_.size_px);
  PictureScale scale;
  scale.eye = placed.eye;
  scale.forward = placed.forward;
  scale.right = placed.right;
  scale.up = placed.up;
  scale.pixels_per_unit = placed.eye.orthographic ? placed.scale / camera_.pixel_size : 1.0f / camera_.pixel_size;
  scale.widest_cosine = placed.eye.orthographic ? 1.0f : 1.0f / std::sqrt(1.0f + diagonal * diagonal);
  scale.vertex_error_px = vertex_error_px();
  if (targets_->samples() == 1) scale.axis_px = 0.5f * camera_.size_px;
  scale.origin = placed.origin;
  level.edge_on.find(scale, edge_on_);
}

void ClipFrame::find_rim(const ClipModel& model, const Placed& placed) {
  HullRim::View view;
  view.eye = placed.eye;
  view.right = placed.right;
  view.up = placed.up;
  view.forward = placed.forward;
  view.unit_px = placed.eye.orthographic ? camera_.pixel_size / placed.scale : camera_.pixel_size;
  view.half_width_px = kRimHalfWidth_px;
  if (has_lines()) view.half_width_px += 0.5f * options_.line_width_px + 0.5f;
  rim_.clear();
  model.rim_.append(view, rim_);
}

Result<ClipFrame::Streamed> ClipFrame::stream(const ClipModel& model) {
  // Faces seen edge on lie behind the loops' points, so that one binding serves both.
  loops_.points.insert(loops_.points.end(), edge_on_.begin(), edge_on_.end());
  const auto points = bytes_of(loops_.points), corners = bytes_of(loops_.corners), segments = bytes_of(segments_),
             rim = bytes_of(rim_);
  constexpr std::size_t kPadding = 64;
  if (auto begun = stream_.begin(points.size() + corners.size() + segments.size() + rim.size() + kPadding); !begun)
    return tl::unexpected(begun.error());
  const auto points_at = static_cast<GLintptr>(stream_.write(points));
  const Streamed streamed{stream_.write(corners), stream_.write(segments)};
  const auto rim_at = static_cast<GLintptr>(stream_.write(rim));
  glVertexArrayVertexBuffer(model.loop_array_.id(), 0, stream_.id(), points_at, sizeof(Vec3));
  glVertexArrayElementBuffer(model.loop_array_.id(), stream_.id());
  glVertexArrayVertexBuffer(model.rim_array_.id(), 0, stream_.id(), rim_at, sizeof(HullVertex));
  return streamed;
}

void ClipFrame::begin_counting(const ClipModel& model, const Placed& placed) {
  mask_->use();
  set_place(*mask_, placed.to_world);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);  // nothing is lost in front of the near plane or behind the far one
  glEnable(GL_STENCIL_TEST);
  glStencilMask(has_lines() ? ClipMatte::kCountBits : marches(model) ? InteriorPass::kCounts : 0xff);
  glStencilFunc(GL_ALWAYS, 0, 0xff);
}

void ClipFrame::count_loops(const ClipModel& model, const Streamed& streamed) {
  glBindVertexArray(model.loop_array_.id());
  glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
  glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(loops_.corners.size()), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(streamed.corners));
  if (edge_on_.empty()) return;
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR_WRAP);
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(loops_.points.size() - edge_on_.size()),
               static_cast<GLsizei>(edge_on_.size()));
}

void ClipFrame::count_faces(const ClipLevel& level) {
  glStencilFunc(GL_ALWAYS, 1, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glBindVertexArray(level.array.id());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * level.face_count), GL_UNSIGNED_INT, nullptr);
}

Result<const gl::Program*> ClipFrame::hull_program(const ClipModel& model) {
  const bool single = model.materials_->size() == 1;
  const unsigned variant =
      (model.normals_ ? 1u : 0u) | (model.colors_ ? 2u : 0u) | (model.displacement_ ? 4u : 0u) | (single ? 8u : 0u);
  if (hulls_[variant] != nullptr) return hulls_[variant];
  std::vector<std::string> defines = stage_.defines;
  if (model.normals_) defines.emplace_back("OBJECT_NORMALS 1");
  if (model.colors_) defines.emplace_back("DETAIL_COLORS 1");
  if (model.displacement_) defines.emplace_back("DISPLACEMENT 1");
  if (single) defines.emplace_back("SINGLE_MATERIAL 1");
  const auto program = context_->program({"clip_surface.vert.glsl", "", stage_.fragment, defines});
  if (!program) return tl::unexpected(program.error());
  hulls_[variant] = *program;
  return hulls_[variant];
}

Result<void> ClipFrame::draw_hull(const ClipModel& model, const Placed& placed) {
  const auto found = hull_program(model);
  if (!found) return tl::unexpected(found.error());
  const gl::Program& program = **found;
  program.use();
  set_place(program, placed.to_world);
  program.set("displacement_range", Vec2(model.displacement_low_, model.displacement_high_));
  model.materials_->bind();
  model.materials_->set_single(program);
  if (model.normals_) glBindTextureUnit(11, model.normals_.id());
  if (model.colors_) glBindTextureUnit(12, model.colors_.id());
  if (model.displacement_) glBindTextureUnit(13, model.displacement_.id());
  if (stage_.prepare) stage_.prepare(program, model);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, has_lines() ? GL_FALSE : GL_TRUE);
  if (has_lines()) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_DST_ALPHA, GL_ONE_MINUS_DST_ALPHA);
  }
  glEnable(GL_DEPTH_TEST);
  if (marches(model)) return draw_interior(model, placed, program);
  glStencilFunc(GL_NOTEQUAL, 0, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glStencilMask(0);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glBindVertexArray(model.hull_array_.id());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(model.hull_index_count_), GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CULL_FACE);
  if (!rim_.empty()) {
    // Wide as lines want it, the rim would be seen over the hull's own inner edges.
    if (has_lines()) glStencilFunc(GL_EQUAL, ClipMatte::kLineBit, 0xff);
    glBindVertexArray(model.rim_array_.id());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * (rim_.size() / 4)), GL_UNSIGNED_INT, nullptr);
  }
  return {};
}

bool ClipFrame::marches(const ClipModel& model) const {
  return options_.interior.way == ClipInterior::kMarch && options_.antialias != ClipAntialias::kLines &&
         model.shell_.face_count > 0;
}

Result<void> ClipFrame::draw_interior(const ClipModel& model, const Placed& placed, const gl::Program& plain) {
  const std::size_t variant = model.colors_ ? 1 : 0;
  if (interiors_[variant] == nullptr) {
    std::vector<std::string> defines;
    if (model.colors_) defines.emplace_back("DETAIL_COLORS 1");
    const auto program = context_->program({"clip_interior.vert.glsl", "", "clip_interior.frag.glsl", defines});
    if (!program) return tl::unexpected(program.error());
    interiors_[variant] = *program;
  }
  const gl::Program& program = *interiors_[variant];
  program.use();
  set_place(program, placed.to_world);
  model.materials_->set_single(program);
  program.set("shell_range", Vec2(model.displacement_low_, model.displacement_high_));
  program.set("model_eye", Vec4(placed.eye.at, placed.eye.orthographic ? 0.0f : 1.0f));
  program.set("unit_px", placed.eye.orthographic ? camera_.pixel_size / placed.scale : camera_.pixel_size);
  program.set("texels_a_step", options_.interior.texels_a_step);
  program.set("march_steps", options_.interior.steps);
  glBindTextureUnit(8, model.displacement_.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, model.shell_.faces.id());
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  InteriorPass::Draws draws;
  draws.mask = mask_;
  draws.march = &program;
  draws.plain = &plain;
  draws.hull = [&] {
    glBindVertexArray(model.hull_array_.id());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(model.hull_index_count_), GL_UNSIGNED_INT, nullptr);
  };
  draws.shell = [&] {
    glBindVertexArray(model.shell_.array.id());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * model.shell_.face_count));
  };
  draws.rim = [&] {
    if (rim_.empty()) return;
    glDisable(GL_CULL_FACE);
    glBindVertexArray(model.rim_array_.id());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * (rim_.size() / 4)), GL_UNSIGNED_INT, nullptr);
    glEnable(GL_CULL_FACE);
  };
  InteriorPass::draw(draws);
  glDisable(GL_CULL_FACE);
  return {};
}

void ClipFrame::draw_original(ClipModel& model, const Placed& placed) {
  const ClipOriginal& original = model.original();
  original_->use();
  set_place(*original_, placed.to_world);
  original_->set("flat_normals", 0);
  original_->set("draw_faces", 1);
  model.plain_material_->bind();
  glBindVertexArray(original.array.id());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(original.vertex_count));
}

Result<void> ClipFrame::draw_clipped(ClipModel& model, const Placed& placed, ClipDrawn& drawn) {
  const Box box = box_of(model.bounds_, placed);
  if (box.width <= 0 || box.height <= 0) return {};
  drawn.level = choose_level(model, placed);
  ClipLevel& level = *model.levels_[drawn.level];
  loops_.points.clear();
  loops_.corners.clear();
  loops_.ends.clear();
  edge_on_.clear();
  if (drawn.place == EyePlace::kOutside) find_silhouette(level, placed, drawn);
  find_rim(model, placed);
  segments_.clear();
  if (has_lines()) segments_of(loops_, segments_);
  const auto streamed = stream(model);
  if (!streamed) return tl::unexpected(streamed.error());
  glEnable(GL_SCISSOR_TEST);
  glScissor(box.x, box.y, box.width, box.height);
  const auto meets = [&](const Box& other) {
    return box.x < other.x + other.width && other.x < box.x + box.width && box.y < other.y + other.height &&
           other.y < box.y + box.height;
  };
  const Clock::time_point begun = Clock::now();
  glStencilMask(0xff);
  if (std::any_of(counted_.begin(), counted_.end(), meets)) glClear(GL_STENCIL_BUFFER_BIT);
  counted_.push_back(box);
  if (has_lines()) {
    matte_->draw_lines(stream_.id(), streamed->segments, segments_.size(), rows_of(placed.to_world),
                       options_.line_width_px);
  }
  begin_counting(model, placed);
  if (drawn.place == EyePlace::kOutside) {
    count_loops(model, *streamed);
  } else {
    count_faces(level);
  }
  if (has_lines()) matte_->transfer();
  if (options_.time_stages) {
    glFinish();
    drawn.stencil_ms = ms_since(begun);
  }
  const Clock::time_point counted = Clock::now();
  if (auto hull = draw_hull(model, placed); !hull) return hull;
  stream_.end();
  if (options_.time_stages) {
    glFinish();
    drawn.hull_ms = ms_since(counted);
  }
  return {};
}

Result<ClipDrawn> ClipFrame::draw(ClipModel& model, const Mat4& to_world) {
  assert(targets_ != nullptr);
  ClipDrawn drawn;
  const Placed placed = place(to_world);
  drawn.place = model.locator_.place(camera_, far_distance_, placed.to_eye, placed.eye.at);
  if (drawn.place == EyePlace::kInside) {
    draw_original(model, placed);
    return drawn;
  }
  const Result<void> done = draw_clipped(model, placed, drawn);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_BLEND);
  glStencilMask(0xff);
  glEnable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glBindVertexArray(0);
  if (!done) return tl::unexpected(done.error());
  return drawn;
}

}  // namespace limn
