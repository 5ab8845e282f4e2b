#include "analysis/report/flow_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/pile/mass_quantile.h"
#include "analysis/report/section_canvas.h"

namespace scree {
namespace {

constexpr unsigned kRestGrey = 0xbdbdbd;
constexpr int kFewestInArrow = 3;
constexpr double kLeastArrow = 0.1;  // of the longest; shorter ones are dots
constexpr double kArrowCells = 1.6;  // length of the arrow of the fastest cell

/// Moving grains of one cell: sums by mass.
struct CellFlow {
  double mass = 0, x = 0, z = 0, vx = 0, vz = 0;  // kg, kg m, kg m/s
  int grains = 0;
  double speed() const { return std::hypot(vx, vz) / mass; }
};

std::vector<CellFlow> cell_flows(const Snapshot& snapshot, const VerticalSection& section,
                                 double moving_speed) {
  std::map<std::pair<long, long>, CellFlow> cells;
  for (const Grain* grain : grains_behind_cut(snapshot.grains, section)) {
    if (!(grain->velocity.norm() > moving_speed)) continue;
    const Vec3 &p = grain->position, &v = grain->velocity;
    CellFlow& cell =
        cells[{std::lround(std::floor(p.x() / section.cell)), std::lround(std::floor(p.z() / section.cell))}];
    cell.mass += grain->mass, ++cell.grains;
    cell.x += grain->mass * p.x(), cell.z += grain->mass * p.z();
    cell.vx += grain->mass * v.x(), cell.vz += grain->mass * v.z();
  }
  std::vector<CellFlow> flows;
  for (const auto& [at, cell] : cells)
    if (cell.grains >= kFewestInArrow) flows.push_back(cell);
  return flows;
}

/// Arrows through the centres of mass of the cells, and one beside the pile that shows their scale. What
/// draws them goes to `above`.
std::string arrows(const std::vector<CellFlow>& flows, const VerticalSection& section,
                   const SectionFrame& frame, std::string& above) {
  double fastest = 0;
  for (const CellFlow& flow : flows) fastest = std::max(fastest, flow.speed());
  if (!(fastest > 0)) return "";
  const double scale = kArrowCells * section.cell / fastest;  // m of the picture for 1 m/s
  std::string script = "$arrows << END\n";
  for (const CellFlow& flow : flows) {
    if (flow.speed() < kLeastArrow * fastest) continue;
    const double dx = scale * flow.vx / flow.mass, dz = scale * flow.vz / flow.mass;
    script += fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}\n", flow.x / flow.mass - dx / 2,
                          flow.z / flow.mass - dz / 2, dx, dz);
  }
  const double speed = round_number_above(fastest / 2);
  const double from = frame.right - 0.02 * (frame.right - frame.left) - scale * speed;
  const double z = frame.high - 0.05 * (frame.high - frame.low);
  script += fmt::format(
      "{0:.5g} {1:.5g} {2:.5g} 0\nEND\nset label 100 {3} at {0:.5g},{1:.5g} right offset -0.7,0 tc rgb "
      "'#333333'\n",
      from, z, scale * speed, gnuplot_quoted(fmt::format("mean velocity, {:.3g} m/s", speed)));
  for (const char* look : {"filled size screen 0.008,18 lw 4 lc rgb '#ffffff'",
                           "filled size screen 0.008,18 lw 1.6 lc rgb '#c1121f'"})
    above += fmt::format(", $arrows using 1:2:3:4 with vectors {} notitle", look);
  return script;
}

}  // namespace

Picture draw_velocity(const Snapshot& snapshot, const std::vector<Grain>& fixed,
                      const VerticalSection& section, const std::filesystem::path& file,
                      double moving_speed) {
  check(section);
  const SectionCanvas canvas(frame_of(snapshot.grains, section), 1, section);
  std::vector<WeighedValue> speeds;
  for (const Grain* grain : grains_behind_cut(snapshot.grains, section))
    if (const double speed = grain->velocity.norm(); speed > moving_speed) speeds.push_back({speed, 1});
  const double fast = speeds.empty() ? 1 : std::ceil(mass_quantile(speeds, 0.98));
  const auto colour = [&](const Grain& grain) {
    const double speed = grain.velocity.norm();
    return speed > moving_speed ? viridis(speed / fast) : kRestGrey;
  };
  const std::string title = fmt::format("Speed at {:.1f} s: {}", snapshot.time, cut_words(section));
  std::string above, script = canvas.head() + viridis_palette() + canvas.panel(0, title, "speed (m/s)");
  script += fmt::format("set cbrange [0:{:.6g}]\nset cbtics scale 0.4\n", fast);
  script += disc_block(snapshot.grains, fixed, section, canvas, colour);
  script += arrows(cell_flows(snapshot, section, moving_speed), section, canvas.frame(), above);
  script += plot_discs(0, above);
  run_gnuplot(script + "unset multiplot\n", file);
  return {
      "Flow of a load", file,
      fmt::format("The load {:.1f} s into the run: grains coloured by speed, those at rest grey; red arrows "
                  "are mean velocities of the moving rock.",
                  snapshot.time)};
}

}  // namespace scree
