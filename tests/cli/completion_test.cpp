// Completion scripts know every listed verb and flag, and bash's works.
#include <gtest/gtest.h>
#include <string>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

class Completion : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  /// What bash would offer for the last of the words.
  std::string offered(const std::string& words) {
    const Outcome outcome = limn.shell("eval \"$(limn completion bash)\"; COMP_WORDS=(" + words +
                                       "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _limn; echo ${COMPREPLY[*]}");
    EXPECT_EQ(outcome.err, "");
    return outcome.out.substr(0, outcome.out.find('\n'));
  }
};

TEST_F(Completion, NamesEveryListedVerbAndFlagInEveryShell) {
  const auto verbs = limn.json({"help"})["verbs"];
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const std::string script = limn.run({"completion", shell}).out;
    for (const auto& verb : verbs) {
      const std::string name = verb["name"];
      if (name == "completion" || name == "man") continue;
      EXPECT_NE(script.find(name), std::string::npos) << shell << name;
      for (const auto& option : verb["options"]) {
        const std::string flag = option["name"];
        if (!flag.starts_with("--")) continue;
        const std::string written = shell == "fish" ? " -l " + flag.substr(2) : flag;
        EXPECT_NE(script.find(written), std::string::npos) << shell << name << flag;
        for (const auto& choice : option.value("choices", nlohmann::json::array())) {
          EXPECT_NE(script.find(choice.get<std::string>()), std::string::npos) << shell << flag << choice;
        }
      }
    }
  }
}

TEST_F(Completion, BashOffersVerbsFlagsChoicesAndFiles) {
  folder.write("model.ply", "");
  EXPECT_EQ(offered("limn ref"), "refine");
  EXPECT_EQ(offered("limn refine --max"), "--max-level");
  EXPECT_EQ(offered("limn refine --blend p"), "paper");
  EXPECT_EQ(offered("limn make tor"), "torus");
  EXPECT_EQ(offered("limn help comp"), "compare");
  EXPECT_EQ(offered("limn info mod"), "model.ply");
  EXPECT_EQ(offered("limn refine model.ply -o mod"), "model.ply");
}

TEST_F(Completion, BashScriptIsValid) {
  EXPECT_EQ(limn.shell("limn completion bash | bash -n").exit, 0);
}

}  // namespace
}  // namespace limn::test
