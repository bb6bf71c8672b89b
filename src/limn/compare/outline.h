#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "limn/base/camera.h"
#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/compare/coverage.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// How far apart two outlines are, in pixels.
struct OutlineError {
  double mean_px = 0;
  double p95_px = 0;  ///< the smallest distance that at least 95 % of them do not exceed
  double max_px = 0;
  double iou = 1;                  ///< pixels in both coverages over pixels in either; 1 when both are empty
  std::size_t outline_pixels = 0;  ///< how many distances those figures are of
};

/// The pixels of the outline, 1 or 0 each: covered, with an uncovered neighbour among four. What lies beyond the
/// picture's rim counts as uncovered.
std::vector<std::uint8_t> outline_pixels(const Coverage& coverage);

/// For each outline pixel of `candidate` the distance to the nearest outline pixel of `reference`, exact
/// (distance_transform.h).
///
/// When only one of the two has an outline, each of its pixels counts as far away as the picture's diagonal is long.
/// \pre sizes agree. Cost: linear in pixels. Same bits for any number of threads.
OutlineError compare_outlines(const Coverage& candidate, const Coverage& reference);

struct CompareOptions {
  int views = 20;
  int size_px = 1024;  ///< pictures are square; 1 … kMaxCoverageSize
  std::uint64_t seed = 1;
  float fill = 0.9f;         ///< share of the picture that the reference's diagonal spans, above 0 and at most 1
  bool perspective = false;  ///< else orthographic
  Progress progress{};
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
/// reference.
///
/// Views are taken one after the other, each with all threads; the candidate's function is called from the calling
/// thread, once a view. Same figures for any number of threads and on every machine. Errors: kUnsuitable when the
/// reference has no faces; kInvalidArgument; whatever the candidate's function gives; kCancelled.
Result<Comparison> compare_meshes(const MeshForCamera& candidate, const Mesh& reference,
                                  const CompareOptions& options = {});
Result<Comparison> compare_meshes(const Mesh& candidate, const Mesh& reference, const CompareOptions& options = {});

}  // namespace limn
