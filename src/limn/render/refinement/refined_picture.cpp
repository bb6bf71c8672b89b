#include "limn/render/refinement/refined_picture.h"

#include <chrono>
#include <utility>

#include "limn/gl/timer.h"
#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/picture.h"
#include "limn/render/targets.h"

namespace limn {
namespace {

/// Milliseconds until the device has done it; what was submitted before does not count.
template <class Work>
Result<double> time_on_device(const Work& work) {
  gl::finish();
  const auto begun = std::chrono::steady_clock::now();
  if (Result<void> done = work(); !done) return tl::unexpected(done.error());
  gl::finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace

Result<RefinedPicture> render_refined(const RefinementScene& scene, RefinementMethod& method, const Camera& camera,
                                      const RenderOptions& options) {
  if (auto checked = check_picture(options); !checked) return tl::unexpected(checked.error());
  scene.context().make_current();
  const auto targets = RenderTargets::create(options.width, options.height, options.samples);
  if (!targets) return tl::unexpected(targets.error());
  const auto materials = MaterialTable::create(scene.meshes());
  if (!materials) return tl::unexpected(materials.error());
  const CameraBuffer camera_buffer;
  camera_buffer.update(make_camera_block(camera, options.width, options.height));
  RefinedPicture picture;
  const auto refined = time_on_device([&] { return method.refine(view_of(camera, options.height)); });
  if (!refined) return tl::unexpected(refined.error());
  picture.refine_ms = *refined;
  targets->begin_faces();
  camera_buffer.bind();
  materials->bind();
  const auto drawn =
      time_on_device([&] { return method.draw({.flat_normals = options.flat, .wireframe = options.wireframe}); });
  if (!drawn) return tl::unexpected(drawn.error());
  picture.draw_ms = *drawn;
  picture.triangles = method.triangle_count();
  auto image = targets->resolve(scene.context(), options.background);
  if (!image) return tl::unexpected(image.error());
  picture.image = std::move(*image);
  return picture;
}

}  // namespace limn
