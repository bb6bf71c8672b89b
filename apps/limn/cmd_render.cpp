#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "limn/image/image.h"
#include "limn/render/picture.h"
#include "limn/render/refinement/refined_picture.h"
#include "limn/render/render.h"

#include "camera_options.h"
#include "clip_rendering.h"
#include "drawn_lines.h"
#include "interrupt.h"
#include "level_options.h"
#include "mesh_files.h"
#include "refinement_methods.h"
#include "verb.h"

namespace limn::cli {
namespace {

struct RenderFlags {
  InputOptions input;
  std::string output;
  RenderMethod method = RenderMethod::kCoarse;
  std::uint64_t budget = 0;
  CameraOptions camera;
  LevelFlags levels;
  ClipDrawFlags clip;
  Size size{1024, 1024};
  RenderOptions options;
  bool level_lines = false;
  bool outline = false;

  bool lines() const { return level_lines || outline; }
};

/// What was drawn, and by what.
struct Drawn {
  Image image;
  RenderMethod method = RenderMethod::kCoarse;
  std::uint64_t triangles = 0;
  std::size_t lines = 0;
  double time_ms = 0;
  nlohmann::ordered_json device{};  ///< what only methods on the device tell
};

/// What is drawn: the mesh as it is or refined, and the lines over it.
struct Scene {
  Mesh mesh;
  Camera camera;
  std::vector<Segment3> lines;
};

/// Lines are found in triangles that the CPU has.
RenderMethod chosen_method(const RenderFlags& flags) {
  if (flags.method != RenderMethod::kAuto) return flags.method;
  return flags.lines() ? RenderMethod::kRefine : RenderMethod::kPatterns;
}

tl::unexpected<Error> not_for(RenderMethod method, const std::string& flag, const std::string& remedy) {
  return fail(ErrorCode::kInvalidArgument, fmt::format("{} is not for --method {}", flag, method_name(method)), remedy);
}

Result<void> check_method(const RenderFlags& flags) {
  const RenderMethod method = chosen_method(flags);
  const bool patterns = method == RenderMethod::kPatterns;
  const bool cpu = method == RenderMethod::kCoarse || method == RenderMethod::kRefine;
  if (method == RenderMethod::kClip && (flags.options.wireframe || flags.options.flat))
    return not_for(method, flags.options.flat ? "--flat" : "--wireframe", "use --method coarse on limn hull's output");
  if (flags.lines() && !cpu)
    return not_for(method, flags.outline ? "--outline" : "--levels", "use --method refine or auto");
  if (flags.budget > 0 && !patterns) return not_for(method, "--budget", "use --method patterns, or leave it out");
  if (flags.levels.family != PatternFamily::kNested && !patterns && !cpu)
    return not_for(method, "--topology", "use --method patterns or refine, or leave it out");
  if (flags.levels.blend != Blend::kSurplus && !patterns && !cpu)
    return not_for(method, "--blend", "use --method patterns or refine, or leave it out");
  return {};
}

Result<void> check(const Session& session, const RenderFlags& flags) {
  return check_camera(flags.camera)
      .and_then([&] { return check_levels(flags.levels); })
      .and_then([&] { return check_method(flags); })
      .and_then([&] { return check_picture_output(session, flags.output, ".png"); });
}

/// Black, or white where the background is dark.
Vec3 ink(const Vec4& background) {
  const float brightness = 0.3f * background.x + 0.6f * background.y + 0.1f * background.z;
  return background.w < 0.5f || brightness > 0.35f ? Vec3(0.0f) : Vec3(1.0f);
}

Result<Scene> build_scene(Session& session, const RenderFlags& flags, const Mesh& mesh, const Camera& camera) {
  Scene scene{mesh, camera, {}};
  const bool draw_refined = chosen_method(flags) == RenderMethod::kRefine;
  if (draw_refined || flags.level_lines) {
    const RefineOptions options = refine_options(flags.levels, session.progress());
    const Result<Refiner> refiner = Refiner::create(mesh, options);
    if (!refiner) return tl::unexpected(about(refiner.error(), flags.input.path));
    Result<Refinement> refined = refiner->refine(view_of(camera, flags.size.height), options.levels);
    if (!refined) return tl::unexpected(about(refined.error(), flags.input.path));
    if (flags.level_lines)
      append_level_lines(*refiner, *refined, options.levels.max_level,
                         draw_refined ? std::optional(options.blend) : std::nullopt, scene.lines);
    if (draw_refined) scene.mesh = std::move(refined->mesh);
  }
  if (flags.outline) append_outline(scene.mesh, scene.camera, ink(flags.options.background), scene.lines);
  return scene;
}

RenderOptions render_options(const RenderFlags& flags) {
  RenderOptions options = flags.options;
  options.width = flags.size.width;
  options.height = flags.size.height;
  return options;
}

Result<Drawn> draw_from_cpu(Session& session, const RenderFlags& flags, const Mesh& mesh, const Camera& camera,
                            gl::Context& context) {
  const Result<Scene> scene = build_scene(session, flags, mesh, camera);
  if (!scene) return tl::unexpected(scene.error());
  Result<Image> image = render(context, scene->mesh, scene->camera, render_options(flags), scene->lines);
  if (!image) return tl::unexpected(image.error());
  return Drawn{std::move(*image), chosen_method(flags), scene->mesh.face_count(), scene->lines.size()};
}

Result<Drawn> draw_on_device(Session& session, const RenderFlags& flags, Mesh mesh, const Camera& camera,
                             gl::Context& context) {
  if (const Result<void> fit = check_extent(mesh); !fit) return tl::unexpected(about(fit.error(), flags.input.path));
  const double scale = unit_scale(mesh, camera);
  for (Vec3& p : mesh.positions)
    p = scaled(p, scale);
  RefineOptions options = refine_options(flags.levels, session.progress());
  options.levels.near_distance = static_cast<float>(flags.levels.near_distance * scale);
  options.levels.far_distance = static_cast<float>(flags.levels.far_distance * scale);
  const Result<Refiner> refiner = Refiner::create(std::move(mesh), options);
  if (!refiner) return tl::unexpected(about(refiner.error(), flags.input.path));
  Result<RefinementScene> scene = RefinementScene::create(context, *refiner, {.center = options.center});
  if (!scene) return tl::unexpected(scene.error());
  const RenderMethod chosen = chosen_method(flags);
  const Result<std::unique_ptr<RefinementMethod>> method = make_method(chosen, *scene, options, flags.budget);
  if (!method) return tl::unexpected(about(method.error(), flags.input.path));
  Result<RefinedPicture> picture = render_refined(*scene, **method, scaled(camera, scale), render_options(flags));
  if (!picture) return tl::unexpected(about(picture.error(), flags.input.path));
  Drawn drawn{std::move(picture->image), chosen, picture->triangles};
  drawn.device = {
      {"refine_ms", picture->refine_ms}, {"draw_ms", picture->draw_ms}, {"device_bytes", (*method)->device_bytes()}};
  return drawn;
}

Result<Drawn> draw(Session& session, const RenderFlags& flags, const LoadedMesh& loaded, gl::Context& context) {
  const Mesh& mesh = loaded.mesh;
  const auto begun = std::chrono::steady_clock::now();
  const float aspect = static_cast<float>(flags.size.width) / static_cast<float>(flags.size.height);
  const Result<Camera> camera = place_camera(flags.camera, loaded.framed(), aspect, face_bounds(mesh));
  if (!camera) return tl::unexpected(camera.error());
  Result<Drawn> drawn = on_device(chosen_method(flags)) ? draw_on_device(session, flags, mesh, *camera, context)
                                                        : draw_from_cpu(session, flags, mesh, *camera, context);
  if (drawn)
    drawn->time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  return drawn;
}

Result<void> report(Session& session, const RenderFlags& flags, const LoadedMesh& loaded, const Drawn& drawn,
                    const gl::Context& context) {
  session.say(fmt::format("{}: {}x{}, {}, {:.1f} ms ({})", flags.output, flags.size.width, flags.size.height,
                          counted(drawn.triangles, "triangle"), drawn.time_ms, context.renderer()));
  if (flags.budget > 0 && drawn.triangles > flags.budget) {
    session.say(fmt::format("{}: over the budget of {}: the mesh as it is has as many", flags.output,
                            counted(flags.budget, "triangle")));
  }
  if (!session.json()) return {};
  nlohmann::ordered_json data = {
      {"input", flags.input.path},      {"output", flags.output},      {"method", method_name(drawn.method)},
      {"width", flags.size.width},      {"height", flags.size.height}, {"triangles_in", loaded.mesh.face_count()},
      {"triangles", drawn.triangles},   {"lines", drawn.lines},        {"time_ms", drawn.time_ms},
      {"renderer", context.renderer()}, {"opengl", context.version()}, {"notes", loaded.notes},
      {"repairs", loaded.repairs}};
  if (!drawn.device.is_null()) data.update(drawn.device);
  return session.print_json(data);
}

nlohmann::ordered_json details_of(const ClipPicture& picture) {
  const ClipDrawn& drawn = picture.drawn.front();
  constexpr const char* kPlaces[] = {"outside", "between", "inside"};
  return {{"draw_ms", picture.draw_ms},
          {"eye", kPlaces[static_cast<int>(drawn.place)]},
          {"silhouette_level", drawn.level},
          {"silhouette_edges", drawn.silhouette_edges},
          {"stencil_triangles", drawn.stencil_triangles}};
}

/// Draws a clip asset instead of a mesh.
Result<int> run_clip(Session& session, const RenderFlags& flags) {
  const Result<ClipAsset> asset = load_clip_asset(flags.input.path);
  if (!asset) return tl::unexpected(asset.error());
  const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  const auto begun = std::chrono::steady_clock::now();
  LoadedMesh original;
  original.mesh = asset->levels.front().mesh;
  const float aspect = static_cast<float>(flags.size.width) / static_cast<float>(flags.size.height);
  const Result<Camera> camera = place_camera(flags.camera, original.mesh, aspect);
  if (!camera) return tl::unexpected(camera.error());
  Result<ClipPicture> picture = draw_clip_asset(**context, *asset, *camera, render_options(flags), flags.clip);
  if (!picture) return tl::unexpected(about(picture.error(), flags.input.path));
  Drawn drawn{std::move(picture->image), RenderMethod::kClip, asset->hull.face_count()};
  drawn.device = details_of(*picture);
  drawn.time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  return session.check_stop()
      .and_then([&] {
        const Unstoppable writing;
        return write_png(drawn.image, flags.output);
      })
      .and_then([&] { return report(session, flags, original, drawn, **context); })
      .map([] { return kExitDone; });
}

Result<int> run(Session& session, const RenderFlags& flags) {
  if (const Result<void> good = check(session, flags); !good) return tl::unexpected(good.error());
  if (flags.method == RenderMethod::kClip) return run_clip(session, flags);
  const Result<LoadedMesh> loaded = load_with_faces(session, flags.input);
  if (!loaded) return tl::unexpected(loaded.error());
  const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  const Result<Drawn> drawn = draw(session, flags, *loaded, **context);
  if (!drawn) return tl::unexpected(drawn.error());
  return session.check_stop()
      .and_then([&] {
        const Unstoppable writing;
        return write_png(drawn->image, flags.output);
      })
      .and_then([&] { return report(session, flags, *loaded, *drawn, **context); })
      .map([] { return kExitDone; });
}

Run declare_render(OptionTable& table) {
  const auto flags = std::make_shared<RenderFlags>();
  table.argument("MODEL", flags->input.path, "mesh to draw; - is standard input");
  table.begin(Group::kOwn);
  table.file("-o,--output", flags->output, "picture to write, .png; - is standard output").required = true;
  table
      .choice("--method", flags->method, render_methods(),
              "coarse (default): as it is; refine: on the CPU; auto: as it goes best; clip: an asset of limn clip")
      .value = "NAME";
  table.count("--budget", flags->budget, 1, 1'000'000'000, "the most triangles --method patterns refines to");
  table.parsed("--size", "WxH", flags->size, parse_size, "of the picture (default 1024x1024)");
  table.toggle("--wireframe", flags->options.wireframe, "the edges of the triangles drawn");
  table.toggle("--levels", flags->level_lines, "the model's edges coloured by refinement level, blue 0 to yellow M");
  table.toggle("--outline", flags->outline, "the silhouette and the open borders drawn as lines");
  table.toggle("--flat", flags->options.flat, "each triangle in one shade");
  table.parsed("--background", "COLOR", flags->options.background, parse_color,
               "name, #rgb, #rrggbb, #rrggbbaa, transparent (default white)");
  table.choice("--samples", flags->options.samples, {{"1", 1}, {"4", 4}}, "a pixel (default 4)");
  add_clip_options(table, flags->clip);
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
              "MODEL -o FILE.png [--method patterns] [options]",
              true,
              {{{"limn render knot.ply -o knot.png --view 30,20", "as it is"},
                {"limn render knot.ply -o fine.png --method patterns --wireframe --size 640x480",
                 "refined for this view on the graphics device, its triangles shown"},
                {"limn render knot.ply -o - --method refine --outline --background transparent --size 256 > ink.png",
                 "with its outline, on no background, to standard output"}}},
              declare_render};
}

}  // namespace limn::cli
