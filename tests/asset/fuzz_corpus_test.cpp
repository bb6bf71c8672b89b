#include <filesystem>
#include <gtest/gtest.h>

#include "limn/asset/asset_file.h"
#include "limn/base/file.h"
#include "limn/mesh/import.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

TEST(FuzzCorpus, EveryKeptAssetIsReadOrRefused) {
  std::size_t files = 0, whole = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(LIMN_SOURCE_DIR) / "fuzz/corpus/asset")) {
    const Result<FileBytes> file = FileBytes::open(entry.path());
    ASSERT_TRUE(file);
    static_cast<void>(read_mesh(file->bytes(), MeshFormat::kGlb, "corpus"));
    static_cast<void>(measure_clip_asset(file->bytes(), "corpus"));
    const Result<ClipAsset> asset = read_clip_asset(file->bytes(), "corpus");
    if (!asset) {
      EXPECT_FALSE(asset.error().message.empty() || asset.error().remedy.empty()) << entry.path();
      EXPECT_EQ(asset.error().file, "corpus") << entry.path();
    }
    whole += asset ? 1 : 0;
    ++files;
  }
  EXPECT_GE(files, 4u);
  EXPECT_GE(whole, 2u);  // else files of this version are no longer read
}

}  // namespace
}  // namespace limn
