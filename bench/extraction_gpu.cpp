#include "extraction_gpu.h"

#ifdef LIMN_BENCH_WITH_GL

#include <algorithm>
#include <chrono>
#include <vector>

#include "limn/gl/context.h"
#include "limn/gl/timer.h"
#include "limn/render/extraction.h"
#include "limn/silhouette/brute.h"

namespace limn::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Samples {
  std::vector<double> device, wall, read_back;

  GpuViewTimes medians() const { return {median(device), median(wall), median(read_back)}; }
};

/// One view by one method, three times: by the device's clock, by ours, and with read-back. Returns the edges.
Result<std::vector<EdgeId>> time_view(SceneExtractor& extractor, const Eye& eye, Compaction method, Samples& samples) {
  const std::span<const Eye> eyes(&eye, 1);
  const gl::Timer timer;
  timer.start();
  if (auto done = extractor.extract(eyes, method); !done) return tl::unexpected(done.error());
  timer.stop();
  samples.device.push_back(timer.milliseconds());
  gl::finish();

  auto start = Clock::now();
  if (auto done = extractor.extract(eyes, method); !done) return tl::unexpected(done.error());
  gl::finish();
  samples.wall.push_back(ms_since(start));

  start = Clock::now();
  if (auto done = extractor.extract(eyes, method); !done) return tl::unexpected(done.error());
  SceneExtractor::Lists lists = extractor.read_silhouettes();
  samples.read_back.push_back(ms_since(start));
  return std::move(lists.edges);
}

struct Timed {
  Samples pyramid, scan;
  std::vector<double> brute;
  double edges_found = 0;
};

Result<void> time_contestants(SceneExtractor& extractor, const Topology& topology, std::span<const Plane> planes,
                              const Eye& eye, Timed& timed) {
  const auto start = Clock::now();
  std::vector<EdgeId> expected;
  extract_silhouette_brute(topology, planes, eye, expected);
  timed.brute.push_back(ms_since(start));
  const auto by_pyramid = time_view(extractor, eye, Compaction::kHistogramPyramid, timed.pyramid);
  if (!by_pyramid) return tl::unexpected(by_pyramid.error());
  const auto by_scan = time_view(extractor, eye, Compaction::kScan, timed.scan);
  if (!by_scan) return tl::unexpected(by_scan.error());
  timed.edges_found += static_cast<double>(expected.size());
  if (*by_pyramid == expected && *by_scan == expected) return {};
  return fail(ErrorCode::kUnsuitable, "the graphics device found other silhouettes than brute force",
              "report the device and its driver");
}

}  // namespace

Result<GpuExtractionTimes> time_gpu_extraction(const Topology& topology, std::span<const Plane> planes,
                                               std::span<const Eye> eyes) {
  auto context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  const auto start = Clock::now();
  const SceneObject object{&topology, planes, {}};
  auto extractor = SceneExtractor::create(**context, std::span(&object, 1));
  if (!extractor) return tl::unexpected(extractor.error());
  gl::finish();
  GpuExtractionTimes times;
  times.renderer = (*context)->renderer();
  times.upload_ms = ms_since(start);
  Timed warm_up, timed;
  if (auto done = time_contestants(*extractor, topology, planes, eyes.front(), warm_up); !done)
    return tl::unexpected(done.error());
  for (const Eye& eye : eyes) {
    if (auto done = time_contestants(*extractor, topology, planes, eye, timed); !done)
      return tl::unexpected(done.error());
  }
  times.pyramid = timed.pyramid.medians();
  times.scan = timed.scan.medians();
  times.brute_ms = median(timed.brute);
  times.edges_found = timed.edges_found / static_cast<double>(eyes.size());
  return times;
}

}  // namespace limn::bench

#else

namespace limn::bench {

Result<GpuExtractionTimes> time_gpu_extraction(const Topology&, std::span<const Plane>, std::span<const Eye>) {
  return fail(ErrorCode::kNoGraphics, "limn was built without graphics", "configure with LIMN_GL=ON");
}

}  // namespace limn::bench

#endif
