#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

/// What a program left behind.
struct Outcome {
  int exit = -1;    ///< exit code; -1 when a signal ended it
  int signal = 0;   ///< the signal that ended it, or 0
  std::string out;  ///< standard output
  std::string err;  ///< standard error
};

using Arguments = std::vector<std::string>;

/// Runs the built limn in child processes, within a folder.
class Program {
 public:
  explicit Program(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Variables of the child's environment, besides the test's own.
  std::map<std::string, std::string> environment;

  Outcome run(const Arguments& arguments, std::string_view standard_input = {}) const;

  /// A shell's command line, where `limn` is the built program.
  Outcome shell(const std::string& command) const;

  /// Sends a signal `delay_ms` after the program began to handle it.
  Outcome run_and_signal(const Arguments& arguments, int signal, int delay_ms) const;

  /// Runs with standard error on a terminal of 80 columns; `err` is what the terminal was sent.
  Outcome run_on_terminal(const Arguments& arguments) const;

  /// What `--json` printed; the test fails when it is not one JSON value or the exit code is not 0.
  nlohmann::json json(Arguments arguments) const;

 private:
  [[noreturn]] void become(const Arguments& arguments) const;
  std::filesystem::path folder_;
};

/// The folder the built program lies in.
std::filesystem::path program_folder();

}  // namespace limn::test
