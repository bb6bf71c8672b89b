// Measures what refinement gains: how far two outlines lie from that of a dense model, in pixels, over many views.
#include <iostream>

#include <limn/compare/outline.h>
#include <limn/mesh/shapes.h>
#include <limn/refine/refine.h>

int main() {
  const limn::Result<limn::Mesh> dense = limn::make_shape(limn::Shape::kTorus, {.faces = 20000});
  const limn::Result<limn::Mesh> coarse = limn::make_shape(limn::Shape::kTorus, {.faces = 300});
  if (!dense || !coarse) return 1;

  // Refinement depends on the view, so the comparison asks for the mesh anew for every camera.
  const limn::Result<limn::Refiner> refiner = limn::Refiner::create(*coarse);
  if (!refiner) return 1;
  const limn::MeshForCamera refined = [&](const limn::Camera& camera, int height_px) {
    return refiner->refine(limn::view_of(camera, height_px), {}).map([](limn::Refinement&& fine) { return fine.mesh; });
  };

  const limn::CompareOptions options{.views = 6, .size_px = 256};
  const limn::Result<limn::Comparison> before = limn::compare_meshes(*coarse, *dense, options);
  const limn::Result<limn::Comparison> after = limn::compare_meshes(refined, *dense, options);
  if (!before || !after) return 1;
  std::cout << "outline error: " << before->overall.mean_px << " px coarse, " << after->overall.mean_px
            << " px refined\n";
  return after->overall.mean_px < before->overall.mean_px ? 0 : 1;
}
