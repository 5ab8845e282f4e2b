#pragma once
// What HTML reports are made of.
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/pictures.h"
#include "analysis/results/results.h"

namespace scree {

/// A whole page that needs neither network nor script; `title` and `under` (the line below it) as plain text,
/// `body` as HTML.
std::string html_page(const std::string& title, const std::string& under, const std::string& body);

/// A value with its deviation below it, both with the same decimals; a dash for what does not exist.
std::string value_cell(std::string_view quantity, double value, std::optional<double> std,
                       const std::string& unit);
/// A mean with its deviation, if there is one; a dash for a mean of nothing.
std::string value_cell(std::string_view quantity, const MeanStd& value, const std::string& unit);

/// A paragraph on what z and the sources of comparison_table() are.
std::string comparison_explained();
/// Printed values beside ours with z, coloured by agreement; empty without any.
std::string comparison_table(const std::vector<Comparison>& comparison);

/// The figures of one page: each picture with its caption, its bytes within the page, or why it is missing.
/// Throw std::runtime_error if a file cannot be read or is empty.
class PageFigures {
 public:
  std::string figure(const Picture& picture);
  /// What `draw` gives, see add_picture().
  std::string figure(const std::function<std::optional<Picture>()>& draw);
  /// Several under a heading, nothing without any.
  std::string figures(const char* heading, const std::vector<Picture>& pictures);

  /// gnuplot's words for each that it refused; empty: the page lacks nothing.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::vector<std::string> missing_;
};

}  // namespace scree
