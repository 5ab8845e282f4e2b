#pragma once
// Reading tables that others made.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/material/input_bytes.h"

namespace scree {

/// Letters of a column's or a number's name that are looked at; regular expressions go as deep as a name is
/// long.
inline constexpr std::size_t kLongestName = 200;

/// A decimal number and nothing else, not infinite; with `comma`, a decimal comma is one too.
std::optional<double> number_in(std::string_view text, bool comma = false);

/// Without blanks at either end; in small letters.
std::string_view trimmed(std::string_view text);
std::string in_small_letters(std::string_view text);

/// A table with a header, row by row. Fields are separated by commas, semicolons, tabulators or, where the
/// header has none of these, blanks; a first line `sep=;`, as of Excel, says which. Semicolons or tabulators
/// allow decimal commas. A field may stand in double quotes (RFC 4180: "" is one of them, line ends are
/// allowed within). Lines that are empty, whose fields are all empty, or that begin with # are passed over;
/// line ends of Windows and a byte order mark are taken. All errors are FileError.
class DelimitedTable {
 public:
  /// Throws when the file is empty, larger than `most` bytes, no text, not UTF-8, or has no header, a column
  /// stands twice in it, or has a name longer than kLongestName.
  explicit DelimitedTable(const std::filesystem::path& file, std::uintmax_t most = kMostBytes);

  const std::vector<std::string>& header() const { return header_; }  ///< as written, without blanks around
  /// Lines with # above the header, without it, blanks around and the separators that spreadsheets put
  /// behind; the first hundred of them, their first thousand bytes.
  struct Comment {
    int line;
    std::string text;
  };
  const std::vector<Comment>& comments() const { return comments_; }
  /// Number of the column of this name, whatever its case; none if there is none.
  std::optional<std::size_t> column(std::string_view name) const;
  bool next();  ///< goes to the next row; false after the last. Throws unless it has a field a column
  const std::string& field(std::size_t column) const { return fields_[column]; }  ///< without blanks around
  /// The number in a field; none if it is empty. Throws if it is no number, and where the numbers asked
  /// for have decimal commas and decimal points for 1.210 and 1,210: either may be a thousand.
  std::optional<double> number(std::size_t column) const;
  int line() const { return row_line_; }  ///< where this row begins
  int header_line() const { return header_line_; }
  [[noreturn]] void fail(const std::string& message) const { throw FileError(file_, row_line_, message); }

 private:
  std::optional<char> read_separator();       // that of a line `sep=;`, which is passed over
  void check_mark(std::size_t column) const;  // of the number in a field
  void keep_comment(std::string_view line);
  bool read_row();
  bool go_to_text();  // to the next line that says something
  void read_field(std::string& field);
  bool at_line_end() const;
  std::filesystem::path file_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1, row_line_ = 1, header_line_ = 1;
  char separator_ = ',';  // ' ': blanks
  // Where the first number with a mark stands, and the first whose mark may separate thousands.
  struct Marked {
    struct Place {
      int line = 0;
      std::size_t column = 0;
      std::string text;
    } first, doubtful;
  };
  mutable Marked points_, commas_;  // of the numbers asked for
  std::vector<Comment> comments_;
  std::vector<std::string> header_, fields_;
  std::size_t used_ = 0;  // of fields_, in this row
};

}  // namespace scree
