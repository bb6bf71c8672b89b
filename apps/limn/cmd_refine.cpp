#include <array>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#ifdef LIMN_WITH_GL
#include "limn/render/refinement/device_refine.h"
#endif

#include "camera_options.h"
#include "level_options.h"
#include "mesh_files.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

struct RefineFlags {
  InputOptions input;
  OutputOptions output;
  CameraOptions camera;
  LevelFlags levels;
  Size size{1024, 1024};
  bool on_device = false;
};

Result<void> check(const Session& session, const RefineFlags& flags) {
  if (flags.levels.needs_eye() && !flags.camera.placed()) {
    return fail(
        ErrorCode::kInvalidArgument,
        fmt::format("refine: {} needs to know where the mesh is seen from",
                    flags.levels.pixels > 0 ? "--pixels"
                                            : "--criterion " + std::string(criterion_name(flags.levels.criterion))),
        "add --view AZ,EL or --eye X,Y,Z, or use --criterion uniform");
  }
  return check_camera(flags.camera).and_then([&] { return check_levels(flags.levels); }).and_then([&] {
    return check_output(session, flags.output);
  });
}

/// How many of the input's faces were refined at each level, from 0.
std::array<std::size_t, kMaxLevel + 1> faces_by_level(const Refinement& refined) {
  std::array<std::size_t, kMaxLevel + 1> counts{};
  for (const std::uint8_t level : refined.face_level)
    ++counts[level];
  return counts;
}

std::string levels_text(const Refinement& refined, int max_level) {
  const auto counts = faces_by_level(refined);
  std::string text;
  for (std::size_t level = 0; level <= static_cast<std::size_t>(max_level); ++level) {
    text += fmt::format("{}{} at {}", level == 0 ? "" : ", ", counts[level], level);
  }
  return text;
}

Result<void> report(Session& session, const RefineFlags& flags, const LoadedMesh& loaded, const Refinement& refined,
                    double time_ms) {
  session.say(fmt::format("{}: {} to {}, {:.1f} ms; faces by level: {}", flags.output.path,
                          counted(loaded.mesh.face_count(), "triangle"), counted(refined.mesh.face_count(), "triangle"),
                          time_ms, levels_text(refined, flags.levels.max_level)));
  if (!session.json()) return {};
  const auto counts = faces_by_level(refined);
  return session.print_json(
      {{"input", flags.input.path},
       {"output", flags.output.path},
       {"backend", flags.on_device ? "gpu" : "cpu"},
       {"criterion", criterion_name(flags.levels.criterion)},
       {"max_level", flags.levels.max_level},
       {"triangles_in", loaded.mesh.face_count()},
       {"triangles_out", refined.mesh.face_count()},
       {"vertices_out", refined.mesh.positions.size()},
       {"refined_faces", refined.refined_faces},
       {"faces_by_level", std::vector<std::size_t>(counts.begin(), counts.begin() + flags.levels.max_level + 1)},
       {"time_ms", time_ms},
       {"notes", loaded.notes},
       {"repairs", loaded.repairs}});
}

Result<Refinement> refine_by_backend(Session& session, const RefineFlags& flags, const Mesh& mesh, const View& view) {
  const RefineOptions options = refine_options(flags.levels, session.progress());
  if (!flags.on_device) return refine(mesh, view, options);
#ifdef LIMN_WITH_GL
  const auto context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  return refine_on_device(**context, mesh, view, options);
#else
  return fail(ErrorCode::kNoGraphics, "this limn was built without OpenGL", "use --backend cpu");
#endif
}

Result<int> run(Session& session, const RefineFlags& flags) {
  if (const Result<void> good = check(session, flags); !good) return tl::unexpected(good.error());
  const Result<LoadedMesh> loaded = load_with_faces(session, flags.input);
  if (!loaded) return tl::unexpected(loaded.error());
  View view;
  if (flags.camera.placed()) {
    const float aspect = static_cast<float>(flags.size.width) / static_cast<float>(flags.size.height);
    const Result<Camera> camera = place_camera(flags.camera, loaded->framed(), aspect, face_bounds(loaded->mesh));
    if (!camera) return tl::unexpected(camera.error());
    view = view_of(*camera, flags.size.height);
  }
  const auto begun = std::chrono::steady_clock::now();
  const Result<Refinement> refined = refine_by_backend(session, flags, loaded->mesh, view);
  if (!refined) return tl::unexpected(about(refined.error(), flags.input.path));
  const double time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  return save(session, refined->mesh, flags.output)
      .and_then([&] { return report(session, flags, *loaded, *refined, time_ms); })
      .map([] { return kExitDone; });
}

Run declare_refine(OptionTable& table) {
  const auto flags = std::make_shared<RefineFlags>();
  table.argument("MODEL", flags->input.path, "coarse mesh; - is standard input");
  table.begin(Group::kFiles);
  add_output_options(table, flags->output);
  add_input_options(table, flags->input);
  add_camera_options(table, flags->camera);
  add_level_options(table, flags->levels);
  table.parsed("--size", "WxH", flags->size, parse_size, "of the picture --pixels counts in (default 1024x1024)");
  table.choice("--backend", flags->on_device, {{"cpu", false}, {"gpu", true}},
               "where the surface is computed (default cpu); the same triangles in another order");
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb refine_verb() {
  return Verb{"refine",
              "writes a mesh that is fine along its outline, seen from a viewpoint, and watertight",
              "MODEL -o FILE (--eye X,Y,Z | --view AZ,EL) [options]",
              true,
              {{{"limn refine knot.ply -o fine.ply --view 30,20", "seen from 30 degrees to the right and 20 above"},
                {"limn refine knot.ply -o fine.obj --eye 0,1,4 --pixels 0.25 --size 1920x1080 --max-level 5",
                 "as fine as a picture of that size can show"},
                {"limn refine knot.ply -o smooth.glb --criterion uniform --max-level 2",
                 "everywhere, for no particular view"}}},
              declare_refine};
}

}  // namespace limn::cli
