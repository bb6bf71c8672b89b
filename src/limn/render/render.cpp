#include "limn/render/render.h"

#include <cmath>
#include <epoxy/gl.h>
#include <new>
#include <string>
#include <type_traits>

#include "limn/gl/objects.h"
#include "limn/render/camera_block.h"
#include "limn/render/gpu_mesh.h"
#include "limn/render/materials.h"
#include "limn/render/targets.h"

namespace limn {
namespace {

constexpr int kLargestSide = 16384;

static_assert(sizeof(Segment3) == 9 * sizeof(float) && std::is_standard_layout_v<Segment3>,
              "segments are uploaded as they lie in memory");

Result<void> check(const RenderOptions& options) {
  const auto outside = [](int side) { return side < 1 || side > kLargestSide; };
  if (outside(options.width) || outside(options.height)) {
    return fail(ErrorCode::kInvalidArgument,
                "a picture of " + std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels",
                "sides go from 1 to " + std::to_string(kLargestSide));
  }
  if (options.samples != 1 && options.samples != 4) {
    return fail(ErrorCode::kInvalidArgument, std::to_string(options.samples) + " samples a pixel", "ask for 1 or 4");
  }
  if (!(options.line_width_px > 0.0f) || !std::isfinite(options.line_width_px)) {
    return fail(ErrorCode::kInvalidArgument, "a line width that is not above 0");
  }
  for (int c = 0; c < 4; ++c) {
    if (!(options.background[c] >= 0.0f && options.background[c] <= 1.0f)) {
      return fail(ErrorCode::kInvalidArgument, "a background colour outside 0 to 1");
    }
  }
  return {};
}

Result<void> draw_faces(gl::Context& context, const Mesh& mesh, std::span<const Vec3> points,
                        const RenderOptions& options) {
  const auto gpu = GpuMesh::upload(mesh, points);
  if (!gpu) return tl::unexpected(gpu.error());
  const auto materials = MaterialTable::create(mesh);
  if (!materials) return tl::unexpected(materials.error());
  gl::ProgramFiles files{"face.vert.glsl", "", "face.frag.glsl", {}};
  if (options.wireframe) {
    files.geometry = "wire.geom.glsl";
    files.defines = {"WIREFRAME 1"};
  }
  const auto found = context.program(files);
  if (!found) return tl::unexpected(found.error());
  const gl::Program& program = **found;
  program.use();
  materials->bind();
  program.set("flat_normals", options.flat || !gpu->has_normals() ? 1 : 0);
  program.set("draw_faces", options.draw_faces ? 1 : 0);
  glVertexAttrib4f(3, 1.0f, 1.0f, 1.0f, 1.0f);  // the tint of a mesh without colours
  if (!options.draw_faces) {
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    gpu->draw();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (!options.wireframe) return {};
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  gpu->draw();
  return {};
}

Result<void> draw_segments(gl::Context& context, std::span<const Segment3> segments, const RenderOptions& options,
                           const RenderTargets& targets) {
  const std::string multisample = "MULTISAMPLE " + std::to_string(targets.samples() > 1 ? targets.samples() : 0);
  const auto found = context.program({"line.vert.glsl", "", "line.frag.glsl", {multisample}});
  if (!found) return tl::unexpected(found.error());
  const gl::Program& program = **found;
  gl::take_out_of_memory();
  const gl::Buffer buffer = gl::make_buffer_of(segments);
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for " + std::to_string(segments.size()) + " lines");
  }
  const gl::VertexArray array = gl::make_vertex_array();
  for (unsigned i = 0; i < 3; ++i) {
    gl::attach_attribute(array, buffer, {i, 3, i * sizeof(Vec3), sizeof(Segment3), true});
  }
  program.use();
  program.set("half_width_px", 0.5f * options.line_width_px);
  targets.begin_lines();
  glBindTextureUnit(0, targets.depth().id());
  glBindVertexArray(array.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(segments.size()));
  glBindVertexArray(0);
  return {};
}

/// The scene as the device sees it. Squares and products in a shader are floats: a model in kilometres or nanometres
/// has to come near unit size before it is drawn. By a power of two, which changes no digit.
struct UnitScene {
  Camera camera;
  std::span<const Vec3> points;
  std::span<const Segment3> segments;
  std::vector<Vec3> moved_points;
  std::vector<Segment3> moved_segments;
};

UnitScene bring_to_unit_scale(const Mesh& mesh, const Camera& camera, std::span<const Segment3> segments) {
  UnitScene scene{camera, mesh.positions, segments, {}, {}};
  const double diagonal = face_bounds(mesh).diagonal();
  const double size = diagonal > 0.0 ? diagonal : glm::length(DVec3(camera.target) - DVec3(camera.eye));
  if (size > 1e-3 && size < 1e3) return scene;
  const double scale = std::ldexp(1.0, -std::ilogb(size));
  const auto scaled = [scale](float length) { return static_cast<float>(double{length} * scale); };
  const auto moved = [scale](const Vec3& p) { return Vec3(DVec3(p) * scale); };
  scene.camera.eye = moved(camera.eye);
  scene.camera.target = moved(camera.target);
  scene.camera.ortho_height = scaled(camera.ortho_height);
  scene.camera.near_distance = scaled(camera.near_distance);
  scene.camera.far_distance = scaled(camera.far_distance);
  for (const Vec3& p : mesh.positions)
    scene.moved_points.push_back(moved(p));
  for (const Segment3& s : segments)
    scene.moved_segments.push_back({moved(s.a), moved(s.b), s.color});
  scene.points = scene.moved_points;
  scene.segments = scene.moved_segments;
  return scene;
}

}  // namespace

Result<Image> render(gl::Context& context, const Mesh& mesh, const Camera& camera, const RenderOptions& options,
                     std::span<const Segment3> segments) try {
  if (auto checked = check(options); !checked) return tl::unexpected(checked.error());
  context.make_current();
  const auto targets = RenderTargets::create(options.width, options.height, options.samples);
  if (!targets) return tl::unexpected(targets.error());
  const UnitScene scene = bring_to_unit_scale(mesh, camera, segments);
  const CameraBuffer camera_buffer;
  camera_buffer.update(make_camera_block(scene.camera, options.width, options.height));
  camera_buffer.bind();
  targets->begin_faces();
  if (!mesh.faces.empty()) {
    if (auto drawn = draw_faces(context, mesh, scene.points, options); !drawn) return tl::unexpected(drawn.error());
  }
  if (!segments.empty()) {
    if (auto drawn = draw_segments(context, scene.segments, options, *targets); !drawn)
      return tl::unexpected(drawn.error());
  }
  return targets->resolve(context, options.background);
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kNoGraphics, "not enough memory for the picture or the mesh", "draw a smaller one");
}

}  // namespace limn
