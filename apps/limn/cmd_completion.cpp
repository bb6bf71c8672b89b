#include <memory>
#include <nlohmann/json.hpp>

#include "completion.h"
#include "verb.h"

namespace limn::cli {
namespace {

Run declare_completion(OptionTable& table) {
  const auto shell = std::make_shared<Shell>(Shell::kBash);
  Option& option = table.choice("SHELL", *shell, {{"bash", Shell::kBash}, {"zsh", Shell::kZsh}, {"fish", Shell::kFish}},
                                "bash, zsh or fish");
  option.group = Group::kArguments;
  option.required = true;
  return [shell](Session& session) {
    const std::string script = completion_script(*shell);
    return (session.json() ? session.print_json(nlohmann::ordered_json{{"script", script}}) : session.print(script))
        .map([] { return kExitDone; });
  };
}

}  // namespace

Verb completion_verb() {
  return Verb{"completion",
              "prints a script that completes limn's verbs and flags in a shell",
              "bash|zsh|fish",
              false,
              {{{"limn completion bash > limn.bash", "for bash: source it, or save it among bash-completion's"},
                {"limn completion zsh > _limn", "for zsh: a folder named in $fpath"},
                {"limn completion fish > limn.fish", "for fish: ~/.config/fish/completions"}}},
              declare_completion};
}

}  // namespace limn::cli
