// The verb hull, seen from outside.
#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class HullVerb : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(limn.run({"make", "holes3", "--faces", "3000", "-o", "model.ply"}).exit, 0); }
  TempFolder folder;
  Program limn{folder.path()};
};

TEST_F(HullVerb, WritesAClosedMeshOfTheSizeAskedForThatIsLargerOrSmaller) {
  const auto outer = limn.json({"hull", "model.ply", "-o", "outer.ply", "--faces", "300"});
  const auto inner = limn.json({"hull", "model.ply", "-o", "inner.ply", "--faces", "300", "--inner"});
  EXPECT_GT(outer["volume_ratio"], 1.0);
  EXPECT_LT(inner["volume_ratio"], 1.0);
  for (const char* name : {"outer.ply", "inner.ply"}) {
    const auto info = limn.json({"info", name});
    EXPECT_EQ(info["closed"], true);
    EXPECT_LE(info["faces"], 300);
    EXPECT_EQ(info["has_normals"], true);
  }
  EXPECT_NEAR(limn.json({"info", "outer.ply"})["volume"].get<double>(), outer["volume_out"].get<double>(), 1e-6);
  EXPECT_NEAR(limn.json({"info", "model.ply"})["volume"].get<double>(), outer["volume_in"].get<double>(), 1e-6);
  EXPECT_GT(outer["certificate"]["proved"], 1000);
  EXPECT_GE(outer["certificate"]["worst_margin"], 0.0);
}

TEST_F(HullVerb, KeepsEveryHullInOneFile) {
  const auto made = limn.json({"hull", "model.ply", "--sequence", "all.hulls", "--faces", "100", "-o", "outer.ply"});
  const auto read = limn.json({"hull", "all.hulls", "-o", "again.ply", "--faces", "100"});
  EXPECT_EQ(made["faces_out"], read["faces_out"]);
  EXPECT_NEAR(made["volume_out"].get<double>(), read["volume_out"].get<double>(), 1e-9);
  EXPECT_EQ(made["outer_steps"], read["outer_steps"]);
  EXPECT_EQ(made["inner_steps"], read["inner_steps"]);
  double last = 0;
  for (const auto& [side, faces] : std::initializer_list<std::pair<const char*, const char*>>{
           {"--inner", "100"}, {"--inner", "1000"}, {"--quiet", "3000"}, {"--quiet", "1000"}, {"--quiet", "100"}}) {
    const auto json = limn.json({"hull", "all.hulls", "-o", "one.ply", "--faces", faces, side});
    EXPECT_LE(json["faces_out"], std::stoi(faces));
    EXPECT_EQ(json["reached"], true);
    EXPECT_GT(json["volume_out"].get<double>(), last);
    last = json["volume_out"];
  }
}

TEST_F(HullVerb, RefusesASequenceThatIsDamaged) {
  ASSERT_EQ(limn.run({"hull", "model.ply", "--sequence", "all.hulls", "--faces", "1000"}).exit, 0);
  std::string bytes = slurp(folder / "all.hulls");
  bytes[bytes.size() / 2] ^= 1;
  folder.write("bad.hulls", bytes);
  const Outcome outcome = limn.run({"hull", "bad.hulls", "-o", "one.ply"});
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_NE(outcome.err.find("bad.hulls: the hull sequence is damaged"), std::string::npos) << outcome.err;
}

TEST_F(HullVerb, EndsWithFiveWhereAGateHolds) {
  const Arguments plain{"hull", "model.ply", "-o", "hull.ply", "--faces", "300"};
  const auto with = [&](const std::string& gate) {
    Arguments words = plain;
    words.insert(words.end(), {"--fail-if", gate});
    return limn.run(words).exit;
  };
  EXPECT_EQ(with("volume>100"), 0);
  EXPECT_EQ(with("volume>1"), 5);
  EXPECT_EQ(with("faces<=300"), 5);
  EXPECT_EQ(with("mean_px>1"), 2);
}

TEST_F(HullVerb, SaysWhatItClosedAndRefusesWhatHasNoInside) {
  folder.write("box.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
               "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");  // without its lid
  const Outcome open = limn.run({"hull", "box.obj", "-o", "hull.ply", "--faces", "12"});
  EXPECT_EQ(open.exit, 0) << open.err;
  EXPECT_NE(open.err.find("closed 1 boundary of 4 edges with 2 faces"), std::string::npos) << open.err;
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome flat = limn.run({"hull", "flat.obj", "-o", "hull.ply"});
  EXPECT_EQ(flat.exit, 4);
  EXPECT_NE(flat.err.find("flat.obj: the surface encloses no volume"), std::string::npos) << flat.err;
}

TEST_F(HullVerb, NeedsSomethingToWrite) {
  EXPECT_EQ(limn.run({"hull", "model.ply"}).exit, 2);
  EXPECT_EQ(limn.run({"hull", "model.ply", "--sequence", "-"}).exit, 2);
  EXPECT_EQ(limn.run({"hull", "model.ply", "-o", "none/hull.ply"}).exit, 3);
  EXPECT_EQ(limn.run({"hull", "none.ply", "-o", "hull.ply"}).exit, 3);
}

TEST_F(HullVerb, StrictMakesNoSelfIntersections) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "3000", "-o", "knot.ply"}).exit, 0);
  const auto loose = limn.json({"hull", "knot.ply", "-o", "hull.ply", "--faces", "200"});
  const auto strict = limn.json({"hull", "knot.ply", "-o", "hull.ply", "--faces", "200", "--strict"});
  EXPECT_EQ(strict["self_intersections_in"], 0);
  EXPECT_GT(loose["self_intersections"], 0);
  EXPECT_EQ(strict["self_intersections"], 0);
}

}  // namespace
}  // namespace limn::test
