#include "sim/material/input_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace scree {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::string in_quotes(std::string_view text) {
  return fmt::format("'{}{}'", text.substr(0, 40), text.size() > 40 ? "..." : "");
}

// 1.210, or 1,210: a thousand or a fraction. 0.210 can only be a fraction.
bool may_be_a_thousand(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  const auto mark = text.find_first_of(".,");
  return mark >= 1 && mark <= 3 && text.size() == mark + 4 && text.front() != '0' &&
         std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }) ==
             static_cast<std::ptrdiff_t>(text.size()) - 1;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string in_small_letters(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::optional<double> number_in(std::string_view text, bool comma) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  std::string with_point;
  if (comma && text.find(',') != std::string_view::npos) {
    if (text.find('.') != std::string_view::npos) return std::nullopt;  // 1.234,5: either may be meant
    with_point = text;
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    text = with_point;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

DelimitedTable::DelimitedTable(const std::filesystem::path& file, std::uintmax_t most)
    : file_(file), text_(read_input_text(file, most)) {
  if (const int line = line_that_is_not_utf8(text_))
    throw FileError(file, line, "is not UTF-8; save it as CSV UTF-8");
  const std::optional<char> stated = read_separator();
  const std::size_t start = at_;
  const int start_line = line_;
  // Else the separator is the header's; read it once to see which.
  separator_ = '\n';
  if (!read_row()) throw FileError(file, 0, "the file has no header");
  const std::string head = fields_.front();
  for (const char candidate : {';', '\t', ',', ' '}) {
    separator_ = candidate;
    if (candidate == ' ' || head.find(candidate) != std::string::npos) break;
  }
  if (separator_ == ' ' && trimmed(head).find(' ') == std::string_view::npos) separator_ = ',';  // one column
  separator_ = stated.value_or(separator_);
  at_ = start, line_ = start_line;
  comments_.clear();
  if (!read_row()) throw FileError(file, 0, "the file has no header");
  header_line_ = row_line_;
  header_.assign(fields_.begin(), fields_.begin() + static_cast<std::ptrdiff_t>(used_));
  for (std::size_t k = 0; k < header_.size(); ++k) {
    if (header_[k].size() > kLongestName)
      fail(fmt::format("the column {} has a name of {} letters; {} are allowed", in_quotes(header_[k]),
                       header_[k].size(), kLongestName));
    if (!header_[k].empty() && column(header_[k]) != k)
      fail(fmt::format("the column {} stands twice in the header", in_quotes(header_[k])));
  }
}

std::optional<std::size_t> DelimitedTable::column(std::string_view name) const {
  const std::string wanted = in_small_letters(name);
  for (std::size_t k = 0; k < header_.size(); ++k)
    if (in_small_letters(header_[k]) == wanted) return k;
  return std::nullopt;
}

bool DelimitedTable::next() {
  if (!read_row()) return false;
  // Blanks after a last separator, as spreadsheets leave them.
  while (used_ > header_.size() && fields_[used_ - 1].empty()) --used_;
  if (used_ != header_.size())
    fail(fmt::format("{} fields, but the header has {}{}", used_, header_.size(),
                     separator_ == ',' && used_ > header_.size()
                         ? "; where commas are decimal, separate fields by semicolons"
                         : ""));
  return true;
}

std::optional<double> DelimitedTable::number(std::size_t column) const {
  const std::string& text = fields_[column];
  if (text.empty()) return std::nullopt;
  const bool commas = separator_ == ';' || separator_ == '\t';
  if (const auto value = number_in(text, commas)) {
    if (commas) check_mark(column);
    return value;
  }
  const std::string word = in_small_letters(text);
  if (word == "nan" || word == "inf" || word == "-inf" || word == "infinity" || word == "-nan")
    fail(fmt::format("{}: {} is not finite", header_[column], text));
  fail(fmt::format("{}: {} is no number", header_[column], in_quotes(text)));
}

void DelimitedTable::check_mark(std::size_t column) const {
  const std::string& text = fields_[column];
  const auto at = text.find_first_of(".,");
  if (at == std::string::npos) return;
  Marked& own = text[at] == ',' ? commas_ : points_;
  if (own.first.line == 0) own.first = {row_line_, column, text};
  if (own.doubtful.line == 0 && may_be_a_thousand(text)) own.doubtful = {row_line_, column, text};
  for (const auto& [marked, other] :
       {std::pair(&points_, &commas_.first), std::pair(&commas_, &points_.first)}) {
    if (marked->doubtful.line == 0 || other->line == 0) continue;
    const Marked::Place doubtful = std::exchange(marked->doubtful, {});  // said once
    std::string whole = doubtful.text;
    whole.erase(whole.find_first_of(".,"), 1);
    throw FileError(file_, doubtful.line,
                    fmt::format("{}: {}: is it {} or {}? line {} has {}; write all numbers with the same "
                                "decimal mark and without a thousands separator",
                                header_[doubtful.column], in_quotes(doubtful.text), whole,
                                *number_in(doubtful.text, true), other->line, in_quotes(other->text)));
  }
}

std::optional<char> DelimitedTable::read_separator() {
  const std::size_t end = std::min(text_.find('\n', 0), text_.size());
  const std::string_view first = std::string_view(text_).substr(0, end);
  if (in_small_letters(first.substr(0, 4)) != "sep=" || first.size() < 5) return std::nullopt;
  const char separator = first[4];
  if (separator != ';' && separator != ',' && separator != '\t') return std::nullopt;
  at_ = std::min(end + 1, text_.size());
  line_ = 2;
  return separator;
}

bool DelimitedTable::at_line_end() const {
  return at_ >= text_.size() || text_[at_] == '\n' || text_[at_] == '\r';
}

void DelimitedTable::read_field(std::string& field) {
  const auto ends = [&] {
    return at_line_end() || text_[at_] == separator_ || (separator_ == ' ' && is_blank(text_[at_]));
  };
  field.clear();
  while (!at_line_end() && is_blank(text_[at_]) && text_[at_] != separator_) ++at_;
  if (separator_ != '\n' && at_ < text_.size() && text_[at_] == '"') {
    for (++at_;; ++at_) {
      if (at_ >= text_.size()) fail("a field in quotes does not end");
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] == '"') {
        if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') break;
        ++at_;
      }
      field += text_[at_];
    }
    ++at_;
    while (!ends() && is_blank(text_[at_])) ++at_;
    if (!ends()) fail("text after a field in quotes");
  } else {
    const std::size_t from = at_;
    while (!ends()) ++at_;
    field.assign(text_, from, at_ - from);
  }
  field = std::string(trimmed(field));
}

bool DelimitedTable::read_row() {
  do {
    if (!go_to_text()) return false;
    row_line_ = line_;
    used_ = 0;
    while (true) {
      if (separator_ == ' ') {
        while (!at_line_end() && is_blank(text_[at_])) ++at_;
        if (at_line_end() && used_ > 0) break;
      }
      if (used_ == fields_.size()) fields_.emplace_back();
      read_field(fields_[used_++]);
      if (at_line_end()) break;
      ++at_;
    }
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ < text_.size() && text_[at_] == '\n') ++at_;
    ++line_;
  } while (std::all_of(fields_.begin(), fields_.begin() + static_cast<std::ptrdiff_t>(used_),
                       [](const std::string& field) { return field.empty(); }));
  return true;
}

bool DelimitedTable::go_to_text() {
  for (;; ++line_) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view whole = std::string_view(text_).substr(at_, end - at_);
    if (!whole.empty() && whole.back() == '\r') whole.remove_suffix(1);
    whole = trimmed(whole);
    if (!whole.empty() && whole.front() != '#') return true;
    if (!whole.empty() && header_.empty()) keep_comment(whole.substr(1));
    at_ = end + 1;
  }
}

void DelimitedTable::keep_comment(std::string_view line) {
  if (comments_.size() >= 100) return;
  while (!line.empty() && (is_blank(line.back()) || line.back() == ',' || line.back() == ';'))
    line.remove_suffix(1);
  comments_.push_back({line_, std::string(trimmed(line.substr(0, 1000)))});
}

}  // namespace scree
