#include "limn/asset/leaf_codec.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/silhouette/extractor.h"
#include "limn/silhouette/search/leaf_partition.h"

#include "asset/stand_in.h"
#include "silhouette/eyes.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using namespace limn::asset;

TEST(LeafCodec, KeepsThePartitionOfAwkwardMeshes) {
  for (const StableMesh& stable : awkward_meshes()) {
    const SilhouetteLevel level = level_of(stable.mesh, 0.0f);
    const Topology topology = build_topology(level.mesh);
    const std::vector<std::byte> bytes = encode_leaves(level.leaf_of_edge, topology);
    const auto read = decode_leaves(bytes, topology);
    ASSERT_TRUE(read) << stable.name;
    EXPECT_EQ(*read, level.leaf_of_edge) << stable.name;
  }
}

TEST(LeafCodec, TakesAFractionOfAPlainTree) {
  const SilhouetteLevel level = level_of(bumpy_sphere(20480), 0.0f);
  const std::size_t bytes = encode_leaves(level.leaf_of_edge, build_topology(level.mesh)).size();
  EXPECT_LT(static_cast<double>(bytes) / static_cast<double>(level.mesh.faces.size()), 0.8);  // plain: 15
}

TEST(LeafPartition, FindsWhatTheTreeItCameFromFinds) {
  for (const StableMesh& stable : awkward_meshes()) {
    const SilhouetteLevel level = level_of(stable.mesh, 0.0f);
    const Topology topology = build_topology(level.mesh);
    const std::vector<Plane> planes = face_planes(level.mesh);
    const auto clusters = partition_clusters(level.leaf_of_edge, topology);
    ASSERT_TRUE(clusters) << stable.name;
    EXPECT_EQ(leaf_partition(*clusters, topology), level.leaf_of_edge) << stable.name;
    const SilhouetteExtractor brute(level.mesh, topology, planes, SearchMethod::kBrute);
    const SilhouetteExtractor tree(level.mesh, topology, planes, SearchMethod::kTree, *clusters);
    for (const Eye& eye : awkward_eyes(level.mesh, 30, 5))
      EXPECT_EQ(tree.find_sorted(eye), brute.find_sorted(eye)) << stable.name;
  }
}

TEST(LeafPartition, RefusesWhatIsNoneOfTheMesh) {
  const SilhouetteLevel level = level_of(bumpy_sphere(320), 0.0f);
  const Topology topology = build_topology(level.mesh);
  ASSERT_TRUE(partition_clusters(level.leaf_of_edge, topology));
  const auto refused = [&](const std::vector<std::uint32_t>& leaves) { return !partition_clusters(leaves, topology); };
  std::vector<std::uint32_t> leaves = level.leaf_of_edge;
  leaves.pop_back();
  EXPECT_TRUE(refused(leaves)) << "an edge is missing";
  leaves = level.leaf_of_edge;
  leaves[3] = kInvalidId;
  EXPECT_TRUE(refused(leaves)) << "an edge is in no leaf";
  leaves.assign(leaves.size(), 0);
  EXPECT_TRUE(refused(leaves)) << "all in one leaf";
  leaves = level.leaf_of_edge;
  for (std::uint32_t& leaf : leaves)
    ++leaf;
  EXPECT_TRUE(refused(leaves)) << "a leaf is empty";
  leaves = level.leaf_of_edge;
  leaves[3] = static_cast<std::uint32_t>(leaves.size());
  EXPECT_TRUE(refused(leaves)) << "more leaves than edges";
}

TEST(LeafCodec, AnyBytesGiveAPartitionOrNothing) {
  const SilhouetteLevel level = level_of(bumpy_sphere(20), 0.0f);
  const Topology topology = build_topology(level.mesh);
  const std::vector<std::byte> good = encode_leaves(level.leaf_of_edge, topology);
  Random random(6);
  std::size_t different = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::byte> bytes = good;
    if (round % 4 == 0) bytes.resize(random.below(bytes.size()));
    for (std::uint64_t n = random.below(4); n > 0 && !bytes.empty(); --n)
      bytes[random.below(bytes.size())] = static_cast<std::byte>(random.next());
    const auto read = decode_leaves(bytes, topology);
    if (!read) continue;
    EXPECT_TRUE(partition_clusters(*read, topology));
    different += *read != level.leaf_of_edge ? 1 : 0;
  }
  EXPECT_GT(different, 0u);  // other trees come up, and they are whole ones
}

}  // namespace
}  // namespace limn::test
