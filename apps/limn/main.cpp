#include <exception>
#include <fmt/format.h>
#include <new>
#include <string>
#include <vector>

#include "help.h"
#include "interrupt.h"
#include "nearest.h"
#include "parse.h"
#include "verb.h"

namespace limn::cli {
namespace {

/// What a shell reports for a program that a closed pipe has ended; not an error, so nothing is said.
constexpr int kExitClosedPipe = 141;

int finish(Session& session, const Result<int>& result) {
  if (result) return *result;
  if (result.error().code == ErrorCode::kUnwritable && stdout_closed()) return kExitClosedPipe;
  if (stop_signal() != 0) {
    session.complain(Error{ErrorCode::kCancelled, "interrupted; nothing was written", {}, {}, {}});
    return 128 + stop_signal();
  }
  session.complain(result.error());
  return exit_code(result.error().code);
}

Result<int> refuse_verb(const std::string& word) {
  std::vector<std::string_view> known;
  for (const Verb& verb : verbs()) {
    if (verb.listed) known.push_back(verb.name);
  }
  if (word.starts_with('-')) {
    return fail(ErrorCode::kInvalidArgument, fmt::format("no such flag '{}'", word),
                "flags follow a verb; see limn --help");
  }
  return fail(ErrorCode::kInvalidArgument, fmt::format("no such verb '{}'", word),
              suggest(word, known) + " (limn --help lists all)");
}

int run_verb(const Verb& verb, std::span<const std::string> arguments) {
  OptionTable table;
  CommonOptions common;
  bool help = false;
  const Run run = declare(verb, table, common, help);
  const Result<void> parsed = parse(verb, table, arguments, help);
  Session session(common);
  if (!parsed) return finish(session, tl::unexpected(parsed.error()));
  if (help) return finish(session, session.print(verb_screen(verb)).map([] { return kExitDone; }));
  return finish(session, run(session));
}

int run_program(const std::vector<std::string>& arguments) {
  Session session({});
  if (arguments.empty()) {
    session.say(program_screen());
    return kExitUsage;
  }
  const std::span<const std::string> rest(arguments.begin() + 1, arguments.end());
  const std::string& word = arguments.front();
  if (word == "-h" || word == "--help") {
    return finish(session, session.print(program_screen()).map([] { return kExitDone; }));
  }
  const Verb* const verb = find_verb(word == "--version" ? "version" : word);
  return verb != nullptr ? run_verb(*verb, rest) : finish(session, refuse_verb(word));
}

/// The library throws nothing; what reaches this is the machine's memory or a fault of ours.
int run_guarded(const std::vector<std::string>& arguments) {
  Session session({});
  try {
    return run_program(arguments);
  } catch (const std::bad_alloc&) {
    session.complain(Error{ErrorCode::kUnsuitable, "out of memory", {}, {}, "use a smaller mesh or a lower level"});
    return exit_code(ErrorCode::kUnsuitable);
  } catch (const std::exception& error) {
    session.complain(Error{ErrorCode::kUnsuitable, error.what(), {}, {}, "this is a fault in limn; please report it"});
    return 1;
  }
}

}  // namespace
}  // namespace limn::cli

int main(int argc, char** argv) {
  limn::cli::install_signal_handlers();
  return limn::cli::run_guarded(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
