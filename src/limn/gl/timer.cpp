#include "limn/gl/timer.h"

#include <epoxy/gl.h>

namespace limn::gl {

Timer::Timer() {
  glCreateQueries(GL_TIME_ELAPSED, 1, &query_);
}

Timer::~Timer() {
  glDeleteQueries(1, &query_);
}

void Timer::start() const {
  glBeginQuery(GL_TIME_ELAPSED, query_);
}

void Timer::stop() const {
  glEndQuery(GL_TIME_ELAPSED);
}

double Timer::milliseconds() const {
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &nanoseconds);
  return static_cast<double>(nanoseconds) * 1e-6;
}

void finish() {
  glFinish();
}

}  // namespace limn::gl
