#pragma once
// A table of reference data: its columns are known beforehand.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/material/input_text.h"

namespace scree {

/// A DelimitedTable whose header is known, field by field by the name of its column. All errors are FileError.
class CsvTable {
 public:
  /// Throws if the file cannot be read, is no text or its header is not `columns`.
  CsvTable(const std::filesystem::path& file, const std::vector<std::string>& columns);

  bool next() { return table_.next(); }  ///< goes to the next row; false after the last
  /// Fields of this row by the name of their column; throw if they are empty or not what they should be.
  const std::string& text(const std::string& column) const;
  const std::string& one_of(const std::string& column, const std::vector<std::string>& allowed) const;
  double number(const std::string& column) const;
  std::optional<double> optional_number(const std::string& column) const;  ///< none if empty
  [[noreturn]] void fail(const std::string& what) const { table_.fail(what); }

 private:
  std::size_t at(const std::string& column) const;
  DelimitedTable table_;
};

}  // namespace scree
