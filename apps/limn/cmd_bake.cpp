#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "limn/bake/bake.h"

#include "bake_files.h"
#include "gate.h"
#include "mesh_files.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> kFigures{"miss", "worst", "overlap"};

struct BakeFlags {
  InputOptions high, low;
  BakeFileOptions files;
  std::vector<std::string> maps{"normal"};
  bool object_space = false;
  BakeOptions options;
  std::vector<Gate> gates;
};

/// "normal,color".
Result<std::vector<std::string>> parse_maps(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    names.emplace_back(text.substr(at, end - at));
    const std::string& name = names.back();
    if (name != "normal" && name != "color" && name != "displacement" && name != "ao") {
      return fail(ErrorCode::kInvalidArgument, fmt::format("'{}' is no map", name),
                  "name normal, color, displacement and ao, with commas between them");
    }
    at = end + 1;
  }
  return names;
}

bool wants(const BakeFlags& flags, std::string_view map) {
  return std::find(flags.maps.begin(), flags.maps.end(), map) != flags.maps.end();
}

Result<void> check(const Session& session, const BakeFlags& flags) {
  if (flags.high.path == "-" && flags.low.path == "-")
    return fail(ErrorCode::kInvalidArgument, "bake: both meshes are standard input", "name a file for one of them");
  if (flags.files.path == "-")
    return fail(ErrorCode::kInvalidArgument, "bake: a folder of maps cannot be standard output",
                "name a folder, or a .glb, .gltf or .obj");
  if (!is_model(flags.files.path)) return check_destination(session, flags.files.path);
  const bool other = flags.object_space || wants(flags, "displacement") || wants(flags, "ao");
  if (other || flags.files.depth == 32) {
    return fail_at(ErrorCode::kInvalidArgument, flags.files.path, {},
                   "a model holds tangent-space normals and colours as PNG; this is something else",
                   "name a folder as output");
  }
  OutputOptions output;
  output.path = flags.files.path;
  return check_output(session, output);
}

BakeOptions bake_options(Session& session, const BakeFlags& flags) {
  BakeOptions options = flags.options;
  options.maps.object_normals = wants(flags, "normal") && flags.object_space;
  options.maps.tangent_normals = wants(flags, "normal") && !flags.object_space;
  options.maps.colors = wants(flags, "color");
  options.maps.displacement = wants(flags, "displacement");
  options.maps.occlusion = wants(flags, "ao");
  options.progress = session.progress();
  return options;
}

std::vector<std::string> failed_gates(const BakeFlags& flags, const BakeReport& report) {
  const std::array<double, 3> figures{report.miss_share(), report.worst_distance,
                                      static_cast<double>(report.overlapping_texels)};
  return tripped(flags.gates, figures);
}

ordered_json report_json(const BakeFlags& flags, const BakedMaps& maps, const std::vector<std::string>& files) {
  const BakeReport& report = maps.report;
  return {{"output", flags.files.path},
          {"files", files},
          {"maps", flags.maps},
          {"method", flags.options.method == BakeMethod::kShoot ? "shoot" : "closest"},
          {"space", flags.object_space ? "object" : "tangent"},
          {"layout", report.tile_px > 0 ? "tiles" : "uvs"},
          {"size_px", flags.options.size_px},
          {"samples_per_texel", flags.options.samples},
          {"texels", report.texels},
          {"samples", report.samples},
          {"misses", report.misses},
          {"miss_share", report.miss_share()},
          {"overruled", report.overruled},
          {"worst_distance", report.worst_distance},
          {"worst_texel", {report.worst_x, report.worst_y}},
          {"worst_face", report.worst_face},
          {"displacement_low", report.displacement_low},
          {"displacement_high", report.displacement_high},
          {"overlapping_texels", report.overlapping_texels},
          {"tile_px", report.tile_px},
          {"leg_px", report.leg_px},
          {"clean_mip_level", report.clean_mip_level},
          {"embree", report.embree},
          {"build_ms", report.build_ms},
          {"shoot_ms", report.shoot_ms}};
}

Result<void> tell(Session& session, const BakeFlags& flags, const BakedMaps& maps,
                  const std::vector<std::string>& files, const std::array<const LoadedMesh*, 2>& meshes,
                  const std::vector<std::string>& failed) {
  const BakeReport& report = maps.report;
  session.say(fmt::format("{}: {} of {} px, {:.3f} % missed, longest way {:.4g}, {:.0f} ms", flags.files.path,
                          counted(report.texels, "texel"), flags.options.size_px, 100.0 * report.miss_share(),
                          report.worst_distance, report.build_ms + report.shoot_ms));
  if (report.overlapping_texels > 0) {
    session.say(fmt::format("{}: faces overlap in the picture, at {}", flags.low.path,
                            counted(report.overlapping_texels, "texel")));
  }
  for (const std::string& gate : failed)
    session.say(fmt::format("limn: bake: --fail-if '{}' holds", gate));
  if (!session.json()) return {};
  ordered_json json{{"high", flags.high.path},
                    {"low", flags.low.path},
                    {"triangles_high", meshes[0]->mesh.face_count()},
                    {"triangles_low", meshes[1]->mesh.face_count()}};
  json.update(report_json(flags, maps, files));
  json["failed"] = failed;
  json["notes"] = ordered_json::array();
  json["repairs"] = ordered_json::array();
  for (const LoadedMesh* mesh : meshes) {
    for (const std::string& note : mesh->notes)
      json["notes"].push_back(note);
    for (const std::string& change : mesh->repairs)
      json["repairs"].push_back(change);
  }
  return session.print_json(json);
}

Result<int> run(Session& session, BakeFlags flags) {
  if (const Result<void> good = check(session, flags); !good) return tl::unexpected(good.error());
  flags.low.repair = flags.high.repair;
  const Result<LoadedMesh> high = load_with_faces(session, flags.high);
  if (!high) return tl::unexpected(high.error());
  const Result<LoadedMesh> low = load_with_faces(session, flags.low);
  if (!low) return tl::unexpected(low.error());
  const Result<BakedMaps> maps = bake(high->mesh, low->mesh, bake_options(session, flags));
  if (!maps) return tl::unexpected(about(maps.error(), flags.low.path));
  const Result<std::vector<std::string>> files = write_maps(session, *maps, flags.files);
  if (!files) return tl::unexpected(files.error());
  const std::vector<std::string> failed = failed_gates(flags, maps->report);
  return tell(session, flags, *maps, *files, {&*high, &*low}, failed).map([&] {
    return failed.empty() ? kExitDone : kExitGateFailed;
  });
}

Run declare_bake(OptionTable& table) {
  const auto flags = std::make_shared<BakeFlags>();
  BakeOptions& options = flags->options;
  table.argument("HIGH", flags->high.path, "fine mesh, whose surface goes into the maps");
  table.argument("LOW", flags->low.path, "coarse mesh, which they are drawn on");
  table.begin(Group::kOwn);
  table.parsed("--maps", "LIST", flags->maps, parse_maps, "of normal, color, displacement, ao (default normal)");
  table.integer("--size", options.size_px, 4, 16384, "width and height in texels (default 1024)");
  table.choice("--method", options.method, {{"shoot", BakeMethod::kShoot}, {"closest", BakeMethod::kClosest}},
               "along the normals (default), or the closest point");
  table.choice("--space", flags->object_space, {{"tangent", false}, {"object", true}}, "of normals (default tangent)");
  table.choice("--layout", options.layout,
               {{"auto", BakeLayout::kAuto}, {"tiles", BakeLayout::kTiles}, {"uvs", BakeLayout::kOwnUvs}},
               "LOW's texture coordinates, or a tile a face");
  table.choice("--samples", options.samples, {{"1", 1}, {"4", 4}, {"16", 16}}, "a texel (default 1)");
  table.integer("--mips", options.clean_mip_level, 0, 8, "mip levels that tiles stay apart in");
  table.integer("--gutter", options.gutter_px, 0, 1024, "texels around islands of own coordinates (default 8)");
  table.number("--max-distance", "D", options.max_distance, {.low = 0}, "longest ray in model units (default: none)");
  table.number("--stretch", "R", options.most_stretch, {.low = 0},
               "long rays give way to a point R times nearer (default 2; 0: none does)");
  table.integer("--ao-rays", options.occlusion_rays, 1, 65536, "a texel (default 64)");
  table.number("--ao-distance", "D", options.occlusion_distance, {.low = 0}, "what is farther does not occlude");
  table.count("--seed", options.seed, 0, UINT64_MAX, "of the occlusion rays (default 1)");
  Option& gate =
      table.text("--fail-if", "'miss>0.1%'", flags->files.path, "exit 5 if so; miss, worst, overlap; repeatable");
  gate.repeatable = true;
  gate.set = [flags](const std::string& text) {
    return parse_gate(text, kFigures).map([&](const Gate& read) { flags->gates.push_back(read); });
  };
  table.begin(Group::kFiles);
  table.file("-o,--output", flags->files.path, ".glb, .gltf or .obj with its maps, or a folder for all of them")
      .required = true;
  table.choice("--depth", flags->files.depth, {{"8", 8}, {"16", 16}, {"32", 32}},
               "bits a channel; 32: OpenEXR (default 8)");
  table.toggle("--repair", flags->high.repair, "remove useless faces, turn flipped ones; says what it changed");
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb bake_verb() {
  return Verb{
      "bake",
      "puts a fine mesh's normals, colours and displacement into maps over a coarse one",
      "HIGH LOW -o OUT.glb|DIR [--maps LIST] [--size PX] [options]",
      true,
      {{{"limn bake dense.ply knot.ply -o baked.glb --size 256", "a model with a normal map, for any viewer"},
        {"limn bake dense.ply knot.ply -o maps --maps normal,displacement,ao --space object --size 256 --ao-rays 8",
         "a folder of pictures, mesh.glb, and what their values mean"},
        {"limn bake dense.ply knot.ply -o baked.glb --size 256 --samples 4 --fail-if 'miss>50%' --json",
         "a gate for a script: exit 5 when too many rays met nothing"}}},
      declare_bake};
}

}  // namespace limn::cli
