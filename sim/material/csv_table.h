#pragma once
// A table of reference data: commas, a header that is known beforehand, no quoting.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/material/input_bytes.h"

namespace scree {

/// Reads a CSV file row by row. Lines that are empty or begin with # are passed over. All errors are
/// FileError.
class CsvTable {
 public:
  /// Throws if the file cannot be read, is no text or its header is not `columns`.
  CsvTable(const std::filesystem::path& file, std::vector<std::string> columns);

  bool next();  ///< goes to the next row; false after the last
  /// Fields of this row by the name of their column; throw if they are empty or not what they should be.
  const std::string& text(const std::string& column) const;
  const std::string& one_of(const std::string& column, const std::vector<std::string>& allowed) const;
  double number(const std::string& column) const;
  std::optional<double> optional_number(const std::string& column) const;  ///< none if empty
  [[noreturn]] void fail(const std::string& what) const;

 private:
  bool next_line(std::string& line);
  const std::string& field(const std::string& column) const;
  std::filesystem::path file_;
  std::string text_;
  std::size_t at_ = 0;
  int line_number_ = 0;
  std::vector<std::string> columns_, fields_;
};

}  // namespace scree
