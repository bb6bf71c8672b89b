#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/compare/outline.h"
#include "limn/mesh/mesh.h"
#include "limn/refine/refine.h"

namespace limn::bench {

/// A dense model and what it is reduced to.
struct Case {
  std::string name;
  Mesh original;
  std::size_t faces = 0;            ///< to reduce to; 0: the original itself is refined
  float crease_angle_deg = 180.0f;  ///< where an original without normals is split
  /// The largest mean error, in pixels, that the refined mesh may have: a fixed figure, or a share of the coarse
  /// mesh's.
  double limit_px = 0;
  double limit_of_coarse = 0;
};

struct CaseOptions {
  std::filesystem::path models = "models";
  bool shapes_only = false;
  std::vector<std::string>* missing = nullptr;  ///< gets one line for each model that is not there; may be null
};

/// The benchmark's cases: procedural shapes first, then those models that are there (scripts/models fetches them).
Result<std::vector<Case>> make_cases(const CaseOptions& options);

/// The coarse mesh of a case, with normals of the original.
Mesh coarse_mesh(const Case& c);

/// Outline error of one way to draw, its triangles, and the time it takes to prepare a view.
struct Measured {
  OutlineError error;
  double triangles = 0;  ///< the mean over the views
  double ms = 0;  ///< the median over the views: computing the mesh for the view, without drawing; 0 when there is
                  ///< nothing to do
};

Result<Measured> measure_mesh(const Mesh& mesh, const Mesh& original, const CompareOptions& options);

/// Every edge at `level`, computed once for all views.
Result<Measured> measure_uniform(const Refiner& refiner, int level, const Mesh& original,
                                 const CompareOptions& options);

/// Refined for each view where its outline is, M = `max_level`.
Result<Measured> measure_silhouette(const Refiner& refiner, int max_level, const Mesh& original,
                                    const CompareOptions& options);

}  // namespace limn::bench
