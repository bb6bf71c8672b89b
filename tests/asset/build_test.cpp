#include "limn/asset/build.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>

#include "limn/asset/asset_file.h"
#include "limn/bake/face_tree.h"
#include "limn/base/parallel.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/search/leaf_partition.h"

#include "asset/stand_in.h"
#include "support/mesh_bits.h"
#include "support/solid.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

ClipOptions small_options(std::size_t faces = 100) {
  ClipOptions options;
  options.faces = faces;
  options.size_px = 64 + 64 * static_cast<int>(faces > 200);
  return options;
}

/// Points of the inner mesh lie inside the outer one, or on it.
void expect_encloses(const Mesh& outer, const Mesh& inner) {
  const bake_detail::FaceTree tree(outer.positions, outer.faces);
  const std::size_t step = inner.positions.size() / 200 + 1;
  for (std::size_t v = 0; v < inner.positions.size(); v += step) {
    const Vec3& p = inner.positions[v];
    if (tree.closest(p).distance < 1e-5f) continue;
    EXPECT_NEAR(solid_angle_winding(outer.positions, outer.faces, DVec3(p)), 1.0, 1e-3) << v;
  }
}

std::string file_of(const ClipAsset& asset) {
  const TempFolder folder;
  EXPECT_TRUE(write_clip_asset(asset, folder / "asset.glb"));
  return slurp(folder / "asset.glb");
}

TEST(BuildClipAsset, TheFirstSilhouetteIsTheOriginal) {
  for (const Shape shape : {Shape::kKnot, Shape::kCube, Shape::kAsteroid}) {
    const Mesh original = *make_shape(shape, {.faces = 2000});
    const auto built = build_clip_asset(original, small_options());
    ASSERT_TRUE(built) << format_error(built.error());
    const SilhouetteLevel& first = built->asset.levels.front();
    EXPECT_EQ(first.error, 0.0f);
    EXPECT_EQ(first.mesh.faces.size(), original.faces.size());
    const Mesh ordered = asset::order_for_storage(original);
    const auto corners_of = [](const Mesh& mesh) {
      std::vector<std::array<float, 9>> corners;
      for (const Triangle& face : mesh.faces) {
        std::array<std::array<float, 3>, 3> three;
        for (std::size_t c = 0; c < 3; ++c)
          three[c] = {mesh.positions[face[c]].x, mesh.positions[face[c]].y, mesh.positions[face[c]].z};
        std::rotate(three.begin(), std::min_element(three.begin(), three.end()), three.end());
        corners.push_back({three[0][0], three[0][1], three[0][2], three[1][0], three[1][1], three[1][2], three[2][0],
                           three[2][1], three[2][2]});
      }
      std::sort(corners.begin(), corners.end());
      return corners;
    };
    EXPECT_EQ(corners_of(first.mesh), corners_of(ordered));
    EXPECT_EQ(built->asset.bounds.low, face_bounds(original).low);
    EXPECT_EQ(built->asset.bounds.high, face_bounds(original).high);
  }
}

TEST(BuildClipAsset, LevelsAreNestedAndWithinTheirErrors) {
  const Mesh original = bumpy_sphere(20480);
  const auto built = build_clip_asset(original, small_options(60));
  ASSERT_TRUE(built) << format_error(built.error());
  const std::vector<SilhouetteLevel>& levels = built->asset.levels;
  ASSERT_EQ(levels.size(), 4u);
  const bake_detail::FaceTree tree(original.positions, original.faces);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double share =
        static_cast<double>(levels[i].mesh.faces.size()) / static_cast<double>(levels[i - 1].mesh.faces.size());
    EXPECT_NEAR(share, 0.25, 0.01) << i;
    EXPECT_GT(levels[i].error, levels[i - 1].error) << i;
    for (const Vec3& p : levels[i].mesh.positions)
      EXPECT_LE(tree.closest(p).distance, levels[i].error) << i;
    expect_encloses(levels[i].mesh, levels[i - 1].mesh);
  }
  expect_encloses(built->asset.hull, levels.back().mesh);
}

TEST(BuildClipAsset, HasWhatARendererNeeds) {
  Mesh original = bumpy_sphere(5120);
  original.colors.values.assign(original.positions.size(), Vec4(0.2f, 0.5f, 1.0f, 1.0f));
  const auto built = build_clip_asset(original, small_options());
  ASSERT_TRUE(built) << format_error(built.error());
  const ClipAsset& asset = built->asset;
  EXPECT_TRUE(built->report.hull.reached_target);
  EXPECT_LE(asset.hull.faces.size(), 100u);
  EXPECT_FALSE(asset.hull.uvs.empty() || asset.hull.normals.empty());
  ASSERT_EQ(asset.hull.materials.size(), 1u);
  EXPECT_FALSE(asset.hull.materials[0].normal_image.empty());
  EXPECT_FALSE(asset.hull.materials[0].base_color_image.empty());
  EXPECT_EQ(asset.maps.normals.width, 64);
  EXPECT_EQ(asset.maps.colors.width, 64);
  EXPECT_EQ(asset.maps.displacement.size(), 64u * 64u);
  EXPECT_LT(asset.maps.displacement_low, asset.maps.displacement_high);
  for (const SilhouetteLevel& level : asset.levels)
    EXPECT_TRUE(partition_clusters(level.leaf_of_edge, build_topology(level.mesh)));
}

TEST(BuildClipAsset, ComesBackFromAFileAsItWasBuilt) {
  const auto built = build_clip_asset(*make_shape(Shape::kKnot, {.faces = 3000}), small_options(300));
  ASSERT_TRUE(built) << format_error(built.error());
  const TempFolder folder;
  ASSERT_TRUE(write_clip_asset(built->asset, folder / "knot.glb"));
  const Result<ClipAsset> read = read_clip_asset(folder / "knot.glb");
  ASSERT_TRUE(read) << format_error(read.error());
  const Mesh &before = built->asset.hull, &after = read->hull;
  EXPECT_EQ(before.faces, after.faces);
  EXPECT_TRUE(same_bits(before.positions, after.positions));
  EXPECT_TRUE(same_bits(before.uvs.values, after.uvs.values));
  EXPECT_TRUE(same_bits(before.normals.values, after.normals.values));
  ClipAsset without = built->asset;
  EXPECT_FALSE(without.hull.tangents.empty());  // for other readers; limn's own does without
  without.hull.tangents = {};
  EXPECT_EQ(file_of(*read), file_of(without));
}

TEST(BuildClipAsset, GivesTheSameBytesForAnyNumberOfThreads) {
  const Mesh original = bumpy_sphere(5120);
  const auto many = build_clip_asset(original, small_options());
  const ThreadLimit one(1);
  const auto alone = build_clip_asset(original, small_options());
  ASSERT_TRUE(many && alone);
  EXPECT_EQ(file_of(many->asset), file_of(alone->asset));
}

TEST(BuildClipAsset, LeavesOutWhatIsNotAskedFor) {
  ClipOptions options = small_options();
  options.maps = {false, false, false};
  options.levels = 1;
  const auto built = build_clip_asset(bumpy_sphere(5120), options);
  ASSERT_TRUE(built);
  EXPECT_EQ(built->asset.levels.size(), 1u);
  EXPECT_TRUE(built->asset.maps.normals.rgba.empty());
  EXPECT_TRUE(built->asset.maps.displacement.empty());
  EXPECT_FALSE(built->asset.hull.materials[0].normal_image.empty());
}

TEST(BuildClipAsset, KeepsTheMaterialOfTheOriginal) {
  Mesh original = bumpy_sphere(1280);
  const auto plain = build_clip_asset(original, small_options(40));
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->asset.hull.materials[0].base_color, plain_material(original).base_color);
  EXPECT_EQ(plain->asset.hull.materials[0].roughness, plain_material(original).roughness);
  original.materials.resize(1);
  original.materials[0].base_color = Vec4(0.1f, 0.7f, 0.3f, 1.0f);
  original.materials[0].roughness = 0.25f;
  const auto painted = build_clip_asset(original, small_options(40));
  ASSERT_TRUE(painted);
  EXPECT_EQ(painted->asset.hull.materials[0].base_color, original.materials[0].base_color);
  EXPECT_EQ(painted->asset.hull.materials[0].roughness, 0.25f);
}

TEST(BuildClipAsset, SaysWhatItClosedAndRefusesWhatEnclosesNothing) {
  Mesh open = bumpy_sphere(1280);
  open.faces.resize(open.faces.size() - 8);
  const auto built = build_clip_asset(open, small_options(40));
  ASSERT_TRUE(built) << format_error(built.error());
  EXPECT_FALSE(built->report.notes.empty());
  const Topology topology = build_topology(built->asset.levels[0].mesh);
  for (const EdgeClass edge_class : topology.edge_class)
    EXPECT_NE(edge_class, EdgeClass::kBoundary);
  Mesh nothing;
  const auto empty = build_clip_asset(nothing, small_options());
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::kUnsuitable);
}

TEST(BuildClipAsset, RefusesOptionsOutOfRangeAndStopsWhenAsked) {
  const Mesh mesh = bumpy_sphere(1280);
  ClipOptions options = small_options();
  options.levels = 0;
  EXPECT_EQ(build_clip_asset(mesh, options).error().code, ErrorCode::kInvalidArgument);
  options = small_options();
  options.faces = 3;
  EXPECT_EQ(build_clip_asset(mesh, options).error().code, ErrorCode::kInvalidArgument);
  options = small_options();
  options.size_px = 3;
  EXPECT_EQ(build_clip_asset(mesh, options).error().code, ErrorCode::kInvalidArgument);
  for (const std::string_view stage : {"silhouettes", "hull"}) {
    options = small_options();
    options.progress = [stage](std::string_view now, double) { return now != stage; };
    const auto built = build_clip_asset(mesh, options);
    ASSERT_FALSE(built) << stage;
    EXPECT_EQ(built.error().code, ErrorCode::kCancelled);
  }
}

}  // namespace
}  // namespace limn::test
