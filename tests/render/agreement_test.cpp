#include <algorithm>
#include <gtest/gtest.h>

#include "limn/mesh/shapes.h"
#include "limn/render/extraction.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/sander/paper_forest.h"
#include "limn/silhouette/search/edge_blocks.h"
#include "limn/silhouette/search/moving_silhouette.h"
#include "limn/silhouette/search/search_tree.h"

#include "render/drawing_test.h"
#include "silhouette/eyes.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using Agreement = DrawingTest;

/// Every way of finding silhouettes, over one mesh.
class EveryMethod {
 public:
  EveryMethod(gl::Context& context, const Mesh& mesh)
      : topology_(build_topology(mesh)),
        planes_(face_planes(mesh)),
        tree_(leaf_clusters(mesh, topology_, planes_), planes_, quantized_frame(mesh, planes_)),
        quantized_(block_clusters(mesh, topology_), planes_, quantized_frame(mesh, planes_)),
        floats_(block_clusters(mesh, topology_), planes_, quantized_frame(mesh, planes_), EdgeBlocks::Planes::kExact),
        forest_(*build_paper_forest(mesh, topology_, planes_)),
        moving_(tree_) {
    const SceneObject object{&topology_, planes_, {}};
    gpu_.emplace(*SceneExtractor::create(context, {&object, 1}));
  }
  EveryMethod(const EveryMethod&) = delete;
  EveryMethod& operator=(const EveryMethod&) = delete;

  /// How many of them do not find what the oracle finds.
  std::size_t mismatches(const Eye& eye) {
    extract_silhouette_brute(topology_, planes_, eye, oracle_);
    wrong_ = 0;
    for (const SimdLevel level : simd_levels()) {
      check(tree_.find(eye, scratch_, nullptr, level));
      check(tree_.find_flat(eye, scratch_, nullptr, level));
      quantized_.extract(eye, found_, level);
      check(found_);
      floats_.extract(eye, found_, level);
      check(found_);
    }
    check(moving_.find(eye));
    extract_silhouette_forest(forest_, eye, found_);
    check(found_);
    for (const Compaction compaction : {Compaction::kScan, Compaction::kHistogramPyramid}) {
      EXPECT_TRUE(gpu_->extract({&eye, 1}, compaction));
      check(gpu_->read_silhouettes().edges);
    }
    return wrong_;
  }

  /// The same of the eye that moves, for a few small steps on from there.
  std::size_t mismatches_on_the_way(Eye eye, Random& random) {
    wrong_ = 0;
    const float step = 0.004f * glm::length(eye.at);
    for (int i = 0; i < 3; ++i) {
      eye.at += step * random.direction();
      extract_silhouette_brute(topology_, planes_, eye, oracle_);
      check(moving_.find(eye));
      followed_ += moving_.counters().searched ? 0u : 1u;
    }
    return wrong_;
  }
  /// Steps that the moving eye answered without the tree.
  std::size_t followed() const { return followed_; }

 private:
  void check(std::span<const EdgeId> edges) {
    std::vector<EdgeId> sorted(edges.begin(), edges.end());
    std::sort(sorted.begin(), sorted.end());
    wrong_ += sorted == oracle_ ? 0u : 1u;
  }

  Topology topology_;
  std::vector<Plane> planes_;
  SearchTree tree_;
  EdgeBlocks quantized_, floats_;
  PaperForest forest_;
  MovingSilhouette moving_;
  std::optional<SceneExtractor> gpu_;
  SearchScratch scratch_;
  std::vector<EdgeId> oracle_, found_;
  std::size_t wrong_ = 0;
  std::size_t followed_ = 0;
};

TEST_F(Agreement, OfEveryMethodInTenThousandViews) {
  std::vector<StableMesh> meshes = awkward_meshes();
  for (const ShapeInfo& shape : shapes())
    meshes.push_back({std::string(shape.name), *make_shape(shape.shape, {.faces = 1000})});
  std::size_t views = 0, wrong = 0, followed = 0;
  Random random(5);
  for (const StableMesh& stable : meshes) {
    EveryMethod methods(*context_, stable.mesh);
    for (const Eye& eye : awkward_eyes(stable.mesh, 200, 77)) {
      wrong += methods.mismatches(eye);
      wrong += methods.mismatches_on_the_way(eye, random);
      ++views;
    }
    followed += methods.followed();
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GE(views, 10'000u);
  EXPECT_GE(followed, 10'000u);
  RecordProperty("views", static_cast<int>(views));
}

}  // namespace
}  // namespace limn::test
