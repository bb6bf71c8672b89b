#pragma once

#include <span>
#include <string>
#include <vector>

#include "refinement_frames.h"

namespace limn::bench {

/// Adds contestants by name until one cannot be made.
///
/// Names: uniform-static, uniform-patterns (to max_level everywhere), ark, arkfpi, dmr, suapt, patterns (minimal),
/// patterns nested, tess, dyken, dyken dynamic, dyken unblended, dyken packed. With " stored" behind them patterns keep
/// their vertices for a frame's passes; with " held" they keep them while levels do not change, so that a frame is
/// draw() alone.
class Line {
 public:
  /// \param given  a level an edge instead of the criterion's; empty: none
  Line(FrameStage& stage, LevelOptions levels, std::span<const float> given = {})
      : stage_(&stage), levels_(levels), given_(given) {}

  /// What is added from here on need not draw anything but positions.
  Line& positions_only() {
    positions_only_ = true;
    return *this;
  }
  Line& add(const std::string& name);
  /// The contestants, or why one is missing.
  Result<std::vector<FrameTimes>> time(const FrameOptions& options);

 private:
  Result<Contestant> make(const std::string& name) const;
  FrameStage* stage_;
  LevelOptions levels_;
  std::span<const float> given_;
  bool positions_only_ = false;
  std::vector<Contestant> contestants_;
  Result<void> state_{};
};

}  // namespace limn::bench
