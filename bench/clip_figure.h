#pragma once

#include <string>
#include <vector>

#include "clip_frames.h"

namespace limn::bench {

/// A way to draw a model of so many faces: how long a frame takes, and how far its outline is from the original's.
struct FigurePoint {
  std::size_t faces = 0;
  double ms = 0;
  double mean_px = 0;
};

/// Sander et al. 2000, Fig. 11: three ways over numbers of faces.
struct Figure {
  std::string name;
  std::vector<FigurePoint> simplified;          ///< drawn as it is
  std::vector<FigurePoint> clipped;             ///< one hull, clipped to the silhouettes of its own sequence
  std::vector<FigurePoint> clipped_simplified;  ///< the same hull, clipped to those of simplified meshes
};
Result<Figure> measure_figure(gl::Context& context, const SubjectName& about, const std::filesystem::path& models,
                              const FrameSettings& settings);

/// Time against error as an SVG file's text.
std::string figure_svg(const std::vector<Figure>& figures);

}  // namespace limn::bench
