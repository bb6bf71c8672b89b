#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "limn/asset/asset_file.h"
#include "limn/asset/build.h"

#include "asset_json.h"
#include "interrupt.h"
#include "mesh_files.h"
#include "stopwatch.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

struct ClipFlags {
  InputOptions input;
  std::string output;
  int faces = 500, levels = 4, size_px = 1024, samples = 1;
  bool strict = false;
  ClipMaps maps;
};

/// What all of it took, beside what the building says of its stages.
struct Times {
  double write_ms = 0;
  double total_ms = 0;  ///< reading included
};

/// The most memory this program ever had, in bytes.
std::uint64_t peak_memory() {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

Result<ClipMaps> parse_maps(std::string_view text) {
  ClipMaps maps{false, false, false};
  if (text == "none") return maps;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    bool* const map = word == "normal"         ? &maps.normals
                      : word == "color"        ? &maps.colors
                      : word == "displacement" ? &maps.displacement
                                               : nullptr;
    if (map == nullptr) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("takes any of normal,color,displacement, or none, not '{}'", word));
    }
    *map = true;
    if (comma == std::string_view::npos) return maps;
    text.remove_prefix(comma + 1);
  }
}

Result<BuiltClipAsset> build(Session& session, const ClipFlags& flags, const Mesh& mesh) {
  ClipOptions options;
  options.faces = static_cast<std::size_t>(flags.faces);
  options.strict = flags.strict;
  options.levels = static_cast<std::size_t>(flags.levels);
  options.size_px = flags.size_px;
  options.samples = flags.samples;
  options.maps = flags.maps;
  options.progress = session.progress();
  return build_clip_asset(mesh, options);
}

ordered_json hull_json(const ClipFlags& flags, const HullReport& hull) {
  return {{"target", flags.faces},
          {"faces", hull.faces},
          {"reached_target", hull.reached_target},
          {"shell_faces", hull.faces_before},
          {"volume_ratio", hull.volume_ratio},
          {"certified", hull.certified},
          {"worst_margin", hull.worst_margin},
          {"rescued", hull.rescued}};
}

ordered_json bake_json(const ClipFlags& flags, const BakeReport& bake) {
  return {{"size_px", flags.size_px}, {"tile_px", bake.tile_px},         {"samples", bake.samples},
          {"misses", bake.misses},    {"miss_share", bake.miss_share()}, {"worst_distance", bake.worst_distance}};
}

ordered_json clip_json(const ClipFlags& flags, const LoadedMesh& loaded, const ClipReport& report,
                       const AssetBytes& bytes, const Times& times) {
  return {{"input", flags.input.path},
          {"output", flags.output},
          {"triangles_in", loaded.mesh.face_count()},
          {"hull", hull_json(flags, report.hull)},
          {"bake", bake_json(flags, report.bake)},
          {"asset", asset_json(bytes)},
          {"hull_ms", report.hull_ms},
          {"silhouettes_ms", report.silhouettes_ms},
          {"maps_ms", report.maps_ms},
          {"write_ms", times.write_ms},
          {"total_ms", times.total_ms},
          {"peak_memory_bytes", peak_memory()},
          {"shell_notes", report.notes},
          {"notes", loaded.notes},
          {"repairs", loaded.repairs}};
}

std::string summary(const ClipFlags& flags, const LoadedMesh& loaded, const ClipReport& report, const AssetBytes& bytes,
                    const Times& times) {
  return fmt::format(
      "{}: {} in a hull of {} (volume x{:.3f}), {}, {:.2f} MB, {:.3g} % of rays missed, {:.2f} s, {} MB of memory",
      flags.output, counted(loaded.mesh.face_count(), "triangle"), report.hull.faces, report.hull.volume_ratio,
      counted(bytes.levels.size(), "silhouette"), static_cast<double>(bytes.file) * 1e-6,
      100.0 * report.bake.miss_share(), times.total_ms * 1e-3, peak_memory() >> 20);
}

void say_shortfalls(Session& session, const ClipFlags& flags, const ClipReport& report) {
  for (const std::string& note : report.notes)
    session.say(fmt::format("{}: {}", flags.input.path, note));
  if (report.hull.reached_target) return;
  session.say(fmt::format("{}: the hull stopped at {}: no step that stays outside was left on the way to {}",
                          flags.input.path, counted(report.hull.faces, "face"), flags.faces));
}

Result<int> run(Session& session, const ClipFlags& flags) {
  if (const Result<void> good = check_picture_output(session, flags.output, ".glb"); !good)
    return tl::unexpected(good.error());
  Stopwatch watch;
  const Result<LoadedMesh> loaded = load_with_faces(session, flags.input);
  if (!loaded) return tl::unexpected(loaded.error());
  Times times;
  times.total_ms = watch.lap_ms();
  const Result<BuiltClipAsset> built = build(session, flags, loaded->mesh);
  if (!built) return tl::unexpected(about(built.error(), flags.input.path));
  times.total_ms += watch.lap_ms();
  if (const Result<void> going = session.check_stop(); !going) return tl::unexpected(going.error());
  const Unstoppable writing;
  const Result<AssetBytes> bytes = write_clip_asset(built->asset, flags.output);
  if (!bytes) return tl::unexpected(bytes.error());
  times.write_ms = watch.lap_ms();
  times.total_ms += times.write_ms;
  say_shortfalls(session, flags, built->report);
  session.say(summary(flags, *loaded, built->report, *bytes, times));
  if (!session.json()) return kExitDone;
  return session.print_json(clip_json(flags, *loaded, built->report, *bytes, times)).map([] { return kExitDone; });
}

Run declare_clip(OptionTable& table) {
  const auto flags = std::make_shared<ClipFlags>();
  table.argument("MODEL", flags->input.path, "dense mesh; - is standard input");
  table.begin(Group::kOwn);
  table.integer("--faces", flags->faces, 4, 100'000'000, "of the hull (default 500)");
  table.toggle("--strict", flags->strict, "no step that would make the hull cross itself");
  table.integer("--levels", flags->levels, 1, 32, "silhouettes at most, each a quarter of the last (default 4)");
  table.integer("--size", flags->size_px, 4, 16384, "width and height of the maps in pixels (default 1024)");
  table.choice("--samples", flags->samples, {{"1", 1}, {"4", 4}, {"16", 16}}, "a texel (default 1)");
  table.parsed("--maps", "LIST", flags->maps, parse_maps, "for limn: normal,color,displacement (default all) or none");
  table.begin(Group::kFiles);
  table.file("-o,--output", flags->output, "asset to write, a .glb; - is standard output").required = true;
  add_input_options(table, flags->input);
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb clip_verb() {
  return Verb{"clip",
              "makes a small asset of a dense mesh: a coarse hull, its maps, the exact outline",
              "MODEL -o FILE.glb [--faces N] [options]",
              true,
              {{{"limn clip dense.ply -o knot.glb --faces 200 --size 256", "a hull of 200 faces; opens in any viewer"},
                {"limn clip dense.ply -o small.glb --faces 300 --size 128 --levels 1 --maps none",
                 "one silhouette, and no more maps than a viewer needs"},
                {"limn clip dense.ply -o strict.glb --faces 400 --size 256 --strict --json | head -c 300",
                 "stage times, memory and bytes for a script"}}},
              declare_clip};
}

}  // namespace limn::cli
