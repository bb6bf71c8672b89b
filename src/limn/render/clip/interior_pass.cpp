#include "limn/render/clip/interior_pass.h"

#include <epoxy/gl.h>

namespace limn {
namespace {

void march(const InteriorPass::Draws& draws) {
  draws.march->use();
  glStencilMask(InteriorPass::kDone);
  glStencilFunc(GL_NOTEQUAL, InteriorPass::kDone, InteriorPass::kCounts);
  glStencilOp(GL_KEEP, GL_REPLACE, GL_REPLACE);  // where something else lies in front, too
  draws.shell();
}

/// Where something was drawn, nothing is left to do.
void strike_done(const InteriorPass::Draws& draws) {
  draws.mask->use();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glStencilMask(0xff);
  glStencilFunc(GL_LEQUAL, InteriorPass::kDone, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
  draws.hull();
  glEnable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void fill_rest(const InteriorPass::Draws& draws) {
  draws.plain->use();
  glStencilMask(0);
  glStencilFunc(GL_NOTEQUAL, 0, 0xff);
  draws.hull();
  draws.rim();
}

}  // namespace

void InteriorPass::draw(const Draws& draws) {
  march(draws);
  strike_done(draws);
  fill_rest(draws);
}

}  // namespace limn
