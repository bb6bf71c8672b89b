#include "demo_picture.h"

#include "session.h"

#ifdef LIMN_WITH_GL
#include <chrono>

#include "limn/image/image.h"
#include "limn/render/render.h"

#include "drawn_lines.h"
#include "interrupt.h"
#endif

namespace limn::cli {

#ifdef LIMN_WITH_GL

Result<std::vector<double>> draw_demo(std::span<const Mesh* const> meshes, const Camera& camera, const Size& size,
                                      const std::string& path) {
  const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  RenderOptions options;
  options.width = size.width / static_cast<int>(meshes.size());
  options.height = size.height;
  options.wireframe = true;
  std::vector<Image> panels;
  std::vector<double> times_ms;
  for (const Mesh* mesh : meshes) {
    std::vector<Segment3> outline;
    append_outline(*mesh, camera, Vec3(0.0f), outline);
    const auto begun = std::chrono::steady_clock::now();
    Result<Image> panel = render(**context, *mesh, camera, options, outline);
    if (!panel) return tl::unexpected(panel.error());
    times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count());
    panels.push_back(std::move(*panel));
  }
  const Unstoppable writing;
  return write_png(side_by_side(panels), path).map([&] { return times_ms; });
}

#else

Result<std::vector<double>> draw_demo(std::span<const Mesh* const>, const Camera&, const Size&, const std::string&) {
  return fail(ErrorCode::kNoGraphics, "this limn was built without OpenGL", "build it with LIMN_GL=ON for the picture");
}

#endif

}  // namespace limn::cli
