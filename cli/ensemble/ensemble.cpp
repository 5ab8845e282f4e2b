#include "cli/ensemble/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "analysis/results/summary.h"
#include "sim/io/checkpoint_file.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 0.2;      // s between reports
constexpr double kSignOfLife = 60;     // s between signs of life
constexpr double kLookAtOthers = 2.0;  // s between looks at what other programs do
constexpr int kMostInterruptions = 3;  // of one run alone, by a signal from outside

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
    // What is known already is counted first, so that the time left is that of the rest.
    std::erase_if(waiting_, [&](const RunRequest* run) {
      const auto known = store_.find(run->key);
      const bool failed = known && known->state == RunState::failed && !settings_.again;
      if (failed) ++progress_.failed;
      const bool done = known && known->state == RunState::done;
      if (done) known_done(run->key);
      return failed || done;
    });
    std::error_code none;  // of one that was interrupted or killed
    for (const auto& entry : fs::directory_iterator(piles_folder(), none))
      piles_.insert(entry.path().filename().string());
  }
  ~Ensemble() {
    executor_.cancel();
    for (const auto& [key, run] : under_way_) {
      if (!has_checkpoint(key)) forget_folder(key);  // before another program may claim it and make its own
      try {
        store_.release(key);
      } catch (const std::exception&) {  // it is free again when this program has ended
      }
    }
    std::error_code ignored;
    if (idle())
      for (const std::string& pile : piles_) fs::remove_all(piles_folder() / pile, ignored);
    fs::remove(piles_folder(), ignored);  // if no other program keeps any there
    fs::remove(work_folder(), ignored);   // if nobody works in it
  }
  Ensemble(const Ensemble&) = delete;
  Ensemble& operator=(const Ensemble&) = delete;

  EnsembleProgress run(const std::function<bool(const EnsembleProgress&)>& report) {
    double alive = now();
    while (true) {
      start_what_can_be();
      const auto ended = executor_.wait(idle() ? 0 : kPatience);
      if (ended) settle(*ended);
      if (now() - alive > kSignOfLife) {
        store_.sign_of_life();
        alive = now();
      }
      progress_.here = under_way_.size();
      progress_.others = left_to_others_.size();
      progress_.share_under_way = 0;
      progress_.work_here = ended_work_;
      for (const ShareDone& share : executor_.shares()) {
        progress_.share_under_way += share.now;
        progress_.work_here += share.now - share.before;
      }
      if (!report(progress_)) return progress_;
      if (idle()) return progress_;
    }
  }

 private:
  bool idle() const { return waiting_.empty() && under_way_.empty() && left_to_others_.empty(); }
  fs::path work_folder() const { return store_.file().string() + ".work"; }
  fs::path folder_of(const std::string& key) const { return work_folder() / key; }
  // Piles that runs still waiting can read are kept in run folders by their hash.
  fs::path piles_folder() const { return work_folder() / "piles"; }
  fs::path pile_of(const RunRequest& run) const { return piles_folder() / run.pile; }
  void forget_folder(const std::string& key) const {
    std::error_code ignored;
    fs::remove_all(folder_of(key), ignored);
  }

  // Its result is in the store; a program killed right after it was put there has left the folder.
  void known_done(const std::string& key) {
    ++progress_.done;
    forget_folder(key);
  }

  // Whether a run of this key, killed or interrupted, got as far as a checkpoint.
  bool has_checkpoint(const std::string& key) const {
    std::error_code none;
    for (const auto& entry : fs::recursive_directory_iterator(folder_of(key) / "run", none))
      if (entry.path().filename().string().starts_with(kCheckpointName)) return true;
    return false;
  }

  void start_what_can_be() {
    if (waiting_.empty() && !left_to_others_.empty() && now() - looked_ > kLookAtOthers) {
      waiting_.swap(left_to_others_);
      looked_ = now();
    }
    while (executor_.free_places() > 0) {
      const auto next = next_to_start();
      if (next == waiting_.end()) return;
      const RunRequest& run = **next;
      waiting_.erase(next);
      switch (store_.claim(run, settings_.version, settings_.again && !tried_.contains(run.key))) {
        case Claim::done:
          known_done(run.key);
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

  // One whose pile is there, so that readings follow their simulation; else the first whose pile is not just
  // being made.
  std::vector<const RunRequest*>::iterator next_to_start() {
    const auto read = std::find_if(waiting_.begin(), waiting_.end(),
                                   [&](const RunRequest* run) { return piles_.contains(run->pile); });
    if (read != waiting_.end()) return read;
    return std::find_if(waiting_.begin(), waiting_.end(), [&](const RunRequest* run) {
      return run->pile.empty() || std::none_of(under_way_.begin(), under_way_.end(), [&](const auto& other) {
               return other.second->pile == run->pile;
             });
    });
  }

  // Whether another run, to come or under way, can read the pile of this one.
  bool shares_pile(const RunRequest& run) const {
    const auto same = [&](const RunRequest* other) { return other != &run && other->pile == run.pile; };
    return !run.pile.empty() &&
           (std::any_of(waiting_.begin(), waiting_.end(), same) ||
            std::any_of(left_to_others_.begin(), left_to_others_.end(), same) ||
            std::any_of(under_way_.begin(), under_way_.end(), [&](const auto& o) { return same(o.second); }));
  }

  // Puts a run's pile where others find it, and takes away one that nobody will read.
  void sort_piles(const RunRequest& run) {
    std::error_code error;
    const fs::path kept = seed_folder(pile_of(run), run.seed) / kPileName,
                   fresh = seed_folder(folder_of(run.key) / "run", run.seed) / kPileName;
    if (!shares_pile(run)) {
      if (piles_.erase(run.pile) > 0) fs::remove_all(pile_of(run), error);
      return;
    }
    if (!fs::exists(fresh, error)) return;
    fs::create_directories(kept.parent_path(), error);
    fs::rename(fresh, kept, error);
    if (!error) piles_.insert(run.pile);
  }

  void start(const RunRequest& run) {
    under_way_[run.key] = &run;
    tried_.insert(run.key);
    const fs::path folder = folder_of(run.key);
    const bool read = piles_.contains(run.pile), keep = !read && shares_pile(run);
    const int still = static_cast<int>(waiting_.size()) + 1,
              threads = read ? 1 : std::max(1, executor_.free_places() / still);
    if (!read && has_checkpoint(run.key) && !refused_.contains(run.key))
      return executor_.start({run.key, folder, true, keep, threads, {}});
    std::error_code error;
    fs::remove_all(folder, error);  // of one that was killed
    // Another program that has just ended may take the empty parent away in between.
    for (int k = 0; k < 3 && !fs::create_directories(folder, error) && error; ++k) {
    }
    if (error) fail_to_write(folder, error.message());
    write_text_file(folder / "scenario.yaml", run.scenario);
    if (read) reading_.insert(run.key);
    executor_.start({run.key, folder, false, keep, threads, read ? pile_of(run) : fs::path()});
  }

  void settle(const EndedJob& ended) {
    const RunRequest* request = under_way_.at(ended.key);
    under_way_.erase(ended.key);
    const bool was_reading = reading_.erase(ended.key) > 0;
    std::string failure = ended.message, text;
    std::map<std::string, double> outputs;
    double seconds = ended.wall_seconds;
    if (ended.end == JobEnd::good) {
      try {
        std::ifstream in(folder_of(ended.key) / "run" / "summary.json");
        std::ostringstream summary;
        summary << in.rdbuf();
        text = summary.str();
        StoredRun run = parse_summary(text);
        if (run.outputs.size() != 1) throw std::runtime_error("a summary of one seed is expected");
        outputs = std::move(run.outputs.front());
        if (ended.resumed) seconds = std::max(seconds, run.wall_seconds.front());
      } catch (const std::runtime_error& error) {
        failure = error.what();
      }
    }
    if (ended.end == JobEnd::refused && was_reading) {  // a pile that was damaged: it is made anew
      std::error_code ignored;
      piles_.erase(request->pile);
      fs::remove_all(pile_of(*request), ignored);
      forget_folder(ended.key);
      store_.release(ended.key);
      waiting_.insert(waiting_.begin(), request);
      return;
    }
    if (ended.end == JobEnd::refused && ended.resumed) {
      // Of another version of the program, or of another run: it begins anew.
      refused_.insert(ended.key);
      ++progress_.begun_anew;
      progress_.why_anew = ended.message;
      forget_folder(ended.key);
      store_.release(ended.key);
      waiting_.insert(waiting_.begin(), request);
      return;
    }
    // A run that was killed or lacked memory or disk has left its checkpoint, one that blew up has not.
    const bool may_go_on = ended.end != JobEnd::good && has_checkpoint(ended.key);
    if (ended.end == JobEnd::interrupted) {
      // By a signal to all, which ends the loop as well, or to this run alone: then it is done again.
      if (++interrupted_[ended.key] < kMostInterruptions) {
        if (!may_go_on) forget_folder(ended.key);
        store_.release(ended.key);
        waiting_.push_back(request);
        return;
      }
      failure =
          fmt::format("{} {} times", failure.empty() ? "interrupted" : failure + ",", kMostInterruptions);
    }
    sort_piles(*request);
    const bool ours = failure.empty() ? store_.finish(ended.key, text, outputs, seconds)
                                      : store_.fail(ended.key, failure, seconds);
    if (!ours) {  // it was taken for dead, and another program does the run now
      left_to_others_.push_back(request);
      return;
    }
    if (!may_go_on) forget_folder(ended.key);
    ++progress_.ended_here;
    ended_work_ += 1 - ended.share_before;
    failure.empty() ? ++progress_.done : ++progress_.failed;
  }

  ResultsStore& store_;
  Executor& executor_;
  EnsembleSettings settings_;
  std::vector<const RunRequest*> waiting_, left_to_others_;
  std::map<std::string, const RunRequest*> under_way_;
  std::map<std::string, int> interrupted_;           // how often, by key
  std::set<std::string> tried_, refused_, reading_;  // keys
  std::set<std::string> piles_;                      // that are there
  double looked_ = 0, ended_work_ = 0;
  EnsembleProgress progress_;
};

}  // namespace

EnsembleProgress run_ensemble(const std::vector<RunRequest>& runs, ResultsStore& store, Executor& executor,
                              const EnsembleSettings& settings,
                              const std::function<bool(const EnsembleProgress&)>& report) {
  return Ensemble(runs, store, executor, settings).run(report);
}

}  // namespace scree
