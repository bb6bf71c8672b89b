#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "man_page.h"
#include "nearest.h"
#include "verb.h"

namespace limn::cli {
namespace {

Result<int> run(Session& session, const std::string& name) {
  const Verb* const verb = name.empty() ? nullptr : find_verb(name);
  if (!name.empty() && verb == nullptr) {
    std::vector<std::string_view> known;
    for (const Verb& other : verbs())
      known.push_back(other.name);
    return fail(ErrorCode::kInvalidArgument, fmt::format("man: no such verb '{}'", name), suggest(name, known));
  }
  const std::string page = verb != nullptr ? verb_man_page(*verb) : program_man_page();
  return (session.json() ? session.print_json(nlohmann::ordered_json{{"page", page}}) : session.print(page)).map([] {
    return kExitDone;
  });
}

Run declare_man(OptionTable& table) {
  const auto name = std::make_shared<std::string>();
  table.argument("VERB", *name, "whose page to print; none: the program's", ValueKind::kChoice).required = false;
  return [name](Session& session) { return run(session, *name); };
}

}  // namespace

Verb man_verb() {
  return Verb{"man",
              "prints a manual page in man's own format",
              "[VERB]",
              false,
              {{{"limn man > limn.1", "the program's page"},
                {"limn man refine > limn-refine.1", "a verb's page"},
                {"limn man info --json", "the page as a string of a JSON object"}}},
              declare_man};
}

}  // namespace limn::cli
