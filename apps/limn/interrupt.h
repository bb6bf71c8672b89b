#pragma once

namespace limn::cli {

/// Makes Ctrl-C (SIGINT) and SIGTERM ask the work to stop instead of ending the program at once, so that nothing is
/// left half written; work that does not stop within a second is abandoned, a second signal ends it at once. Makes
/// writing into a closed pipe an error instead of a signal.
void install_signal_handlers();

/// While one lives, the program is not ended by work that takes its time to stop: a file is being written.
class Unstoppable {
 public:
  Unstoppable();
  ~Unstoppable();
  Unstoppable(const Unstoppable&) = delete;
  Unstoppable& operator=(const Unstoppable&) = delete;
};

/// The signal that asked to stop, or 0.
int stop_signal();

/// Whether nobody reads standard output any more (the other end of a pipe was closed).
bool stdout_closed();

}  // namespace limn::cli
