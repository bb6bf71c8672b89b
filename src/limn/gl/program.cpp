#include "limn/gl/program.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

namespace limn::gl {
namespace {

constexpr const char* kRemedy = "update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 to draw on the CPU";

/// A compiled shader until the program it goes into is linked.
class Shader {
 public:
  Shader(GLenum stage, const std::string& text) : id_(glCreateShader(stage)) {
    const char* const start = text.c_str();
    glShaderSource(id_, 1, &start, nullptr);
    glCompileShader(id_);
  }
  ~Shader() { glDeleteShader(id_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  GLuint id() const { return id_; }
  bool compiled() const {
    GLint status = 0;
    glGetShaderiv(id_, GL_COMPILE_STATUS, &status);
    return status == GL_TRUE;
  }
  std::string log() const {
    GLint length = 0;
    glGetShaderiv(id_, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(id_, length, &length, text.data());
    text.resize(static_cast<std::size_t>(std::max(length, 0)));
    return text;
  }

 private:
  GLuint id_;
};

std::string link_log(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetProgramInfoLog(program, length, &length, text.data());
  text.resize(static_cast<std::size_t>(std::max(length, 0)));
  return text;
}

Result<void> attach(GLuint program, GLenum stage, const std::string& text, const std::string& name) {
  if (text.empty()) return {};
  const Shader shader(stage, text);
  if (!shader.compiled()) {
    return fail_at(ErrorCode::kNoGraphics, name, {}, "the shader does not compile here: " + shader.log(), kRemedy);
  }
  // Deleting an attached shader only marks it, so the program keeps it as long as needed.
  glAttachShader(program, shader.id());
  return {};
}

}  // namespace

Result<std::unique_ptr<Program>> Program::link(const ProgramText& text, const std::string& name) {
  std::unique_ptr<Program> program(new Program(glCreateProgram()));
  const std::pair<GLenum, const std::string*> stages[] = {{GL_VERTEX_SHADER, &text.vertex},
                                                          {GL_TESS_CONTROL_SHADER, &text.tessellation_control},
                                                          {GL_TESS_EVALUATION_SHADER, &text.tessellation_evaluation},
                                                          {GL_GEOMETRY_SHADER, &text.geometry},
                                                          {GL_FRAGMENT_SHADER, &text.fragment},
                                                          {GL_COMPUTE_SHADER, &text.compute}};
  for (const auto& [stage, source] : stages) {
    if (auto attached = attach(program->id_, stage, *source, name); !attached) return tl::unexpected(attached.error());
  }
  std::vector<const char*> captured;
  for (const std::string& varying : text.captured)
    captured.push_back(varying.c_str());
  if (!captured.empty()) {
    glTransformFeedbackVaryings(program->id_, static_cast<GLsizei>(captured.size()), captured.data(),
                                GL_INTERLEAVED_ATTRIBS);
  }
  glLinkProgram(program->id_);
  GLint status = 0;
  glGetProgramiv(program->id_, GL_LINK_STATUS, &status);
  if (status != GL_TRUE) {
    return fail_at(ErrorCode::kNoGraphics, name, {}, "the program does not link here: " + link_log(program->id_),
                   kRemedy);
  }
  program->find_uniforms();
  return program;
}

Program::~Program() {
  glDeleteProgram(id_);
}

void Program::use() const {
  glUseProgram(id_);
}

void Program::find_uniforms() {
  GLint count = 0, longest = 0;
  glGetProgramiv(id_, GL_ACTIVE_UNIFORMS, &count);
  glGetProgramiv(id_, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
  for (GLint i = 0; i < count; ++i) {
    GLint size = 0;
    GLenum type = 0;
    GLsizei length = 0;
    glGetActiveUniform(id_, static_cast<GLuint>(i), static_cast<GLsizei>(name.size()), &length, &size, &type,
                       name.data());
    const std::string used = name.substr(0, static_cast<std::size_t>(length));
    locations_.emplace_back(used, glGetUniformLocation(id_, used.c_str()));
  }
  std::sort(locations_.begin(), locations_.end());
}

int Program::location(std::string_view uniform) const {
  const auto found = std::lower_bound(locations_.begin(), locations_.end(), uniform,
                                      [](const auto& known, std::string_view name) { return known.first < name; });
  return found != locations_.end() && found->first == uniform ? found->second : -1;
}

void Program::set(const char* uniform, int value) const {
  glProgramUniform1i(id_, location(uniform), value);
}
void Program::set(const char* uniform, unsigned value) const {
  glProgramUniform1ui(id_, location(uniform), value);
}
void Program::set(const char* uniform, float value) const {
  glProgramUniform1f(id_, location(uniform), value);
}
void Program::set(const char* uniform, const Vec2& value) const {
  glProgramUniform2fv(id_, location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Vec3& value) const {
  glProgramUniform3fv(id_, location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Vec4& value) const {
  glProgramUniform4fv(id_, location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const Mat4& value) const {
  glProgramUniformMatrix4fv(id_, location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const char* uniform, std::span<const std::array<std::uint32_t, 4>> values) const {
  if (!values.empty())
    glProgramUniform4uiv(id_, location(uniform), static_cast<GLsizei>(values.size()), values.front().data());
}
void Program::set(const char* uniform, std::span<const Vec4> values) const {
  glProgramUniform4fv(id_, location(uniform), static_cast<GLsizei>(values.size()), &values.data()->x);
}

}  // namespace limn::gl
