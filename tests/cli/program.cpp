#include "cli/program.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "support/temp_folder.h"

namespace limn::test {
namespace {

struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    read_end = ends[0];
    write_end = ends[1];
  }
};

/// Reads both streams until both are closed.
void drain(int out, int err, Outcome& outcome) {
  pollfd streams[2] = {{out, POLLIN, 0}, {err, POLLIN, 0}};
  std::string* const texts[2] = {&outcome.out, &outcome.err};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (::poll(streams, 2, -1) < 0 && errno != EINTR) return;
    for (int i = 0; i < 2; ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      char buffer[65536];
      const ssize_t count = ::read(streams[i].fd, buffer, sizeof buffer);
      if (count > 0) texts[i]->append(buffer, static_cast<std::size_t>(count));
      if (count > 0 || (count < 0 && errno == EINTR)) continue;
      ::close(streams[i].fd);
      streams[i].fd = -1;
    }
  }
}

void wait_for(pid_t child, Outcome& outcome) {
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status)) outcome.exit = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
}

/// Whether a process has a handler of its own for the signal: what is sent before that would only end it.
bool catches(pid_t pid, int signal) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return ((std::stoull(line.substr(7), nullptr, 16) >> (signal - 1)) & 1u) != 0;
  }
  return false;
}

/// Runs `child` in a process of its own with its three streams redirected.
template <class Child>
Outcome run_child(int in, const Child& child, int signal = 0, int delay_ms = 0) {
  const Pipe out, err;
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::dup2(in, STDIN_FILENO);
    ::dup2(out.write_end, STDOUT_FILENO);
    ::dup2(err.write_end, STDERR_FILENO);
    child();
  }
  ::close(out.write_end);
  ::close(err.write_end);
  if (signal != 0) {
    for (int i = 0; i < 1000 && !catches(pid, signal); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    ::kill(pid, signal);
  }
  Outcome outcome;
  drain(out.read_end, err.read_end, outcome);
  wait_for(pid, outcome);
  return outcome;
}

/// A file that holds the text and is gone once closed, to be read from its start.
int text_as_input(std::string_view text) {
  if (text.empty()) return ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int fd = ::open(std::filesystem::temp_directory_path().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  EXPECT_GE(fd, 0);
  EXPECT_EQ(::write(fd, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ::lseek(fd, 0, SEEK_SET);
  return fd;
}

}  // namespace

std::filesystem::path program_folder() {
  return std::filesystem::path(LIMN_PROGRAM).parent_path();
}

void Program::become(const Arguments& arguments) const {
  std::vector<char*> words;
  for (const std::string& word : arguments)
    words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  for (const auto& [name, value] : environment)
    ::setenv(name.c_str(), value.c_str(), 1);
  if (::chdir(folder_.c_str()) == 0) ::execv(words[0], words.data());
  ::_exit(127);
}

Outcome Program::run(const Arguments& arguments, std::string_view standard_input) const {
  Arguments words{LIMN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int in = text_as_input(standard_input);
  Outcome outcome = run_child(in, [&] { become(words); });
  ::close(in);
  return outcome;
}

Outcome Program::shell(const std::string& command) const {
  const std::string path = "PATH=" + program_folder().string() + ":$PATH; ";
  const int in = text_as_input({});
  Outcome outcome = run_child(in, [&] { become({"/bin/bash", "-c", path + command}); });
  ::close(in);
  return outcome;
}

Outcome Program::run_and_signal(const Arguments& arguments, int signal, int delay_ms) const {
  Arguments words{LIMN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int in = text_as_input({});
  Outcome outcome = run_child(
      in, [&] { become(words); }, signal, delay_ms);
  ::close(in);
  return outcome;
}

Outcome Program::run_on_terminal(const Arguments& arguments) const {
  Arguments words{LIMN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  struct winsize size {};
  size.ws_col = 80;
  size.ws_row = 24;
  int master = -1, slave = -1;
  EXPECT_EQ(::openpty(&master, &slave, nullptr, nullptr, &size), 0);
  ::fcntl(master, F_SETFD, FD_CLOEXEC);
  const Pipe out;
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::dup2(out.write_end, STDOUT_FILENO);
    ::dup2(slave, STDERR_FILENO);
    ::close(slave);
    become(words);
  }
  ::close(out.write_end);
  ::close(slave);
  Outcome outcome;
  drain(out.read_end, master, outcome);
  wait_for(pid, outcome);
  return outcome;
}

nlohmann::json Program::json(Arguments arguments) const {
  arguments.emplace_back("--json");
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  nlohmann::json json = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << outcome.out;
  return json;
}

}  // namespace limn::test
