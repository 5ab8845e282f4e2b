#include "analysis/pile/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "analysis/pile/segregation.h"
#include "analysis/pile/slope_profile.h"
#include "sim/material/random.h"

namespace scree {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr int kDeals = 20;  // of dumps to grains, for what chance does

using Grains = std::vector<const Grain*>;

double surface_slope(const std::vector<Grain>& pile, const VerticalSection& section) {
  std::vector<Grain> about_axis;
  for (const Grain& grain : pile)
    if (std::abs(grain.position.y() - section.y0) <= section.half_width) about_axis.push_back(grain);
  const double height = section.bench->height;
  const auto line = slope_line(slope_profile(about_axis, height), height);
  return line && line->angle > 0 ? line->angle : section.bench->slope_deg;
}

/// The slope as an axis down its surface from the crest and one normal to it, m.
struct SlopeAxes {
  double cosine = 1, sine = 0, height = 0;
  double along(const Vec3& p) const { return p.x() * cosine + (height - p.z()) * sine; }
  double off(const Vec3& p) const { return p.x() * sine - (height - p.z()) * cosine; }
};

/// Grains of each dump in each stretch of the slope.
using Stretches = std::map<int, std::map<int, Grains>>;

Stretches cut_slope(const std::vector<Grain>& pile, const VerticalSection& section, const SlopeAxes& axes) {
  const double length = axes.height / axes.sine;
  const auto n = std::max(1L, std::lround(length * 2 / 3 / section.cell));
  Stretches stretches;
  for (const Grain& grain : pile) {
    if (std::abs(grain.position.y() - section.y0) > section.half_width) continue;
    const double share = (axes.along(grain.position) / length - 1.0 / 6) * 1.5;
    if (share >= 0 && share < 1)
      stretches[static_cast<int>(share * static_cast<double>(n))][grain.dump].push_back(&grain);
  }
  return stretches;
}

/// One dump over all stretches.
struct Pieces {
  Grains all;
  std::vector<Grain> lower, upper;  // a grain across the middle lies in both, with a part of its mass
  double thickness = 0;
  int covered = 0;
};

/// Share of a sphere's volume below a plane `above` its centre (m).
double share_below(double above, double radius) {
  const double h = std::clamp(1 + above / radius, 0.0, 2.0);
  return 0.25 * h * h * (3 - h);
}

/// Halves a layer by the plane along the slope that has half of its mass on either side.
void halve(const Grains& grains, const SlopeAxes& axes, Pieces& pieces) {
  double low = INFINITY, high = -INFINITY, mass = 0;
  for (const Grain* grain : grains) {
    const double off = axes.off(grain->position), r = grain->diameter / 2;
    low = std::min(low, off - r), high = std::max(high, off + r), mass += grain->mass;
  }
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    double below = 0;
    for (const Grain* grain : grains)
      below += grain->mass * share_below(middle - axes.off(grain->position), grain->diameter / 2);
    (below < 0.5 * mass ? low : high) = middle;
  }
  for (const Grain* grain : grains) {
    const double share = share_below(high - axes.off(grain->position), grain->diameter / 2);
    for (const auto& [half, part] : {std::pair{&pieces.lower, share}, std::pair{&pieces.upper, 1 - share}}) {
      if (part < 1e-9) continue;
      half->push_back(*grain);
      half->back().mass *= part;
    }
  }
}

/// Sums of log10 d by mass.
struct LogSum {
  double mass = 0, moment = 0;
  void add(const Grain& grain) { mass += grain.mass, moment += grain.mass * std::log10(grain.diameter); }
  double mean() const { return moment / mass; }
};

/// A grain of a stretch and the row of its dump there.
struct DealtGrain {
  double mass = 0, deviation = 0;  // of log10 d from the stretch's mean
  std::size_t dump = 0;
};

/// Sum over dumps of mass times the squared deviation of their means.
double between_dumps(const std::vector<DealtGrain>& grains, std::size_t dumps) {
  std::vector<LogSum> sums(dumps);
  for (const DealtGrain& grain : grains)
    sums[grain.dump].mass += grain.mass, sums[grain.dump].moment += grain.mass * grain.deviation;
  double sum = 0;
  for (const LogSum& each : sums)
    if (each.mass > 0) sum += each.mass * std::pow(each.mean(), 2);
  return sum;
}

void share_variance(const Stretches& stretches, Layers& result) {
  double whole = 0, between = 0, by_chance = 0, mass = 0;
  for (const auto& [place, dumps] : stretches) {
    LogSum stretch;
    for (const auto& [dump, grains] : dumps)
      for (const Grain* grain : grains) stretch.add(*grain);
    mass += stretch.mass;
    std::vector<DealtGrain> dealt;
    std::size_t row = 0;
    for (const auto& [dump, grains] : dumps) {
      for (const Grain* grain : grains)
        dealt.push_back({grain->mass, std::log10(grain->diameter) - stretch.mean(), row});
      ++row;
    }
    for (const DealtGrain& grain : dealt) whole += grain.mass * std::pow(grain.deviation, 2);
    between += between_dumps(dealt, dumps.size());
    Random random(0, static_cast<std::uint64_t>(place), RandomPurpose::measurement);
    for (int deal = 0; deal < kDeals; ++deal) {
      for (std::size_t k = dealt.size(); k > 1; --k) {
        const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(k));
        std::swap(dealt[k - 1].dump, dealt[other].dump);
      }
      by_chance += between_dumps(dealt, dumps.size()) / kDeals;
    }
  }
  const bool scatter = whole > 1e-20 * mass;  // above what rounding leaves of equal sizes
  result.variance_between = scatter ? between / whole : kNaN;
  result.variance_by_chance = scatter ? by_chance / whole : kNaN;
}

}  // namespace

Layers analyse_layers(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                      const VerticalSection& section, double porosity, int fewest_grains) {
  check(section);
  if (!section.bench) throw std::invalid_argument("layers need the bench of the section");
  if (!(porosity >= 0 && porosity < 1))
    throw std::invalid_argument(fmt::format("porosity {} must lie between 0 and 1", porosity));
  if (fewest_grains < 2)
    throw std::invalid_argument(fmt::format("{} grains: at least 2 are needed", fewest_grains));

  Layers result;
  result.slope_deg = surface_slope(pile, section);
  const double slope = result.slope_deg * std::numbers::pi / 180;
  const SlopeAxes axes{std::cos(slope), std::sin(slope), section.bench->height};
  const Stretches stretches = cut_slope(pile, section, axes);
  const double length = axes.height / axes.sine * 2 / 3;
  const double stretch_area =
      length / static_cast<double>(std::max(1L, std::lround(length / section.cell))) * 2 * section.half_width;

  std::map<int, Pieces> dumps;
  for (const auto& [place, layers] : stretches)
    for (const auto& [dump, grains] : layers) {
      Pieces& pieces = dumps[dump];
      pieces.all.insert(pieces.all.end(), grains.begin(), grains.end());
      if (grains.size() < static_cast<std::size_t>(fewest_grains)) continue;
      double rock = 0;
      for (const Grain* grain : grains) rock += std::numbers::pi / 6 * std::pow(grain->diameter, 3);
      pieces.thickness += rock / (stretch_area * (1 - porosity));
      ++pieces.covered;
      halve(grains, axes, pieces);
    }

  std::vector<NamedGrains> parts;
  for (const auto& [dump, pieces] : dumps) {
    parts.push_back({"", 0, pieces.all});
    for (const std::vector<Grain>* half : {&pieces.lower, &pieces.upper}) {
      parts.push_back({"", 0, {}});
      for (const Grain& grain : *half) parts.back().grains.push_back(&grain);
    }
  }
  const SectionTable table = tabulate(parts, original);
  double moment = 0, mass = 0;
  std::size_t row = 0;
  for (const auto& [dump, pieces] : dumps) {
    const Section& all = table.sections[row];
    Layer layer{dump, all.grains, all.mass, kNaN, kNaN, kNaN, kNaN, kNaN};
    if (pieces.covered > 0) {
      layer.thickness = pieces.thickness / pieces.covered;
      layer.chi = all.chi;
      layer.chi_lower = table.sections[row + 1].chi;
      layer.chi_upper = table.sections[row + 2].chi;
      layer.coarsening_down = layer.chi_lower - layer.chi_upper;
      if (std::isfinite(layer.coarsening_down))
        moment += layer.mass * layer.coarsening_down, mass += layer.mass;
    }
    result.layers.push_back(layer);
    row += 3;
  }
  result.mean_coarsening_down = mass > 0 ? moment / mass : kNaN;
  share_variance(stretches, result);
  return result;
}

}  // namespace scree
