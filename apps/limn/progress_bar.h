#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace limn::cli {

/// One line at the bottom of a terminal: stage, share done, rate, time left. Appears only when a stage has taken half a
/// second, is redrawn at most ten times a second, and leaves nothing behind. Draws nothing unless `enabled`.
class ProgressBar {
 public:
  explicit ProgressBar(bool enabled) : enabled_(enabled) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::string_view stage, double done);
  /// Takes the line off the screen, for a message or at the end.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool visible_ = false;
  std::string stage_;
  Clock::time_point begun_{};
  Clock::time_point drawn_{};
};

/// The line itself. \param done 0 to 1 \param elapsed_s time this stage has taken
std::string progress_line(std::string_view stage, double done, double elapsed_s, int columns);

}  // namespace limn::cli
