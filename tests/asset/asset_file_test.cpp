#include "limn/asset/asset_file.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/asset/asset_layout.h"
#include "limn/base/file.h"
#include "limn/base/random.h"
#include "limn/mesh/export.h"
#include "limn/mesh/import.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/extractor.h"

#include "asset/stand_in.h"
#include "silhouette/eyes.h"
#include "support/mesh_bits.h"
#include "support/stable.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

std::string written(const ClipAsset& asset) {
  const TempFolder folder;
  const Result<AssetBytes> bytes = write_clip_asset(asset, folder / "asset.glb");
  EXPECT_TRUE(bytes) << format_error(bytes.error());
  return bytes ? slurp(folder / "asset.glb") : std::string();
}

Result<ClipAsset> read(std::string_view text) {
  return read_clip_asset(bytes_of(text), "test.glb");
}

bool same_level(const SilhouetteLevel& a, const SilhouetteLevel& b) {
  return a.mesh.faces == b.mesh.faces && same_bits(a.mesh.positions, b.mesh.positions) && a.error == b.error &&
         a.leaf_of_edge == b.leaf_of_edge;
}

bool same_image(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.rgba == b.rgba;
}

void expect_same(const ClipAsset& a, const ClipAsset& b, const std::string& name) {
  ASSERT_EQ(a.levels.size(), b.levels.size()) << name;
  for (std::size_t i = 0; i < a.levels.size(); ++i)
    EXPECT_TRUE(same_level(a.levels[i], b.levels[i])) << name << ", level " << i;
  EXPECT_EQ(a.bounds.low, b.bounds.low) << name;
  EXPECT_EQ(a.bounds.high, b.bounds.high) << name;
  EXPECT_TRUE(same_image(a.maps.normals, b.maps.normals)) << name;
  EXPECT_TRUE(same_image(a.maps.colors, b.maps.colors)) << name;
  EXPECT_EQ(a.maps.displacement, b.maps.displacement) << name;
  EXPECT_EQ(a.maps.displacement_width, b.maps.displacement_width) << name;
  EXPECT_EQ(a.maps.displacement_height, b.maps.displacement_height) << name;
  EXPECT_EQ(a.maps.displacement_low, b.maps.displacement_low) << name;
  EXPECT_EQ(a.maps.displacement_high, b.maps.displacement_high) << name;
  EXPECT_TRUE(same_bits(corner_positions(a.hull), corner_positions(b.hull))) << name;
}

/// A forged file: altered, with a checksum that is right again.
std::string sealed(std::string file) {
  const auto at = asset::find_checksum(file);
  if (at) file.replace(*at, asset::kNoChecksum.size(), asset::checksum_of(file, *at));
  return file;
}

TEST(AssetFile, ComesBackBitForBit) {
  const ClipAsset asset = stand_in_asset();
  const Result<ClipAsset> again = read(written(asset));
  ASSERT_TRUE(again) << format_error(again.error());
  expect_same(*again, asset, "stand-in");
  // What was read once is a fixed point: texture coordinates, too, which glTF turns upside down.
  const Result<ClipAsset> third = read(written(*again));
  ASSERT_TRUE(third);
  EXPECT_TRUE(same_bits(third->hull.uvs.values, again->hull.uvs.values));
  EXPECT_TRUE(same_bits(third->hull.normals.values, again->hull.normals.values));
  EXPECT_EQ(third->hull.faces, again->hull.faces);
}

TEST(AssetFile, KeepsLevelsOfAwkwardMeshes) {
  std::size_t count = 0;
  for (const StableMesh& stable : awkward_meshes()) {
    ClipAsset asset = stand_in_asset(320);
    asset.levels = {level_of(stable.mesh, 0.0f)};
    if (asset.levels[0].mesh.faces.empty()) continue;
    asset.bounds = face_bounds(stable.mesh);
    const Result<ClipAsset> again = read(written(asset));
    ASSERT_TRUE(again) << stable.name << ": " << format_error(again.error());
    expect_same(*again, asset, stable.name);
    ++count;
  }
  EXPECT_GT(count, 10u);
}

TEST(AssetFile, KeepsSurfacesThatTakeNextToNothing) {
  // A flat two-sided grid with whole coordinates: so regular that it is the padding that says how large it is.
  Mesh grid;
  constexpr VertexId kSide = 300;
  for (VertexId y = 0; y < kSide; ++y) {
    for (VertexId x = 0; x < kSide; ++x)
      grid.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
  }
  for (VertexId y = 0; y + 1 < kSide; ++y) {
    for (VertexId x = 0; x + 1 < kSide; ++x) {
      const VertexId v = y * kSide + x;
      grid.faces.push_back({v, v + 1, v + kSide});
      grid.faces.push_back({v + 1, v + kSide + 1, v + kSide});
    }
  }
  ClipAsset asset = stand_in_asset(80);
  asset.maps = {};
  asset.levels = {{asset::order_for_storage(grid), 0.0f, {}}};
  const std::string file = written(asset);
  EXPECT_LT(file.size(), grid.faces.size() / 6);
  const Result<ClipAsset> again = read(file);
  ASSERT_TRUE(again) << format_error(again.error());
  EXPECT_TRUE(same_level(again->levels[0], asset.levels[0]));
}

TEST(AssetFile, SilhouettesThroughItEqualBruteForceOnTheOriginal) {
  const Mesh original = bumpy_sphere(5120);
  ClipAsset asset = stand_in_asset();
  asset.levels = {level_of(original, 0.0f)};
  const Result<ClipAsset> again = read(written(asset));
  ASSERT_TRUE(again);
  const SilhouetteLevel& level = again->levels[0];
  const Topology topology = build_topology(level.mesh);
  const std::vector<Plane> planes = face_planes(level.mesh);
  const auto clusters = partition_clusters(level.leaf_of_edge, topology);
  ASSERT_TRUE(clusters);
  const SilhouetteExtractor extractor(level.mesh, topology, planes, SearchMethod::kTree, *clusters);
  std::size_t found = 0;
  for (const Eye& eye : awkward_eyes(level.mesh, 200, 7)) {
    std::vector<EdgeId> brute;
    extract_silhouette_brute(topology, planes, eye, brute);
    EXPECT_EQ(extractor.find_sorted(eye), brute);
    found += brute.size();
  }
  EXPECT_GT(found, 1000u);
}

TEST(AssetFile, SameAssetGivesSameBytes) {
  EXPECT_EQ(written(stand_in_asset()), written(stand_in_asset()));
}

TEST(AssetFile, IsAMeshForEveryOtherReader) {
  ClipAsset asset = stand_in_asset();
  const std::string file = written(asset);
  const ImportedMesh imported = must_read(file, MeshFormat::kGlb);
  EXPECT_EQ(imported.mesh.faces.size(), asset.hull.faces.size());
  EXPECT_TRUE(same_bits(corner_positions(imported.mesh), corner_positions(asset.hull)));
  EXPECT_TRUE(holds_clip_asset(bytes_of(file)));
  const TempFolder folder;
  ASSERT_TRUE(write_mesh(asset.hull, folder / "plain.glb"));
  const std::string plain = slurp(folder / "plain.glb");
  EXPECT_FALSE(holds_clip_asset(bytes_of(plain)));
  const Result<ClipAsset> none = read(plain);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(none.error().message.find("no clip asset"), std::string::npos);
  EXPECT_FALSE(none.error().remedy.empty());
}

TEST(AssetFile, StoresColoursOnceWhenTheMaterialShowsThem) {
  const TempFolder folder;
  ClipAsset asset = stand_in_asset();
  asset.hull.uvs.values.assign(asset.hull.positions.size(), Vec2(0.25f));
  asset.hull.uvs.indices.clear();
  asset.hull.normals = {};
  asset.hull.materials[0].base_color_image_mime = "image/png";
  ASSERT_TRUE(write_png(asset.maps.colors, folder / "colors.png"));
  const std::string png = slurp(folder / "colors.png");
  const auto bytes = bytes_of(png);
  asset.hull.materials[0].base_color_image.assign(bytes.begin(), bytes.end());
  const Result<AssetBytes> size = write_clip_asset(asset, folder / "asset.glb");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->colors, 0u);
  const Result<ClipAsset> again = read_clip_asset(folder / "asset.glb");
  ASSERT_TRUE(again) << format_error(again.error());
  EXPECT_TRUE(same_image(again->maps.colors, asset.maps.colors));
}

TEST(AssetFile, MeasuresItsParts) {
  const TempFolder folder;
  const Result<AssetBytes> said = write_clip_asset(stand_in_asset(), folder / "asset.glb");
  ASSERT_TRUE(said);
  const std::string file = slurp(folder / "asset.glb");
  const Result<AssetBytes> found = measure_clip_asset(bytes_of(file), "asset.glb");
  ASSERT_TRUE(found) << format_error(found.error());
  EXPECT_EQ(found->file, file.size());
  EXPECT_EQ(said->file, file.size());
  ASSERT_EQ(found->levels.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found->levels[i].faces, said->levels[i].faces);
    EXPECT_EQ(found->levels[i].mesh, said->levels[i].mesh);
    EXPECT_EQ(found->levels[i].search, said->levels[i].search);
    EXPECT_EQ(found->levels[i].error, said->levels[i].error);
  }
  EXPECT_EQ(found->normals, said->normals);
  EXPECT_EQ(found->displacement, said->displacement);
  EXPECT_GT(found->rest(), 1000u);
  EXPECT_LT(found->rest(), found->file);
}

TEST(AssetFile, RefusesEveryTruncationAndEveryAlteredByte) {
  ClipAsset asset = stand_in_asset(80);
  asset.levels.pop_back();
  const std::string file = written(asset);
  for (std::size_t i = 0; i < file.size(); ++i) {
    if (i % 3 == 0 || i < 64) {
      const Result<ClipAsset> cut = read(std::string_view(file).substr(0, i));
      ASSERT_FALSE(cut) << i;
      EXPECT_EQ(cut.error().code, ErrorCode::kUnreadable) << i;
      EXPECT_EQ(cut.error().file, "test.glb") << i;
      EXPECT_FALSE(cut.error().message.empty() || cut.error().remedy.empty()) << i;
    }
    std::string altered = file;
    altered[i] = static_cast<char>(altered[i] ^ 0x10);
    const Result<ClipAsset> damaged = read(altered);
    ASSERT_FALSE(damaged) << i;
    EXPECT_EQ(damaged.error().code, ErrorCode::kUnreadable) << i;
    EXPECT_FALSE(damaged.error().remedy.empty()) << i;
  }
  EXPECT_FALSE(read(file + "x"));
}

TEST(AssetFile, ForgedFilesGiveAnErrorOrExactSilhouettes) {
  // Anybody can compute the checksum: what it covers must be checked as well.
  ClipAsset asset = stand_in_asset(80);
  const std::string file = written(asset);
  Random random(8);
  std::size_t accepted = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string forged = file;
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n) {
      const std::size_t at = random.below(forged.size());
      // Digits become other digits, so that the JSON's numbers are tried and not its syntax alone.
      if (forged[at] >= '0' && forged[at] <= '9')
        forged[at] = static_cast<char>('0' + random.below(10));
      else
        forged[at] = static_cast<char>(random.next());
    }
    const Result<ClipAsset> read_back = read(sealed(std::move(forged)));
    if (!read_back) continue;
    ++accepted;
    for (const SilhouetteLevel& level : read_back->levels) {
      if (level.leaf_of_edge.empty()) continue;  // the word "search" was altered: there is none
      const Topology topology = build_topology(level.mesh);
      const std::vector<Plane> planes = face_planes(level.mesh);
      const auto clusters = partition_clusters(level.leaf_of_edge, topology);
      ASSERT_TRUE(clusters);
      const SilhouetteExtractor tree(level.mesh, topology, planes, SearchMethod::kTree, *clusters);
      std::vector<EdgeId> brute;
      const Eye eye{random.direction() * 3.0f};
      extract_silhouette_brute(topology, planes, eye, brute);
      ASSERT_EQ(tree.find_sorted(eye), brute);
    }
  }
  EXPECT_GT(accepted, 100u);
}

TEST(AssetFile, NamesWhatCannotBeWritten) {
  const TempFolder folder;
  const auto refused = [&](const ClipAsset& asset) {
    const Result<AssetBytes> bytes = write_clip_asset(asset, folder / "bad.glb");
    EXPECT_FALSE(std::filesystem::exists(folder / "bad.glb"));
    return bytes ? std::string("written") : bytes.error().where;
  };
  ClipAsset asset = stand_in_asset(80);
  asset.hull.faces.clear();
  EXPECT_EQ(refused(asset), "hull");
  asset = stand_in_asset(80);
  asset.levels.clear();
  EXPECT_EQ(refused(asset), "levels");
  asset = stand_in_asset(80);
  std::swap(asset.levels[0].error, asset.levels[1].error);
  EXPECT_EQ(refused(asset), "level 1");
  asset = stand_in_asset(80);
  asset.levels[0].leaf_of_edge.swap(asset.levels[1].leaf_of_edge);
  EXPECT_EQ(refused(asset), "level 0");
  asset = stand_in_asset(80);
  asset.levels[1].mesh.positions[5].y = NAN;
  EXPECT_EQ(refused(asset), "level 1");
  asset = stand_in_asset(80);
  asset.maps.displacement.pop_back();
  EXPECT_EQ(refused(asset), "displacement");
  asset = stand_in_asset(80);
  ++asset.maps.normals.width;
  EXPECT_EQ(refused(asset), "normals");
}

TEST(AssetFile, SaysWhichVersionItNeeds) {
  std::string file = written(stand_in_asset(80));
  const std::size_t at = file.find("\"version\":1");
  ASSERT_NE(at, std::string::npos);
  file[at + 10] = '2';
  const Result<ClipAsset> newer = read(file);
  ASSERT_FALSE(newer);
  EXPECT_NE(newer.error().message.find("this program reads 1"), std::string::npos) << newer.error().message;
}

}  // namespace
}  // namespace limn::test
