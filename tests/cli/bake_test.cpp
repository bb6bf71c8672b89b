// What `limn bake` writes, refuses and reports.
#include <gtest/gtest.h>
#include <string>

#include "limn/image/image.h"

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class BakeVerb : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(limn.run({"make", "knot", "--faces", "300", "-o", "low.ply"}).exit, 0);
    ASSERT_EQ(limn.run({"make", "knot", "--faces", "5000", "-o", "high.ply"}).exit, 0);
  }
  Outcome bake(const Arguments& more) {
    Arguments arguments{"bake", "high.ply", "low.ply", "--size", "128"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return limn.run(arguments);
  }
  TempFolder folder;
  Program limn{folder.path()};
};

TEST_F(BakeVerb, WritesAModelWithTangentsAndANormalMap) {
  ASSERT_EQ(bake({"-o", "baked.glb", "--layout", "tiles"}).exit, 0);
  const std::string glb = slurp(folder / "baked.glb");
  EXPECT_NE(glb.find("\"TANGENT\""), std::string::npos);
  EXPECT_NE(glb.find("\"normalTexture\""), std::string::npos);
  EXPECT_NE(glb.find("\"image/png\""), std::string::npos);
  EXPECT_EQ(limn.json({"info", "baked.glb"})["closed"], true);
}

TEST_F(BakeVerb, WritesAFolderThatSaysWhatItsValuesMean) {
  ASSERT_EQ(bake({"-o", "maps", "--maps", "normal,color,displacement,ao", "--ao-rays", "2"}).exit, 0);
  const auto maps = nlohmann::json::parse(slurp(folder / "maps/maps.json"));
  for (const char* name : {"normal", "color", "displacement", "occlusion"}) {
    const auto picture = read_png(folder.path() / "maps" / maps[name]["file"].get<std::string>());
    ASSERT_TRUE(picture) << name;
    EXPECT_EQ(picture->width, 128);
  }
  EXPECT_LE(maps["displacement"]["low"].get<double>(), 0.0);
  EXPECT_GT(maps["displacement"]["high"].get<double>(), maps["displacement"]["low"].get<double>());
  EXPECT_EQ(limn.json({"info", "maps/mesh.glb"})["has_uvs"], true);
  ASSERT_EQ(bake({"-o", "deep", "--depth", "32", "--space", "object"}).exit, 0);
  EXPECT_TRUE(slurp(folder / "deep/normal_object.exr").starts_with("\x76\x2f\x31\x01"));
}

TEST_F(BakeVerb, IsTheSameForAnyNumberOfThreads) {
  ASSERT_EQ(bake({"-o", "one.glb", "--threads", "1"}).exit, 0);
  ASSERT_EQ(bake({"-o", "two.glb", "--threads", "2"}).exit, 0);
  EXPECT_TRUE(slurp(folder / "one.glb") == slurp(folder / "two.glb"));
}

TEST_F(BakeVerb, EndsWithFiveWhenAGateFails) {
  EXPECT_EQ(bake({"-o", "baked.glb", "--fail-if", "miss>50%", "--fail-if", "overlap>0"}).exit, 0);
  const Outcome failed = bake({"-o", "baked.glb", "--fail-if", "worst>0"});
  EXPECT_EQ(failed.exit, 5);
  EXPECT_NE(failed.err.find("worst>0"), std::string::npos) << failed.err;
  // Nothing misses with the closest point.
  EXPECT_EQ(bake({"-o", "baked.glb", "--method", "closest", "--fail-if", "miss>0"}).exit, 0);
}

TEST_F(BakeVerb, RefusesWhatAModelCannotHold) {
  for (const Arguments& more : {Arguments{"--maps", "displacement"}, Arguments{"--space", "object"},
                                Arguments{"--depth", "32"}, Arguments{"--maps", "normal,ao"}}) {
    Arguments arguments = more;
    arguments.insert(arguments.end(), {"-o", "baked.glb"});
    const Outcome outcome = bake(arguments);
    EXPECT_EQ(outcome.exit, 2) << more[0];
    EXPECT_NE(outcome.err.find("folder"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(bake({"-o", "baked.glb", "--maps", "bumps"}).exit, 2);
  EXPECT_EQ(bake({"-o", "baked.glb", "--fail-if", "fun>0"}).exit, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "baked.glb"));
}

TEST_F(BakeVerb, SaysWhichSizeTheTilesNeed) {
  const Outcome outcome =
      limn.run({"bake", "high.ply", "high.ply", "-o", "b.glb", "--size", "64", "--layout", "tiles"});
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("256"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace limn::test
