#include "silhouette_methods.h"

#include <algorithm>
#include <array>

#include "limn/silhouette/brute.h"
#include "limn/silhouette/extractor.h"
#include "limn/silhouette/sander/paper_forest.h"
#ifdef LIMN_WITH_GL
#include "limn/render/extraction.h"
#endif

#include "stopwatch.h"

namespace limn::cli {
namespace {

FoundSilhouette test_all(const Topology& topology, std::span<const Plane> planes, const Eye& eye) {
  FoundSilhouette found;
  Stopwatch watch;
  extract_silhouette_brute(topology, planes, eye, found.edges);
  found.extract_ms = watch.lap_ms();
  return found;
}

FoundSilhouette search_tree(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes, const Eye& eye) {
  FoundSilhouette found;
  Stopwatch watch;
  const SilhouetteExtractor extractor(mesh, topology, planes, SearchMethod::kTree);
  found.build_ms = watch.lap_ms();
  found.edges = extractor.find_sorted(eye);
  found.extract_ms = watch.lap_ms();
  return found;
}

Result<FoundSilhouette> search_paper_forest(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes,
                                            const Eye& eye, const Progress& progress) {
  FoundSilhouette found;
  Stopwatch watch;
  const Result<PaperForest> forest = build_paper_forest(mesh, topology, planes, {}, progress);
  if (!forest) return tl::unexpected(forest.error());
  found.build_ms = watch.lap_ms();
  extract_silhouette_forest(*forest, eye, found.edges);
  std::sort(found.edges.begin(), found.edges.end());
  found.extract_ms = watch.lap_ms();
  return found;
}

#ifdef LIMN_WITH_GL
Result<FoundSilhouette> search_on_device(const Topology& topology, std::span<const Plane> planes, const Eye& eye) {
  FoundSilhouette found;
  Stopwatch watch;
  const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
  if (!context) return tl::unexpected(context.error());
  const SceneObject object{&topology, planes, {}};
  Result<SceneExtractor> extractor = SceneExtractor::create(**context, {&object, 1});
  if (!extractor) return tl::unexpected(extractor.error());
  found.build_ms = watch.lap_ms();
  if (Result<void> done = extractor->extract({&eye, 1}); !done) return tl::unexpected(done.error());
  found.edges = extractor->read_silhouettes().edges;
  found.extract_ms = watch.lap_ms();
  return found;
}
#endif

}  // namespace

std::span<const std::pair<std::string_view, SilhouetteMethod>> silhouette_methods() {
  static constexpr std::pair<std::string_view, SilhouetteMethod> kMethods[] = {
      {"auto", SilhouetteMethod::kAuto},     {"brute", SilhouetteMethod::kBrute},
      {"forest", SilhouetteMethod::kForest}, {"paper-forest", SilhouetteMethod::kPaperForest},
#ifdef LIMN_WITH_GL
      {"gpu", SilhouetteMethod::kGpu},
#endif
  };
  return kMethods;
}

std::string_view method_name(SilhouetteMethod method) {
  for (const auto& [name, value] : silhouette_methods()) {
    if (value == method) return name;
  }
  return "";
}

Result<FoundSilhouette> find_silhouette(SilhouetteMethod method, const Mesh& mesh, const Topology& topology,
                                        std::span<const Plane> planes, const Eye& eye, const Progress& progress) {
  Result<FoundSilhouette> found = [&]() -> Result<FoundSilhouette> {
    switch (method) {
      case SilhouetteMethod::kForest:
        return search_tree(mesh, topology, planes, eye);
      case SilhouetteMethod::kPaperForest:
        return search_paper_forest(mesh, topology, planes, eye, progress);
#ifdef LIMN_WITH_GL
      case SilhouetteMethod::kGpu:
        return search_on_device(topology, planes, eye);
#endif
      default:
        return test_all(topology, planes, eye);
    }
  }();
  if (found) found->method = method == SilhouetteMethod::kAuto ? SilhouetteMethod::kBrute : method;
  return found;
}

}  // namespace limn::cli
