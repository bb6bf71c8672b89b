#include <array>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "limn/compare/outline.h"

#include "gate.h"
#include "level_options.h"
#include "mesh_files.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kFigures{"mean_px", "p95_px", "max_px", "iou"};

struct CompareFlags {
  InputOptions candidate;
  InputOptions reference;
  bool refined = false;
  LevelFlags levels;
  CompareOptions options;
  std::vector<Gate> gates;
};

ordered_json figures_json(const OutlineError& error) {
  return {{"mean_px", error.mean_px},
          {"p95_px", error.p95_px},
          {"max_px", error.max_px},
          {"iou", error.iou},
          {"outline_pixels", error.outline_pixels}};
}

ordered_json compare_json(const CompareFlags& flags, const Comparison& comparison,
                          const std::vector<std::string>& failed) {
  ordered_json json = figures_json(comparison.overall);
  json["candidate"] = flags.candidate.path;
  json["reference"] = flags.reference.path;
  json["method"] = flags.refined ? "refine" : "coarse";
  json["options"] = {{"views", flags.options.views},
                     {"size_px", flags.options.size_px},
                     {"seed", flags.options.seed},
                     {"perspective", flags.options.perspective}};
  json["views"] = ordered_json::array();
  for (std::size_t i = 0; i < comparison.views.size(); ++i) {
    ordered_json view{
        {"direction", {comparison.directions[i].x, comparison.directions[i].y, comparison.directions[i].z}}};
    view.update(figures_json(comparison.views[i]));
    json["views"].push_back(view);
  }
  json["failed"] = failed;
  return json;
}

std::string compare_text(const CompareFlags& flags, const OutlineError& error) {
  return fmt::format("mean {:.4f} px, 95th percentile {:.4f} px, maximum {:.4f} px, IoU {:.6f} ({} at {} px)\n",
                     error.mean_px, error.p95_px, error.max_px, error.iou,
                     counted(static_cast<std::size_t>(flags.options.views), "view"), flags.options.size_px);
}

Result<Comparison> measure(Session& session, const CompareFlags& flags, const LoadedMesh& candidate,
                           const Mesh& reference) {
  CompareOptions options = flags.options;
  options.progress = session.progress();
  if (!flags.refined) return compare_meshes(candidate.mesh, reference, options);
  const RefineOptions refining = refine_options(flags.levels, session.silent_progress());
  const Result<Refiner> refiner = Refiner::create(candidate.mesh, refining);
  if (!refiner) return tl::unexpected(refiner.error());
  const MeshForCamera seen = [&](const Camera& camera, int height_px) -> Result<Mesh> {
    return refiner->refine(view_of(camera, height_px), refining.levels).map([](Refinement&& refined) {
      return std::move(refined.mesh);
    });
  };
  return compare_meshes(seen, reference, options);
}

Result<int> run(Session& session, const CompareFlags& flags) {
  if (flags.candidate.path == "-" && flags.reference.path == "-") {
    return fail(ErrorCode::kInvalidArgument, "compare: both meshes are standard input", "name a file for one of them");
  }
  if (const Result<void> good = check_levels(flags.levels); !good) return tl::unexpected(good.error());
  const Result<LoadedMesh> candidate = load_with_faces(session, flags.candidate);
  if (!candidate) return tl::unexpected(candidate.error());
  const Result<LoadedMesh> reference = load_with_faces(session, flags.reference);
  if (!reference) return tl::unexpected(reference.error());
  const Result<Comparison> comparison = measure(session, flags, *candidate, reference->mesh);
  if (!comparison) return tl::unexpected(comparison.error());
  const OutlineError& overall = comparison->overall;
  const std::array values{overall.mean_px, overall.p95_px, overall.max_px, overall.iou};
  const std::vector<std::string> failed = tripped(flags.gates, values);
  const Result<void> printed = session.json() ? session.print_json(compare_json(flags, *comparison, failed))
                                              : session.print(compare_text(flags, comparison->overall));
  if (!printed) return tl::unexpected(printed.error());
  for (const std::string& gate : failed)
    session.say(fmt::format("limn: compare: --fail-if '{}' holds", gate));
  return failed.empty() ? kExitDone : kExitGateFailed;
}

Run declare_compare(OptionTable& table) {
  const auto flags = std::make_shared<CompareFlags>();
  table.argument("A", flags->candidate.path, "candidate mesh");
  table.argument("B", flags->reference.path, "mesh it is held against; frames the pictures");
  table.begin(Group::kOwn);
  table.integer("--views", flags->options.views, 1, 1'000'000, "random views (default 20)");
  table.integer("--size", flags->options.size_px, 1, 16384,
                "width and height of the pictures in pixels (default 1024)");
  table.count("--seed", flags->options.seed, 0, UINT64_MAX, "of the views (default 1)");
  table.choice("--method", flags->refined, {{"coarse", false}, {"refine", true}},
               "A as it is, or refined anew for each view");
  table.toggle("--perspective", flags->options.perspective, "instead of parallel projection");
  Option& gate = table.text("--fail-if", "'mean_px>0.5'", flags->candidate.path,
                            "exit 5 if so; mean_px, p95_px, max_px, iou; repeatable");
  gate.repeatable = true;
  gate.set = [flags](const std::string& text) {
    return parse_gate(text, kFigures).map([&](const Gate& read) { flags->gates.push_back(read); });
  };
  table.begin(Group::kFiles);
  table.toggle("--repair", flags->candidate.repair, "A: remove useless faces, turn flipped ones; says what it changed");
  add_level_options(table, flags->levels);
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb compare_verb() {
  return Verb{"compare",
              "measures how far two models' outlines are apart, in pixels, over random views",
              "A B [--views N] [--size PX] [--method coarse|refine] [--fail-if EXPR] [options]",
              true,
              {{{"limn compare knot.ply dense.ply --views 5 --size 256", "the coarse mesh against the dense one"},
                {"limn compare knot.ply dense.ply --method refine --views 5 --size 256 --json",
                 "refined for each view, every view's figures"},
                {"limn compare dense.ply dense.ply --views 3 --size 256 --fail-if 'mean_px>0.5' --fail-if 'iou<0.99'",
                 "a gate for a script: exit 5 when the outlines have drifted apart"}}},
              declare_compare};
}

}  // namespace limn::cli
