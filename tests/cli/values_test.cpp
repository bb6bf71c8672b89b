// Values as typed: junk is refused by name, before any file is touched.
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Values : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  void expect_refused(Arguments words, const std::string& flag, const std::vector<std::string>& values) {
    words.push_back(flag);
    words.emplace_back();
    for (const std::string& value : values) {
      words.back() = value;
      const Outcome outcome = limn.run(words);
      EXPECT_EQ(outcome.exit, 2) << flag << " " << value << "\n" << outcome.err;
      EXPECT_NE(outcome.err.find(flag + " "), std::string::npos) << value << "\n" << outcome.err;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }

  /// Whether the value was read: the verb then fails on its missing file, not on its arguments.
  void expect_accepted(Arguments words, const std::string& flag, const std::vector<std::string>& values) {
    words.push_back(flag);
    words.emplace_back();
    for (const std::string& value : values) {
      words.back() = value;
      const Outcome outcome = limn.run(words);
      EXPECT_EQ(outcome.exit, 3) << flag << " " << value << "\n" << outcome.err;
    }
  }
};

const Arguments kMake = {"make", "torus", "-o", "a.ply"};
const Arguments kRefine = {"refine", "missing.ply", "-o", "a.ply", "--view", "0,0"};
const Arguments kRefineUnseen = {"refine", "missing.ply", "-o", "a.ply"};
const Arguments kRender = {"render", "missing.ply", "-o", "a.png"};
const Arguments kCompare = {"compare", "missing.ply", "b.ply"};

TEST_F(Values, RefuseWhatIsNoWholeNumber) {
  const std::vector<std::string> junk = {"3x",  "",    " 3",  "3 ",   "-1",  "+3",
                                         "nan", "inf", "1e3", "0x10", "3.5", "99999999999999999999999"};
  expect_refused(kMake, "--faces", junk);
  expect_refused(kMake, "--seed", junk);
  expect_refused(kMake, "--threads", junk);
  expect_refused(kMake, "--threads", {"0", "1025"});
  expect_refused(kMake, "--faces", {"0", "1073741825"});
  expect_refused(kRefine, "--max-level", junk);
  expect_refused(kRefine, "--max-level", {"9"});
  expect_refused(kCompare, "--views", junk);
  expect_refused(kCompare, "--views", {"0"});
  expect_refused(kCompare, "--size", junk);
  expect_refused(kCompare, "--size", {"0", "16385"});
  expect_accepted(kRefine, "--max-level", {"0", "8"});
  expect_accepted(kCompare, "--seed", {"0", "18446744073709551615"});
}

TEST_F(Values, RefuseWhatIsNoNumberInRange) {
  const std::vector<std::string> junk = {"3x",   "",      " 3",   "3 ",  "nan", "NaN", "inf",
                                         "-inf", "1e999", "0x10", "1,5", "--",  "+-1", "++1"};
  for (const char* flag : {"--pixels", "--fov", "--wedge", "--crease-angle", "--near"})
    expect_refused(kRefine, flag, junk);
  expect_refused(kRefine, "--pixels", {"0", "-1"});
  expect_refused(kRefine, "--fov", {"0", "180", "-20"});
  expect_refused(kRefine, "--wedge", {"0", "90"});
  expect_refused(kRefine, "--crease-angle", {"-1", "180.5"});
  expect_accepted(kRefine, "--pixels", {"0.5", ".5", "5e-1", "+2"});
  expect_accepted(kRefine, "--crease-angle", {"0", "180"});
}

TEST_F(Values, RefuseWhatIsNoPointOrView) {
  const std::vector<std::string> junk = {"1",      "1,2",     "1,2,3,4",  "1,2,x", "1,,3",
                                         "1, 2,3", "nan,0,0", "1e39,0,0", "",      "a,b,c"};
  expect_refused(kRefineUnseen, "--eye", junk);
  expect_refused(kRefine, "--target", junk);
  expect_refused(kRefineUnseen, "--view", {"1", "1,2,3", "0,91", "0,-90.5", "x,0", "nan,0", ""});
  expect_accepted(kRefineUnseen, "--eye", {"-1,-2,-3", "0,0,1e3"});
  expect_accepted(kRefineUnseen, "--view", {"-30,20", "720,-90"});
}

TEST_F(Values, RefuseWhatIsNoSize) {
  const std::vector<std::string> junk = {"0x5",  "5x0", "x",       "5x",    "x5",  "5x5x5",
                                         "-5x5", "5X5", "16385x1", "5.5x5", "axb", ""};
  expect_refused(kRender, "--size", junk);
  expect_refused({"demo"}, "--size", junk);
  expect_accepted(kRender, "--size", {"1x1", "64", "16384x1"});
}

TEST_F(Values, RefuseWhatIsNoColour) {
  expect_refused(kRender, "--background",
                 {"", "#", "#12", "#1234", "#12345", "#gggggg", "#1234567", "whit", "White", "123456"});
  expect_accepted(kRender, "--background", {"white", "transparent", "#fff", "#FfA010", "#11223344"});
}

TEST_F(Values, RefuseWhatIsNoGate) {
  expect_refused(kCompare, "--fail-if",
                 {"", "mean_px", "mean_px>", ">1", "mean_px=1", "mean_px==1", "mean_px>x", "mean_px>1x", "mean_px>nan",
                  "mean>1", "iou>1>2"});
  expect_accepted(kCompare, "--fail-if", {"mean_px>0.5", "p95_px >= 1", " max_px<3", "iou<=0.99"});
}

TEST_F(Values, RefuseWordsThatAreNoChoice) {
  expect_refused(kRefine, "--blend", {"", "Surplus", "both"});
  expect_refused(kRefine, "--topology", {"", "Nested", "both"});
  expect_refused(kRender, "--samples", {"0", "2", "8"});
  expect_refused(kRender, "--method", {"fine"});
  expect_refused(kMake, "--format", {"xyz", "3ds"});
}

}  // namespace
}  // namespace limn::test
