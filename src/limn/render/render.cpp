#include "limn/render/render.h"

#include <epoxy/gl.h>
#include <new>

#include "limn/gl/objects.h"
#include "limn/render/camera_block.h"
#include "limn/render/gpu_mesh.h"
#include "limn/render/materials.h"
#include "limn/render/picture.h"
#include "limn/render/targets.h"

namespace limn {
namespace {

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

/// The scene as the device sees it, near unit size.
struct UnitScene {
  Camera camera;
  std::span<const Vec3> points;
  std::span<const Segment3> segments;
  std::vector<Vec3> moved_points;
  std::vector<Segment3> moved_segments;
};

UnitScene bring_to_unit_scale(const Mesh& mesh, const Camera& camera, std::span<const Segment3> segments) {
  UnitScene scene{camera, mesh.positions, segments, {}, {}};
  const double scale = unit_scale(mesh, camera);
  if (scale == 1.0) return scene;
  scene.camera = scaled(camera, scale);
  for (const Vec3& p : mesh.positions)
    scene.moved_points.push_back(scaled(p, scale));
  for (const Segment3& s : segments)
    scene.moved_segments.push_back({scaled(s.a, scale), scaled(s.b, scale), s.color});
  scene.points = scene.moved_points;
  scene.segments = scene.moved_segments;
  return scene;
}

}  // namespace

Result<Image> render(gl::Context& context, const Mesh& mesh, const Camera& camera, const RenderOptions& options,
                     std::span<const Segment3> segments) try {
  if (auto checked = check_picture(options); !checked) return tl::unexpected(checked.error());
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
