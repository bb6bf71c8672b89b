#include "session.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <unistd.h>

#include "limn/base/file.h"

#include "interrupt.h"

namespace limn::cli {
namespace {

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool smart_terminal() {
  const char* const kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::string_view(kind) != "dumb");
}

void put_line(std::string line) {
  line += '\n';
  std::string_view rest = line;
  while (!rest.empty()) {
    const ssize_t count = ::write(STDERR_FILENO, rest.data(), rest.size());
    if (count <= 0) return;
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return kExitUsage;
    case ErrorCode::kUnreadable:
      return 3;
    case ErrorCode::kUnwritable:
      return 3;
    case ErrorCode::kUnsuitable:
      return 4;
    case ErrorCode::kNoGraphics:
      return 6;
    case ErrorCode::kCancelled:
      return 130;
  }
  return kExitUsage;
}

Session::Session(const CommonOptions& options) : options_(options), bar_(smart_terminal() && !options.quiet) {
  if (options.threads > 0) threads_ = std::make_unique<ThreadLimit>(options.threads);
}

void Session::say(std::string_view line) {
  if (options_.quiet) return;
  bar_.clear();
  put_line(std::string(line));
}

void Session::complain(const Error& error) {
  bar_.clear();
  const bool colored = smart_terminal() && !is_set("NO_COLOR");
  put_line((colored ? "\x1b[1;31mlimn:\x1b[0m " : "limn: ") + format_error(error));
}

Result<void> Session::print(std::string_view data) {
  bar_.clear();
  return write_file("-", data);
}

Result<void> Session::print_json(const nlohmann::ordered_json& data) {
  // File names need not be UTF-8; what is not becomes U+FFFD rather than an exception.
  return print(data.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

Progress Session::progress() {
  return [this](std::string_view stage, double done) {
    bar_.update(stage, done);
    return stop_signal() == 0;
  };
}

Progress Session::silent_progress() const {
  return [](std::string_view, double) { return stop_signal() == 0; };
}

Result<void> Session::check_stop() const {
  if (stop_signal() != 0) return fail(ErrorCode::kCancelled, "interrupted");
  return {};
}

}  // namespace limn::cli
