#pragma once

#include <array>
#include <functional>
#include <span>
#include <string_view>

#include "option_table.h"
#include "session.h"

namespace limn::cli {

/// A command that works as it stands, where the files named by example_files() lie. The tests run every one.
struct Example {
  std::string_view command;
  std::string_view what;
};

/// What a verb does once its options are read; gives the exit code.
using Run = std::function<Result<int>(Session&)>;

/// One subcommand. Each is defined in a file of its own, cmd_NAME.cpp.
struct Verb {
  std::string_view name;
  std::string_view summary;  ///< what it does, one clause
  std::string_view usage;    ///< its arguments, for the usage line
  bool listed = true;        ///< named in help and completion
  std::array<Example, 3> examples;
  /// Adds the verb's options to the table and gives what runs once they are set.
  Run (*declare)(OptionTable& table);
};

/// All verbs, in the order of the help page.
std::span<const Verb> verbs();
/// nullptr when there is none of that name.
const Verb* find_verb(std::string_view name);

/// How the files that examples use are made, before them.
std::span<const std::string_view> example_files();

/// The verb's whole table, the common options and -h included. \param common where the common options go
Run declare(const Verb& verb, OptionTable& table, CommonOptions& common, bool& help);

Verb demo_verb();
Verb info_verb();
Verb make_verb();
Verb refine_verb();
Verb hull_verb();
Verb clip_verb();
Verb render_verb();
Verb silhouette_verb();
Verb bake_verb();
Verb compare_verb();
Verb help_verb();
Verb version_verb();
Verb completion_verb();
Verb man_verb();

}  // namespace limn::cli
