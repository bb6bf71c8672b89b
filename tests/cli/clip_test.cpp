// limn clip, seen from outside: the asset, what info says of it, and how it lines up with the model.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "limn/asset/asset_file.h"
#include "limn/image/image.h"

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Clip : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(limn.run({"make", "knot", "--faces", "6000", "-o", "knot.ply"}).exit, 0);
    made = limn.run({"clip", "knot.ply", "-o", "knot.glb", "--faces", "300", "--size", "128"});
    ASSERT_EQ(made.exit, 0) << made.err;
  }
  TempFolder folder;
  Program limn{folder.path()};
  Outcome made;
};

TEST_F(Clip, WritesAnAssetThatHoldsTheModelsSilhouette) {
  EXPECT_EQ(made.out, "");
  EXPECT_EQ(std::count(made.err.begin(), made.err.end(), '\n'), 1) << made.err;
  const Result<ClipAsset> asset = read_clip_asset(folder / "knot.glb");
  ASSERT_TRUE(asset) << format_error(asset.error());
  const auto info = limn.json({"info", "knot.ply"});
  EXPECT_EQ(asset->levels[0].mesh.faces.size(), info["faces"].get<std::size_t>());
  EXPECT_LE(asset->hull.faces.size(), 300u);
  EXPECT_EQ(asset->maps.normals.width, 128);
}

TEST_F(Clip, SameModelGivesTheSameFileWithAnyThreads) {
  ASSERT_EQ(limn.run({"clip", "knot.ply", "-o", "one.glb", "--faces", "300", "--size", "128", "--threads", "1"}).exit,
            0);
  EXPECT_TRUE(slurp(folder / "one.glb") == slurp(folder / "knot.glb"));
  const Outcome piped = limn.run({"clip", "knot.ply", "-o", "-", "--faces", "300", "--size", "128", "--quiet"});
  EXPECT_TRUE(piped.out == slurp(folder / "knot.glb"));
  EXPECT_EQ(piped.err, "");
}

TEST_F(Clip, InfoListsItsSilhouettesAndBytes) {
  const Outcome info = limn.run({"info", "knot.glb"});
  EXPECT_NE(info.out.find("exact"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("clip asset"), std::string::npos) << info.out;
  EXPECT_EQ(info.err, "");  // nothing of the file was left out
  const auto asset = limn.json({"info", "knot.glb"})["asset"];
  EXPECT_EQ(asset["file_bytes"].get<std::size_t>(), slurp(folder / "knot.glb").size());
  EXPECT_EQ(asset["levels"][0]["error"], 0.0);
  EXPECT_FALSE(limn.json({"info", "knot.ply"}).contains("asset"));
}

TEST_F(Clip, ADamagedAssetIsSaidAndStillAMesh) {
  std::string file = slurp(folder / "knot.glb");
  file[file.size() / 2] = static_cast<char>(file[file.size() / 2] ^ 1);
  folder.write("damaged.glb", file);
  const Outcome info = limn.run({"info", "damaged.glb"});
  EXPECT_EQ(info.exit, 0);
  EXPECT_NE(info.err.find("damaged.glb"), std::string::npos) << info.err;
  EXPECT_NE(info.err.find("altered or damaged"), std::string::npos) << info.err;
  EXPECT_EQ(info.out.find("clip asset"), std::string::npos);
}

#ifdef LIMN_WITH_GL
TEST_F(Clip, PicturesOfModelAndAssetLineUp) {
  for (const std::string view : {"20,10", "200,-40"}) {
    ASSERT_EQ(limn.run({"render", "knot.ply", "-o", "model.png", "--view", view, "--size", "96", "--background",
                        "transparent"})
                  .exit,
              0);
    const Outcome drawn = limn.run({"render", "knot.glb", "-o", "hull.png", "--method", "coarse", "--view", view,
                                    "--size", "96", "--background", "transparent"});
    ASSERT_EQ(drawn.exit, 0) << drawn.err;
    const auto model = read_png(folder / "model.png"), hull = read_png(folder / "hull.png");
    ASSERT_TRUE(model && hull);
    std::size_t covered = 0, missed = 0, more = 0;
    for (std::size_t i = 3; i < model->rgba.size(); i += 4) {
      covered += model->rgba[i] != 0 ? 1 : 0;
      missed += model->rgba[i] == 255 && hull->rgba[i] == 0 ? 1 : 0;
      more += model->rgba[i] == 0 && hull->rgba[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(covered, 1000u);
    EXPECT_EQ(missed, 0u);  // the hull hides the model, pixel by pixel
    EXPECT_GT(more, 0u);    // and is larger: so cameras that fitted it would have stood further off
    EXPECT_LT(more, covered / 2);
  }
}
#endif

TEST_F(Clip, SaysWhatIsWrong) {
  EXPECT_EQ(limn.run({"clip", "knot.ply", "-o", "knot.obj"}).exit, 2);
  EXPECT_EQ(limn.run({"clip", "knot.ply", "-o", "none/knot.glb"}).exit, 3);
  const Outcome maps = limn.run({"clip", "knot.ply", "-o", "x.glb", "--maps", "normal,height"});
  EXPECT_EQ(maps.exit, 2);
  EXPECT_NE(maps.err.find("height"), std::string::npos) << maps.err;
  ASSERT_EQ(limn.run({"make", "terrain", "--faces", "200", "-o", "terrain.ply"}).exit, 0);
  folder.write("empty.off", "OFF\n0 0 0\n");
  EXPECT_EQ(limn.run({"clip", "empty.off", "-o", "x.glb"}).exit, 4);
}

}  // namespace
}  // namespace limn::test
