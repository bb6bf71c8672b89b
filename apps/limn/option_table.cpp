#include "option_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "nearest.h"

namespace limn::cli {

std::string_view group_title(Group group) {
  switch (group) {
    case Group::kArguments:
      return "arguments";
    case Group::kOwn:
      return "options";
    case Group::kPage:
      return "page";
    case Group::kFiles:
      return "files";
    case Group::kCamera:
      return "camera";
    case Group::kLevels:
      return "levels";
    case Group::kCommon:
      return "common";
  }
  return "";
}

std::string Option::spelled() const {
  std::string text = short_name.empty() ? name : short_name + ", " + name;
  if (!value.empty() && !positional()) text += " " + value;
  return text;
}

Option& OptionTable::add(std::string name, std::string value, std::string what,
                         std::function<Result<void>(const std::string&)> set) {
  Option option;
  // "-o,--output" gives a short and a long name.
  const std::size_t comma = name.find(',');
  if (comma != std::string::npos) {
    option.short_name = name.substr(0, comma);
    name.erase(0, comma + 1);
  }
  option.name = std::move(name);
  option.value = std::move(value);
  option.what = std::move(what);
  option.group = group_;
  option.set = std::move(set);
  options_.push_back(std::move(option));
  return options_.back();
}

Option& OptionTable::argument(std::string name, std::string& target, std::string what, ValueKind kind) {
  Option& option = text(std::move(name), "", target, std::move(what));
  option.value = option.name;
  option.group = Group::kArguments;
  option.kind = kind;
  option.required = true;
  return option;
}

Option& OptionTable::toggle(std::string name, bool& target, std::string what) {
  return add(std::move(name), "", std::move(what), [&target](const std::string&) -> Result<void> {
    target = true;
    return {};
  });
}

Option& OptionTable::text(std::string name, std::string value, std::string& target, std::string what) {
  return add(std::move(name), std::move(value), std::move(what), [&target](const std::string& text) -> Result<void> {
    if (text.empty()) return fail(ErrorCode::kInvalidArgument, "takes a value that is not empty");
    target = text;
    return {};
  });
}

Option& OptionTable::file(std::string name, std::string& target, std::string what) {
  Option& option = text(std::move(name), "FILE", target, std::move(what));
  option.kind = ValueKind::kFile;
  return option;
}

Option& OptionTable::integer(std::string name, int& target, int low, int high, std::string what) {
  return add(std::move(name), "N", std::move(what), [&target, low, high](const std::string& text) {
    return parse_count(text, static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high))
        .map([&target](std::uint64_t value) { target = static_cast<int>(value); });
  });
}

Option& OptionTable::count(std::string name, std::uint64_t& target, std::uint64_t low, std::uint64_t high,
                           std::string what) {
  return add(std::move(name), "N", std::move(what), [&target, low, high](const std::string& text) {
    return parse_count(text, low, high).map([&target](std::uint64_t value) { target = value; });
  });
}

Option& OptionTable::number(std::string name, std::string value, double& target, const Range& range, std::string what) {
  return add(std::move(name), std::move(value), std::move(what), [&target, range](const std::string& text) {
    return parse_number(text, range).map([&target](double read) { target = read; });
  });
}

Option& OptionTable::add_choice(std::string name, std::vector<std::string> words, std::string what) {
  Option& option = add(std::move(name), fmt::format("{}", fmt::join(words, "|")), std::move(what), {});
  option.kind = ValueKind::kChoice;
  option.choices = std::move(words);
  return option;
}

Result<void> OptionTable::not_a_choice(const std::string& text, const std::vector<std::string>& words) {
  const std::vector<std::string_view> known(words.begin(), words.end());
  return fail(ErrorCode::kInvalidArgument, fmt::format("takes {}, not '{}'", fmt::join(words, ", "), text),
              suggest(text, known));
}

}  // namespace limn::cli
