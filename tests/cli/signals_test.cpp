// Ctrl-C, terminals and the progress bar.
#include <csignal>
#include <gtest/gtest.h>
#include <string>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Signals : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  bool only(const std::string& name) const {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      if (entry.path().filename() != name) return false;
    }
    return true;
  }
};

/// Work that takes minutes: interrupted long before its end.
const Arguments kLongCompare = {"compare", "knot.ply", "knot.ply", "--views", "100000", "--method", "refine"};

TEST_F(Signals, InterruptedComparisonEndsWith130AndPrintsNothing) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "2000", "-o", "knot.ply"}).exit, 0);
  const Outcome outcome = limn.run_and_signal(kLongCompare, SIGINT, 700);
  EXPECT_EQ(outcome.exit, 130) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
}

TEST_F(Signals, TerminatedComparisonEndsWith143) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "2000", "-o", "knot.ply"}).exit, 0);
  EXPECT_EQ(limn.run_and_signal(kLongCompare, SIGTERM, 700).exit, 143);
}

TEST_F(Signals, InterruptedRefinementLeavesNoFile) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "150000", "-o", "knot.ply"}).exit, 0);
  const Outcome outcome = limn.run_and_signal(
      {"refine", "knot.ply", "-o", "fine.ply", "--criterion", "uniform", "--max-level", "4", "--threads", "1"}, SIGINT,
      300);
  EXPECT_EQ(outcome.exit, 130) << outcome.err;
  EXPECT_TRUE(only("knot.ply"));
}

TEST_F(Signals, InterruptedRefinementKeepsTheEarlierFile) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "150000", "-o", "knot.ply"}).exit, 0);
  const std::string before = slurp(folder / "knot.ply");
  const Outcome outcome = limn.run_and_signal(
      {"refine", "knot.ply", "-o", "knot.ply", "--criterion", "uniform", "--max-level", "4", "--threads", "1"}, SIGINT,
      300);
  EXPECT_EQ(outcome.exit, 130) << outcome.err;
  EXPECT_TRUE(slurp(folder / "knot.ply") == before);
  EXPECT_TRUE(only("knot.ply"));
}

TEST_F(Signals, LongWorkDrawsABarOnATerminalAndTakesItOff) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "2000", "-o", "knot.ply"}).exit, 0);
  limn.environment = {{"TERM", "xterm"}};
  const Outcome outcome = limn.run_on_terminal({"compare", "knot.ply", "knot.ply", "--views", "150", "--threads", "1"});
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_NE(outcome.err.find(" %/s"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(" left"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("\r\x1b[K"), std::string::npos);
  EXPECT_EQ(outcome.out.find('\r'), std::string::npos);
}

TEST_F(Signals, ShortWorkAPipeQuietAndDumbTerminalsDrawNoBar) {
  ASSERT_EQ(limn.run({"make", "knot", "--faces", "2000", "-o", "knot.ply"}).exit, 0);
  const Arguments long_enough = {"compare", "knot.ply", "knot.ply", "--views", "60", "--threads", "1"};
  EXPECT_EQ(limn.run(long_enough).err.find('\r'), std::string::npos);
  limn.environment = {{"TERM", "dumb"}};
  EXPECT_EQ(limn.run_on_terminal(long_enough).err.find("%/s"), std::string::npos);
  limn.environment = {{"TERM", "xterm"}};
  EXPECT_EQ(limn.run_on_terminal({"info", "knot.ply"}).err, "");
  Arguments quiet = long_enough;
  quiet.emplace_back("--quiet");
  EXPECT_EQ(limn.run_on_terminal(quiet).err, "");
}

}  // namespace
}  // namespace limn::test
