#include "limn/gl/egl.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

namespace limn::gl {
namespace {

constexpr const char* kRemedy =
    "install the packages libegl1 and libgl1-mesa-dri; if a graphics driver is in the way, set LIBGL_ALWAYS_SOFTWARE=1";

bool has_extension(const char* list, const char* name) {
  return list != nullptr && epoxy_extension_in_string(list, name);
}

std::string egl_error(const char* call) {
  const EGLint code = eglGetError();
  constexpr std::string_view kNames[] = {"success",       "not initialized", "bad access",        "bad alloc",
                                         "bad attribute", "bad config",      "bad context",       "bad current surface",
                                         "bad display",   "bad match",       "bad native pixmap", "bad native window",
                                         "bad parameter", "bad surface",     "context lost"};
  const auto index = static_cast<std::size_t>(code - EGL_SUCCESS);
  return std::string(call) + ": " + (index < std::size(kNames) ? std::string(kNames[index]) : std::to_string(code));
}

/// Mesa's own switch, read as Mesa reads it.
bool software_wanted() {
  const char* const value = std::getenv("LIBGL_ALWAYS_SOFTWARE");
  if (value == nullptr) return false;
  const std::string_view text(value);
  return text == "1" || text == "true" || text == "yes" || text == "y";
}

struct Candidate {
  std::string name;
  EGLenum platform = EGL_NONE;  ///< EGL_NONE: eglGetDisplay
  void* native = nullptr;
};

struct Devices {
  std::vector<Candidate> hardware, software;
};

Devices list_devices(const char* client_extensions) {
  Devices devices;
  const bool enumerable = has_extension(client_extensions, "EGL_EXT_device_enumeration") ||
                          has_extension(client_extensions, "EGL_EXT_device_base");
  if (!enumerable || !has_extension(client_extensions, "EGL_EXT_platform_device")) return devices;
  std::array<EGLDeviceEXT, 64> found{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(static_cast<EGLint>(found.size()), found.data(), &count) != EGL_TRUE) return devices;
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT const device = found[static_cast<std::size_t>(i)];
    const char* const extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    auto& list = has_extension(extensions, "EGL_MESA_device_software") ? devices.software : devices.hardware;
    list.push_back({"device " + std::to_string(i), EGL_PLATFORM_DEVICE_EXT, device});
  }
  return devices;
}

std::vector<Candidate> list_candidates() {
  const char* const client_extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const Devices devices = list_devices(client_extensions);
  std::vector<Candidate> candidates;
  if (!software_wanted()) candidates = devices.hardware;
  if (has_extension(client_extensions, "EGL_MESA_platform_surfaceless")) {
    candidates.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, nullptr});
  }
  candidates.insert(candidates.end(), devices.software.begin(), devices.software.end());
  candidates.push_back({"default display", EGL_NONE, nullptr});
  return candidates;
}

EGLDisplay get_display(const Candidate& candidate) {
  if (candidate.platform == EGL_NONE) return eglGetDisplay(EGL_DEFAULT_DISPLAY);
  return eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
}

/// The configuration for a context; none at all where the driver needs none.
std::optional<EGLConfig> choose_config(EGLDisplay display) {
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_TRUE && count > 0) return config;
  if (epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) return EGLConfig{};
  return std::nullopt;
}

/// Fills in context and surface and makes them current; a reason when that fails.
std::optional<std::string> make_context(EglContext& egl) {
  EGLint major = 0, minor = 0;
  if (eglInitialize(egl.display, &major, &minor) != EGL_TRUE) return egl_error("eglInitialize");
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return "offers no desktop OpenGL";
  const std::optional<EGLConfig> config = choose_config(egl.display);
  if (!config) return "offers no configuration for desktop OpenGL";
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_DEBUG,
                               EGL_TRUE,
                               EGL_NONE};
  egl.context = eglCreateContext(egl.display, *config, EGL_NO_CONTEXT, attributes);
  if (egl.context == EGL_NO_CONTEXT) return egl_error("no OpenGL 4.5 core context, eglCreateContext");
  if (!epoxy_has_egl_extension(egl.display, "EGL_KHR_surfaceless_context")) {
    const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    egl.surface = eglCreatePbufferSurface(egl.display, *config, size);
    if (egl.surface == EGL_NO_SURFACE) return egl_error("eglCreatePbufferSurface");
  }
  if (eglMakeCurrent(egl.display, egl.surface, egl.surface, egl.context) != EGL_TRUE)
    return egl_error("eglMakeCurrent");
  return std::nullopt;
}

}  // namespace

Result<EglContext> open_egl_context() {
  if (!epoxy_has_egl()) return fail(ErrorCode::kNoGraphics, "the library libEGL.so.1 is not installed", kRemedy);
  std::string tried;
  for (const Candidate& candidate : list_candidates()) {
    EglContext egl;
    egl.platform = candidate.name;
    egl.display = get_display(candidate);
    const std::optional<std::string> reason =
        egl.display == EGL_NO_DISPLAY ? std::optional<std::string>("no display") : make_context(egl);
    if (!reason) return egl;
    close_egl_context(egl);
    tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + *reason;
  }
  return fail(ErrorCode::kNoGraphics, "no OpenGL 4.5 through EGL (tried " + tried + ")", kRemedy);
}

void close_egl_context(const EglContext& egl) {
  if (egl.display == EGL_NO_DISPLAY) return;
  if (egl.context != EGL_NO_CONTEXT && eglGetCurrentContext() == egl.context) {
    eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  if (egl.context != EGL_NO_CONTEXT) eglDestroyContext(egl.display, egl.context);
  if (egl.surface != EGL_NO_SURFACE) eglDestroySurface(egl.display, egl.surface);
}

}  // namespace limn::gl
