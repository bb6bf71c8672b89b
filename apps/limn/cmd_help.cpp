#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "help.h"
#include "nearest.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

ordered_json describe(const Option& option) {
  ordered_json json{{"name", option.name}, {"what", option.what}};
  if (!option.short_name.empty()) json["short"] = option.short_name;
  if (!option.is_switch()) json["value"] = option.value;
  if (!option.choices.empty()) json["choices"] = option.choices;
  json["required"] = option.required;
  json["group"] = group_title(option.group);
  return json;
}

ordered_json describe(const Verb& verb) {
  OptionTable table;
  CommonOptions common;
  bool help = false;
  declare(verb, table, common, help);
  ordered_json json{
      {"name", verb.name}, {"summary", verb.summary}, {"usage", fmt::format("limn {} {}", verb.name, verb.usage)}};
  json["options"] = ordered_json::array();
  for (const Option& option : table.options())
    json["options"].push_back(describe(option));
  json["examples"] = ordered_json::array();
  for (const Example& example : verb.examples) {
    json["examples"].push_back({{"command", example.command}, {"what", example.what}});
  }
  return json;
}

ordered_json describe_all(const Verb* only) {
  ordered_json json{{"verbs", ordered_json::array()}};
  for (const Verb& verb : verbs()) {
    if (only == nullptr || only->name == verb.name) json["verbs"].push_back(describe(verb));
  }
  json["example_files"] = example_files();
  return json;
}

Result<int> run(Session& session, const std::string& name) {
  const Verb* const verb = name.empty() ? nullptr : find_verb(name);
  if (!name.empty() && verb == nullptr) {
    std::vector<std::string_view> known;
    for (const Verb& other : verbs())
      known.push_back(other.name);
    return fail(ErrorCode::kInvalidArgument, fmt::format("help: no such verb '{}'", name), suggest(name, known));
  }
  const Result<void> printed = session.json() ? session.print_json(describe_all(verb))
                                              : session.print(verb != nullptr ? verb_page(*verb) : program_screen());
  return printed.map([] { return kExitDone; });
}

Run declare_help(OptionTable& table) {
  const auto name = std::make_shared<std::string>();
  Option& argument = table.argument("VERB", *name, "whose page to show; none: the program's", ValueKind::kChoice);
  argument.required = false;
  return [name](Session& session) { return run(session, *name); };
}

}  // namespace

Verb help_verb() {
  return Verb{"help",
              "shows a verb's options and examples",
              "[VERB]",
              true,
              {{{"limn help", "the verbs"},
                {"limn help refine", "one verb's options and examples"},
                {"limn help --json", "the whole command line, for other programs"}}},
              declare_help};
}

}  // namespace limn::cli
