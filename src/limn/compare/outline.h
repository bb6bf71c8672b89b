#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "limn/base/camera.h"
#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// Which pixels a picture covers: 1 or 0 each, rows from the top.
struct Coverage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> covered;
};

/// Rasterizes a mesh's coverage on the CPU: a pixel counts when its centre lies in a projected triangle, front or back,
/// by the top-left rule on a 1/256-pixel grid with integer edge functions, so that the picture is the same on every
/// machine. Triangles that reach behind an eye's near plane are clipped there. Same bits for any number of threads.
Coverage rasterize_coverage(const Mesh& mesh, const Camera& camera, int width, int height);

/// How far apart two outlines are, in pixels.
struct OutlineError {
  double mean_px = 0;
  double p95_px = 0;
  double max_px = 0;
  double iou = 1;                  ///< pixels in both coverages over pixels in either; 1 when both are empty
  std::size_t outline_pixels = 0;  ///< how many distances those figures are of
};

/// For each outline pixel of `candidate` (covered, with an uncovered neighbour among four, the picture's rim counting
/// as uncovered) the distance to the nearest outline pixel of `reference`, exact (Felzenszwalb and Huttenlocher 2012).
/// When one of the two has no outline and the other has, distances are the picture's diagonal. \pre sizes agree
OutlineError compare_outlines(const Coverage& candidate, const Coverage& reference);

struct CompareOptions {
  int views = 20;
  int size_px = 1024;  ///< pictures are square
  std::uint64_t seed = 1;
  float fill = 0.9f;         ///< share of the picture that the reference's diagonal spans
  bool perspective = false;  ///< else orthographic
  Progress progress;
};

/// The candidate as it should be seen by one camera: lets view-dependent refinement be measured.
using MeshForCamera = std::function<Result<Mesh>(const Camera& camera, int height_px)>;

struct Comparison {
  OutlineError
      overall;  ///< mean, 95th percentile and maximum over the outline pixels of all views together; IoU the mean
  std::vector<OutlineError> views;
  std::vector<Vec3> directions;  ///< towards the viewer, one a view
};

/// Measures a candidate against a reference over seeded random views (uniform over the sphere) that frame the
/// reference. Same figures for any number of threads and on every machine. Errors: kUnsuitable when the reference has
/// no faces; kInvalidArgument; whatever the candidate's function gives; kCancelled.
Result<Comparison> compare_meshes(const MeshForCamera& candidate, const Mesh& reference,
                                  const CompareOptions& options = {});
Result<Comparison> compare_meshes(const Mesh& candidate, const Mesh& reference, const CompareOptions& options = {});

}  // namespace limn
