#include "interrupt.h"

#include <csignal>
#include <fcntl.h>
#include <initializer_list>
#include <poll.h>
#include <unistd.h>

namespace limn::cli {
namespace {

volatile std::sig_atomic_t stopped_by = 0;
volatile std::sig_atomic_t writing = 0;

/// How long work may take to notice that it is to stop, before the program ends without it.
constexpr unsigned kPatience_s = 1;

void on_signal(int signal) {
  if (stopped_by != 0) ::_exit(128 + signal);
  stopped_by = signal;
  ::alarm(kPatience_s);
}

/// Work that does not look (a read that waits, a driver that draws) is left as it stands: only a file being written
/// must not be left half done.
void on_alarm(int) {
  if (writing != 0) {
    ::alarm(kPatience_s);
    return;
  }
  constexpr char kWords[] = "\nlimn: interrupted; nothing was written\n";
  if (::write(STDERR_FILENO, kWords, sizeof kWords - 1) < 0) ::_exit(128 + stopped_by);
  ::_exit(128 + stopped_by);
}

/// A standard stream the caller closed would be taken by the next file opened, which messages would then be written
/// into.
void occupy_standard_streams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) >= 0) continue;
    // Opened the wrong way round, so that using it fails as using a closed stream does.
    const int opened = ::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (opened >= 0 && opened != fd) ::close(opened);
  }
}

}  // namespace

void install_signal_handlers() {
  occupy_standard_streams();
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = on_alarm;
  ::sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &action, nullptr);
}

Unstoppable::Unstoppable() {
  writing = 1;
}

Unstoppable::~Unstoppable() {
  writing = 0;
}

int stop_signal() {
  return stopped_by;
}

bool stdout_closed() {
  struct pollfd state {
    STDOUT_FILENO, POLLOUT, 0
  };
  return ::poll(&state, 1, 0) > 0 && (state.revents & POLLERR) != 0;
}

}  // namespace limn::cli
