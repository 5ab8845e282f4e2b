#pragma once
// The program in the background, as a user starts it and a machine may end it.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

class Background {
 public:
  /// What it says is added to `log`.
  Background(std::vector<std::string> words, const std::filesystem::path& log) : child_(fork()) {
    if (child_ != 0) return;
    words.insert(words.begin(), SCREE_BINARY);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    dup2(file, STDOUT_FILENO), dup2(file, STDERR_FILENO);
    execv(arguments.front(), arguments.data());
    _exit(127);
  }

  Background(Background&& other) noexcept
      : child_(other.child_), ended_(std::exchange(other.ended_, true)), status_(other.status_) {}
  ~Background() {
    send(SIGKILL);
    code();
  }

  /// Waits until it has ended, or `there()`, and no longer than this. True if it has ended.
  template <class Condition>
  bool ended_before(Condition there, double seconds = 60) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!ended_ && !there() && std::chrono::steady_clock::now() < end) {
      ended_ = waitpid(child_, &status_, WNOHANG) == child_;
      if (!ended_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return ended_;
  }
  bool ended_within(double seconds) {
    return ended_before([] { return false; }, seconds);
  }
  void send(int signal) const {
    if (!ended_) kill(child_, signal);
  }
  /// Its exit code, when it has ended; below 0: minus the signal that ended it.
  int code() {
    if (!ended_) waitpid(child_, &status_, 0);
    ended_ = true;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }

 private:
  pid_t child_;
  bool ended_ = false;
  int status_ = 0;
};
