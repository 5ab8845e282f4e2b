#include "sim/material/grading.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/material/input_text.h"

namespace scree {

namespace {

constexpr std::uintmax_t kMostFileBytes = 1'000'000;
constexpr std::size_t kMostPoints = 10'000;             // a measured curve has some twenty
constexpr double kLeastMm = 1e-3, kMostMm = 1'000'000;  // dust; more than any block

/// Passing at `diameter` between two points of a curve linear in log d.
double passing_between(const Grading::Point& a, const Grading::Point& b, double diameter) {
  return a.passing +
         (b.passing - a.passing) * std::log(diameter / a.diameter) / std::log(b.diameter / a.diameter);
}

/// The points of a curve without what is finer than a diameter between its ends, rescaled to 0..1.
std::vector<Grading::Point> coarser_than(double from, const std::vector<Grading::Point>& points) {
  const auto above =
      std::upper_bound(points.begin(), points.end(), from,
                       [](double d, const Grading::Point& point) { return d < point.diameter; });
  const double finer = passing_between(*(above - 1), *above, from);
  std::vector<Grading::Point> coarse{{from, 0}};
  for (auto at = above; at != points.end(); ++at)
    coarse.push_back({at->diameter, (at->passing - finer) / (1 - finer)});
  return coarse;
}

/// The columns of a grading file, and what makes a diameter metres.
struct Columns {
  std::size_t diameter, passing;
  double metres;
};

Columns columns_of(const std::filesystem::path& file, const DelimitedTable& table) {
  const auto passing = table.column("passing_pct");
  std::vector<Columns> found;
  for (const auto& [name, metres] :
       {std::pair("diameter_mm", 1e-3), {"diameter_cm", 1e-2}, {"diameter_m", 1.0}})
    if (const auto diameter = table.column(name); diameter && passing)
      found.push_back({*diameter, *passing, metres});
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    throw FileError(file, table.header_line(), "two columns are diameters; one is wanted");
  throw FileError(file, table.header_line(),
                  "the columns diameter_mm (or diameter_cm, diameter_m) and passing_pct are needed");
}

}  // namespace

Grading::Grading(std::string name, std::vector<Point> points)
    : name_(std::move(name)), points_(std::move(points)) {
  if (points_.size() < 2) throw std::invalid_argument("a grading needs at least two points");
  for (const Point& point : points_) {
    if (!(std::isfinite(point.diameter) && point.diameter > 0))
      throw std::invalid_argument(fmt::format("diameter {} m must be above 0", point.diameter));
    if (!(point.passing >= 0 && point.passing <= 1))
      throw std::invalid_argument(fmt::format("passing {} must be between 0 and 1", point.passing));
  }
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (!(points_[i].diameter > points_[i - 1].diameter))
      throw std::invalid_argument(fmt::format("diameters must rise: {} m follows {} m", points_[i].diameter,
                                              points_[i - 1].diameter));
    if (!(points_[i].passing >= points_[i - 1].passing))
      throw std::invalid_argument(fmt::format("passing must not fall: {} at {} m follows {}",
                                              points_[i].passing, points_[i].diameter,
                                              points_[i - 1].passing));
  }
  if (points_.front().passing != 0)
    throw std::invalid_argument(
        fmt::format("the smallest diameter must have passing 0, not {}", points_.front().passing));
  if (points_.back().passing != 1)
    throw std::invalid_argument(
        fmt::format("the largest diameter must have passing 1, not {}", points_.back().passing));
  // Of sieves that the same passes, at the ends none or all, the outer ones say where rock is; others
  // nothing.
  std::vector<Point> kept;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double here = points_[i].passing;
    const bool as_finer = i == 0 ? here == 0 : points_[i - 1].passing == here,
               as_coarser = i + 1 == points_.size() ? here == 1 : points_[i + 1].passing == here;
    if (!(as_finer && as_coarser)) kept.push_back(points_[i]);
  }
  points_ = std::move(kept);
}

double Grading::passing(double diameter) const {
  if (diameter <= min_diameter()) return 0;
  if (diameter >= max_diameter()) return 1;
  const auto above = std::upper_bound(points_.begin(), points_.end(), diameter,
                                      [](double d, const Point& point) { return d < point.diameter; });
  return passing_between(*(above - 1), *above, diameter);
}

double Grading::diameter(double passing) const {
  if (!(passing >= 0 && passing <= 1))
    throw std::invalid_argument(fmt::format("passing {} must be between 0 and 1", passing));
  if (passing == 1) return max_diameter();
  const auto above = std::upper_bound(points_.begin(), points_.end(), passing,
                                      [](double p, const Point& point) { return p < point.passing; });
  const Point &a = *(above - 1), &b = *above;
  return a.diameter * std::pow(b.diameter / a.diameter, (passing - a.passing) / (b.passing - a.passing));
}

double Grading::cu() const {
  return diameter(0.60) / diameter(0.10);
}

double Grading::cc() const {
  const double d30 = diameter(0.30);
  return d30 * d30 / (diameter(0.10) * diameter(0.60));
}

double Grading::mean_log_diameter() const {
  double sum = 0;  // exact, as the curve is linear in log d between points
  for (std::size_t i = 1; i < points_.size(); ++i)
    sum += (points_[i].passing - points_[i - 1].passing) * 0.5 *
           std::log10(points_[i].diameter * points_[i - 1].diameter);
  return sum;
}

Grading Grading::scalped(double low, double high) const {
  const double low_passing = passing(low), high_passing = passing(high);
  if (!(low > 0 && low < high && low_passing < high_passing))
    throw std::invalid_argument(
        fmt::format("grading {} has nothing between {} m and {} m", name_, low, high));
  low = std::max(low, min_diameter());
  high = std::min(high, max_diameter());
  std::vector<Point> points{{low, 0}};
  for (const Point& point : points_)
    if (point.diameter > low && point.diameter < high)
      points.push_back({point.diameter, (point.passing - low_passing) / (high_passing - low_passing)});
  points.push_back({high, 1});
  return Grading(name_, std::move(points));
}

Grading Grading::with_fines(double share, double ratio) const {
  if (!(share > 0 && share < 1 && ratio > 1))
    throw std::invalid_argument(
        fmt::format("fines: share {} must be between 0 and 1, ratio {} above 1", share, ratio));
  std::vector<Point> points{{min_diameter() / ratio, 0}};
  for (const Point& point : points_) points.push_back({point.diameter, share + (1 - share) * point.passing});
  return Grading(name_, std::move(points));
}

Grading read_grading(const std::filesystem::path& file, std::optional<double> from) {
  DelimitedTable table(file, kMostFileBytes);
  const Columns columns = columns_of(file, table);
  struct Row {
    int line;
    double diameter, passing;  // m; %
  };
  std::vector<Row> rows;
  while (table.next()) {
    const auto diameter = table.number(columns.diameter), passing = table.number(columns.passing);
    if (!diameter || !passing) table.fail("a diameter and what passes it are needed");
    if (!(*diameter > 0)) table.fail(fmt::format("diameter {} must be above 0", *diameter));
    if (const double mm = 1000 * columns.metres * *diameter; mm < kLeastMm || mm > kMostMm)
      table.fail(fmt::format("diameter {} mm; allowed {} to {} mm", mm, kLeastMm, kMostMm));
    if (*passing < 0 || *passing > 100)
      table.fail(fmt::format("passing {} % must be between 0 and 100", *passing));
    if (rows.size() == kMostPoints) table.fail(fmt::format("more than {} points", kMostPoints));
    rows.push_back(
        {table.line(), columns.metres == 1e-3 ? *diameter / 1000 : *diameter * columns.metres, *passing});
  }
  if (rows.size() < 2) throw FileError(file, 0, "a grading needs at least two points");
  if (rows.front().diameter > rows.back().diameter) std::reverse(rows.begin(), rows.end());  // coarse first
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto fail = [&](const std::string& what) { throw FileError(file, rows[k].line, what); };
    if (rows[k].diameter <= rows[k - 1].diameter)
      fail(fmt::format("diameter {:g} m stands beside {:g} m: they must rise or fall throughout",
                       rows[k].diameter, rows[k - 1].diameter));
    if (rows[k].passing < rows[k - 1].passing)
      fail(fmt::format("passing {} % is below that of a finer diameter, {} %", rows[k].passing,
                       rows[k - 1].passing));
  }
  if (rows.back().passing != 100)
    throw FileError(file, rows.back().line,
                    fmt::format("the largest diameter must have passing 100, not {}", rows.back().passing));
  const double finest = from.value_or(0);
  if (rows.front().passing != 0 && !(finest > 0))
    throw FileError(file, rows.front().line,
                    fmt::format("the smallest diameter must have passing 0, not {}{}", rows.front().passing,
                                from ? "; grading_from_m leaves out what is finer than a diameter" : ""));
  if (rows.front().passing != 0 && finest < rows.front().diameter)
    throw FileError(
        file, rows.front().line,
        fmt::format("{} % of the rock are finer than {:g} m, and the table does not say how fine; "
                    "grading_from_m must be {:g} or more",
                    rows.front().passing, rows.front().diameter, rows.front().diameter));
  const auto all = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.passing == 100; });
  if (finest >= all->diameter)
    throw FileError(
        file, all->line,
        fmt::format("no rock is coarser than {:g} m, and grading_from_m is {:g}", all->diameter, finest));
  std::vector<Grading::Point> points;
  for (const Row& row : rows) points.push_back({row.diameter, row.passing / 100});
  return Grading(file.stem().string(),
                 finest >= points.front().diameter ? coarser_than(finest, points) : points);
}

}  // namespace scree
