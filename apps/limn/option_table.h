#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limn/base/result.h"

#include "parse_value.h"

namespace limn::cli {

/// Where an option stands in help pages. Later groups are the first to be shortened when a page would not fit a screen.
enum class Group { kArguments, kOwn, kPage, kFiles, kCamera, kLevels, kCommon };
std::string_view group_title(Group group);

/// What completion offers for a value.
enum class ValueKind { kFree, kFile, kChoice };

/// One argument or flag of a verb: how it is written, what it means, and where its value goes.
struct Option {
  std::string short_name;  ///< "-o"; may be empty
  std::string name;        ///< "--output", or "MODEL" for an argument without a flag
  std::string value;       ///< what its value is called ("FILE"); empty for a switch
  std::string what;        ///< one short line
  Group group = Group::kOwn;
  ValueKind kind = ValueKind::kFree;
  std::vector<std::string> choices;  ///< kChoice
  bool required = false;
  bool repeatable = false;
  std::function<Result<void>(const std::string& text)> set;

  bool positional() const { return !name.starts_with('-'); }
  bool is_switch() const { return value.empty() && !positional(); }
  /// "-o, --output FILE", "--json", "MODEL".
  std::string spelled() const;
};

/// The options of one verb, in the order of its help page: parsing, help, completion and man pages are made from it.
/// The references given to the functions below must outlive the table.
class OptionTable {
 public:
  const std::vector<Option>& options() const { return options_; }

  /// Options added from now on belong to this group.
  void begin(Group group) { group_ = group; }

  Option& argument(std::string name, std::string& target, std::string what, ValueKind kind = ValueKind::kFile);
  Option& toggle(std::string name, bool& target, std::string what);
  Option& text(std::string name, std::string value, std::string& target, std::string what);
  Option& file(std::string name, std::string& target, std::string what);
  Option& integer(std::string name, int& target, int low, int high, std::string what);
  Option& count(std::string name, std::uint64_t& target, std::uint64_t low, std::uint64_t high, std::string what);
  Option& number(std::string name, std::string value, double& target, const Range& range, std::string what);

  /// A value read by one of the parse_… functions.
  template <class T, class Target>
  Option& parsed(std::string name, std::string value, Target& target, Result<T> (*parse)(std::string_view),
                 std::string what) {
    return add(std::move(name), std::move(value), std::move(what), [&target, parse](const std::string& text) {
      return parse(text).map([&target](const T& read) { target = read; });
    });
  }

  /// One of a few words.
  template <class T>
  Option& choice(std::string name, T& target, std::initializer_list<std::pair<std::string_view, T>> words,
                 std::string what) {
    return choice(std::move(name), target, std::span(words.begin(), words.size()), std::move(what));
  }
  template <class T>
  Option& choice(std::string name, T& target, std::span<const std::pair<std::string_view, T>> words, std::string what) {
    std::vector<std::pair<std::string, T>> table(words.begin(), words.end());
    std::vector<std::string> names;
    for (const auto& word : table)
      names.push_back(word.first);
    Option& option = add_choice(std::move(name), names, std::move(what));
    option.set = [&target, table, names](const std::string& text) -> Result<void> {
      for (const auto& [word, value] : table) {
        if (word != text) continue;
        target = value;
        return {};
      }
      return not_a_choice(text, names);
    };
    return option;
  }

 private:
  Option& add(std::string name, std::string value, std::string what,
              std::function<Result<void>(const std::string&)> set);
  Option& add_choice(std::string name, std::vector<std::string> words, std::string what);
  static Result<void> not_a_choice(const std::string& text, const std::vector<std::string>& words);

  std::vector<Option> options_;
  Group group_ = Group::kOwn;
};

}  // namespace limn::cli
