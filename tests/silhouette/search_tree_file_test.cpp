#include "limn/silhouette/search/search_tree_file.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/base/file.h"
#include "limn/mesh/shapes.h"

#include "silhouette/eyes.h"
#include "support/stable.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

struct Built {
  explicit Built(const Mesh& mesh)
      : topology(build_topology(mesh)),
        planes(face_planes(mesh)),
        tree(leaf_clusters(mesh, topology, planes), planes, quantized_frame(mesh, planes)) {}
  Built(const Built&) = delete;
  Built& operator=(const Built&) = delete;

  Topology topology;
  std::vector<Plane> planes;
  SearchTree tree;
};

void put(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  ASSERT_TRUE(write_file(path, bytes));
}

TEST(SearchTreeFile, FindsTheSameInTheSameOrderAfterwards) {
  const TempFolder folder;
  for (const StableMesh& stable : awkward_meshes()) {
    const Built built(stable.mesh);
    const auto path = folder.path() / "tree";
    ASSERT_TRUE(save_search_tree(built.tree, built.topology, path)) << stable.name;
    const Result<SearchTree> loaded = load_search_tree(path, built.topology, built.planes);
    ASSERT_TRUE(loaded) << stable.name << ": " << format_error(loaded.error());
    SearchScratch a, b;
    for (const Eye& eye : awkward_eyes(stable.mesh, 30, 2)) {
      const auto before = built.tree.find(eye, a);
      const auto after = loaded->find(eye, b);
      EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin(), after.end())) << stable.name;
    }
  }
}

TEST(SearchTreeFile, RefusesEveryDamagedByteAndEveryLength) {
  const TempFolder folder;
  const auto path = folder.path() / "tree";
  const Built built(*make_shape(Shape::kIcosphere, {.faces = 80}));
  ASSERT_TRUE(save_search_tree(built.tree, built.topology, path));
  const auto file = FileBytes::open(path);
  ASSERT_TRUE(file);
  const std::vector<std::byte> whole(file->bytes().begin(), file->bytes().end());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::byte> damaged = whole;
    damaged[i] ^= std::byte{0x10};
    put(path, damaged);
    EXPECT_FALSE(load_search_tree(path, built.topology, built.planes)) << i;
    put(path, std::span(whole).first(i));
    EXPECT_FALSE(load_search_tree(path, built.topology, built.planes)) << i;
  }
}

TEST(SearchTreeFile, IsHeldAgainstTheMeshNotOnlyItsHash) {
  // Anybody can compute the hash: what it covers must be right as well.
  const TempFolder folder;
  const Mesh mesh = *make_shape(Shape::kTorus, {.faces = 500});
  const Built built(mesh);
  std::vector<LeafCluster> clusters = leaf_clusters(mesh, built.topology, built.planes);
  std::swap(clusters.front().edges[0], clusters.back().edges[0]);
  const SearchTree wrong(clusters, built.planes, quantized_frame(mesh, built.planes));
  ASSERT_TRUE(save_search_tree(wrong, built.topology, folder.path() / "tree"));  // with a hash that is right
  const Result<SearchTree> loaded = load_search_tree(folder.path() / "tree", built.topology, built.planes);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kUnreadable);
  clusters = leaf_clusters(mesh, built.topology, built.planes);
  clusters.pop_back();  // edges are missing
  const SearchTree less(clusters, built.planes, quantized_frame(mesh, built.planes));
  ASSERT_TRUE(save_search_tree(less, built.topology, folder.path() / "tree"));
  EXPECT_FALSE(load_search_tree(folder.path() / "tree", built.topology, built.planes));
}

TEST(SearchTreeFile, RefusesAnotherMesh) {
  const TempFolder folder;
  const auto path = folder.path() / "tree";
  const Built built(*make_shape(Shape::kTorus, {.faces = 500}));
  ASSERT_TRUE(save_search_tree(built.tree, built.topology, path));
  Mesh moved = *make_shape(Shape::kTorus, {.faces = 500});
  moved.positions[7].x += 1e-3f;
  const Built other(moved);
  const Result<SearchTree> loaded = load_search_tree(path, other.topology, other.planes);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kUnsuitable);
  EXPECT_EQ(load_search_tree(folder.path() / "none", other.topology, other.planes).error().code,
            ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace limn::test
