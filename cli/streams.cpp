#include "cli/streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "cli/ensemble/exit_code.h"

namespace {

int stdout_error = 0;  // errno of what was lost there

// Writes what can be written: what is said is no reason to end a run.
ssize_t say_if_possible(int number, const char* text, size_t size) {
  for (size_t done = 0; done < size;) {
    const ssize_t now = write(number, text + done, size - done);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) {
      if (number == STDOUT_FILENO && stdout_error == 0) stdout_error = errno;
      break;
    }
    done += static_cast<size_t>(now);
  }
  return static_cast<ssize_t>(size);
}

}  // namespace

void make_streams_safe() {
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number)
    if (fcntl(number, F_GETFD) == -1 && open("/dev/null", O_RDWR) < 0) return;
  signal(SIGPIPE, SIG_IGN);
#ifdef __GLIBC__
  const auto say = [](void*, const char* text, size_t size) {
    return say_if_possible(STDOUT_FILENO, text, size);
  };
  const auto tell = [](void*, const char* text, size_t size) {
    return say_if_possible(STDERR_FILENO, text, size);
  };
  if (FILE* safe = fopencookie(nullptr, "w", {nullptr, say, nullptr, nullptr})) {
    setvbuf(safe, nullptr, _IOLBF, BUFSIZ);
    stdout = safe;
  }
  if (FILE* safe = fopencookie(nullptr, "w", {nullptr, tell, nullptr, nullptr})) {
    setvbuf(safe, nullptr, _IONBF, 0);
    stderr = safe;
  }
#endif
}

int with_all_said(int code) {
  errno = 0;
  if (std::fflush(stdout) != 0 && stdout_error == 0) stdout_error = errno;
  if (stdout_error == 0 || stdout_error == EPIPE) return code;
  fmt::print(stderr, "scree: cannot write to the standard output: {}\n", std::strerror(stdout_error));
  return code == kOk ? kFailed : code;
}
