// Every example of every help page does what it says, run as a user would type it.
#include <gtest/gtest.h>
#include <string>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Examples : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  void run_all(const std::string& verb) {
    const auto described = limn.json({"help", verb});
    for (const auto& command : described["example_files"]) {
      ASSERT_EQ(limn.shell(command.get<std::string>()).exit, 0) << command;
    }
    for (const auto& example : described["verbs"][0]["examples"]) {
      const Outcome outcome = limn.shell("set -o pipefail; " + example["command"].get<std::string>());
      EXPECT_EQ(outcome.exit, 0) << example << "\n" << outcome.err;
    }
  }
};

TEST_F(Examples, OfInfoRun) {
  run_all("info");
}
TEST_F(Examples, OfMakeRun) {
  run_all("make");
}
TEST_F(Examples, OfRefineRun) {
  run_all("refine");
}
#ifdef LIMN_WITH_GL
TEST_F(Examples, OfDemoRun) {
  run_all("demo");
}
TEST_F(Examples, OfRenderRun) {
  run_all("render");
}
#endif
#ifdef LIMN_WITH_EMBREE
TEST_F(Examples, OfSilhouetteRun) {
  run_all("silhouette");
}
#endif
TEST_F(Examples, OfHullRun) {
  run_all("hull");
}
TEST_F(Examples, OfCompareRun) {
  run_all("compare");
}
TEST_F(Examples, OfTheOthersRun) {
  for (const char* verb : {"help", "version", "completion", "man"})
    run_all(verb);
}

TEST_F(Examples, CoverEveryVerb) {
  std::size_t count = 10;
#ifdef LIMN_WITH_GL
  ++count;
#endif
#ifdef LIMN_WITH_EMBREE
  ++count;
#endif
  EXPECT_EQ(limn.json({"help"})["verbs"].size(), count) << "a verb without a test above";
}

}  // namespace
}  // namespace limn::test
