#include "limn/gl/timer.h"

#include <epoxy/gl.h>

namespace limn::gl {

Timer::Timer() {
  glCreateQueries(GL_TIMESTAMP, 2, queries_);
}

Timer::~Timer() {
  glDeleteQueries(2, queries_);
}

void Timer::start() const {
  glQueryCounter(queries_[0], GL_TIMESTAMP);
}

void Timer::stop() const {
  glQueryCounter(queries_[1], GL_TIMESTAMP);
}

double Timer::milliseconds() const {
  GLuint64 times_ns[2] = {};
  for (int i = 0; i < 2; ++i)
    glGetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &times_ns[i]);
  return static_cast<double>(times_ns[1] - times_ns[0]) * 1e-6;
}

void finish() {
  glFinish();
}

}  // namespace limn::gl
