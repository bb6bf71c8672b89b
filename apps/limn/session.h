#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "limn/base/parallel.h"
#include "limn/base/progress.h"
#include "limn/base/result.h"

#include "progress_bar.h"

namespace limn::cli {

/// What a verb ends with (docs/command-line.md).
inline constexpr int kExitDone = 0;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitGateFailed = 5;
int exit_code(ErrorCode code);

/// The options every verb takes.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  int threads = 0;  ///< 0: as many as the machine has
};

/// How a running verb talks: data to standard output, everything else to standard error.
class Session {
 public:
  explicit Session(const CommonOptions& options);

  bool json() const { return options_.json; }

  /// A remark on standard error, one line; not when quiet.
  void say(std::string_view line);
  /// An error on standard error, after "limn: ".
  void complain(const Error& error);

  /// Data on standard output. Errors: kUnwritable.
  Result<void> print(std::string_view data);
  Result<void> print_json(const nlohmann::ordered_json& data);

  /// Draws the bar, and asks the work to stop once a signal has arrived. Valid while the session lives.
  Progress progress();
  /// As progress(), without the bar: for work that is one step of a longer one.
  Progress silent_progress() const;
  /// Whether a signal has arrived: kCancelled. For the gaps between stages that report no progress.
  Result<void> check_stop() const;

 private:
  CommonOptions options_;
  ProgressBar bar_;
  std::unique_ptr<ThreadLimit> threads_;
};

}  // namespace limn::cli
