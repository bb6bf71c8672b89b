#include "help.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <vector>

namespace limn::cli {
namespace {

/// Groups in the order in which a crowded page shortens them.
constexpr std::array kShortenFirst{Group::kCommon, Group::kLevels, Group::kCamera, Group::kFiles, Group::kPage};

/// The names that stand in for long lists of choices on a shortened line.
std::string short_spelling(const Option& option) {
  return option.is_switch() ? option.name : option.name + " " + option.value;
}

void append_wrapped(std::string& page, const std::string& head, const std::vector<std::string>& words) {
  std::string line = head;
  for (const std::string& word : words) {
    if (static_cast<int>(line.size() + 2 + word.size()) > kScreenColumns) {
      page += line + "\n";
      line = std::string(head.size(), ' ');
    }
    line += "  " + word;
  }
  page += line + "\n";
}

std::vector<const Option*> members(const OptionTable& table, Group group) {
  std::vector<const Option*> found;
  for (const Option& option : table.options()) {
    if (option.group == group) found.push_back(&option);
  }
  return found;
}

void append_group(std::string& page, const OptionTable& table, Group group, bool shortened) {
  const std::vector<const Option*> options = members(table, group);
  if (options.empty()) return;
  if (shortened) {
    std::vector<std::string> words;
    for (const Option* option : options)
      words.push_back(short_spelling(*option));
    append_wrapped(page, fmt::format("  {}:", group_title(group)), words);
    return;
  }
  std::size_t width = 0;
  for (const Option& option : table.options())
    width = std::max(width, std::min<std::size_t>(option.spelled().size(), 34));
  for (const Option* option : options) {
    const std::string spelled = option->spelled();
    // A long list of choices pushes its own line only.
    page += fmt::format("  {:<{}}  {}\n", spelled, width, option->what);
  }
}

std::string heading(const Verb& verb) {
  return fmt::format("limn {}: {}\n\nusage: limn {} {}\n\n", verb.name, verb.summary, verb.name, verb.usage);
}

std::string options_text(const OptionTable& table, const std::set<Group>& shortened) {
  std::string text;
  for (const Group group :
       {Group::kArguments, Group::kOwn, Group::kPage, Group::kFiles, Group::kCamera, Group::kLevels, Group::kCommon}) {
    append_group(text, table, group, shortened.contains(group));
  }
  return text;
}

bool fits(const std::string& page) {
  return std::count(page.begin(), page.end(), '\n') <= kScreenLines;
}

OptionTable table_of(const Verb& verb) {
  OptionTable table;
  CommonOptions common;
  bool help = false;
  declare(verb, table, common, help);
  return table;
}

}  // namespace

std::string program_screen() {
  std::string page = "limn " LIMN_VERSION ": gives coarse triangle meshes the outline of fine ones\n\n";
  page += "usage: limn VERB [arguments]\n\n";
  for (const Verb& verb : verbs()) {
    if (verb.listed) page += fmt::format("  {:<10}  {}\n", verb.name, verb.summary);
  }
  page += "\nlimn VERB --help shows a verb's options on one screen, limn help VERB all of them with examples.\n";
  page += "Files: OBJ, PLY, STL, OFF, glTF, GLB; '-' is standard input or output.\n";
  page += "Data goes to standard output, messages to standard error; every verb takes --json.\n";
  page += "Exit: 0 done, 2 usage, 3 file, 4 mesh unsuitable, 5 --fail-if, 6 no OpenGL, 130 interrupted.\n";
  return page;
}

std::string verb_screen(const Verb& verb) {
  const OptionTable table = table_of(verb);
  const std::string tail = fmt::format("\nAll of it, with examples: limn help {}\n", verb.name);
  std::set<Group> shortened;
  std::string page = heading(verb) + options_text(table, shortened) + tail;
  for (const Group group : kShortenFirst) {
    if (fits(page)) break;
    shortened.insert(group);
    page = heading(verb) + options_text(table, shortened) + tail;
  }
  return page;
}

std::string verb_page(const Verb& verb) {
  std::string page = heading(verb);
  const OptionTable table = table_of(verb);
  for (const Group group :
       {Group::kArguments, Group::kOwn, Group::kPage, Group::kFiles, Group::kCamera, Group::kLevels, Group::kCommon}) {
    if (members(table, group).empty()) continue;
    page += fmt::format("{}:\n", group_title(group));
    append_group(page, table, group, false);
    page += "\n";
  }
  page += "examples:\n";
  for (const Example& example : verb.examples)
    page += fmt::format("  # {}\n  {}\n", example.what, example.command);
  page += "\nThe files they use were made by\n";
  for (const std::string_view line : example_files())
    page += fmt::format("  {}\n", line);
  return page;
}

}  // namespace limn::cli
