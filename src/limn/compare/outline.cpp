#include "limn/compare/outline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/compare/distance_transform.h"

namespace limn {
namespace {

// Covered pixels of two coverages, together and in all.
double intersection_over_union(const Coverage& a, const Coverage& b) {
  std::size_t in_both = 0;
  std::size_t in_either = 0;
  for (std::size_t i = 0; i < a.covered.size(); ++i) {
    in_both += static_cast<std::size_t>(a.covered[i] & b.covered[i]);
    in_either += static_cast<std::size_t>(a.covered[i] | b.covered[i]);
  }
  return in_either == 0 ? 1.0 : static_cast<double>(in_both) / static_cast<double>(in_either);
}

// Squared distances of the candidate's outline pixels, in the picture's order.
std::vector<std::uint32_t> outline_distances(const Coverage& candidate, const Coverage& reference) {
  const std::vector<std::uint8_t> from = outline_pixels(candidate);
  const std::vector<std::uint8_t> to = outline_pixels(reference);
  const auto count = [](const std::vector<std::uint8_t>& outline) {
    return static_cast<std::size_t>(std::count(outline.begin(), outline.end(), std::uint8_t{1}));
  };
  const std::size_t from_count = count(from);
  const std::size_t to_count = count(to);
  if (from_count == 0 || to_count == 0) {
    const auto width = static_cast<std::uint32_t>(candidate.width);
    const auto height = static_cast<std::uint32_t>(candidate.height);
    return std::vector<std::uint32_t>(from_count + to_count, width * width + height * height);
  }
  const std::vector<std::uint32_t> to_nearest = squared_distances(to, reference.width, reference.height);
  std::vector<std::uint32_t> distances;
  distances.reserve(from_count);
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] != 0) distances.push_back(to_nearest[i]);
  }
  return distances;
}

OutlineError summarize(std::vector<std::uint32_t> squared, double iou) {
  OutlineError error;
  error.iou = iou;
  error.outline_pixels = squared.size();
  if (squared.empty()) return error;
  std::sort(squared.begin(), squared.end());
  double sum = 0;
  for (const std::uint32_t s : squared)
    sum += std::sqrt(static_cast<double>(s));
  const std::size_t rank_95 = (squared.size() * 95 + 99) / 100;
  error.mean_px = sum / static_cast<double>(squared.size());
  error.p95_px = std::sqrt(static_cast<double>(squared[rank_95 - 1]));
  error.max_px = std::sqrt(static_cast<double>(squared.back()));
  return error;
}

Result<void> check_options(const CompareOptions& options) {
  if (options.views < 1) return fail(ErrorCode::kInvalidArgument, "the number of views is below 1");
  if (options.size_px < 1 || options.size_px > kMaxCoverageSize) {
    return fail(ErrorCode::kInvalidArgument, "the pictures' size is not between 1 and 16384 pixels");
  }
  if (!(options.fill > 0.0f && options.fill <= 1.0f)) {
    return fail(ErrorCode::kInvalidArgument, "the share of the picture to fill is not above 0 and at most 1");
  }
  return {};
}

Result<Comparison> compare_views(const std::function<Result<Coverage>(const Camera&)>& candidate, const Mesh& reference,
                                 const CompareOptions& options) {
  if (const Result<void> checked = check_options(options); !checked) return tl::unexpected(checked.error());
  if (reference.faces.empty()) {
    return fail(ErrorCode::kUnsuitable, "the reference has no faces, so it has no outline",
                "give a mesh with triangles");
  }
  const Bounds bounds = face_bounds(reference);
  const CameraFit fit{.orthographic = !options.perspective, .fill = options.fill};
  Random random(options.seed);
  Comparison comparison;
  std::vector<std::uint32_t> all_distances;
  double iou_sum = 0;
  for (int view = 0; view < options.views; ++view) {
    if (!report(options.progress, "compare", static_cast<double>(view) / options.views)) {
      return fail(ErrorCode::kCancelled, "the comparison was stopped");
    }
    const Vec3 direction = random.direction();
    const Camera camera = fit_camera(bounds, direction, fit);
    if (!is_finite(camera.eye) || !std::isfinite(camera.ortho_height) || !std::isfinite(camera.far_distance)) {
      return fail(ErrorCode::kUnsuitable, "the reference is too large for a camera to stand outside of it",
                  "scale both meshes down");
    }
    const Result<Coverage> seen = candidate(camera);
    if (!seen) return tl::unexpected(seen.error());
    const Coverage wanted = rasterize_coverage(reference, camera, options.size_px, options.size_px);
    const std::vector<std::uint32_t> distances = outline_distances(*seen, wanted);
    const double iou = intersection_over_union(*seen, wanted);
    comparison.views.push_back(summarize(distances, iou));
    comparison.directions.push_back(direction);
    all_distances.insert(all_distances.end(), distances.begin(), distances.end());
    iou_sum += iou;
  }
  report(options.progress, "compare", 1.0);
  comparison.overall = summarize(std::move(all_distances), iou_sum / options.views);
  return comparison;
}

}  // namespace

std::vector<std::uint8_t> outline_pixels(const Coverage& coverage) {
  const int width = coverage.width;
  const int height = coverage.height;
  std::vector<std::uint8_t> outline(coverage.covered.size());
  parallel_for(static_cast<std::size_t>(height), 64, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        if (coverage.at(x, y) == 0) continue;
        const bool inner = x > 0 && x + 1 < width && y > 0 && y + 1 < height && coverage.at(x - 1, y) != 0 &&
                           coverage.at(x + 1, y) != 0 && coverage.at(x, y - 1) != 0 && coverage.at(x, y + 1) != 0;
        outline[static_cast<std::size_t>(y) * width + x] = inner ? 0 : 1;
      }
    }
  });
  return outline;
}

OutlineError compare_outlines(const Coverage& candidate, const Coverage& reference) {
  assert(candidate.width == reference.width && candidate.height == reference.height);
  return summarize(outline_distances(candidate, reference), intersection_over_union(candidate, reference));
}

Result<Comparison> compare_meshes(const MeshForCamera& candidate, const Mesh& reference,
                                  const CompareOptions& options) {
  const auto coverage = [&](const Camera& camera) -> Result<Coverage> {
    const Result<Mesh> mesh = candidate(camera, options.size_px);
    if (!mesh) return tl::unexpected(mesh.error());
    return rasterize_coverage(*mesh, camera, options.size_px, options.size_px);
  };
  return compare_views(coverage, reference, options);
}

Result<Comparison> compare_meshes(const Mesh& candidate, const Mesh& reference, const CompareOptions& options) {
  const auto coverage = [&](const Camera& camera) -> Result<Coverage> {
    return rasterize_coverage(candidate, camera, options.size_px, options.size_px);
  };
  return compare_views(coverage, reference, options);
}

}  // namespace limn
