#include "parse.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "nearest.h"

namespace limn::cli {
namespace {

using Slots = std::vector<std::pair<const Option*, CLI::Option*>>;

tl::unexpected<Error> usage_error(const Verb& verb, const std::string& message, const std::string& remedy = {}) {
  return fail(ErrorCode::kInvalidArgument, fmt::format("{}: {}", verb.name, message),
              remedy.empty() ? fmt::format("see limn {} --help", verb.name) : remedy);
}

Slots add_options(CLI::App& app, const OptionTable& table) {
  Slots slots;
  app.set_help_flag();
  app.allow_extras();
  for (const Option& option : table.options()) {
    const std::string names = option.short_name.empty() ? option.name : option.short_name + "," + option.name;
    CLI::Option* slot = nullptr;
    if (option.is_switch()) {
      slot = app.add_flag(names)->disable_flag_override();
    } else {
      slot = app.add_option(names, [](const CLI::results_t&) { return true; });
      slot->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }
    slots.emplace_back(&option, slot);
  }
  return slots;
}

bool is_flag(const OptionTable& table, const std::string& text) {
  return std::any_of(table.options().begin(), table.options().end(), [&](const Option& option) {
    return !option.positional() && (text == option.name || text == option.short_name);
  });
}

Result<void> refuse_extra(const Verb& verb, const OptionTable& table, const std::vector<std::string>& extras) {
  const auto flag = std::find_if(extras.begin(), extras.end(),
                                 [](const std::string& text) { return text.size() > 1 && text.starts_with('-'); });
  if (flag == extras.end()) {
    if (extras.empty()) return {};
    return usage_error(verb, fmt::format("unexpected argument '{}'", extras.front()));
  }
  std::vector<std::string_view> known;
  for (const Option& option : table.options()) {
    if (!option.positional()) known.push_back(option.name);
  }
  const std::string name = flag->substr(0, flag->find('='));
  return usage_error(verb, fmt::format("no such flag '{}'", name), suggest(name, known));
}

Result<void> take_values(const Verb& verb, const OptionTable& table, const Slots& slots) {
  for (const auto& [option, slot] : slots) {
    if (slot->count() == 0) continue;
    if (slot->count() > 1 && !option->repeatable && !option->is_switch()) {
      return usage_error(verb, fmt::format("{} is given more than once", option->name));
    }
    for (const std::string& text : slot->results()) {
      if (!option->is_switch() && is_flag(table, text)) {
        return usage_error(verb, fmt::format("{} has no value: '{}' follows it", option->name, text));
      }
      const Result<void> set = option->set(text);
      if (!set) return usage_error(verb, option->name + " " + set.error().message, set.error().remedy);
    }
  }
  return {};
}

Result<void> require_all(const Verb& verb, const Slots& slots) {
  for (const auto& [option, slot] : slots) {
    if (!option->required || slot->count() > 0) continue;
    return usage_error(verb, fmt::format("{} is missing", option->spelled()),
                       fmt::format("usage: limn {} {}", verb.name, verb.usage));
  }
  return {};
}

/// CLI11 throws; only its words for values that are missing or not wanted get here, all else is found afterwards.
Result<void> read_tokens(const Verb& verb, CLI::App& app, std::span<const std::string> arguments) {
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    const std::string flag = arguments.empty() ? "" : arguments.back();
    if (flag.starts_with('-') && app.get_option_no_throw(flag) != nullptr &&
        app.get_option(flag)->get_items_expected() > 0) {
      return usage_error(verb, flag + " has no value");
    }
    return usage_error(verb, error.what());
  } catch (const CLI::Error& error) {
    return usage_error(verb, error.what());
  }
  return {};
}

}  // namespace

Result<void> parse(const Verb& verb, const OptionTable& table, std::span<const std::string> arguments, bool& help) {
  const auto end = std::find(arguments.begin(), arguments.end(), "--");
  help = std::any_of(arguments.begin(), end, [](const std::string& text) { return text == "-h" || text == "--help"; });
  if (help) return {};
  CLI::App app;
  const Slots slots = add_options(app, table);
  return read_tokens(verb, app, arguments)
      .and_then([&] { return refuse_extra(verb, table, app.remaining()); })
      .and_then([&] { return take_values(verb, table, slots); })
      .and_then([&] { return require_all(verb, slots); });
}

}  // namespace limn::cli
