#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "limn/base/file.h"
#include "limn/drawing/dxf.h"
#include "limn/drawing/edge_list.h"
#include "limn/drawing/line_files.h"
#include "limn/drawing/svg.h"
#include "limn/silhouette/eye.h"

#include "interrupt.h"
#include "silhouette_lines.h"
#include "silhouette_options.h"
#include "stopwatch.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

/// A drawing as it is written, and what the summary says of it.
struct Drawing {
  std::string bytes;
  FoundLines found;
  std::size_t lines = 0;     ///< strokes on the page, polylines in space, or edges listed
  std::size_t drawable = 0;  ///< polylines in space that a page was laid out of
  std::optional<Page> page;  ///< without its points and strokes
};

ordered_json vector_json(const Vec3& v) {
  return ordered_json::array({v.x, v.y, v.z});
}

ordered_json edges_by_class(const EdgeCounts& edges) {
  ordered_json json;
  for (const LineClass line_class : kLineClasses)
    json[std::string(line_class_name(line_class))] = edges[static_cast<std::size_t>(line_class)];
  return json;
}

/// The eye as the predicate takes it: a point, or when orthographic the direction towards it.
ordered_json eye_json(const Camera& camera) {
  const Eye eye = eye_of(camera);
  return {{"at", vector_json(eye.at)}, {"orthographic", eye.orthographic}};
}

std::string description(const SilhouetteFlags& flags, const Camera& camera) {
  return fmt::format("limn silhouette; {} from ({:g}, {:g}, {:g}) towards ({:g}, {:g}, {:g}){}",
                     camera.orthographic ? "parallel" : "perspective", camera.eye.x, camera.eye.y, camera.eye.z,
                     camera.target.x, camera.target.y, camera.target.z,
                     flags.mm_per_unit ? fmt::format("; {:g} mm a unit", *flags.mm_per_unit) : "");
}

Result<void> draw_page(const SilhouetteFlags& flags, const Polylines& lines, const Camera& camera, Drawing& drawing) {
  Result<Page> page = lay_out(lines, camera, flags.page());
  if (!page) return tl::unexpected(about(page.error(), flags.input.path));
  drawing.lines = page->strokes.size();
  drawing.drawable = lines.lines.size();
  if (flags.written_as() == DrawingFormat::kDxf) {
    drawing.bytes = dxf_text(*page);
  } else {
    SvgOptions options;
    options.stroke_mm = flags.stroke_mm.value_or(options.stroke_mm);
    options.title = flags.input.path == "-" ? "silhouette" : flags.input.path;
    options.description = description(flags, camera);
    drawing.bytes = svg_text(*page, options);
  }
  drawing.page = Page{page->width_mm, page->height_mm, page->mm_per_unit, {}, {}};
  return {};
}

/// Why there is nothing on the page or in the file.
std::string why_nothing(const Drawing& drawing) {
  // A perspective from farther than doubles resolve draws the whole model as a point.
  if (drawing.page && drawing.drawable != 0)
    return "nothing to draw: what is seen from there is smaller than 0.002 mm on the page, or off it";
  return "nothing to draw: no line of the kinds asked for is seen from there";
}

/// Whether an edge is asked for: all of it need not be.
bool is_chosen(const SilhouetteFlags& flags, const DrawnEdge& edge) {
  if (flags.outline && !edge.outer) return false;
  return (flags.shows_visible() && !edge.visible.empty()) || (flags.shows_hidden() && edge.hidden);
}

void list_edges(const SilhouetteFlags& flags, const Topology& topology, const Camera& camera, Drawing& drawing) {
  std::vector<DrawnEdge> edges = drawn_edges(drawing.found.lines.intervals);
  std::erase_if(edges, [&](const DrawnEdge& edge) { return !is_chosen(flags, edge); });
  drawing.lines = edges.size();
  const ordered_json head{{"input", flags.input.path},
                          {"eye", eye_json(camera)},
                          {"target", vector_json(camera.target)},
                          {"method", method_name(drawing.found.method)},
                          {"found", edges_by_class(drawing.found.edges)},
                          {"listed", edges.size()}};
  std::string text = head.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  text.pop_back();
  drawing.bytes = text + ",\"edges\":" + edges_json(edges, topology) + "}\n";
}

Result<Drawing> draw(const SilhouetteFlags& flags, const Mesh& mesh, const Camera& camera, const Progress& progress) {
  const Topology topology = build_topology(mesh);
  Result<FoundLines> found = find_lines(flags, mesh, topology, camera, progress);
  if (!found) return tl::unexpected(about(found.error(), flags.input.path));
  Drawing drawing;
  drawing.found = std::move(*found);
  if (flags.written_as() == DrawingFormat::kJson) {
    list_edges(flags, topology, camera, drawing);
    return drawing;
  }
  const Polylines lines = chosen_lines(flags, drawing.found.lines.polylines);
  if (flags.written_as() == DrawingFormat::kPly || flags.written_as() == DrawingFormat::kObj) {
    drawing.bytes = flags.written_as() == DrawingFormat::kObj ? obj_text(lines) : ply_text(lines, flags.ascii);
    drawing.lines = lines.lines.size();
    return drawing;
  }
  if (const Result<void> done = draw_page(flags, lines, camera, drawing); !done) return tl::unexpected(done.error());
  return drawing;
}

std::string summary(const SilhouetteFlags& flags, const Drawing& drawing, double time_ms) {
  std::string text = flags.output + ": ";
  if (drawing.lines == 0) return text + why_nothing(drawing);
  const bool listed = flags.written_as() == DrawingFormat::kJson;
  text += counted(drawing.lines, drawing.page ? "stroke" : listed ? "edge" : "polyline");
  if (drawing.page) text += fmt::format(", {:.0f}x{:.0f} mm", drawing.page->width_mm, drawing.page->height_mm);
  std::string found;
  for (const LineClass line_class : kLineClasses) {
    if (!flags.wants(line_class)) continue;
    found += found.empty() ? "" : ", ";
    found +=
        fmt::format("{} {}", line_class_name(line_class), drawing.found.edges[static_cast<std::size_t>(line_class)]);
  }
  return text + fmt::format(", {:.1f} ms; edges found: {}", time_ms, found);
}

ordered_json page_json(const std::optional<Page>& page) {
  if (!page) return nullptr;
  ordered_json json{{"width_mm", page->width_mm}, {"height_mm", page->height_mm}, {"mm_per_unit", nullptr}};
  if (page->mm_per_unit > 0.0) json["mm_per_unit"] = page->mm_per_unit;
  return json;
}

Result<void> report(Session& session, const SilhouetteFlags& flags, const LoadedMesh& loaded, const Camera& camera,
                    const Drawing& drawing, double time_ms) {
  session.say(summary(flags, drawing, time_ms));
  if (!session.json()) return {};
  return session.print_json({{"input", flags.input.path},
                             {"output", flags.output},
                             {"format", format_name(flags.written_as())},
                             {"method", method_name(drawing.found.method)},
                             {"eye", eye_json(camera)},
                             {"edges", edges_by_class(drawing.found.edges)},
                             {"lines", drawing.lines},
                             {"page", page_json(drawing.page)},
                             {"time_ms", time_ms},
                             {"prepare_ms", drawing.found.prepare_ms},
                             {"extract_ms", drawing.found.extract_ms},
                             {"visible_ms", drawing.found.visible_ms},
                             {"notes", loaded.notes},
                             {"repairs", loaded.repairs}});
}

Result<int> run(Session& session, const SilhouetteFlags& flags) {
  if (const Result<void> good = check_silhouette(session, flags); !good) return tl::unexpected(good.error());
  const Result<LoadedMesh> loaded = load_with_faces(session, flags.input);
  if (!loaded) return tl::unexpected(loaded.error());
  const Result<Camera> camera = place_camera(flags.camera, loaded->framed(), flags.aspect(), face_bounds(loaded->mesh));
  if (!camera) return tl::unexpected(camera.error());
  Stopwatch watch;
  const Result<Drawing> drawing = draw(flags, loaded->mesh, *camera, session.progress());
  if (!drawing) return tl::unexpected(drawing.error());
  const double time_ms = watch.lap_ms();
  return session.check_stop()
      .and_then([&] {
        const Unstoppable writing;
        return write_file(flags.output, drawing->bytes);
      })
      .and_then([&] { return report(session, flags, *loaded, *camera, *drawing, time_ms); })
      .map([] { return kExitDone; });
}

Run declare_silhouette(OptionTable& table) {
  const auto flags = std::make_shared<SilhouetteFlags>();
  add_silhouette_options(table, *flags);
  return [flags](Session& session) { return run(session, *flags); };
}

}  // namespace

Verb silhouette_verb() {
  return Verb{"silhouette",
              "draws a mesh in lines: SVG or DXF in millimetres, polylines, or a list of edges",
              "MODEL -o FILE [--view AZ,EL | --eye X,Y,Z] [--all] [options]",
              true,
              {{{"limn silhouette knot.ply -o knot.svg --view 30,20 --all --width-mm 120",
                 "for a plotter: visible and dashed hidden lines in layers, 12 cm wide"},
                {"limn silhouette knot.ply -o knot.dxf --ortho --scale 25:1 --classes silhouette,boundary,crease",
                 "for CAD: to scale, a unit of the mesh 25 mm long"},
                {"limn silhouette knot.ply --eye 0,1,4 --all --format json -o - | head -c 300",
                 "the silhouette edges as a list, by the file's vertices"}}},
              declare_silhouette};
}

}  // namespace limn::cli
