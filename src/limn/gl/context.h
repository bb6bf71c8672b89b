#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/program.h"

namespace limn::gl {

struct ContextOptions {
  /// Read shaders from the files in this folder, anew whenever a program is asked for, instead of those built in: for
  /// working on shaders without building.
  std::filesystem::path shader_folder;
};

/// An OpenGL 4.5 core context without a window or display, through EGL. A device with hardware is preferred, then
/// Mesa's surfaceless platform (which draws on the CPU where there is no GPU), then software devices, then the default
/// display. With LIBGL_ALWAYS_SOFTWARE set, as Mesa understands it, hardware devices are not asked. Current on the
/// thread that created it until destroyed or another is made current; use and destroy it there.
class Context {
 public:
  /// Errors: kNoGraphics, saying what was tried and which package or variable helps.
  static Result<std::unique_ptr<Context>> create(const ContextOptions& options = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes it the thread's current context again, after another was made. Cheap when it is already.
  void make_current() const;

  /// GL_RENDERER and GL_VERSION, for reports; and which of the EGL platforms gave it ("surfaceless", "device 0").
  const std::string& renderer() const;
  const std::string& version() const;
  const std::string& platform() const;

  /// Debug messages of high severity since creation; tests require 0.
  int severe_messages() const;
  /// The text of the last of them.
  const std::string& last_severe_message() const;

  /// A linked program, made when first asked for and kept; valid while the context lives.
  /// Errors: kNoGraphics with the driver's log, kUnreadable when a file of the shader folder cannot be read.
  Result<const Program*> program(const ProgramFiles& files);

  /// A program that computes, of one shader file. Errors: as program().
  Result<const Program*> compute_program(const std::string& file, std::vector<std::string> defines = {});

 private:
  struct Impl;
  explicit Context(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn::gl
