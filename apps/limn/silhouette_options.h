#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "limn/drawing/page.h"

#include "camera_options.h"
#include "mesh_files.h"
#include "silhouette_methods.h"

namespace limn::cli {

/// What a drawing is written as; the first two are pages.
enum class DrawingFormat { kUnknown, kSvg, kDxf, kPly, kObj, kJson };
std::string_view format_name(DrawingFormat format);

/// The classes of lines asked for, by LineClass.
using ClassSet = std::array<bool, kLineClasses.size()>;
/// "silhouette,crease". Errors: kInvalidArgument, naming the nearest class.
Result<ClassSet> parse_classes(std::string_view text);

/// Which lines are drawn, and where they go.
struct SilhouetteFlags {
  InputOptions input;
  std::string output;
  DrawingFormat format = DrawingFormat::kUnknown;  ///< what --format says
  bool ascii = false;
  SilhouetteMethod method = SilhouetteMethod::kAuto;
  std::optional<ClassSet> classes;
  double crease_deg = 40.0;
  bool only_visible = false;
  bool only_hidden = false;
  bool all = false;
  bool outline = false;
  CameraOptions camera;
  std::optional<double> width_mm;
  std::optional<double> height_mm;
  std::optional<double> margin_mm;
  std::optional<double> stroke_mm;
  std::optional<double> tolerance_mm;
  std::optional<double> mm_per_unit;
  std::optional<Frame> frame;

  bool shows_visible() const { return all || !only_hidden; }
  bool shows_hidden() const { return all || only_hidden; }
  /// Whether lines of a class are asked for.
  bool wants(LineClass line_class) const;
  /// What --format or else the output's name says; kUnknown when neither does.
  DrawingFormat written_as() const;
  PageOptions page() const;
  /// Width over height of the page inside its margins; 1 unless both are given.
  float aspect() const;
};

void add_silhouette_options(OptionTable& table, SilhouetteFlags& flags);

/// Errors: kInvalidArgument for options that contradict each other or the format, kUnwritable; needs no mesh.
Result<void> check_silhouette(const Session& session, const SilhouetteFlags& flags);

}  // namespace limn::cli
