// limn render --method …, seen from outside: every method draws the same shape, and says what it cannot do.
#ifdef LIMN_WITH_GL

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "limn/image/image.h"
#include "limn/mesh/export.h"
#include "limn/mesh/shapes.h"

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

using nlohmann::json;

class RenderMethods : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  void write_knot(const std::string& name, float scale) {
    Mesh mesh = make_shape(Shape::kKnot, {.faces = 600}).value();
    for (Vec3& p : mesh.positions)
      p *= scale;
    ASSERT_TRUE(write_mesh(mesh, (folder / name).string()));
  }

  std::vector<std::string> methods_on_device() const {
    std::vector<std::string> names;
    const json options = limn.json({"help", "render"})["verbs"][0]["options"];
    for (const json& option : options) {
      if (option["name"] != "--method") continue;
      for (const std::string name : option["choices"])
        if (name != "coarse" && name != "refine" && name != "clip") names.push_back(name);
    }
    return names;
  }

  json drawn(const std::string& model, const Arguments& options) {
    Arguments words = {"render", model, "-o", "picture.png", "--size", "200", "--background", "transparent"};
    words.insert(words.end(), options.begin(), options.end());
    return limn.json(words);
  }

  Image picture() const {
    auto image = read_png((folder / "picture.png").string());
    EXPECT_TRUE(image);
    return image ? std::move(*image) : Image(1, 1);
  }

  void expect_refused(const Arguments& options, const std::string& said) {
    Arguments words = {"render", "missing.ply", "-o", "picture.png"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 2) << testing::PrintToString(options) << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
};

TEST_F(RenderMethods, AllDrawTheRefinedShape) {
  write_knot("knot.ply", 1.0f);
  ASSERT_GT(methods_on_device().size(), 3u);
  const json reference = drawn("knot.ply", {"--method", "refine"});
  const Image expected = picture();
  const double coarse_off = [&] {
    drawn("knot.ply", {"--method", "coarse"});
    return compare_images(picture(), expected, 24).failing_share;
  }();
  for (const std::string& method : methods_on_device()) {
    const json data = drawn("knot.ply", {"--method", method});
    EXPECT_EQ(data["method"], method == "auto" ? "patterns" : method);
    EXPECT_GT(data["triangles"], data["triangles_in"]) << method;
    EXPECT_GT(data["draw_ms"], 0) << method;
    EXPECT_GT(data["device_bytes"], 0) << method;
    // Some leave the inside of unrefined faces flat, and some shade finer: the outline is what all share.
    EXPECT_LT(compare_images(picture(), expected, 24).failing_share, 0.25 * coarse_off) << method;
    EXPECT_TRUE(data["triangles"] == reference["triangles"] || method.find("patterns") != 0) << method;
  }
}

TEST_F(RenderMethods, DrawModelsOfAnySize) {
  write_knot("knot.ply", 1.0f);
  write_knot("tiny.ply", 0x1p-60f);
  write_knot("huge.ply", 0x1p+60f);
  for (const std::string& method : methods_on_device()) {
    drawn("knot.ply", {"--method", method});
    const Image expected = picture();
    for (const char* model : {"tiny.ply", "huge.ply"}) {
      drawn(model, {"--method", method});
      EXPECT_LT(compare_images(picture(), expected, 8).failing_share, 0.002) << method << " " << model;
    }
  }
}

TEST_F(RenderMethods, HeedTheOptionsOfThePicture) {
  write_knot("knot.ply", 1.0f);
  for (const std::string method : {"patterns", "tess", "uniform-static"}) {
    drawn("knot.ply", {"--method", method});
    const Image plain = picture();
    EXPECT_EQ(plain.pixel(0, 0)[3], 0) << method;
    for (const Arguments& options :
         {Arguments{"--wireframe"}, {"--flat"}, {"--samples", "1"}, {"--ortho"}, {"--max-level", "1"}}) {
      Arguments words = {"--method", method};
      words.insert(words.end(), options.begin(), options.end());
      drawn("knot.ply", words);
      EXPECT_GT(compare_images(picture(), plain, 2).failing_share, 0) << method << " " << options[0];
    }
  }
}

TEST_F(RenderMethods, KeepABudgetAndTheMinimalTopologysCount) {
  write_knot("knot.ply", 1.0f);
  const auto triangles = [&](const Arguments& options) {
    Arguments words = {"--method", "patterns"};
    words.insert(words.end(), options.begin(), options.end());
    return drawn("knot.ply", words)["triangles"].get<int>();
  };
  const int free = triangles({});
  const int bounded = triangles({"--budget", std::to_string(free / 2)});
  EXPECT_LE(bounded, free / 2);
  EXPECT_GT(bounded, free / 8);
  EXPECT_LT(triangles({"--topology", "minimal"}), free * 2 / 3);
  EXPECT_EQ(drawn("knot.ply", {"--method", "refine", "--topology", "minimal"})["triangles"],
            triangles({"--topology", "minimal"}));
}

TEST_F(RenderMethods, TakeLinesFromTheCpu) {
  write_knot("knot.ply", 1.0f);
  const json data = drawn("knot.ply", {"--method", "auto", "--outline"});
  EXPECT_EQ(data["method"], "refine");
  EXPECT_GT(data["lines"], 0);
}

TEST_F(RenderMethods, SayWhatTheyAreNotFor) {
  expect_refused({"--method", "tess", "--outline"}, "--outline is not for --method tess");
  expect_refused({"--method", "patterns", "--levels"}, "--levels is not for --method patterns");
  expect_refused({"--method", "coarse", "--budget", "1000"}, "--budget is not for --method coarse");
  expect_refused({"--method", "tess", "--topology", "minimal"}, "--topology is not for --method tess");
  expect_refused({"--method", "uniform-static", "--blend", "paper"}, "--blend is not for --method uniform-static");
  expect_refused({"--method", "pattern"}, "patterns");
}

TEST_F(RenderMethods, NameTheReasonWhenACriterionCannotBeUsed) {
  write_knot("knot.ply", 1.0f);
  const auto complaint = [&](const Arguments& options) {
    Arguments words = {"render", "knot.ply", "-o", "picture.png", "--method", "patterns"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = limn.run(words);
    EXPECT_NE(outcome.exit, 0);
    return outcome.err;
  };
  EXPECT_NE(complaint({"--criterion", "distance", "--ortho"}).find("perspective"), std::string::npos);
  EXPECT_NE(complaint({"--criterion", "tags"}).find("knot.ply"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "picture.png"));
}

}  // namespace
}  // namespace limn::test

#endif
