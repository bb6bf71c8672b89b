#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limn/base/result.h"
#include "limn/base/vec.h"

namespace limn::gl {

/// The shader files of a program and what is defined in all of them. One that computes has a compute stage alone.
struct ProgramFiles {
  std::string vertex;
  std::string geometry;  ///< empty: none
  std::string fragment;
  std::vector<std::string> defines;  ///< "NAME VALUE" each
  std::string compute = {};
  std::string tessellation_control = {}, tessellation_evaluation = {};
  /// What transform feedback catches of the last stage before the fragments, a vertex's values one after the other.
  std::vector<std::string> captured = {};
};

/// The texts of a program's stages, ready to compile; those it does not have are empty.
struct ProgramText {
  std::string vertex, geometry, fragment;
  std::string compute = {};
  std::string tessellation_control = {}, tessellation_evaluation = {};
  std::vector<std::string> captured = {};
};

/// A linked program, deleted with its owner. Setting a uniform that the linked program does not use does nothing, and
/// setting one asks the driver nothing.
class Program {
 public:
  /// Compiles and links. \param name  stands for the program in messages
  /// Errors: kNoGraphics with the driver's log.
  static Result<std::unique_ptr<Program>> link(const ProgramText& text, const std::string& name);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const;
  void set(const char* uniform, int value) const;
  void set(const char* uniform, unsigned value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const Vec2& value) const;
  void set(const char* uniform, const Vec3& value) const;
  void set(const char* uniform, const Vec4& value) const;
  void set(const char* uniform, const Mat4& value) const;
  /// An array of uvec4 or vec4, named with its first element: "name[0]".
  void set(const char* uniform, std::span<const std::array<std::uint32_t, 4>> values) const;
  void set(const char* uniform, std::span<const Vec4> values) const;

 private:
  explicit Program(unsigned id) : id_(id) {}
  void find_uniforms();
  int location(std::string_view uniform) const;
  unsigned id_;
  std::vector<std::pair<std::string, int>> locations_;  // sorted
};

}  // namespace limn::gl
