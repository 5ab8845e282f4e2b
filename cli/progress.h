#pragma once
// Progress of several seeds at once: a bar with time left on a terminal, plain lines elsewhere.
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "sim/scene/run.h"

namespace scree {

class ProgressDisplay {
 public:
  explicit ProgressDisplay(std::vector<std::uint64_t> seeds);
  /// Called from any thread.
  void update(std::size_t seed_index, const RunProgress& progress);
  /// Prints a line of its own. Called from any thread.
  void say(const std::string& text);
  /// Ends the bar's line.
  void finish();

 private:
  void draw(bool last);
  std::vector<std::uint64_t> seeds_;
  std::vector<RunProgress> progress_;
  // What was done of a seed that goes on; a share below 0: not known yet.
  struct Before {
    double share = -1, steps = 0;
  };
  std::vector<Before> before_;
  std::chrono::steady_clock::time_point start_, drawn_;
  bool terminal_;
  bool line_open_ = false;
  std::mutex mutex_;
};

/// "1 min 20 s"
std::string spell_duration(double seconds);

}  // namespace scree
