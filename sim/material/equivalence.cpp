#include "sim/material/equivalence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/material/csv_table.h"

namespace scree {
namespace {

constexpr std::array<const char*, 3> kNames{"mu", "mu_r", "local_damping"};

// Of 0 or more; none if empty.
std::optional<double> magnitude(const CsvTable& table, const char* column) {
  const auto value = table.optional_number(column);
  if (value && *value < 0) table.fail(fmt::format("{} '{:g}' is no number of 0 or more", column, *value));
  return value;
}

}  // namespace

Equivalence Equivalence::read(const std::filesystem::path& file) {
  CsvTable csv(file, {"mu", "mu_r", "local_damping", "friction", "rolling", "angle_rrlinear_deg",
                      "angle_impulse_deg"});
  const auto fail = [&](const std::string& what) { csv.fail(what); };
  struct Row {
    std::array<double, 3> at;
    std::optional<Settings> settings;
  };
  std::vector<Row> rows;
  while (csv.next()) {
    Row row{};
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      csv.number(kNames[k]);
      row.at[k] = *magnitude(csv, kNames[k]);
    }
    const auto friction = magnitude(csv, "friction"), rolling = magnitude(csv, "rolling"),
               rrlinear = magnitude(csv, "angle_rrlinear_deg"), impulse = magnitude(csv, "angle_impulse_deg");
    if (friction && rolling && rrlinear && impulse)
      row.settings = Settings{*friction, *rolling, std::abs(*impulse - *rrlinear)};
    else if (friction || rolling)
      fail("a node has friction, rolling and both angles, or neither friction nor rolling");
    rows.push_back(row);
  }
  if (rows.empty()) fail("no rows");

  Equivalence table;
  std::size_t count = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    std::set<double> all;
    for (const Row& row : rows) all.insert(row.at[k]);
    table.axes_[k].assign(all.begin(), all.end());
    count *= all.size();
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.at < b.at; });
  const auto same = [](const Row& a, const Row& b) { return a.at == b.at; };
  if (rows.size() != count || std::adjacent_find(rows.begin(), rows.end(), same) != rows.end())
    fail(fmt::format("{} rows are no grid of {} x {} x {}", rows.size(), table.axes_[0].size(),
                     table.axes_[1].size(), table.axes_[2].size()));
  for (const Row& row : rows) table.nodes_.push_back(row.settings);
  return table;
}

std::optional<Equivalence::Settings> Equivalence::at(double mu, double mu_r, double local_damping) const {
  const std::array<double, 3> point{mu, mu_r, local_damping};
  std::array<std::size_t, 3> cell{};
  std::array<double, 3> share{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double>& axis = axes_[k];
    if (!(point[k] >= axis.front() && point[k] <= axis.back())) return std::nullopt;
    if (axis.size() == 1) continue;
    const auto above = std::upper_bound(axis.begin(), axis.end() - 1, point[k]);
    cell[k] = static_cast<std::size_t>(above - axis.begin()) - 1;
    share[k] = (point[k] - axis[cell[k]]) / (axis[cell[k] + 1] - axis[cell[k]]);
  }
  Settings result;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t node = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool upper = (corner >> k & 1) != 0;
      weight *= upper ? share[k] : 1 - share[k];
      node = node * axes_[k].size() + cell[k] + (upper && axes_[k].size() > 1);
    }
    if (weight == 0) continue;
    if (!nodes_[node]) return std::nullopt;
    result.friction += weight * nodes_[node]->friction;
    result.rolling += weight * nodes_[node]->rolling;
    result.error_deg = std::max(result.error_deg.value_or(0), nodes_[node]->error_deg.value());
  }
  return result;
}

std::string Equivalence::range() const {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double>& axis = axes_[k];
    text += fmt::format("{}{} {:g}", k == 0 ? "" : ", ", kNames[k], axis.front());
    if (axis.size() > 1) text += fmt::format(" to {:g}", axis.back());
  }
  const auto missing =
      std::count_if(nodes_.begin(), nodes_.end(), [](const std::optional<Settings>& node) { return !node; });
  if (missing > 0)
    text += fmt::format(", without {} of {} pairs that Bullet cannot follow", missing, nodes_.size());
  return text;
}

}  // namespace scree
