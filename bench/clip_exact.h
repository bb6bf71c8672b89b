#pragma once

#include <string>
#include <vector>

#include "clip_frames.h"

namespace limn::bench {

/// How pictures of clipped models differ from the originals' in what they cover.
struct PixelCount {
  std::size_t pictures = 0, pictures_differing = 0;
  std::size_t covered = 0;         ///< pixels, by the originals
  std::size_t differing = 0;       ///< pixels
  std::vector<std::string> lines;  ///< one a differing picture, the first few
};

/// Compares coverage over views of every kind in turn: perspective and parallel, from near and far, in pictures of
/// several sizes, within the hull that limn clip makes. \param exact  ClipDrawOptions::exact
Result<PixelCount> count_pixels(gl::Context& context, const SubjectName& about, const std::filesystem::path& models,
                                const FrameSettings& settings, bool exact);

}  // namespace limn::bench
