#include <array>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "limn/compare/outline.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/refine.h"

#include "demo_picture.h"
#include "mesh_files.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kDenseFaces = 60'000;
constexpr float kAzimuthRad = 0.5f;
constexpr float kElevationRad = 0.35f;
/// Share of a panel that the knot spans.
constexpr float kFill = 0.92f;

struct DemoFlags {
  std::string output = "demo.png";
  std::uint64_t faces = 800;
  Size size{1800, 600};
};

/// One of the three, left to right.
struct Panel {
  std::string_view name;
  Mesh mesh;
  std::optional<OutlineError> error;  ///< against the dense one
  std::optional<double> refine_ms, draw_ms;
};

struct Demo {
  std::array<Panel, 3> panels;  ///< coarse, refined, dense
  Camera camera;
  CompareOptions measured;
};

double milliseconds_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

Result<Refinement> refine_panel(Demo& demo, const Refiner& refiner, const DemoFlags& flags) {
  const auto begun = Clock::now();
  Result<Refinement> refined = refiner.refine(view_of(demo.camera, flags.size.height), {});
  demo.panels[1].refine_ms = milliseconds_since(begun);
  return refined;
}

/// Outline errors over random views, the refined mesh refined anew for each.
Result<void> measure(Session& session, Demo& demo, const Refiner& refiner) {
  auto& [coarse, refined, dense] = demo.panels;
  demo.measured.views = 10;
  demo.measured.size_px = 1024;
  demo.measured.progress = session.progress();
  const Result<Comparison> plain = compare_meshes(coarse.mesh, dense.mesh, demo.measured);
  if (!plain) return tl::unexpected(plain.error());
  coarse.error = plain->overall;
  const MeshForCamera seen = [&refiner](const Camera& camera, int height_px) -> Result<Mesh> {
    return refiner.refine(view_of(camera, height_px), {}).map([](Refinement&& result) {
      return std::move(result.mesh);
    });
  };
  const Result<Comparison> smooth = compare_meshes(seen, dense.mesh, demo.measured);
  if (!smooth) return tl::unexpected(smooth.error());
  refined.error = smooth->overall;
  return {};
}

Result<Demo> build(Session& session, const DemoFlags& flags) {
  Result<Mesh> coarse = make_shape(Shape::kKnot, {static_cast<std::size_t>(flags.faces), 1});
  if (!coarse) return tl::unexpected(coarse.error());
  Result<Mesh> dense = make_shape(Shape::kKnot, {kDenseFaces, 1});
  if (!dense) return tl::unexpected(dense.error());
  CameraFit fit;
  fit.fill = kFill;
  const int panel_width = flags.size.width / 3;
  fit.aspect = static_cast<float>(panel_width) / static_cast<float>(flags.size.height);
  Demo demo;
  demo.camera = fit_camera(dense->positions, view_direction(kAzimuthRad, kElevationRad), fit);
  const Result<Refiner> refiner = Refiner::create(*coarse);
  if (!refiner) return tl::unexpected(refiner.error());
  Result<Refinement> refined = refine_panel(demo, *refiner, flags);
  if (!refined) return tl::unexpected(refined.error());
  demo.panels[0].name = "coarse";
  demo.panels[0].mesh = std::move(*coarse);
  demo.panels[1].name = "refined";
  demo.panels[1].mesh = std::move(refined->mesh);
  demo.panels[2].name = "dense";
  demo.panels[2].mesh = std::move(*dense);
  return measure(session, demo, *refiner).map([&] { return std::move(demo); });
}

Result<void> draw(Demo& demo, const DemoFlags& flags) {
  const std::array<const Mesh*, 3> meshes{&demo.panels[0].mesh, &demo.panels[1].mesh, &demo.panels[2].mesh};
  const Result<std::vector<double>> times_ms = draw_demo(meshes, demo.camera, flags.size, flags.output);
  if (!times_ms) return tl::unexpected(times_ms.error());
  for (std::size_t i = 0; i < meshes.size(); ++i)
    demo.panels[i].draw_ms = (*times_ms)[i];
  return {};
}

std::string figure(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

std::string table_text(const Demo& demo) {
  std::string text = "                       outline error in pixels\n";
  text += "model     triangles      mean   95 %    max   refine, ms   draw, ms\n";
  for (const Panel& panel : demo.panels) {
    const auto error = [&](double OutlineError::*member) {
      return panel.error ? figure((*panel.error).*member, 2) : std::string("-");
    };
    text += fmt::format("{:<8} {:>10} {:>9} {:>6} {:>6} {:>12} {:>10}\n", panel.name, panel.mesh.face_count(),
                        error(&OutlineError::mean_px), error(&OutlineError::p95_px), error(&OutlineError::max_px),
                        figure(panel.refine_ms, 2), figure(panel.draw_ms, 1));
  }
  return text +
         fmt::format("Error against the dense model over {} random views of {} x {} pixels, refined anew for each.\n",
                     demo.measured.views, demo.measured.size_px, demo.measured.size_px);
}

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json table_json(const Demo& demo, const DemoFlags& flags, bool drawn) {
  ordered_json json{{"picture", drawn ? ordered_json(flags.output) : ordered_json(nullptr)},
                    {"views", demo.measured.views},
                    {"size_px", demo.measured.size_px},
                    {"models", ordered_json::array()}};
  for (const Panel& panel : demo.panels) {
    const auto error = [&](double OutlineError::*member) {
      return panel.error ? ordered_json((*panel.error).*member) : ordered_json(nullptr);
    };
    json["models"].push_back({{"name", panel.name},
                              {"triangles", panel.mesh.face_count()},
                              {"mean_px", error(&OutlineError::mean_px)},
                              {"p95_px", error(&OutlineError::p95_px)},
                              {"max_px", error(&OutlineError::max_px)},
                              {"iou", error(&OutlineError::iou)},
                              {"refine_ms", number_or_null(panel.refine_ms)},
                              {"draw_ms", number_or_null(panel.draw_ms)}});
  }
  return json;
}

Result<int> run(Session& session, const DemoFlags& flags) {
  if (const Result<void> good = check_picture_output(session, flags.output, ".png"); !good)
    return tl::unexpected(good.error());
  if (flags.output == "-") {
    return fail(ErrorCode::kInvalidArgument, "demo: its table takes standard output", "write the picture to a file");
  }
  if (flags.size.width < 3) {
    return fail(ErrorCode::kInvalidArgument, "demo: --size is narrower than three panels", "make it wider");
  }
  Result<Demo> demo = build(session, flags);
  if (!demo) return tl::unexpected(demo.error());
  if (const Result<void> going = session.check_stop(); !going) return tl::unexpected(going.error());
  // The figures need no OpenGL: they are printed even where the picture cannot be drawn.
  const Result<void> drawn = draw(*demo, flags);
  const Result<void> printed = session.json() ? session.print_json(table_json(*demo, flags, drawn.has_value()))
                                              : session.print(table_text(*demo));
  if (!printed) return tl::unexpected(printed.error());
  if (!drawn) return tl::unexpected(drawn.error());
  session.say(fmt::format("{}: left to right coarse, refined, dense", flags.output));
  return kExitDone;
}

Run declare_demo(OptionTable& table) {
  const auto flags = std::make_shared<DemoFlags>();
  table.file("-o,--output", flags->output, "picture to write (default demo.png)");
  table.count("--faces", flags->faces, 100, kDenseFaces, "of the coarse model, about (default 800)");
  table.parsed("--size", "WxH", flags->size, parse_size, "of the picture, three panels wide (default 1800x600)");
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb demo_verb() {
  return Verb{"demo",
              "shows a coarse model beside the same refined: a picture and a table, no files needed",
              "[-o FILE.png] [--faces N] [--size WxH]",
              true,
              {{{"limn demo", "demo.png, and the table"},
                {"limn demo -o panels.png --size 2400x800 --faces 500", "larger, from a coarser model"},
                {"limn demo --json", "the table for a script"}}},
              declare_demo};
}

}  // namespace limn::cli
