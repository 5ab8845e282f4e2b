#pragma once
// Flow of rock down the slope while a load is dumped.
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "analysis/pile/mass_quantile.h"
#include "analysis/pile/vertical_section.h"
#include "sim/io/snapshot.h"

namespace scree {

/// Where and how a flow is looked at.
struct FlowSettings {
  BenchOutline bench;         ///< crest at x = 0; initial slope, also the plane that depth is normal to
  int sections = 6;           ///< of equal height, S1 at the crest
  double y0 = 0;              ///< m, middle of the band in which depth is measured
  double half_width = 2;      ///< m, of that band
  double moving_speed = 0.1;  ///< m/s above which a grain moves
  int fewest_moving = 10;     ///< a section with fewer moving grains has no speed: one stray block is no flow
  double porosity = 0.4;      ///< of the moving rock, for its depth
  std::size_t most_rows = 4096;  ///< of the histories that are kept; even, at least 2
};

/// One moment of a flow.
struct FlowRow {
  double time = 0;            ///< s
  std::vector<double> mean;   ///< m/s of moving grains, by mass; for each section, NaN without flow
  std::vector<double> fast;   ///< m/s, 95th percentile by mass, in the same way
  double depth = 0;           ///< m, see FlowRecorder
  double kinetic_energy = 0;  ///< J, of all grains below the crest's height

  /// Every member, for checkpoints.
  template <class Stream>
  void state(Stream& stream) {
    stream(time, mean, fast, depth, kinetic_energy);
  }
};

/// Rock as it comes to the lowest section for the first time.
struct FlowArrival {
  double mass = 0;       ///< kg that arrived
  double mean_energy;    ///< J/kg, by mass; NaN when nothing arrived
  double fast_energy;    ///< J/kg, 95th percentile by mass
  double share_of_drop;  ///< mean_energy over g * height of the bench
};

/// Collects the flow of one or more dumps from snapshots taken while rock moves, every 0.1 s or so.
///
/// Sections are slices of equal height between crest and floor, as in analyse_sections(); rock above the
/// crest is not on the slope yet.
///
/// Depth is that of the moving rock at the middle of the slope: volume of the moving grains between 40 and
/// 60 % of the height, within the band, over the area of slope there and 1 - porosity. It is an equivalent
/// thickness normal to the slope: a block that bounces high adds its volume and no more, and a layer that
/// moves slower than `moving_speed` does not count.
///
/// A grain arrives with the first snapshot that has it in the lowest section after one had it higher up, with
/// the energy of motion (without rotation) that it has then: up to one interval after it crossed the border.
///
/// Memory: one entry a grain, one snapshot, and at most `most_rows` rows; when they are full every second one
/// is dropped and from then on every second snapshot (then fourth, ...) gives a row. Maxima are over all
/// snapshots. The same snapshots give the same numbers; each costs a time that goes with its grains.
class FlowRecorder {
 public:
  /// Throws std::invalid_argument for settings that make no sense.
  explicit FlowRecorder(const FlowSettings& settings);

  /// Times must rise; throws std::invalid_argument otherwise.
  void add(const Snapshot& snapshot);

  const FlowSettings& settings() const { return settings_; }
  std::size_t snapshots() const { return snapshots_; }
  const std::vector<FlowRow>& rows() const { return rows_; }
  /// Mean speed (m/s) of moving grains over all snapshots, by mass, in each section; NaN where nothing
  /// flowed.
  std::vector<double> mean_speed() const;
  /// Highest mean and 95th percentile of speed so far (m/s) in each section; NaN where nothing flowed.
  const std::vector<double>& highest_mean() const { return highest_mean_; }
  const std::vector<double>& highest_fast() const { return highest_fast_; }
  double largest_depth() const { return largest_depth_; }  ///< m; 0 without flow
  FlowArrival arrival() const;
  /// The snapshot with the largest kinetic energy of the grains below the crest's height; none before rock
  /// moves there.
  const std::optional<Snapshot>& liveliest() const { return liveliest_; }

  /// For checkpoints: everything but the settings, for a StateWriter or a StateReader.
  template <class Stream>
  void state(Stream& stream);

 private:
  FlowRow look(const Snapshot& snapshot);
  void note_arrivals(const Snapshot& snapshot);
  void keep(FlowRow row);

  FlowSettings settings_;
  std::size_t snapshots_ = 0, stride_ = 1;
  double last_time_ = 0;
  std::vector<FlowRow> rows_;
  std::vector<double> highest_mean_, highest_fast_;
  std::vector<double> moved_mass_, moved_moment_;  // sums over snapshots of kg, kg m/s
  double largest_depth_ = 0, largest_energy_ = 0;
  std::optional<Snapshot> liveliest_;
  std::unordered_map<std::int64_t, bool> arrived_;  // grains seen, false while they were only higher up
  std::vector<WeighedValue> arrivals_;              // J/kg
};

}  // namespace scree
