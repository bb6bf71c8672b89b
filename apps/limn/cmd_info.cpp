#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "limn/asset/asset_file.h"
#include "limn/base/file.h"
#include "limn/hull/suitability.h"
#include "limn/mesh/validate.h"

#include "asset_json.h"
#include "mesh_files.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

struct InfoOptions {
  InputOptions input;
  OutputOptions output;
};

ordered_json vector_json(const Vec3& v) {
  return ordered_json::array({v.x, v.y, v.z});
}

/// What every technique makes of the mesh.
std::vector<Suitability> all_techniques(const Mesh& mesh, const MeshReport& report) {
  std::vector<Suitability> all = suitability(report);
  for (Suitability& one : solid_suitability(mesh))
    all.push_back(std::move(one));
  return all;
}

ordered_json report_json(const MeshReport& report) {
  ordered_json json{{"vertices", report.vertices},
                    {"welded_vertices", report.welded_vertices},
                    {"unused_vertices", report.unused_vertices},
                    {"faces", report.faces},
                    {"edges", report.edges},
                    {"boundary_edges", report.boundary_edges},
                    {"boundary_loops", report.boundary_loops},
                    {"inconsistent_edges", report.inconsistent_edges},
                    {"non_manifold_edges", report.non_manifold_edges},
                    {"non_manifold_vertices", report.non_manifold_vertices},
                    {"degenerate_faces", report.degenerate_faces},
                    {"zero_area_faces", report.zero_area_faces},
                    {"duplicate_faces", report.duplicate_faces},
                    {"components", report.components},
                    {"euler_characteristic", report.euler_characteristic},
                    {"closed", report.closed},
                    {"area", report.area},
                    {"volume", report.volume},
                    {"has_normals", report.has_normals},
                    {"has_uvs", report.has_uvs},
                    {"has_colors", report.has_colors},
                    {"bounds", nullptr}};
  if (!report.bounds.empty()) {
    json["bounds"] = {{"low", vector_json(report.bounds.low)}, {"high", vector_json(report.bounds.high)}};
  }
  return json;
}

/// What the file is made of as a clip asset, where it is one.
std::optional<AssetBytes> asset_bytes(const InfoOptions& options, const LoadedMesh& loaded) {
  if (!loaded.asset) return std::nullopt;
  const Result<FileBytes> file = FileBytes::open(options.input.path);
  if (!file) return std::nullopt;
  const Result<AssetBytes> bytes = measure_clip_asset(file->bytes(), options.input.path);
  return bytes ? std::optional(*bytes) : std::nullopt;
}

ordered_json info_json(const InfoOptions& options, const LoadedMesh& loaded, const MeshReport& report) {
  ordered_json json{{"file", options.input.path}, {"format", format_name(loaded.format)}};
  json.update(report_json(report));
  json["notes"] = loaded.notes;
  json["techniques"] = ordered_json::array();
  for (const Suitability& one : all_techniques(loaded.mesh, report)) {
    json["techniques"].push_back({{"technique", one.technique}, {"can_run", one.can_run}, {"reasons", one.reasons}});
  }
  if (options.input.repair) json["repairs"] = loaded.repairs;
  if (const auto bytes = asset_bytes(options, loaded)) json["asset"] = asset_json(*bytes);
  return json;
}

std::string surface_line(const MeshReport& report) {
  std::string line = "not a surface of two faces an edge";  // neither: only edges that are flipped or crowded
  if (report.closed) line = fmt::format("closed, volume {:.6g}", report.volume);
  if (report.boundary_edges > 0) {
    line = fmt::format("open, {} in {}", counted(report.boundary_edges, "boundary edge"),
                       counted(report.boundary_loops, "loop"));
  }
  return fmt::format("{}, area {:.6g}, {}, Euler characteristic {}", line, report.area,
                     counted(report.components, "component"), report.euler_characteristic);
}

std::string attributes_line(const MeshReport& report) {
  std::string line;
  const auto add = [&line](bool has, std::string_view name) {
    if (has) line += (line.empty() ? "" : ", ") + std::string(name);
  };
  add(report.has_normals, "normals");
  add(report.has_uvs, "texture coordinates");
  add(report.has_colors, "colours");
  return line.empty() ? "none" : line;
}

/// What is wrong, one line a kind; nothing for what is not.
std::string defects(const MeshReport& report) {
  std::string text;
  const auto add = [&text](std::size_t count, std::string_view noun, std::string_view rest = {}) {
    if (count > 0) text += fmt::format("{:<13}{}{}\n", text.empty() ? "defects" : "", counted(count, noun), rest);
  };
  add(report.degenerate_faces, "degenerate face");
  add(report.zero_area_faces, "face", " without area");
  add(report.duplicate_faces, "duplicate face");
  add(report.inconsistent_edges, "edge", " where one face is turned the wrong way");
  add(report.non_manifold_edges, "non-manifold edge");
  add(report.non_manifold_vertices, "non-manifold vertex");
  add(report.unused_vertices, "unused vertex");
  return text;
}

std::string info_text(const InfoOptions& options, const LoadedMesh& loaded, const MeshReport& report) {
  std::string text = fmt::format("{:<13}{} ({})\n", "file", options.input.path, format_name(loaded.format));
  text += fmt::format("{:<13}{}, {} ({} stored), {}\n", "mesh", counted(report.faces, "triangle"),
                      counted(report.welded_vertices, "vertex"), report.vertices, counted(report.edges, "edge"));
  if (report.faces == 0) {
    text += fmt::format("{:<13}no faces: an empty mesh\n", "surface");
  } else {
    const Vec3 &low = report.bounds.low, &high = report.bounds.high;
    text += fmt::format("{:<13}{}\n", "surface", surface_line(report));
    text += fmt::format("{:<13}{},{},{} to {},{},{}\n", "bounds", low.x, low.y, low.z, high.x, high.y, high.z);
  }
  text += fmt::format("{:<13}{}\n", "attributes", attributes_line(report)) + defects(report);
  for (const Suitability& one : all_techniques(loaded.mesh, report)) {
    std::string line = one.can_run ? "yes" : "no";
    for (std::size_t i = 0; i < one.reasons.size(); ++i)
      line += (i == 0 ? ": " : "; ") + one.reasons[i];
    text += fmt::format("{:<13}{}\n", one.technique, line);
  }
  if (const auto bytes = asset_bytes(options, loaded)) text += asset_text(*bytes);
  return text;
}

Result<int> run(Session& session, const InfoOptions& options) {
  if (!options.output.path.empty()) {
    if (!options.input.repair) {
      return fail(ErrorCode::kInvalidArgument, "info: -o writes the repaired mesh and needs --repair", "add --repair");
    }
    const Result<void> checked = check_output(session, options.output);
    if (!checked) return tl::unexpected(checked.error());
  }
  const Result<LoadedMesh> loaded = load(session, options.input);
  if (!loaded) return tl::unexpected(loaded.error());
  const MeshReport report = validate(loaded->mesh, build_topology(loaded->mesh));
  if (!options.output.path.empty()) {
    const Result<void> saved = save(session, loaded->mesh, options.output);
    if (saved && loaded->asset)
      session.say(
          fmt::format("{}: holds the hull alone; the asset's silhouettes and maps are left out", options.output.path));
    if (!saved) return tl::unexpected(saved.error());
    if (options.output.path == "-") return kExitDone;
  }
  const Result<void> printed = session.json() ? session.print_json(info_json(options, *loaded, report))
                                              : session.print(info_text(options, *loaded, report));
  return printed.map([] { return kExitDone; });
}

Run declare_info(OptionTable& table) {
  const auto options = std::make_shared<InfoOptions>();
  table.argument("MODEL", options->input.path, "mesh to look at; - is standard input");
  table.begin(Group::kFiles);
  add_input_options(table, options->input);
  add_output_options(table, options->output, false);
  return [options](Session& session) { return run(session, *options); };
}

}  // namespace

Verb info_verb() {
  return Verb{"info",
              "says what a mesh is like, what is wrong with it, and which techniques can run",
              "MODEL [--repair [-o FILE]]",
              true,
              {{{"limn info knot.ply", "counts, surface, attributes, techniques"},
                {"limn info knot.ply --repair -o repaired.ply",
                 "remove what no technique can use, say what, and keep the result"},
                {"limn info - --json < knot.ply", "the same figures for a script"}}},
              declare_info};
}

}  // namespace limn::cli
