#pragma once
// Where the runs of an ensemble are done. One implementation runs processes of this machine; a cluster's job
// arrays would be another.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A run to be done: `scree run` on a scenario file in a folder of its own, where it leaves run/summary.json
/// and log.txt.
struct Job {
  std::string key;
  std::filesystem::path folder;  ///< holds scenario.yaml
  bool resume = false;           ///< go on with what is in folder/run
  bool keep_pile = false;        ///< leave the finished pile in folder/run
  int threads = 1;               ///< that it may use
  std::filesystem::path pile;    ///< run folder with the finished pile, to be read instead; empty: simulate
};

/// `refused`: bad input, nothing was simulated. `interrupted`: by a signal to all, as when the machine is
/// shut down.
enum class JobEnd { good, bad, refused, interrupted };

/// A run that has ended.
struct EndedJob {
  std::string key;
  JobEnd end = JobEnd::bad;
  std::string message;  ///< the last words of one that ended badly
  double wall_seconds = 0;
  bool resumed = false;     ///< Job::resume
  double share_before = 0;  ///< that was done before it was resumed
};

/// How far a run under way is, from 0 to 1.
struct ShareDone {
  double now = 0;
  double before = 0;  ///< when it was resumed
};

class Executor {
 public:
  virtual ~Executor() = default;
  /// Threads that may be started now.
  virtual int free_places() const = 0;
  virtual void start(const Job& job) = 0;
  /// A run that has ended since the last call; none when nothing has, after at most `patience` seconds.
  virtual std::optional<EndedJob> wait(double patience) = 0;
  /// Of each run under way.
  virtual std::vector<ShareDone> shares() const = 0;
  /// Ends all runs under way, which leave a checkpoint if they make any and can within half a minute, and
  /// forgets them.
  virtual void cancel() = 0;
};

/// Runs processes of the program side by side, of `places` threads in all. They die with this program,
/// however it ends.
class LocalProcesses final : public Executor {
 public:
  /// `program`: this very program, even if its file was replaced meanwhile, unless a test names another.
  /// `checkpoint_minutes`: wall time between checkpoints of a run; 0: none.
  LocalProcesses(int places, double checkpoint_minutes, std::filesystem::path program = "/proc/self/exe");
  ~LocalProcesses() override;
  int free_places() const override;
  void start(const Job& job) override;
  std::optional<EndedJob> wait(double patience) override;
  std::vector<ShareDone> shares() const override;
  void cancel() override;

 private:
  struct Process {
    Job job;
    int pid;
    double started;  // s, steady clock
  };
  std::filesystem::path program_;
  int places_;
  double checkpoint_minutes_;
  std::vector<Process> processes_;
};

}  // namespace scree
