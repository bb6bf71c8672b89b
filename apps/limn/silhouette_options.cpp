#include "silhouette_options.h"

#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>
#include <vector>

#include "nearest.h"

namespace limn::cli {
namespace {

constexpr std::array<std::pair<std::string_view, DrawingFormat>, 5> kFormats{{{"svg", DrawingFormat::kSvg},
                                                                              {"dxf", DrawingFormat::kDxf},
                                                                              {"ply", DrawingFormat::kPly},
                                                                              {"obj", DrawingFormat::kObj},
                                                                              {"json", DrawingFormat::kJson}}};

Result<double> parse_length(std::string_view text) {
  return parse_number(text, {0.0, 1e5, true, false});
}
Result<double> parse_margin(std::string_view text) {
  return parse_number(text, {0.0, 1e4, false, false});
}
Result<double> parse_stroke(std::string_view text) {
  return parse_number(text, {0.001, 100.0, false, false});
}
Result<double> parse_tolerance(std::string_view text) {
  return parse_number(text, {kPageStepMm, 1.0, false, false});
}

tl::unexpected<Error> contradiction(std::string message, std::string remedy) {
  return fail(ErrorCode::kInvalidArgument, std::move(message), std::move(remedy));
}

/// The first page option given, or nothing.
std::string_view page_option(const SilhouetteFlags& flags) {
  if (flags.width_mm) return "--width-mm";
  if (flags.height_mm) return "--height-mm";
  if (flags.margin_mm) return "--margin-mm";
  if (flags.mm_per_unit) return "--scale";
  if (flags.frame) return "--frame";
  return flags.tolerance_mm ? "--tolerance-mm" : "";
}

Result<void> check_against_format(const SilhouetteFlags& flags, DrawingFormat format) {
  const bool is_page = format == DrawingFormat::kSvg || format == DrawingFormat::kDxf;
  const std::string_view given = page_option(flags);
  if (!is_page && !given.empty()) {
    return contradiction(fmt::format("{} is for pages, not for {}", given, format_name(format)),
                         "write .svg or .dxf, or leave it out");
  }
  if (flags.stroke_mm && format != DrawingFormat::kSvg) {
    return contradiction(fmt::format("--stroke-mm is for SVG, not for {}", format_name(format)), "leave it out");
  }
  if (flags.ascii && format != DrawingFormat::kPly) {
    return contradiction(fmt::format("--ascii is for PLY, not for {}", format_name(format)), "leave it out");
  }
  return {};
}

Result<void> check_page(const SilhouetteFlags& flags) {
  if (flags.mm_per_unit && !flags.camera.orthographic) {
    return contradiction("--scale has no meaning in perspective", "add --ortho");
  }
  const double least = 2.0 * flags.page().margin_mm + 1.0;
  for (const auto& [name, length] :
       {std::pair("--width-mm", flags.width_mm), std::pair("--height-mm", flags.height_mm)}) {
    if (length && *length < least) {
      return contradiction(fmt::format("{} {:g} leaves less than 1 mm between margins of {:g} mm", name, *length,
                                       flags.page().margin_mm),
                           "choose a larger page or a smaller --margin-mm");
    }
  }
  return {};
}

Result<void> check_choice_of_lines(const SilhouetteFlags& flags) {
  if (int{flags.only_visible} + int{flags.only_hidden} + int{flags.all} > 1) {
    return contradiction("--visible, --hidden and --all exclude one another", "give one of them");
  }
  if (flags.outline && (flags.only_hidden || flags.all)) {
    return contradiction("the outer outline has no hidden lines", "leave out --hidden or --all, or --outline");
  }
  if (flags.outline && flags.classes) {
    return contradiction("the outer outline is what it is of, whatever its lines' classes",
                         "leave out --classes or --outline");
  }
  return {};
}

}  // namespace

std::string_view format_name(DrawingFormat format) {
  for (const auto& [name, value] : kFormats) {
    if (value == format) return name;
  }
  return "";
}

Result<ClassSet> parse_classes(std::string_view text) {
  std::vector<std::string_view> known;
  for (const LineClass line_class : kLineClasses)
    known.push_back(line_class_name(line_class));
  ClassSet set{};
  for (std::size_t at = 0, end = 0; end != std::string_view::npos; at = end + 1) {
    end = text.find(',', at);
    const std::string_view word = text.substr(at, end - at);
    bool found = false;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (word != known[i]) continue;
      set[i] = true;
      found = true;
    }
    if (!found) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("takes a list of {}, not '{}'", fmt::join(known, ", "), word), suggest(word, known));
    }
  }
  return set;
}

bool SilhouetteFlags::wants(LineClass line_class) const {
  constexpr ClassSet kUnlessTold{true, true, false, false};
  if (outline) return line_class != LineClass::kCrease;
  return classes.value_or(kUnlessTold)[static_cast<std::size_t>(line_class)];
}

DrawingFormat SilhouetteFlags::written_as() const {
  if (format != DrawingFormat::kUnknown) return format;
  std::string extension = std::filesystem::path(output).extension().string();
  for (char& c : extension)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const auto& [name, value] : kFormats) {
    if (extension.starts_with('.') && extension.substr(1) == name) return value;
  }
  return DrawingFormat::kUnknown;
}

PageOptions SilhouetteFlags::page() const {
  PageOptions options;
  options.width_mm = width_mm.value_or(mm_per_unit ? 0.0 : options.width_mm);
  options.height_mm = height_mm.value_or(options.height_mm);
  options.margin_mm = margin_mm.value_or(options.margin_mm);
  options.tolerance_mm = tolerance_mm.value_or(options.tolerance_mm);
  options.mm_per_unit = mm_per_unit.value_or(options.mm_per_unit);
  options.frame = frame.value_or(options.frame);
  return options;
}

float SilhouetteFlags::aspect() const {
  const PageOptions options = page();
  if (options.width_mm == 0.0 || options.height_mm == 0.0) return 1.0f;
  const double margins = 2.0 * options.margin_mm;
  return static_cast<float>((options.width_mm - margins) / (options.height_mm - margins));
}

void add_silhouette_options(OptionTable& table, SilhouetteFlags& flags) {
  table.argument("MODEL", flags.input.path, "mesh to draw; - is standard input");
  table.begin(Group::kOwn);
  table.file("-o,--output", flags.output, "drawing to write: .svg, .dxf, .ply, .obj or .json; - is standard output")
      .required = true;
  table.parsed("--classes", "LIST", flags.classes, parse_classes,
               "of silhouette, boundary, crease, non-manifold (default silhouette,boundary)");
  table.toggle("--visible", flags.only_visible, "draw what is seen (default)");
  table.toggle("--hidden", flags.only_hidden, "draw what the mesh hides");
  table.toggle("--all", flags.all, "draw both, each in layers of its own");
  table.toggle("--outline", flags.outline, "the outer outline alone, in closed loops");
  table.number("--crease-angle", "DEG", flags.crease_deg, {0.0, 180.0, false, false},
               "creases are edges sharper than this (default 40)");
  table.choice("--method", flags.method, silhouette_methods(),
               "how the edges are found, all with the same result (default auto)");
  table.begin(Group::kPage);
  table.parsed("--width-mm", "W", flags.width_mm, parse_length, "of the paper (default 200, or as --scale needs)");
  table.parsed("--height-mm", "H", flags.height_mm, parse_length, "of the paper (default: as the drawing needs)");
  table.parsed("--margin-mm", "M", flags.margin_mm, parse_margin, "left free on every side (default 10)");
  table.parsed("--scale", "A:B", flags.mm_per_unit, parse_ratio, "B of the mesh's units drawn A mm long; with --ortho");
  table.choice("--frame", flags.frame,
               {{"content", std::optional(Frame::kContent)}, {"camera", std::optional(Frame::kCamera)}},
               "fill the paper with all of it (default), or with the camera's picture");
  table.parsed("--stroke-mm", "W", flags.stroke_mm, parse_stroke, "width of the silhouette in SVG (default 0.5)");
  table.parsed("--tolerance-mm", "T", flags.tolerance_mm, parse_tolerance,
               "how far strokes may be from the lines (default 0.002)");
  table.begin(Group::kFiles);
  table.choice("--format", flags.format,
               {{"svg", DrawingFormat::kSvg},
                {"dxf", DrawingFormat::kDxf},
                {"ply", DrawingFormat::kPly},
                {"obj", DrawingFormat::kObj},
                {"json", DrawingFormat::kJson}},
               "of the output where its name does not tell");
  table.toggle("--ascii", flags.ascii, "PLY as text");
  add_input_options(table, flags.input);
  add_camera_options(table, flags.camera);
}

Result<void> check_silhouette(const Session& session, const SilhouetteFlags& flags) {
  const DrawingFormat format = flags.written_as();
  if (format == DrawingFormat::kUnknown && flags.output == "-") {
    return contradiction("-o - does not tell a format", "add --format, for example --format svg");
  }
  if (format == DrawingFormat::kUnknown) {
    return fail_at(ErrorCode::kInvalidArgument, flags.output, {}, "its extension is of no format that can be written",
                   "name it .svg, .dxf, .ply, .obj or .json, or add --format");
  }
  return check_camera(flags.camera)
      .and_then([&] { return check_choice_of_lines(flags); })
      .and_then([&] { return check_against_format(flags, format); })
      .and_then([&] { return check_page(flags); })
      .and_then([&] { return check_destination(session, flags.output); });
}

}  // namespace limn::cli
