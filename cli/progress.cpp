#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scree {
namespace {
constexpr double kTerminalInterval = 0.2, kPlainInterval = 15.0;  // s between drawings
}

std::string spell_duration(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

ProgressDisplay::ProgressDisplay(std::vector<std::uint64_t> seeds)
    : seeds_(std::move(seeds)),
      progress_(seeds_.size()),
      before_(seeds_.size()),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_),
      terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressDisplay::update(std::size_t seed_index, const RunProgress& progress) {
  const std::lock_guard lock(mutex_);
  progress_[seed_index] = progress;
  if (before_[seed_index].share < 0) before_[seed_index] = {progress.share, progress.particle_steps};
  const auto now = std::chrono::steady_clock::now();
  if (std::chrono::duration<double>(now - drawn_).count() < (terminal_ ? kTerminalInterval : kPlainInterval))
    return;
  drawn_ = now;
  draw(false);
}

void ProgressDisplay::draw(bool last) {
  double share = 0, before = 0, steps = 0;
  const RunProgress* shown = &progress_.front();
  for (const RunProgress& p : progress_) {
    share += p.share / static_cast<double>(progress_.size());
    steps += p.particle_steps;
    if (p.share > 0 && p.share < 1 && (shown->share == 0 || shown->share >= 1)) shown = &p;
  }
  for (const Before& first : before_) {
    before += std::max(first.share, 0.0) / static_cast<double>(seeds_.size());
    steps -= first.steps;
  }
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string left = share - before > 0.02
                               ? "about " + spell_duration(elapsed * (1 - share) / (share - before)) + " left"
                               : "estimating";
  std::string where = shown->dumps > 1
                          ? fmt::format("load {} of {}, {}", shown->dump, shown->dumps, shown->stage)
                          : shown->stage;
  if (seeds_.size() > 1)
    where += fmt::format(", seed {}", seeds_[static_cast<std::size_t>(shown - progress_.data())]);
  const std::string text = fmt::format("{:3.0f} %  {}  {}  t = {:.1f} s  {} spheres  {:.1f} M steps/s",
                                       100 * share, last ? spell_duration(elapsed) : left, where, shown->time,
                                       shown->particles, steps / std::max(elapsed, 1e-3) / 1e6);
  if (terminal_) {
    const int full = static_cast<int>(20 * share);
    fmt::print(stderr, "\r\033[K[{}{}] {}", std::string(full, '#'), std::string(20 - full, '.'), text);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void ProgressDisplay::say(const std::string& text) {
  const std::lock_guard lock(mutex_);
  fmt::print(stderr, "{}{}\n", line_open_ ? "\r\033[K" : "", text);
  line_open_ = false;
}

void ProgressDisplay::finish() {
  const std::lock_guard lock(mutex_);
  if (terminal_) draw(true);
  if (line_open_) fmt::print(stderr, "\n");
  line_open_ = false;
}

}  // namespace scree
