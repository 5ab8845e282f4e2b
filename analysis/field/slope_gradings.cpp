#include "analysis/field/slope_gradings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <stdexcept>

#include "analysis/results/output_units.h"
#include "sim/material/input_text.h"

namespace scree {
namespace {

constexpr int kMostSections = 99;
constexpr std::size_t kFewestDiameters = 3;

struct DiameterColumn {
  std::size_t column;
  double passing;  // 0 to 1
  double factor;   // to m
};

/// Where the diameters stand, and in which of the three forms.
struct Layout {
  std::size_t image = 0, section = 0;
  std::optional<std::size_t> chi, diameter, passing;
  double diameter_factor = 1;
  std::vector<DiameterColumn> columns;  // of D_x, by rising x
};

Layout layout_of(const std::filesystem::path& file, const DelimitedTable& table) {
  const auto fail = [&](const std::string& what) -> FileError { return {file, table.header_line(), what}; };
  Layout layout;
  const auto image = table.column("image"), section = table.column("section");
  if (!image || !section)
    throw fail(fmt::format("the header has no {}; needed are image, section, and diameters",
                           !image ? "image" : "section"));
  layout.image = *image, layout.section = *section;
  layout.chi = table.column("chi");
  static const std::regex of_curve("d([0-9]+(?:\\.[0-9]+)?)_(mm|cm|m)"), of_row("diameter_(mm|cm|m)");
  for (std::size_t k = 0; k < table.header().size(); ++k) {
    const std::string name = in_small_letters(table.header()[k]);
    std::smatch parts;
    if (std::regex_match(name, parts, of_curve)) {
      const double percent = std::stod(parts[1]);
      if (percent > 100) throw fail(fmt::format("column {}: D0 to D100 are allowed", name));
      layout.columns.push_back({k, percent / 100, *unit_factor(parts[2], "m")});
    } else if (std::regex_match(name, parts, of_row)) {
      layout.diameter = k;
      layout.diameter_factor = *unit_factor(parts[1], "m");
    } else if (name == "passing_pct") {
      layout.passing = k;
    }
  }
  std::sort(layout.columns.begin(), layout.columns.end(),
            [](const DiameterColumn& a, const DiameterColumn& b) { return a.passing < b.passing; });
  for (std::size_t k = 1; k < layout.columns.size(); ++k)
    if (layout.columns[k].passing == layout.columns[k - 1].passing)
      throw fail(fmt::format("D{:g} stands twice", 100 * layout.columns[k].passing));
  if (layout.diameter && !layout.columns.empty())
    throw fail("columns of D_x and a column of diameters exclude each other");
  if (!layout.diameter && layout.columns.size() < kFewestDiameters)
    throw fail(
        "diameters are missing: three columns like d50_cm at least, or diameter_mm and passing_pct, or "
        "diameter_mm of grains");
  return layout;
}

int section_in(const DelimitedTable& table, const std::string& text) {
  const std::string name = in_small_letters(text);
  if (name == "whole") return 0;
  const auto number = number_in(name.starts_with("s") ? std::string_view(name).substr(1) : name);
  if (!number || *number != std::floor(*number) || *number < 0 || *number > kMostSections)
    table.fail(fmt::format("section '{}' is none; allowed are whole, S1 (at the crest), S2 ... S{}", text,
                           kMostSections));
  return static_cast<int>(*number);
}

int decimals_in(const std::string& text) {
  const auto point = text.find_first_of(".,");
  return point == std::string::npos ? 0 : static_cast<int>(text.size() - point) - 1;
}

/// Both ends of a curve, straight in log d from its last two points, where it has none.
void close_ends(std::vector<Grading::Point>& points) {
  const auto beyond = [](const Grading::Point& last, const Grading::Point& before, double passing) {
    return last.diameter * std::pow(last.diameter / before.diameter,
                                    (passing - last.passing) / (last.passing - before.passing));
  };
  if (points.front().passing > 0) points.insert(points.begin(), {beyond(points[0], points[1], 0), 0});
  const std::size_t n = points.size();
  if (points.back().passing < 1) points.push_back({beyond(points[n - 1], points[n - 2], 1), 1});
}

/// A curve of grains, each a sphere: passing at a grain's diameter counts the grain. The smallest ones are
/// spread over one step of the mean ratio between neighbours.
std::vector<Grading::Point> curve_of_grains(std::vector<double> diameters) {
  std::sort(diameters.begin(), diameters.end());
  double volume = 0;
  std::vector<Grading::Point> points;
  for (const double d : diameters) {
    volume += d * d * d;
    if (!points.empty() && points.back().diameter == d)
      points.back().passing = volume;
    else
      points.push_back({d, volume});
  }
  for (Grading::Point& point : points) point.passing /= volume;
  points.back().passing = 1;
  if (points.size() < 2) throw std::invalid_argument("grains of two sizes at least are needed");
  const double step = std::pow(points.back().diameter / points.front().diameter,
                               1.0 / static_cast<double>(points.size() - 1));
  points.insert(points.begin(), {points.front().diameter / step, 0});
  return points;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : file_(file), table_(file), layout_(layout_of(file, table_)) {}

  SlopeGradings read() {
    while (table_.next()) read_row();
    if (rows_.empty()) throw FileError(file_, 0, "there is a header and no grading below it");
    SlopeGradings out;
    for (const auto& [key, row] : rows_) out.sections = std::max(out.sections, key.second);
    if (out.sections == 0) throw FileError(file_, 0, "there are whole slopes and no sections");
    for (const std::string& name : order_) {
      SlopeGradings::Picture picture{name, {}, {}};
      picture.curves.resize(static_cast<std::size_t>(out.sections) + 1);
      picture.given_chi.assign(picture.curves.size(), std::numeric_limits<double>::quiet_NaN());
      for (int k = 0; k <= out.sections; ++k) fill(picture, k);
      out.pictures.push_back(std::move(picture));
    }
    out.half_digit = half_digit_;
    return out;
  }

 private:
  struct Row {
    int line = 0;
    std::vector<Grading::Point> points;
    std::vector<double> grains;
    std::optional<double> chi;
  };

  void read_row() {
    const std::string& image = table_.field(layout_.image);
    if (image.empty()) table_.fail("image is empty");
    const int section = section_in(table_, table_.field(layout_.section));
    if (std::find(order_.begin(), order_.end(), image) == order_.end()) order_.push_back(image);
    const auto [at, fresh] = rows_.try_emplace({image, section});
    Row& row = at->second;
    if (!layout_.diameter && !fresh)
      table_.fail(fmt::format("image {} section {} stands already in line {}", image, section, row.line));
    if (fresh) row.line = table_.line();
    if (layout_.chi)
      if (const auto chi = table_.number(*layout_.chi)) row.chi = chi;
    layout_.diameter ? read_point(row) : read_curve(row);
  }

  double diameter_in(std::size_t column, double factor) const {
    const auto value = table_.number(column);
    if (!value || !(*value > 0))
      table_.fail(fmt::format("{} must be a number above 0", table_.header()[column]));
    return *value * factor;
  }

  void read_point(Row& row) {
    const double diameter = diameter_in(*layout_.diameter, layout_.diameter_factor);
    if (!layout_.passing) {
      row.grains.push_back(diameter);
      return;
    }
    const auto passing = table_.number(*layout_.passing);
    if (!passing || *passing < 0 || *passing > 100) table_.fail("passing_pct must be a number from 0 to 100");
    row.points.push_back({diameter, *passing / 100});
  }

  void read_curve(Row& row) {
    for (const DiameterColumn& column : layout_.columns) {
      if (table_.field(column.column).empty()) continue;
      row.points.push_back({diameter_in(column.column, column.factor), column.passing});
      if (column.passing > 0 && column.passing < 1) {
        const double half = 0.5 * std::pow(10.0, -decimals_in(table_.field(column.column))) * column.factor;
        half_digit_ = half_digit_ == 0 ? half : std::min(half_digit_, half);
      }
    }
    if (row.points.size() < kFewestDiameters) table_.fail("three diameters at least are needed");
  }

  void fill(SlopeGradings::Picture& picture, int section) {
    const auto found = rows_.find({picture.name, section});
    if (found == rows_.end()) return;
    Row& row = found->second;
    const std::size_t k = static_cast<std::size_t>(section);
    if (row.chi) picture.given_chi[k] = *row.chi;
    try {
      if (!row.grains.empty()) row.points = curve_of_grains(std::move(row.grains));
      std::sort(row.points.begin(), row.points.end(), [](const Grading::Point& a, const Grading::Point& b) {
        return std::pair(a.passing, a.diameter) < std::pair(b.passing, b.diameter);
      });
      if (!layout_.diameter) close_ends(row.points);
      picture.curves[k] = Grading(fmt::format("image {} section {}", picture.name, section), row.points);
    } catch (const std::invalid_argument& error) {
      throw FileError(file_, row.line,
                      fmt::format("image {} section {}: {}", picture.name, section, error.what()));
    }
  }

  std::filesystem::path file_;
  DelimitedTable table_;
  Layout layout_;
  std::vector<std::string> order_;
  std::map<std::pair<std::string, int>, Row> rows_;
  double half_digit_ = 0;
};

}  // namespace

SlopeGradings read_slope_gradings(const std::filesystem::path& file) {
  return Reader(file).read();
}

}  // namespace scree
