#include "limn/gl/context.h"

#include <epoxy/gl.h>
#include <map>

#include "limn/gl/egl.h"
#include "limn/gl/shader_library.h"

namespace limn::gl {
namespace {

std::string gl_string(GLenum name) {
  const auto* const text = reinterpret_cast<const char*>(glGetString(name));
  return text != nullptr ? text : "unknown";
}

}  // namespace

struct Context::Impl {
  EglContext egl;
  ShaderLibrary library;
  std::string renderer, version;
  int severe_messages = 0;
  std::string last_severe_message;
  std::map<std::string, std::unique_ptr<Program>> programs;  // by the full text of their stages

  ~Impl() {
    if (egl.context == EGL_NO_CONTEXT) return;
    EGLContext const other = eglGetCurrentContext();
    EGLDisplay const other_display = eglGetCurrentDisplay();
    EGLSurface const other_surface = eglGetCurrentSurface(EGL_DRAW);
    eglMakeCurrent(egl.display, egl.surface, egl.surface, egl.context);
    programs.clear();
    const bool another_was_current = other != EGL_NO_CONTEXT && other != egl.context;
    if (another_was_current) eglMakeCurrent(other_display, other_surface, other_surface, other);
    close_egl_context(egl);
  }

  static void on_message(GLenum, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                         const void* user) {
    if (severity != GL_DEBUG_SEVERITY_HIGH) return;
    auto* const impl = static_cast<Impl*>(const_cast<void*>(user));
    ++impl->severe_messages;
    impl->last_severe_message.assign(
        text, length >= 0 ? static_cast<std::size_t>(length) : std::char_traits<char>::length(text));
  }

  /// Synchronous, so that messages arrive on the caller's thread and the counter needs no lock.
  void listen() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_HIGH, 0, nullptr, GL_TRUE);
    glDebugMessageCallback(&Impl::on_message, this);
  }
};

Context::Context(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Context::~Context() = default;

Result<std::unique_ptr<Context>> Context::create(const ContextOptions& options) {
  const auto egl = open_egl_context();
  if (!egl) return tl::unexpected(egl.error());
  auto impl = std::make_unique<Impl>();
  impl->egl = *egl;
  impl->library = ShaderLibrary(options.shader_folder);
  impl->renderer = gl_string(GL_RENDERER);
  impl->version = gl_string(GL_VERSION);
  impl->listen();
  return std::unique_ptr<Context>(new Context(std::move(impl)));
}

void Context::make_current() const {
  const EglContext& egl = impl_->egl;
  if (eglGetCurrentContext() != egl.context) eglMakeCurrent(egl.display, egl.surface, egl.surface, egl.context);
}

const std::string& Context::renderer() const {
  return impl_->renderer;
}
const std::string& Context::version() const {
  return impl_->version;
}
const std::string& Context::platform() const {
  return impl_->egl.platform;
}
int Context::severe_messages() const {
  return impl_->severe_messages;
}
const std::string& Context::last_severe_message() const {
  return impl_->last_severe_message;
}

Result<const Program*> Context::program(const ProgramFiles& files) {
  ProgramText text;
  const std::pair<const std::string*, std::string*> stages[] = {
      {&files.vertex, &text.vertex},
      {&files.tessellation_control, &text.tessellation_control},
      {&files.tessellation_evaluation, &text.tessellation_evaluation},
      {&files.geometry, &text.geometry},
      {&files.fragment, &text.fragment},
      {&files.compute, &text.compute}};
  text.captured = files.captured;
  std::string key;
  for (const std::string& varying : files.captured)
    key += varying + '\0';
  for (const auto& [name, source] : stages) {
    if (name->empty()) continue;
    auto read = impl_->library.source(*name, files.defines);
    if (!read) return tl::unexpected(read.error());
    *source = std::move(*read);
    key += *source + '\0';
  }
  std::unique_ptr<Program>& program = impl_->programs[key];
  if (!program) {
    make_current();
    auto linked = Program::link(text, files.compute.empty() ? files.vertex + " + " + files.fragment : files.compute);
    if (!linked) return tl::unexpected(linked.error());
    program = std::move(*linked);
  }
  return program.get();
}

Result<const Program*> Context::compute_program(const std::string& file, std::vector<std::string> defines) {
  ProgramFiles files;
  files.compute = file;
  files.defines = std::move(defines);
  return program(files);
}

}  // namespace limn::gl
