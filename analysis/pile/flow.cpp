#include "analysis/pile/flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "sim/io/snapshot_state.h"

namespace scree {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kGravity = 9.81;                      // m/s2, as in the world
constexpr double kMiddleLow = 0.4, kMiddleHigh = 0.6;  // of the height, where depth is measured
constexpr double kFast = 0.95;

void raise(double& highest, double value) {
  if (!(value <= highest) && !std::isnan(value)) highest = value;
}

}  // namespace

template <class Stream>
void state(Stream& stream, WeighedValue& value) {
  stream(value.value, value.mass);
}

FlowRecorder::FlowRecorder(const FlowSettings& settings) : settings_(settings) {
  check(settings.bench);
  const auto refuse = [](bool bad, const char* words) {
    if (bad) throw std::invalid_argument(words);
  };
  refuse(settings.sections < 1, "a flow needs at least 1 section");
  refuse(!(settings.half_width > 0), "the half width of the band must be above 0");
  refuse(!(settings.moving_speed >= 0), "the speed of moving grains must be 0 or more");
  refuse(settings.fewest_moving < 1, "a flow has at least 1 moving grain");
  refuse(!(settings.porosity >= 0 && settings.porosity < 1),
         "the porosity of a flow must lie between 0 and 1");
  refuse(settings.most_rows < 2 || settings.most_rows % 2 != 0, "the rows kept must be even, at least 2");
  highest_mean_.assign(static_cast<std::size_t>(settings.sections), kNaN);
  highest_fast_ = highest_mean_;
  moved_mass_.assign(highest_mean_.size(), 0);
  moved_moment_ = moved_mass_;
}

FlowRow FlowRecorder::look(const Snapshot& snapshot) {
  const double height = settings_.bench.height, slope = settings_.bench.slope_deg * std::numbers::pi / 180;
  const auto n = static_cast<std::size_t>(settings_.sections);
  std::vector<std::vector<WeighedValue>> speeds(n);
  FlowRow row{snapshot.time, std::vector<double>(n, kNaN), std::vector<double>(n, kNaN), 0, 0};
  double rock = 0;  // m3
  for (const Grain& grain : snapshot.grains) {
    const double below = (height - grain.position.z()) / height;
    if (!(below >= 0)) continue;
    const double speed = grain.velocity.norm();
    row.kinetic_energy += 0.5 * grain.mass * speed * speed;
    if (!(speed > settings_.moving_speed)) continue;
    const auto section =
        static_cast<std::size_t>(std::min(below * settings_.sections, settings_.sections - 1.0));
    speeds[section].push_back({speed, grain.mass});
    if (below >= kMiddleLow && below < kMiddleHigh &&
        std::abs(grain.position.y() - settings_.y0) <= settings_.half_width)
      rock += std::numbers::pi / 6 * std::pow(grain.diameter, 3);
  }
  const double area = (kMiddleHigh - kMiddleLow) * height / std::sin(slope) * 2 * settings_.half_width;
  row.depth = rock / (area * (1 - settings_.porosity));
  for (std::size_t k = 0; k < n; ++k) {
    if (speeds[k].size() < static_cast<std::size_t>(settings_.fewest_moving)) continue;
    double mass = 0, moment = 0;
    for (const WeighedValue& each : speeds[k]) mass += each.mass, moment += each.mass * each.value;
    row.mean[k] = moment / mass;
    moved_mass_[k] += mass, moved_moment_[k] += moment;
    row.fast[k] = mass_quantile(std::move(speeds[k]), kFast);
  }
  return row;
}

void FlowRecorder::note_arrivals(const Snapshot& snapshot) {
  const double border = settings_.bench.height / settings_.sections;
  for (const Grain& grain : snapshot.grains) {
    const bool lowest = grain.position.z() <= border;
    const auto [at, fresh] = arrived_.try_emplace(grain.id, lowest);
    if (fresh || at->second || !lowest) continue;
    at->second = true;
    arrivals_.push_back({0.5 * grain.velocity.squaredNorm(), grain.mass});
  }
}

void FlowRecorder::keep(FlowRow row) {
  if (snapshots_ % stride_ != 0) return;
  if (rows_.size() == settings_.most_rows) {
    for (std::size_t k = 0; 2 * k < rows_.size(); ++k) rows_[k] = std::move(rows_[2 * k]);
    rows_.resize(rows_.size() / 2);
    stride_ *= 2;
    // With an even number of rows this snapshot is due at the wider stride too.
  }
  rows_.push_back(std::move(row));
}

void FlowRecorder::add(const Snapshot& snapshot) {
  if (snapshots_ > 0 && !(snapshot.time > last_time_))
    throw std::invalid_argument(
        fmt::format("a snapshot of {} s after one of {} s: times must rise", snapshot.time, last_time_));
  last_time_ = snapshot.time;
  FlowRow row = look(snapshot);
  for (std::size_t k = 0; k < row.mean.size(); ++k) {
    raise(highest_mean_[k], row.mean[k]);
    raise(highest_fast_[k], row.fast[k]);
  }
  largest_depth_ = std::max(largest_depth_, row.depth);
  if (row.kinetic_energy > largest_energy_) {
    largest_energy_ = row.kinetic_energy;
    liveliest_ = snapshot;
  }
  note_arrivals(snapshot);
  keep(std::move(row));
  ++snapshots_;
}

template <class Stream>
void FlowRecorder::state(Stream& stream) {
  stream.section("flow", 1);
  std::vector<std::int64_t> seen;
  std::vector<std::uint8_t> came;
  for (const auto& [id, at_toe] : arrived_) seen.push_back(id);
  std::sort(seen.begin(), seen.end());
  for (const std::int64_t id : seen) came.push_back(arrived_.at(id) ? 1 : 0);
  stream(snapshots_, stride_, last_time_, rows_, highest_mean_, highest_fast_, moved_mass_, moved_moment_,
         largest_depth_, largest_energy_, liveliest_, seen, came, arrivals_);
  if (!Stream::kReads) return;
  arrived_.clear();
  for (std::size_t k = 0; k < seen.size(); ++k) arrived_.emplace(seen[k], came.at(k) != 0);
}
template void FlowRecorder::state(StateWriter&);
template void FlowRecorder::state(StateReader&);

std::vector<double> FlowRecorder::mean_speed() const {
  std::vector<double> speeds;
  for (std::size_t k = 0; k < moved_mass_.size(); ++k)
    speeds.push_back(moved_mass_[k] > 0 ? moved_moment_[k] / moved_mass_[k] : kNaN);
  return speeds;
}

FlowArrival FlowRecorder::arrival() const {
  FlowArrival result{0, kNaN, kNaN, kNaN};
  if (arrivals_.empty()) return result;
  double moment = 0;
  for (const WeighedValue& each : arrivals_) result.mass += each.mass, moment += each.mass * each.value;
  result.mean_energy = moment / result.mass;
  result.fast_energy = mass_quantile(arrivals_, kFast);
  result.share_of_drop = result.mean_energy / (kGravity * settings_.bench.height);
  return result;
}

}  // namespace scree
