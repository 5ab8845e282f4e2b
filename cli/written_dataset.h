#pragma once
// The end of every command that writes a dataset.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// A dataset that is first written where nobody looks, and read again, so that a user gets what diagnose
/// would get: a refused one changes nothing.
class WrittenDataset {
 public:
  /// Writes into a folder that is there; returns notes. Called twice.
  using Write = std::function<std::vector<std::string>(const std::filesystem::path&)>;

  WrittenDataset(std::filesystem::path folder, Write write);

  /// What `write` throws as std::invalid_argument, and what is wrong with the dataset, goes to stderr. kOk or
  /// kBadInput.
  int check();
  /// After a check that was kOk: writes it, and says the notes and what it holds.
  void put_in_place() const;

 private:
  std::filesystem::path folder_;
  Write write_;
  std::size_t observables_ = 0;  // as checked
};

/// In words, names of observables that scree::write_dataset left out; none for none.
std::vector<std::string> note_of_left_out(const std::vector<std::string>& names);
