// Files and streams: outputs are whole or absent, standard streams work, pipes end quietly.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder.path()))
      found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
};

TEST_F(Files, ReplaceTheInputWhenTheOutputIsTheSameFile) {
  ASSERT_EQ(limn.run({"make", "icosphere", "--faces", "80", "-o", "ball.ply"}).exit, 0);
  const std::string before = slurp(folder / "ball.ply");
  ASSERT_EQ(limn.run({"refine", "ball.ply", "-o", "ball.ply", "--criterion", "uniform", "--max-level", "2"}).exit, 0);
  EXPECT_GT(slurp(folder / "ball.ply").size(), 4 * before.size());
  EXPECT_EQ(limn.json({"info", "ball.ply"})["faces"], 80 * 16);
  EXPECT_EQ(names(), std::vector<std::string>{"ball.ply"});
}

TEST_F(Files, KeepAnEarlierOutputWhenTheWorkFails) {
  folder.write("out.ply", "precious");
  folder.write("out.png", "precious");
  EXPECT_EQ(limn.run({"refine", "missing.ply", "-o", "out.ply", "--view", "0,0"}).exit, 3);
  EXPECT_EQ(limn.run({"render", "missing.ply", "-o", "out.png"}).exit, 3);
  EXPECT_EQ(slurp(folder / "out.ply"), "precious");
  EXPECT_EQ(slurp(folder / "out.png"), "precious");
}

TEST_F(Files, AreCheckedForTheirNameBeforeTheInputIsRead) {
  const Outcome outcome = limn.run({"refine", "missing.ply", "-o", "out.xyz", "--view", "0,0"});
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("out.xyz"), std::string::npos);
}

TEST_F(Files, OfEveryFormatComeBackWithTheSameFaces) {
  ASSERT_EQ(limn.run({"make", "torus", "--faces", "500", "-o", "torus.ply"}).exit, 0);
  const auto faces = limn.json({"info", "torus.ply"})["faces"];
  for (const char* name : {"t.ply", "t.stl", "t.off", "t.obj", "t.gltf", "t.glb"}) {
    ASSERT_EQ(limn.run({"make", "torus", "--faces", "500", "-o", name}).exit, 0) << name;
    const auto info = limn.json({"info", name});
    EXPECT_EQ(info["faces"], faces) << name;
    EXPECT_EQ(info["closed"], true) << name;
  }
}

TEST_F(Files, AreToldByFormatWhereTheirNameDoesNotTell) {
  ASSERT_EQ(limn.run({"make", "cube", "-o", "cube.dat", "--format", "off"}).exit, 0);
  EXPECT_TRUE(slurp(folder / "cube.dat").starts_with("OFF"));
  EXPECT_EQ(limn.json({"info", "cube.dat", "--input-format", "off"})["format"], "OFF");
}

TEST_F(Files, AsTextWhenAskedTo) {
  ASSERT_EQ(limn.run({"make", "cube", "-o", "cube.ply", "--ascii"}).exit, 0);
  EXPECT_TRUE(slurp(folder / "cube.ply").starts_with("ply\nformat ascii 1.0\n"));
}

TEST_F(Files, GoThroughStandardStreams) {
  const Outcome made = limn.run({"make", "torus", "--faces", "300", "--format", "ply", "-o", "-"});
  ASSERT_EQ(made.exit, 0) << made.err;
  ASSERT_EQ(limn.run({"make", "torus", "--faces", "300", "-o", "torus.ply"}).exit, 0);
  EXPECT_TRUE(made.out == slurp(folder / "torus.ply"));
  const Outcome refined = limn.run({"refine", "-", "-o", "-", "--format", "ply", "--view", "0,0"}, made.out);
  ASSERT_EQ(refined.exit, 0) << refined.err;
  ASSERT_EQ(limn.run({"refine", "torus.ply", "-o", "fine.ply", "--view", "0,0"}).exit, 0);
  EXPECT_TRUE(refined.out == slurp(folder / "fine.ply"));
}

TEST_F(Files, PipeFromVerbToVerb) {
  const Outcome outcome = limn.shell(
      "limn make knot --faces 500 --format glb -o - | limn refine - --criterion uniform --max-level 1 "
      "--format ply -o - | limn info - --json");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["closed"], true);
}

TEST_F(Files, ClosedPipesEndQuietly) {
  const Outcome outcome = limn.shell(
      "limn make torus --faces 1000000 --format ply -o - --quiet | head -c 10; code=${PIPESTATUS[0]}; echo; echo "
      "$code");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, "ply\nformat\n141\n");
  EXPECT_EQ(limn.shell("limn help --json | head -c 1").err, "");
}

TEST_F(Files, AFullStandardOutputIsAnError) {
  const Outcome outcome = limn.shell("limn version > /dev/full");
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_NE(outcome.err.find("standard output: No space left on device"), std::string::npos) << outcome.err;
}

TEST_F(Files, AClosedStandardOutputIsAnErrorAndHarmsNoFile) {
  ASSERT_EQ(limn.run({"make", "cube", "-o", "cube.ply"}).exit, 0);
  EXPECT_EQ(limn.shell("limn info cube.ply >&-").exit, 3);
  EXPECT_EQ(limn.shell("limn make cube -o two.ply --json >&- 2>&-").exit, 3);
  EXPECT_TRUE(slurp(folder / "cube.ply") == slurp(folder / "two.ply"));
}

TEST_F(Files, OutsideTheFolderAreNotReadThroughAModel) {
  folder.write("secret.bin", std::string(36, '\0'));
  folder.write("inner/evil.gltf",
               R"({"asset":{"version":"2.0"},"buffers":[{"uri":"../secret.bin","byteLength":36}],
                  "bufferViews":[{"buffer":0,"byteLength":36}],
                  "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}],
                  "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})");
  const Outcome outcome = limn.run({"info", "inner/evil.gltf"});
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_NE(outcome.err.find("../secret.bin"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace limn::test
