#include "cli/ensemble/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>

#include "analysis/run_outputs.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 0.2;      // s between reports
constexpr double kSignOfLife = 60;     // s between signs of life
constexpr double kLookAtOthers = 2.0;  // s between looks at what other programs do

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Ensemble {
 public:
  Ensemble(const std::vector<RunRequest>& runs, ResultsStore& store, Executor& executor,
           const EnsembleSettings& settings)
      : store_(store), executor_(executor), settings_(settings) {
    std::set<std::string> keys;  // the same run may stand in a sweep twice
    for (const RunRequest& run : runs)
      if (keys.insert(run.key).second) waiting_.push_back(&run);
    progress_.runs = waiting_.size();
  }
  ~Ensemble() {
    executor_.cancel();
    for (const std::string& key : under_way_) {
      try {
        store_.release(key);
      } catch (const std::exception&) {  // it is free again when this program has ended
      }
      forget_folder(key);
    }
  }
  Ensemble(const Ensemble&) = delete;
  Ensemble& operator=(const Ensemble&) = delete;

  EnsembleProgress run(const std::function<bool(const EnsembleProgress&)>& report) {
    double alive = now();
    while (true) {
      start_what_can_be();
      const auto ended = executor_.wait(waiting_.empty() && under_way_.empty() ? 0 : kPatience);
      if (ended) settle(*ended);
      if (now() - alive > kSignOfLife) {
        store_.sign_of_life();
        alive = now();
      }
      progress_.here = under_way_.size();
      progress_.others = left_to_others_.size();
      const std::vector<double> shares = executor_.shares();
      progress_.share_here =
          static_cast<double>(progress_.ended_here) + std::accumulate(shares.begin(), shares.end(), 0.0);
      if (!report(progress_)) return progress_;
      if (waiting_.empty() && under_way_.empty() && left_to_others_.empty()) return progress_;
    }
  }

 private:
  fs::path folder_of(const std::string& key) const {
    return fs::path(store_.file().string() + ".work") / key;
  }
  void forget_folder(const std::string& key) const {
    std::error_code ignored;
    fs::remove_all(folder_of(key), ignored);
    fs::remove(folder_of(key).parent_path(), ignored);  // if it is empty
  }

  void start_what_can_be() {
    if (waiting_.empty() && !left_to_others_.empty() && now() - looked_ > kLookAtOthers) {
      waiting_.swap(left_to_others_);
      looked_ = now();
    }
    while (!waiting_.empty() && executor_.free_places() > 0) {
      const RunRequest& run = *waiting_.front();
      waiting_.erase(waiting_.begin());
      switch (store_.claim(run, settings_.version, settings_.again && !tried_.contains(run.key))) {
        case Claim::done:
          ++progress_.done;
          break;
        case Claim::failed:
          ++progress_.failed;
          break;
        case Claim::others:
          left_to_others_.push_back(&run);
          break;
        case Claim::ours:
          start(run);
          break;
      }
    }
  }

  void start(const RunRequest& run) {
    under_way_.insert(run.key);
    tried_.insert(run.key);
    const fs::path folder = folder_of(run.key);
    std::error_code error;
    fs::remove_all(folder, error);  // of one that was killed
    fs::create_directories(folder, error);
    if (error) fail_to_write(folder, error.message());
    write_text_file(folder / "scenario.yaml", run.scenario);
    executor_.start({run.key, folder});
  }

  void settle(const EndedJob& ended) {
    under_way_.erase(ended.key);
    ++progress_.ended_here;
    std::string failure = ended.message, text;
    std::map<std::string, double> outputs;
    if (ended.good) {
      try {
        std::ifstream in(folder_of(ended.key) / "run" / "summary.json");
        std::ostringstream summary;
        summary << in.rdbuf();
        text = summary.str();
        outputs = run_outputs(text);
      } catch (const std::runtime_error& error) {
        failure = error.what();
      }
    }
    if (failure.empty()) {
      store_.finish(ended.key, text, outputs, ended.wall_seconds);
      ++progress_.done;
    } else {
      store_.fail(ended.key, failure, ended.wall_seconds);
      ++progress_.failed;
    }
    forget_folder(ended.key);
  }

  ResultsStore& store_;
  Executor& executor_;
  EnsembleSettings settings_;
  std::vector<const RunRequest*> waiting_, left_to_others_;
  std::set<std::string> under_way_, tried_;
  double looked_ = 0;
  EnsembleProgress progress_;
};

}  // namespace

EnsembleProgress run_ensemble(const std::vector<RunRequest>& runs, ResultsStore& store, Executor& executor,
                              const EnsembleSettings& settings,
                              const std::function<bool(const EnsembleProgress&)>& report) {
  return Ensemble(runs, store, executor, settings).run(report);
}

}  // namespace scree
