#pragma once

namespace limn::gl {

/// How long the device works on what is submitted between start() and stop(). Needs a current context; timers must not
/// overlap.
class Timer {
 public:
  Timer();
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  void start() const;
  void stop() const;
  /// Waits for the device. \pre started and stopped
  double milliseconds() const;

 private:
  unsigned query_ = 0;
};

/// Waits until the device has done all that was submitted.
void finish();

}  // namespace limn::gl
