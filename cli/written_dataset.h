#pragma once
// The end of every command that writes a dataset.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// A dataset that is written beside its folder, read again, so that a user gets what diagnose would get, and
/// moved in only if it is good: a refused one changes nothing. What was not moved goes with this object.
class WrittenDataset {
 public:
  /// `folder`: `out` or one in it.
  WrittenDataset(std::filesystem::path out, std::filesystem::path folder);
  ~WrittenDataset();
  WrittenDataset(const WrittenDataset&) = delete;
  WrittenDataset& operator=(const WrittenDataset&) = delete;

  /// Calls `write` with a folder that is there; it returns notes. What it throws as std::invalid_argument,
  /// and what is wrong with the dataset, goes to stderr. kOk or kBadInput.
  int write(const std::function<std::vector<std::string>(const std::filesystem::path&)>& write);
  /// Moves it to its folder, and says the notes and what the dataset holds.
  void put_in_place();

 private:
  std::filesystem::path folder_, beside_, written_;
  std::vector<std::string> notes_;
  std::size_t observables_ = 0;
};

/// In words, names of observables that scree::write_dataset left out; none for none.
std::vector<std::string> note_of_left_out(const std::vector<std::string>& names);
