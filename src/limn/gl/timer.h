#pragma once

namespace limn::gl {

/// Time on the device's own clock between having done all that was submitted before start() and all before stop().
/// Needs a current context. By time stamps: Mesa's software device counts no computing as elapsed time.
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
  unsigned queries_[2] = {};
};

/// Waits until the device has done all that was submitted.
void finish();

}  // namespace limn::gl
