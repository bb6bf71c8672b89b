// limn render --method clip, seen from outside: it covers what the original covers, and says what it cannot do.
#ifdef LIMN_WITH_GL

#include <gtest/gtest.h>

#include "limn/image/image.h"

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class ClipRender : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  void make_asset() {
    ASSERT_EQ(limn.run({"make", "knot", "--faces", "6000", "-o", "knot.ply"}).exit, 0);
    ASSERT_EQ(limn.run({"clip", "knot.ply", "-o", "knot.glb", "--faces", "600", "--size", "128"}).exit, 0);
  }
  Image picture(const Arguments& words) {
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    auto image = read_png((folder / "out.png").string());
    EXPECT_TRUE(image);
    return image ? std::move(*image) : Image(1, 1);
  }
};

TEST_F(ClipRender, TheAssetCoversWhatTheOriginalCovers) {
  make_asset();
  for (const char* view : {"30,20", "100,-40"}) {
    const Arguments common = {"-o", "out.png", "--view", view, "--size", "200x150", "--background", "transparent"};
    Arguments original = {"render", "knot.ply", "--samples", "4"};
    Arguments clipped = {"render", "knot.glb", "--method", "clip", "--level-tolerance", "0"};
    original.insert(original.end(), common.begin(), common.end());
    clipped.insert(clipped.end(), common.begin(), common.end());
    const Image wanted = picture(original), got = picture(clipped);
    ASSERT_EQ(wanted.rgba.size(), got.rgba.size());
    std::size_t differing = 0, covered = 0;
    for (std::size_t i = 3; i < wanted.rgba.size(); i += 4) {
      differing += wanted.rgba[i] != got.rgba[i] ? 1 : 0;
      covered += wanted.rgba[i] > 0 ? 1 : 0;
    }
    EXPECT_EQ(differing, 0u) << view;
    EXPECT_GT(covered, 2000u);
  }
}

TEST_F(ClipRender, ItTellsHowItDrew) {
  make_asset();
  for (const char* smoothing : {"none", "lines", "msaa"}) {
    const auto data =
        limn.json({"render", "knot.glb", "-o", "out.png", "--method", "clip", "--aa", smoothing, "--size", "100"});
    EXPECT_EQ(data["method"], "clip");
    EXPECT_EQ(data["eye"], "outside");
    EXPECT_GT(data["silhouette_edges"], 50);
    EXPECT_LE(data["triangles"], 700);
  }
}

TEST_F(ClipRender, MeshesAndOptionsThatAreNotForItAreRefused) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "600", "-o", "knot.ply"}).exit, 0);
  const Outcome mesh = limn.run({"render", "knot.ply", "-o", "out.png", "--method", "clip"});
  EXPECT_EQ(mesh.exit, 3) << mesh.err;
  EXPECT_NE(mesh.err.find("no clip asset"), std::string::npos) << mesh.err;
  for (const char* option : {"--wireframe", "--flat", "--outline", "--levels"})
    EXPECT_EQ(limn.run({"render", "missing.glb", "-o", "out.png", "--method", "clip", option}).exit, 2) << option;
  ASSERT_EQ(limn.run({"clip", "knot.ply", "-o", "knot.glb", "--faces", "200", "--size", "128"}).exit, 0);
  const Outcome lines = limn.run(
      {"render", "knot.glb", "-o", "out.png", "--method", "clip", "--aa", "lines", "--background", "transparent"});
  EXPECT_EQ(lines.exit, 2);
  EXPECT_NE(lines.err.find("opaque"), std::string::npos) << lines.err;
}

}  // namespace
}  // namespace limn::test
#endif
