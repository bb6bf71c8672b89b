// What each verb does, seen from outside.
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "limn/image/image.h"

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Verbs : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  void make(const std::string& shape, const std::string& name, int faces) {
    ASSERT_EQ(limn.run({"make", shape, "--faces", std::to_string(faces), "-o", name}).exit, 0);
  }
  Image picture(const std::string& name) {
    const auto image = read_png(folder / name);
    EXPECT_TRUE(image.has_value());
    return image ? *image : Image(1, 1);
  }
};

TEST_F(Verbs, MakeMakesEveryShapeItLists) {
  const auto shapes = limn.json({"make", "--list"})["shapes"];
  EXPECT_EQ(shapes.size(), 9u);
  for (const auto& shape : shapes) {
    const std::string name = shape["name"];
    ASSERT_EQ(limn.run({"make", name, "-o", name + ".glb"}).exit, 0) << name;
    const auto info = limn.json({"info", name + ".glb"});
    EXPECT_EQ(info["closed"], name != "sheet" && name != "terrain") << name;
    EXPECT_EQ(info["has_normals"], true) << name;
    EXPECT_EQ(info["has_uvs"], true) << name;
  }
}

TEST_F(Verbs, MakeHeedsFacesAndSeed) {
  make("asteroid", "one.ply", 1000);
  make("asteroid", "same.ply", 1000);
  ASSERT_EQ(limn.run({"make", "asteroid", "--faces", "1000", "--seed", "2", "-o", "two.ply"}).exit, 0);
  EXPECT_NEAR(limn.json({"info", "one.ply"})["faces"].get<double>(), 1000, 300);
  EXPECT_TRUE(slurp(folder / "one.ply") == slurp(folder / "same.ply"));
  EXPECT_FALSE(slurp(folder / "one.ply") == slurp(folder / "two.ply"));
}

TEST_F(Verbs, InfoSaysThatAnEmptyMeshIsEmpty) {
  folder.write("empty.off", "OFF\n0 0 0\n");
  const Outcome outcome = limn.run({"info", "empty.off"});
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.out.find("no faces: an empty mesh"), std::string::npos) << outcome.out;
}

TEST_F(Verbs, InfoSaysWhatRepairWouldChangeAndWritesItOnlyWhenAsked) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 2 3\nf 1 1 2\n";
  folder.write("broken.obj", text);
  const auto plain = limn.json({"info", "broken.obj"});
  EXPECT_EQ(plain["faces"], 3);
  EXPECT_EQ(plain["duplicate_faces"], 1);
  EXPECT_EQ(plain["degenerate_faces"], 1);
  const auto repaired = limn.json({"info", "broken.obj", "--repair"});
  EXPECT_EQ(repaired["faces"], 1);
  EXPECT_GE(repaired["repairs"].size(), 3u);
  EXPECT_EQ(slurp(folder / "broken.obj"), text);
  ASSERT_EQ(limn.run({"info", "broken.obj", "--repair", "-o", "good.ply"}).exit, 0);
  EXPECT_EQ(limn.json({"info", "good.ply"})["faces"], 1);
}

TEST_F(Verbs, RepairSaysOnStandardErrorWhatItChanged) {
  folder.write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n");
  const Outcome outcome = limn.run({"refine", "broken.obj", "-o", "fine.ply", "--view", "0,0", "--repair"});
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("broken.obj: repair: "), std::string::npos) << outcome.err;
}

TEST_F(Verbs, RefineKeepsAClosedMeshClosedAndMakesItFiner) {
  make("knot", "knot.ply", 1000);
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--view", "30,20"},
           {"--view", "30,20", "--ortho"},
           {"--eye", "0,0,4", "--target", "0,0.1,0", "--fov", "40"},
           {"--view", "0,0", "--pixels", "0.2", "--size", "1920x1080", "--max-level", "5"},
           {"--view", "0,0", "--beta", "quarter"},
           {"--view", "0,0", "--wedge", "40", "--blend", "paper", "--center", "mean"},
           {"--view", "0,0", "--topology", "minimal", "--max-level", "5"},
           {"--view", "0,0", "--normals", "compute", "--crease-angle", "80"},
           {"--eye", "0,0,2", "--criterion", "distance", "--near", "0.5", "--far", "4"},
           {"--criterion", "curvature"},
           {"--criterion", "uniform", "--max-level", "2"}}) {
    Arguments words = {"refine", "knot.ply", "-o", "fine.ply"};
    words.insert(words.end(), options.begin(), options.end());
    const auto done = limn.json(words);
    EXPECT_GT(done["triangles_out"], done["triangles_in"]) << testing::PrintToString(options);
    const auto info = limn.json({"info", "fine.ply"});
    EXPECT_EQ(info["closed"], true) << testing::PrintToString(options);
    EXPECT_EQ(info["faces"], done["triangles_out"]);
  }
}

TEST_F(Verbs, RefineNeedsFewerTrianglesInTheMinimalTopology) {
  make("knot", "knot.ply", 1000);
  const auto nested = limn.json({"refine", "knot.ply", "-o", "a.ply", "--view", "30,20", "--topology", "nested"});
  const auto minimal = limn.json({"refine", "knot.ply", "-o", "b.ply", "--view", "30,20", "--topology", "minimal"});
  EXPECT_EQ(nested["refined_faces"], minimal["refined_faces"]);
  EXPECT_LT(minimal["triangles_out"].get<int>(), nested["triangles_out"].get<int>() * 2 / 3);
}

TEST_F(Verbs, RefineRefinesWhereItIsSeenFrom) {
  make("icosphere", "ball.ply", 1280);
  const auto near_outline = limn.json({"refine", "ball.ply", "-o", "a.ply", "--view", "0,0"});
  EXPECT_LT(near_outline["refined_faces"], near_outline["triangles_in"]);
  ASSERT_EQ(limn.run({"refine", "ball.ply", "-o", "b.ply", "--view", "90,0"}).exit, 0);
  EXPECT_FALSE(slurp(folder / "a.ply") == slurp(folder / "b.ply"));
}

TEST_F(Verbs, RefineTellsHowToNameAViewpoint) {
  make("cube", "cube.ply", 12);
  const Outcome outcome = limn.run({"refine", "cube.ply", "-o", "fine.ply"});
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("--view"), std::string::npos) << outcome.err;
  EXPECT_EQ(limn.run({"refine", "cube.ply", "-o", "fine.ply", "--eye", "0,0,0"}).exit, 2);
}

TEST_F(Verbs, CompareOfAMeshWithItselfIsZero) {
  make("knot", "knot.ply", 1000);
  const auto same = limn.json({"compare", "knot.ply", "knot.ply", "--views", "3", "--size", "200"});
  EXPECT_EQ(same["mean_px"], 0);
  EXPECT_EQ(same["max_px"], 0);
  EXPECT_EQ(same["iou"], 1);
  EXPECT_EQ(same["views"].size(), 3u);
}

TEST_F(Verbs, CompareFindsRefinementNearerThanCoarse) {
  make("knot", "knot.ply", 1000);
  make("knot", "dense.ply", 30000);
  const Arguments common = {"compare", "knot.ply", "dense.ply", "--views", "4", "--size", "400"};
  Arguments fine = common;
  fine.insert(fine.end(), {"--method", "refine"});
  EXPECT_LT(limn.json(fine)["mean_px"].get<double>(), 0.5 * limn.json(common)["mean_px"].get<double>());
  Arguments other_seed = common;
  other_seed.insert(other_seed.end(), {"--seed", "2"});
  EXPECT_NE(limn.json(other_seed)["views"][0]["direction"], limn.json(common)["views"][0]["direction"]);
}

TEST_F(Verbs, CompareExitsWith5WhenAGateFailsOnly) {
  make("knot", "knot.ply", 500);
  make("knot", "dense.ply", 8000);
  Arguments words = {"compare", "knot.ply", "dense.ply", "--views", "2", "--size", "256", "--fail-if", ""};
  for (const auto& [gate, exit] : std::vector<std::pair<std::string, int>>{
           {"mean_px>1000", 0}, {"mean_px>0", 5}, {"max_px >= 0", 5}, {"iou<0.1", 0}, {"iou<=1", 5}, {"p95_px<0", 0}}) {
    words.back() = gate;
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, exit) << gate << outcome.err;
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err.find("--fail-if") != std::string::npos, exit == 5) << outcome.err;
  }
}

#ifdef LIMN_WITH_GL

TEST_F(Verbs, RenderDrawsAPictureOfTheSizeAskedFor) {
  make("torus", "torus.ply", 500);
  ASSERT_EQ(limn.run({"render", "torus.ply", "-o", "torus.png", "--size", "120x80", "--background", "#102030"}).exit,
            0);
  const Image image = picture("torus.png");
  EXPECT_EQ(image.width, 120);
  EXPECT_EQ(image.height, 80);
  EXPECT_EQ(std::vector<int>(image.pixel(0, 0), image.pixel(0, 0) + 4), (std::vector<int>{0x10, 0x20, 0x30, 255}));
}

TEST_F(Verbs, RenderLeavesCoverageInATransparentBackground) {
  make("icosphere", "ball.ply", 1280);
  ASSERT_EQ(limn.run({"render", "ball.ply", "-o", "ball.png", "--size", "64", "--background", "transparent"}).exit, 0);
  const Image image = picture("ball.png");
  EXPECT_EQ(image.pixel(0, 0)[3], 0);
  EXPECT_EQ(image.pixel(32, 32)[3], 255);
}

TEST_F(Verbs, RenderToStandardOutputGivesTheSameBytes) {
  make("torus", "torus.ply", 500);
  const Arguments words = {"render", "torus.ply", "--size", "64x64", "-o"};
  Arguments to_file = words, to_stdout = words;
  to_file.emplace_back("torus.png");
  to_stdout.emplace_back("-");
  ASSERT_EQ(limn.run(to_file).exit, 0);
  EXPECT_TRUE(limn.run(to_stdout).out == slurp(folder / "torus.png"));
}

TEST_F(Verbs, RenderOptionsChangeThePicture) {
  make("knot", "knot.ply", 600);
  const auto drawn = [&](const Arguments& options) {
    Arguments words = {"render", "knot.ply", "-o", "knot.png", "--size", "160x160"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(limn.run(words).exit, 0) << testing::PrintToString(options);
    return slurp(folder / "knot.png");
  };
  const std::string plain = drawn({});
  for (const Arguments& options : std::vector<Arguments>{{"--method", "refine"},
                                                         {"--wireframe"},
                                                         {"--levels"},
                                                         {"--outline"},
                                                         {"--flat"},
                                                         {"--samples", "1"},
                                                         {"--view", "0,0"},
                                                         {"--ortho"},
                                                         {"--fov", "60"},
                                                         {"--eye", "0,0,5"},
                                                         {"--target", "0.2,0,0"}}) {
    EXPECT_FALSE(drawn(options) == plain) << testing::PrintToString(options);
  }
  EXPECT_TRUE(drawn({"--view", "30,20"}) == plain) << "the default view";
}

TEST_F(Verbs, WithoutOpenGlRenderExitsWith6AndTheDemoStillPrintsItsTable) {
  make("torus", "torus.ply", 500);
  limn.environment = {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null"}, {"LIBGL_DRIVERS_PATH", "/nonexistent"}};
  const Outcome render = limn.run({"render", "torus.ply", "-o", "torus.png"});
  EXPECT_EQ(render.exit, 6) << render.err;
  EXPECT_NE(render.err.find(';'), std::string::npos) << "no advice: " << render.err;
  const Outcome demo = limn.run({"demo"});
  EXPECT_EQ(demo.exit, 6);
  EXPECT_NE(demo.out.find("refined"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "demo.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "torus.png"));
}

TEST_F(Verbs, DemoShowsThatRefinementIsNearerToTheDenseModel) {
  const auto demo = limn.json({"demo", "-o", "panels.png", "--size", "600x200"});
  EXPECT_EQ(demo["picture"], "panels.png");
  EXPECT_EQ(picture("panels.png").width, 600);
  EXPECT_LT(demo["models"][1]["mean_px"].get<double>(), demo["models"][0]["mean_px"].get<double>() / 3);
  EXPECT_LT(demo["models"][1]["triangles"], demo["models"][2]["triangles"]);
}

#endif

}  // namespace
}  // namespace limn::test
