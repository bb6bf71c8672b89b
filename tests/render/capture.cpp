#include "render/capture.h"

#include <epoxy/gl.h>

#include "limn/gl/objects.h"
#include "limn/render/camera_block.h"
#include "limn/render/targets.h"

namespace limn::test {

std::vector<CapturedVertex> capture(RefinementMethod& method, std::size_t most) {
  const auto targets = RenderTargets::create(16, 16, 1);
  EXPECT_TRUE(targets) << format_error(targets.error());
  targets->begin_faces();
  const CameraBuffer camera;
  camera.update(CameraBlock{});
  camera.bind();
  const gl::Buffer caught = gl::make_storage(most * sizeof(CapturedVertex));
  // Caught by an object of its own, so that the context's is not left bound.
  GLuint feedback = 0, query = 0;
  glCreateTransformFeedbacks(1, &feedback);
  glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &query);
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, feedback);
  glTransformFeedbackBufferBase(feedback, 0, caught.id());
  glEnable(GL_RASTERIZER_DISCARD);
  // A method draws with several programs, and feedback must not be on while one is changed: it catches one at a time.
  GLuint64 written = 0;
  std::vector<CapturedVertex> all;
  const auto result =
      method.draw({.stage = SurfaceStage::kPositions,
                   .captured = {"captured_position", "captured_source"},
                   .before_draw =
                       [&] {
                         glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
                         glBeginTransformFeedback(GL_TRIANGLES);
                       },
                   .after_draw =
                       [&] {
                         glEndTransformFeedback();
                         glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
                         glGetQueryObjectui64v(query, GL_QUERY_RESULT, &written);
                         const std::size_t before = all.size();
                         all.resize(before + 3 * written);
                         gl::read_buffer(caught.id(), 0, std::as_writable_bytes(std::span(all).subspan(before)));
                       }});
  EXPECT_TRUE(result) << format_error(result.error());
  EXPECT_LT(3 * written, most) << "room for more was needed";
  glDisable(GL_RASTERIZER_DISCARD);
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
  glDeleteTransformFeedbacks(1, &feedback);
  glDeleteQueries(1, &query);
  std::erase_if(all, [](const CapturedVertex& v) { return v.face == 0xfffffffeu; });  // gaps, collapsed
  return all;
}

}  // namespace limn::test
