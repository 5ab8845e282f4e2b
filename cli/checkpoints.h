#pragma once
// The checkpoints of one seed, in its folder: the last two, its outcome when it has come to its end, and that
// again as a pile that other runs may read.
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "sim/io/checkpoint_file.h"

class Checkpoints {
 public:
  /// `minutes` of wall time between checkpoints; 0: none are made.
  Checkpoints(std::filesystem::path folder, scree::CheckpointHeader header, double minutes);

  /// The newest checkpoint that is whole, or the outcome of the finished seed (`finished`); null if there is
  /// none. `warn` hears of those that are damaged; they are taken away. Throws std::runtime_error with what
  /// to do when one is of another program or scenario.
  std::unique_ptr<scree::CheckpointReader> newest(const std::function<void(const std::string&)>& warn) const;
  std::unique_ptr<scree::CheckpointReader> finished(
      const std::function<void(const std::string&)>& warn) const;

  bool on() const { return minutes_ > 0; }
  /// The time for another has come.
  bool due() const;
  /// Makes one and takes the oldest of three away. Throws std::runtime_error; those that are there stay.
  void save(double time, const std::function<void(scree::StateWriter&)>& state);
  /// Keeps the outcome of the seed instead of its checkpoints.
  void finish(double time, const std::function<void(scree::StateWriter&)>& outcome);

  /// Keeps the outcome of the seed for runs of the same `pile` (RunRequest).
  void keep_pile(const std::string& pile, double time,
                 const std::function<void(scree::StateWriter&)>& outcome) const;
  /// What another run kept for this seed in this folder. Throws StateError: it is not there, damaged, or of
  /// another program, pile or seed.
  std::unique_ptr<scree::CheckpointReader> pile(const std::string& pile) const;

  /// Takes all of them away, but for the pile.
  static void remove_from(const std::filesystem::path& folder);
  static void remove_pile_from(const std::filesystem::path& folder);

 private:
  std::unique_ptr<scree::CheckpointReader> open(const std::filesystem::path& file,
                                                const std::function<void(const std::string&)>& warn) const;

  std::filesystem::path folder_;
  scree::CheckpointHeader header_;
  double minutes_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};
