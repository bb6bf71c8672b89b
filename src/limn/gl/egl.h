#pragma once

#include <epoxy/egl.h>
#include <string>

#include "limn/base/result.h"

namespace limn::gl {

/// A context as EGL hands it out, current on this thread.
struct EglContext {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLSurface surface = EGL_NO_SURFACE;  ///< a 1 x 1 pbuffer where the driver cannot do without one
  EGLContext context = EGL_NO_CONTEXT;
  std::string platform;
};

/// Tries the platforms in the order that context.h states. Errors: kNoGraphics, listing what was tried.
Result<EglContext> open_egl_context();

/// Releases the context and its surface. The display stays initialized: other contexts of the process may share it.
void close_egl_context(const EglContext& context);

}  // namespace limn::gl
