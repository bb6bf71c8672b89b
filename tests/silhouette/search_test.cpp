#include <algorithm>
#include <gtest/gtest.h>

#include "limn/base/parallel.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/extractor.h"
#include "limn/silhouette/search/edge_blocks.h"
#include "limn/silhouette/search/edge_clusters.h"
#include "limn/silhouette/search/search_tree.h"

#include "silhouette/eyes.h"
#include "support/stable.h"

namespace limn::test {
namespace {

std::vector<EdgeId> sorted(std::span<const EdgeId> edges) {
  std::vector<EdgeId> copy(edges.begin(), edges.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

/// Everything that finds silhouettes in one mesh.
struct Finders {
  explicit Finders(const Mesh& mesh)
      : topology(build_topology(mesh)),
        planes(face_planes(mesh)),
        frame(quantized_frame(mesh, planes)),
        leaves(leaf_clusters(mesh, topology, planes)),
        blocks(block_clusters(mesh, topology)),
        tree(leaves, planes, frame),
        quantized(blocks, planes, frame),
        exact(blocks, planes, frame, EdgeBlocks::Planes::kExact) {}
  Finders(const Finders&) = delete;
  Finders& operator=(const Finders&) = delete;

  Topology topology;
  std::vector<Plane> planes;
  QuantizedFrame frame;
  std::vector<LeafCluster> leaves;
  std::vector<BlockCluster> blocks;
  SearchTree tree;
  EdgeBlocks quantized, exact;
};

/// How many of the finders differ from the oracle, in set or, among levels, in order.
std::size_t mismatches(const Finders& finders, const Eye& eye, SearchScratch& scratch) {
  std::vector<EdgeId> oracle;
  extract_silhouette_brute(finders.topology, finders.planes, eye, oracle);
  std::size_t wrong = 0;
  std::vector<EdgeId> tree_order, block_order;
  for (const SimdLevel level : simd_levels()) {
    std::vector<std::vector<EdgeId>> found(4);
    const auto tree = finders.tree.find(eye, scratch, nullptr, level);
    found[0].assign(tree.begin(), tree.end());
    const auto flat = finders.tree.find_flat(eye, scratch, nullptr, level);
    found[1].assign(flat.begin(), flat.end());
    finders.quantized.extract(eye, found[2], level);
    finders.exact.extract(eye, found[3], level);
    if (level == SimdLevel::kScalar) {
      tree_order = found[0];
      block_order = found[2];
    }
    for (const auto& edges : found)
      wrong += sorted(edges) == oracle ? 0u : 1u;
    wrong += found[0] == tree_order && found[1] == tree_order ? 0u : 1u;
    wrong += found[2] == block_order && found[3] == block_order ? 0u : 1u;
  }
  return wrong;
}

std::size_t mismatches(const Mesh& mesh, std::size_t views, std::uint64_t seed) {
  const Finders finders(mesh);
  SearchScratch scratch;
  std::size_t wrong = 0;
  for (const Eye& eye : awkward_eyes(mesh, views, seed))
    wrong += mismatches(finders, eye, scratch);
  return wrong;
}

TEST(Search, EveryMethodAndLevelEqualsTheOracleOnAwkwardMeshes) {
  for (const StableMesh& stable : awkward_meshes())
    EXPECT_EQ(mismatches(stable.mesh, 200, 11), 0u) << stable.name;
}

TEST(Search, EveryMethodAndLevelEqualsTheOracleOnShapes) {
  for (const ShapeInfo& shape : shapes())
    EXPECT_EQ(mismatches(*make_shape(shape.shape, {.faces = 4000}), 180, 12), 0u) << shape.name;
}

TEST(Search, EqualsTheOracleWhereFloatsAreCoarse) {
  // A million radii from the origin hardly a bit of the offset is left: culling must give way, not guess.
  for (const float offset : {1e3f, 1e5f, 1e6f}) {
    Mesh mesh = *make_shape(Shape::kAsteroid, {.faces = 3000});
    for (Vec3& position : mesh.positions)
      position += Vec3(offset, -0.7f * offset, 0.3f * offset);
    EXPECT_EQ(mismatches(mesh, 100, 13), 0u) << offset;
  }
  for (const float scale : {1e-30f, 1e-18f, 1e18f, 1e30f}) {
    Mesh mesh = *make_shape(Shape::kKnot, {.faces = 3000});
    for (Vec3& position : mesh.positions)
      position *= scale;
    EXPECT_EQ(mismatches(mesh, 100, 14), 0u) << scale;
  }
}

TEST(Search, ClustersHoldEveryEdgeWithTwoFacesOnce) {
  for (const StableMesh& stable : awkward_meshes()) {
    const Finders finders(stable.mesh);
    std::vector<EdgeId> wanted, in_leaves, in_blocks;
    for (std::size_t e = 0; e < finders.topology.edge_count(); ++e) {
      const EdgeClass edge_class = finders.topology.edge_class[e];
      if (edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent)
        wanted.push_back(static_cast<EdgeId>(e));
    }
    for (const LeafCluster& cluster : finders.leaves)
      in_leaves.insert(in_leaves.end(), cluster.edges.begin(), cluster.edges.begin() + cluster.edge_count);
    for (const BlockCluster& cluster : finders.blocks)
      in_blocks.insert(in_blocks.end(), cluster.edges.begin(), cluster.edges.begin() + cluster.edge_count);
    EXPECT_EQ(sorted(in_leaves), wanted) << stable.name;
    EXPECT_EQ(sorted(in_blocks), wanted) << stable.name;
  }
}

TEST(Search, ThreadsChangeNothing) {
  const Mesh mesh = *make_shape(Shape::kAsteroid, {.faces = 200'000});
  const Eye eye{Vec3(2.0f, 1.0f, -1.5f)};
  std::vector<std::vector<EdgeId>> found;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    const Finders finders(mesh);
    SearchScratch scratch;
    const auto tree = finders.tree.find(eye, scratch);
    found.emplace_back(tree.begin(), tree.end());
    finders.quantized.extract(eye, found.emplace_back());
  }
  EXPECT_EQ(found[0], found[2]);
  EXPECT_EQ(found[1], found[3]);
}

TEST(Search, TreeLeavesMostOfASmoothMeshOut) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 100'000});
  const Finders finders(mesh);
  SearchScratch scratch;
  SearchCounters counters;
  finders.tree.find({Vec3(0.4f, 1.0f, 3.0f)}, scratch, &counters);
  EXPECT_LT(counters.leaves_tested * 8, finders.tree.leaf_count());
  EXPECT_LT(counters.groups_tested * 2, finders.tree.leaf_count() / 16);
}

TEST(Search, TreeFollowsAMeshThatMoves) {
  Mesh mesh = *make_shape(Shape::kHoles3, {.faces = 5000});
  Finders finders(mesh);
  for (Vec3& position : mesh.positions)
    position += 0.3f * Vec3(std::sin(5.0f * position.y), std::cos(7.0f * position.z), std::sin(3.0f * position.x));
  finders.planes = face_planes(mesh);
  finders.tree.refit(finders.planes, quantized_frame(mesh, finders.planes));
  SearchScratch scratch;
  for (const Eye& eye : awkward_eyes(mesh, 100, 5)) {
    std::vector<EdgeId> oracle;
    extract_silhouette_brute(finders.topology, finders.planes, eye, oracle);
    EXPECT_EQ(sorted(finders.tree.find(eye, scratch)), oracle);
  }
}

TEST(Search, ExtractorEqualsTheOracleWhateverTheMethod) {
  for (const Shape shape : {Shape::kAsteroid, Shape::kTerrain, Shape::kCube}) {
    const Mesh mesh = *make_shape(shape, {.faces = 20'000});
    const Topology topology = build_topology(mesh);
    const std::vector<Plane> planes = face_planes(mesh);
    for (const SearchMethod method :
         {SearchMethod::kAuto, SearchMethod::kBrute, SearchMethod::kFlat, SearchMethod::kTree}) {
      const SilhouetteExtractor extractor(mesh, topology, planes, method);
      for (const Eye& eye : awkward_eyes(mesh, 60, 21)) {
        std::vector<EdgeId> oracle;
        extract_silhouette_brute(topology, planes, eye, oracle);
        EXPECT_EQ(extractor.find_sorted(eye), oracle);
      }
    }
  }
}

}  // namespace
}  // namespace limn::test
