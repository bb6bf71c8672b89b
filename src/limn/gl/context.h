#pragma once

#include <memory>
#include <string>

#include "limn/base/result.h"

namespace limn::gl {

/// An OpenGL 4.5 core context without a window or display, through EGL: surfaceless where Mesa offers it, else a
/// device's. Current on the thread that created it until destroyed; use and destroy it there.
class Context {
 public:
  /// Errors: kNoGraphics, saying what was tried and which package or variable helps.
  static Result<std::unique_ptr<Context>> create();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// GL_RENDERER and GL_VERSION, for reports.
  const std::string& renderer() const;
  const std::string& version() const;

  /// Debug messages of high severity since creation; tests require 0.
  int severe_messages() const;
  /// The text of the last of them.
  const std::string& last_severe_message() const;

 private:
  struct Impl;
  explicit Context(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn::gl
