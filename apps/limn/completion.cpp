#include "completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vector>

#include "verb.h"

namespace limn::cli {
namespace {

struct Described {
  const Verb* verb;
  OptionTable table;
};

std::vector<Described> listed_verbs() {
  std::vector<Described> all;
  for (const Verb& verb : verbs()) {
    if (!verb.listed) continue;
    Described& one = all.emplace_back(Described{&verb, {}});
    CommonOptions common;
    bool help = false;
    declare(verb, one.table, common, help);
  }
  return all;
}

std::vector<std::string> verb_names(const std::vector<Described>& all) {
  std::vector<std::string> names;
  for (const Described& one : all)
    names.emplace_back(one.verb->name);
  return names;
}

/// What may stand as a value; help's argument is a verb.
std::vector<std::string> choices_of(const Option& option, const std::vector<std::string>& names) {
  return option.kind == ValueKind::kChoice && option.choices.empty() ? names : option.choices;
}

std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string names_of(const Option& option, std::string_view separator) {
  return option.short_name.empty() ? option.name : fmt::format("{}{}{}", option.short_name, separator, option.name);
}

std::string bash_case(const Described& one, const std::vector<std::string>& names) {
  std::vector<std::string> flags;
  std::string values, words;
  for (const Option& option : one.table.options()) {
    const std::string list = fmt::format("{}", fmt::join(choices_of(option, names), " "));
    if (option.positional()) {
      words += words.empty() || list.empty() ? list : " " + list;
      continue;
    }
    flags.push_back(names_of(option, " "));
    if (option.is_switch()) continue;
    const std::string reply = option.kind == ValueKind::kFile
                                  ? "COMPREPLY=($(compgen -f -- \"$word\"))"
                                  : fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", list);
    values += fmt::format("        {}) {}; return ;;\n", names_of(option, "|"), reply);
  }
  std::string text = fmt::format("    {})\n", one.verb->name);
  if (!values.empty()) text += "      case $before in\n" + values + "      esac\n";
  text += fmt::format("      flags='{}'\n      words='{}' ;;\n", fmt::join(flags, " "), words);
  return text;
}

std::string bash_script(const std::vector<Described>& all) {
  const std::vector<std::string> names = verb_names(all);
  std::string text = "# bash completion for limn, made by `limn completion bash`\n_limn() {\n";
  text +=
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} flags='' words=''\n  COMPREPLY=()\n";
  text += fmt::format(
      "  if ((COMP_CWORD == 1)); then\n    COMPREPLY=($(compgen -W '{} --help --version' -- \"$word\"))\n    return\n  "
      "fi\n",
      fmt::join(names, " "));
  text += "  case ${COMP_WORDS[1]} in\n";
  for (const Described& one : all)
    text += bash_case(one, names);
  text += "  esac\n  if [[ $word == -* ]]; then\n    COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n  else\n";
  text += "    COMPREPLY=($(compgen -f -W \"$words\" -- \"$word\"))\n  fi\n}\ncomplete -o filenames -F _limn limn\n";
  return text;
}

/// Text inside zsh's square brackets and after its colons.
std::string zsh_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_action(const Option& option, const std::vector<std::string>& names) {
  if (option.kind == ValueKind::kFile) return "_files";
  const std::vector<std::string> choices = choices_of(option, names);
  return choices.empty() ? " " : fmt::format("({})", fmt::join(choices, " "));
}

std::string zsh_option(const Option& option, const std::vector<std::string>& names) {
  const std::string value =
      option.is_switch() ? "" : fmt::format(":{}:{}", zsh_escaped(option.value), zsh_action(option, names));
  if (option.positional()) return quoted((option.required ? "" : ":") + value);
  const std::string tail = fmt::format("[{}]{}", zsh_escaped(option.what), value);
  if (option.short_name.empty()) return quoted((option.repeatable ? "*" : "") + option.name + tail);
  return fmt::format("{} {}", quoted(option.short_name + tail), quoted(option.name + tail));
}

std::string zsh_script(const std::vector<Described>& all) {
  const std::vector<std::string> names = verb_names(all);
  std::string text = "#compdef limn\n# zsh completion for limn, made by `limn completion zsh`\n_limn() {\n";
  text += "  if ((CURRENT == 2)); then\n    local -a verbs=(\n";
  for (const Described& one : all) {
    text += fmt::format("      {}\n", quoted(fmt::format("{}:{}", one.verb->name, zsh_escaped(one.verb->summary))));
  }
  text +=
      "    )\n    _describe verb verbs\n    return\n  fi\n  local verb=$words[2]\n  shift words\n  ((CURRENT--))\n  "
      "case $verb in\n";
  for (const Described& one : all) {
    text += fmt::format("    {})\n      _arguments -S", one.verb->name);
    for (const Option& option : one.table.options())
      text += " \\\n        " + zsh_option(option, names);
    text += " ;;\n";
  }
  return text + "  esac\n}\n_limn \"$@\"\n";
}

std::string fish_option(const Described& one, const Option& option, const std::vector<std::string>& names) {
  const std::string choices = fmt::format("{}", fmt::join(choices_of(option, names), " "));
  std::string line = fmt::format("complete -c limn -n '__fish_seen_subcommand_from {}'", one.verb->name);
  if (option.positional()) return choices.empty() ? "" : fmt::format("{} -f -a {}\n", line, quoted(choices));
  if (!option.short_name.empty()) line += " -s " + option.short_name.substr(1);
  line += " -l " + option.name.substr(2);
  if (!option.is_switch()) line += option.kind == ValueKind::kFile ? " -r -F" : " -x";
  if (!option.is_switch() && !choices.empty()) line += " -a " + quoted(choices);
  return fmt::format("{} -d {}\n", line, quoted(option.what));
}

std::string fish_script(const std::vector<Described>& all) {
  const std::vector<std::string> names = verb_names(all);
  std::string text = "# fish completion for limn, made by `limn completion fish`\n";
  for (const Described& one : all) {
    text += fmt::format("complete -c limn -n __fish_use_subcommand -f -a {} -d {}\n", one.verb->name,
                        quoted(one.verb->summary));
  }
  for (const Described& one : all) {
    for (const Option& option : one.table.options())
      text += fish_option(one, option, names);
  }
  return text;
}

}  // namespace

std::string completion_script(Shell shell) {
  const std::vector<Described> all = listed_verbs();
  switch (shell) {
    case Shell::kBash:
      return bash_script(all);
    case Shell::kZsh:
      return zsh_script(all);
    case Shell::kFish:
      return fish_script(all);
  }
  return {};
}

}  // namespace limn::cli
