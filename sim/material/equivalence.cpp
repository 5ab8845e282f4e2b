#include "sim/material/equivalence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

namespace scree {
namespace {

constexpr std::string_view kHeader =
    "mu,mu_r,local_damping,friction,rolling,angle_rrlinear_deg,angle_impulse_deg";
constexpr std::array<const char*, 3> kNames{"mu", "mu_r", "local_damping"};
constexpr std::size_t kColumns = 7;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else if (c != '\r')
      fields.back() += c;
  return fields;
}

}  // namespace

Equivalence Equivalence::read(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
  int number = 0;
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), number, what));
  };
  struct Row {
    std::array<double, 3> at;
    std::optional<Settings> settings;
  };
  std::vector<Row> rows;
  bool header = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#' || line == "\r") continue;
    const std::vector<std::string> fields = split(line);
    if (!header) {
      if (fields != split(std::string(kHeader))) fail(fmt::format("the header must be '{}'", kHeader));
      header = true;
      continue;
    }
    if (fields.size() != kColumns) fail(fmt::format("{} columns, {} are needed", fields.size(), kColumns));
    std::array<std::optional<double>, kColumns> values;
    for (std::size_t k = 0; k < kColumns; ++k) {
      if (fields[k].empty()) continue;
      double value = 0;
      const char* end = fields[k].data() + fields[k].size();
      const auto [stopped, error] = std::from_chars(fields[k].data(), end, value);
      if (error != std::errc() || stopped != end || !std::isfinite(value) || value < 0)
        fail(fmt::format("'{}' is no number of 0 or more", fields[k]));
      values[k] = value;
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (!values[k]) fail(fmt::format("{} is empty", kNames[k]));
    Row row{{*values[0], *values[1], *values[2]}, std::nullopt};
    if (values[3] && values[4] && values[5] && values[6])
      row.settings = Settings{*values[3], *values[4], std::abs(*values[6] - *values[5])};
    else if (values[3] || values[4])
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
