#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "limn/image/image.h"
#include "limn/render/render.h"

#include "camera_options.h"
#include "drawn_lines.h"
#include "interrupt.h"
#include "level_options.h"
#include "mesh_files.h"
#include "verb.h"

namespace limn::cli {
namespace {

struct RenderFlags {
  InputOptions input;
  std::string output;
  bool refined = false;
  CameraOptions camera;
  LevelFlags levels;
  Size size{1024, 1024};
  RenderOptions options;
  bool level_lines = false;
  bool outline = false;
};

/// What is drawn: the mesh as it is or refined, and the lines over it.
struct Scene {
  Mesh mesh;
  Camera camera;
  std::vector<Segment3> lines;
};

Result<void> check(const Session& session, const RenderFlags& flags) {
  return check_camera(flags.camera).and_then([&] { return check_levels(flags.levels); }).and_then([&] {
    return check_picture_output(session, flags.output, ".png");
  });
}

/// Black, or white where the background is dark.
Vec3 ink(const Vec4& background) {
  const float brightness = 0.3f * background.x + 0.6f * background.y + 0.1f * background.z;
  return background.w < 0.5f || brightness > 0.35f ? Vec3(0.0f) : Vec3(1.0f);
}

Result<Scene> build_scene(Session& session, const RenderFlags& flags, const Mesh& mesh) {
  const float aspect = static_cast<float>(flags.size.width) / static_cast<float>(flags.size.height);
  const Result<Camera> camera = place_camera(flags.camera, mesh, aspect);
  if (!camera) return tl::unexpected(camera.error());
  Scene scene{mesh, *camera, {}};
  if (flags.refined || flags.level_lines) {
    const RefineOptions options = refine_options(flags.levels, session.progress());
    const Result<Refiner> refiner = Refiner::create(mesh, options);
    if (!refiner) return tl::unexpected(about(refiner.error(), flags.input.path));
    Result<Refinement> refined = refiner->refine(view_of(*camera, flags.size.height), options.levels);
    if (!refined) return tl::unexpected(about(refined.error(), flags.input.path));
    if (flags.level_lines)
      append_level_lines(*refiner, *refined, options.levels.max_level,
                         flags.refined ? std::optional(options.blend) : std::nullopt, scene.lines);
    if (flags.refined) scene.mesh = std::move(refined->mesh);
  }
  if (flags.outline) append_outline(scene.mesh, scene.camera, ink(flags.options.background), scene.lines);
  return scene;
}

Result<void> report(Session& session, const RenderFlags& flags, const LoadedMesh& loaded, const Scene& scene,
                    const gl::Context& context, double time_ms) {
  session.say(fmt::format("{}: {}x{}, {}, {:.1f} ms ({})", flags.output, flags.size.width, flags.size.height,
                          counted(scene.mesh.face_count(), "triangle"), time_ms, context.renderer()));
  if (!session.json()) return {};
  return session.print_json({{"input", flags.input.path},
                             {"output", flags.output},
                             {"method", flags.refined ? "refine" : "coarse"},
                             {"width", flags.size.width},
                             {"height", flags.size.height},
                             {"triangles_in", loaded.mesh.face_count()},
                             {"triangles", scene.mesh.face_count()},
                             {"lines", scene.lines.size()},
                             {"time_ms", time_ms},
                             {"renderer", context.renderer()},
                             {"opengl", context.version()},
                             {"notes", loaded.notes},
                             {"repairs", loaded.repairs}});
}

Result<int> run(Session& session, const RenderFlags& flags) {
  if (const Result<void> good = check(session, flags); !good) return tl::unexpected(good.error());
  const Result<LoadedMesh> loaded = load_with_faces(session, flags.input);
  if (!loaded) return tl::unexpected(loaded.error());
  const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  const auto begun = std::chrono::steady_clock::now();
  const Result<Scene> scene = build_scene(session, flags, loaded->mesh);
  if (!scene) return tl::unexpected(scene.error());
  RenderOptions options = flags.options;
  options.width = flags.size.width;
  options.height = flags.size.height;
  const Result<Image> image = render(**context, scene->mesh, scene->camera, options, scene->lines);
  if (!image) return tl::unexpected(image.error());
  const double time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  return session.check_stop()
      .and_then([&] {
        const Unstoppable writing;
        return write_png(*image, flags.output);
      })
      .and_then([&] { return report(session, flags, *loaded, *scene, **context, time_ms); })
      .map([] { return kExitDone; });
}

Run declare_render(OptionTable& table) {
  const auto flags = std::make_shared<RenderFlags>();
  table.argument("MODEL", flags->input.path, "mesh to draw; - is standard input");
  table.begin(Group::kOwn);
  table.file("-o,--output", flags->output, "picture to write, .png; - is standard output").required = true;
  table.choice("--method", flags->refined, {{"coarse", false}, {"refine", true}},
               "as it is (default), or refined for this view");
  table.parsed("--size", "WxH", flags->size, parse_size, "of the picture (default 1024x1024)");
  table.toggle("--wireframe", flags->options.wireframe, "the edges of the triangles drawn");
  table.toggle("--levels", flags->level_lines, "the model's edges coloured by refinement level, blue 0 to yellow M");
  table.toggle("--outline", flags->outline, "the silhouette and the open borders drawn as lines");
  table.toggle("--flat", flags->options.flat, "each triangle in one shade");
  table.parsed("--background", "COLOR", flags->options.background, parse_color,
               "name, #rgb, #rrggbb, #rrggbbaa, transparent (default white)");
  table.choice("--samples", flags->options.samples, {{"1", 1}, {"4", 4}}, "a pixel (default 4)");
  table.begin(Group::kFiles);
  add_input_options(table, flags->input);
  add_camera_options(table, flags->camera);
  add_level_options(table, flags->levels);
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb render_verb() {
  return Verb{"render",
              "draws a mesh into a picture, without a display; as it is or refined",
              "MODEL -o FILE.png [--method refine] [options]",
              true,
              {{{"limn render knot.ply -o knot.png --view 30,20", "as it is"},
                {"limn render knot.ply -o levels.png --method refine --levels --size 640x480",
                 "refined for this view, edges coloured by level"},
                {"limn render knot.ply -o - --method refine --outline --background transparent --size 256 > ink.png",
                 "with its outline, on no background, to standard output"}}},
              declare_render};
}

}  // namespace limn::cli
