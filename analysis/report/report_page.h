#pragma once
// What HTML reports are made of.
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

/// Printed values beside ours with z, coloured by agreement; empty without any.
std::string comparison_table(const std::vector<Comparison>& comparison);

/// A picture with its caption, its bytes within the page, or why it is missing; several under a heading,
/// nothing without any. Throw std::runtime_error if a file cannot be read or is empty.
std::string figure(const Picture& picture);
std::string figures(const char* heading, const std::vector<Picture>& pictures);

}  // namespace scree
