#include "progress_bar.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace limn::cli {
namespace {

using namespace std::chrono_literals;

int terminal_columns() {
  struct winsize size {};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

void put(std::string_view text) {
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
}

}  // namespace

std::string progress_line(std::string_view stage, double done, double elapsed_s, int columns) {
  constexpr int kBar = 20;
  const double share = std::clamp(done, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(std::lround(share * kBar));
  std::string line = fmt::format("{} [{:-<{}}] {:3.0f} %", stage, std::string(filled, '#'), kBar, 100 * share);
  if (share > 0 && elapsed_s > 0) {
    line += fmt::format("  {:.3g} %/s  {} left", 100 * share / elapsed_s, duration(elapsed_s * (1 - share) / share));
  }
  // One column stays free: a full line would wrap, and the next one could not be drawn over it.
  return line.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
}

void ProgressBar::update(std::string_view stage, double done) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (stage_ != stage) {
    stage_ = stage;
    begun_ = now;
  }
  if (now - begun_ < 500ms || now - drawn_ < 100ms) return;
  drawn_ = now;
  visible_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - begun_).count();
  put(fmt::format("\r{}\x1b[K", progress_line(stage, done, elapsed_s, terminal_columns())));
}

void ProgressBar::clear() {
  if (visible_) put("\r\x1b[K");
  visible_ = false;
}

}  // namespace limn::cli
