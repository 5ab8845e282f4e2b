#include "analysis/report/inside_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "analysis/pile/mass_quantile.h"
#include "analysis/report/section_canvas.h"

namespace scree {
namespace {

// ColorBrewer RdBu (Brewer, 2003) with red for coarse: blue is finer than dumped.
constexpr const char* kDiverging =
    "set palette defined (-3 '#2166ac', -2 '#67a9cf', -1 '#d1e5f0', 0 '#ffffff', 1 '#fddbc7', 2 '#ef8a62', 3 "
    "'#b2182b')\n";

/// Slivers of a grain that reach into a box are not drawn as a cell.
bool has_rock(const Inside& inside, const InsideCell& cell) {
  const double box = inside.section.cell * inside.section.cell * 2 * inside.section.half_width;
  return cell.solid_volume > 0.1 * box;
}

/// A value of every cell that has rock; those without a number grey.
std::string cell_blocks(const Inside& inside, const char* name,
                        const std::function<double(const InsideCell&)>& value) {
  std::string known = fmt::format("${} << END\n", name), unknown = fmt::format("$no_{} << END\n", name);
  const double size = inside.section.cell;
  for (int k = 0; k < inside.nz; ++k)
    for (int i = 0; i < inside.nx; ++i) {
      const InsideCell& cell = inside.at(i, k);
      if (!has_rock(inside, cell)) continue;
      const double x = inside.x0 + i * size, z = inside.z0 + k * size, v = value(cell);
      const std::string corners = fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}", x + size / 2,
                                              z + size / 2, x, x + size, z, z + size);
      if (std::isfinite(v))
        known += fmt::format("{} {:.6g}\n", corners, v);
      else
        unknown += corners + "\n";
    }
  // A row far outside keeps a block from being empty, which gnuplot refuses.
  return known + "1e9 1e9 1e9 1e9 1e9 1e9 1\nEND\n" + unknown + "1e9 1e9 1e9 1e9 1e9 1e9\nEND\n";
}

std::string plot_cells(const char* name) {
  return fmt::format(
      "plot $no_{0} using 1:2:3:4:5:6 with boxxyerror fs solid 1.0 noborder lc rgb '#e4e4e4' notitle, ${0} "
      "using "
      "1:2:3:4:5:6:7 with boxxyerror fs solid 1.0 noborder lc palette notitle\n",
      name);
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool known() const { return low <= high; }
};

Range range_of(const Inside& inside, const std::function<double(const InsideCell&)>& value) {
  Range range;
  for (const InsideCell& cell : inside.cells)
    if (const double v = value(cell); std::isfinite(v))
      range = {std::min(range.low, v), std::max(range.high, v)};
  return range;
}

SectionFrame frame_of(const Inside& inside) {
  const double size = inside.section.cell;
  std::vector<WeighedValue> across;  // a stone that rolled far does not widen the picture
  double top = inside.section.ground(0);
  for (int k = 0; k < inside.nz; ++k)
    for (int i = 0; i < inside.nx; ++i) {
      if (!has_rock(inside, inside.at(i, k))) continue;
      across.push_back({inside.x0 + (i + 0.5) * size, inside.at(i, k).mass});
      top = std::max(top, inside.z0 + (k + 1) * size);
    }
  if (across.empty()) throw std::invalid_argument("no grain lies in the section that is to be drawn");
  SectionFrame frame{mass_quantile(across, 0.002), mass_quantile(across, 0.998), 0, top};
  if (inside.section.bench) {
    frame.left = std::min(frame.left, 0.0);
    frame.right = std::max(frame.right, inside.section.bench->toe());
  }
  return {frame.left - 2 * size, frame.right + 2 * size, -0.5 * size, frame.high + size};
}

/// One step of colour for each dump, where there are few enough to be told apart; ticks in their middle.
std::string dump_scale(int first, int last) {
  const int n = last - first + 1;
  std::string out = viridis_palette();
  if (n <= 32) {
    out = "set palette defined (";
    for (int k = 0; k < n; ++k)
      out += fmt::format("{0}{1} '#{3:06x}', {2} '#{3:06x}'", k == 0 ? "" : ", ", k, k + 1,
                         viridis(n > 1 ? static_cast<double>(k) / (n - 1) : 0.5));
    out += ")\n";
  }
  const int step = static_cast<int>(std::max(1.0, round_number_above(n / 12.0)));
  return out + fmt::format("set cbrange [{}:{}]\nset cbtics {} scale 0.4\n", first - 0.5, last + 0.5, step);
}

}  // namespace

Picture draw_layers(const std::vector<Grain>& pile, const std::vector<Grain>& fixed,
                    const VerticalSection& section, const std::filesystem::path& file) {
  check(section);
  const SectionCanvas canvas(frame_of(pile, section), 1, section);
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const Grain& grain : pile) first = std::min(first, grain.dump), last = std::max(last, grain.dump);
  const auto colour = [&](const Grain& grain) {
    return viridis(last > first ? static_cast<double>(grain.dump - first) / (last - first) : 0.5);
  };
  std::string script = canvas.head() + canvas.panel(0, "Layers: " + cut_words(section), "number of the dump");
  script += dump_scale(first, last);
  script += disc_block(pile, fixed, section, canvas, colour) + plot_discs(first);
  run_gnuplot(script + "unset multiplot\n", file);
  return {"Layers inside the pile", file,
          "A cut through the pile; each colour is the rock of one dump, from the first (dark) to the last "
          "(yellow)."};
}

bool shows_rock(const Inside& inside) {
  for (int k = 0; k < inside.nz; ++k)
    for (int i = 0; i < inside.nx; ++i)
      if (has_rock(inside, inside.at(i, k))) return true;
  return false;
}

Picture draw_inside(const Inside& inside, const std::filesystem::path& file) {
  const auto chi = [](const InsideCell& cell) { return cell.chi; };
  const auto porosity = [](const InsideCell& cell) { return cell.porosity; };
  const auto ksat = [](const InsideCell& cell) { return cell.ksat_grading; };
  const VerticalSection& section = inside.section;
  Range pores = range_of(inside, porosity);
  std::vector<std::string> notes{
      fmt::format("Cells of {0:.3g} m by {0:.3g} m, {1:.3g} m deep across the section.", section.cell,
                  2 * section.half_width),
      "Grey: too few grains for a grading; porosity only where a cell lies wholly inside the pile."};
  if (pores.low < 0)
    notes.emplace_back("Porosity below 0: soft grains overlap by more than the voids between them.");
  const SectionCanvas canvas(frame_of(inside), 3, section, notes);
  std::string script = canvas.head() + cell_blocks(inside, "chi", chi) +
                       cell_blocks(inside, "porosity", porosity) + cell_blocks(inside, "ksat", ksat);

  // Chi falls far below 0 in a little rock at the crest; that must not wash out the rest.
  std::vector<WeighedValue> chis;
  for (const InsideCell& cell : inside.cells)
    if (std::isfinite(cell.chi)) chis.push_back({std::abs(cell.chi), cell.mass});
  const double most = chis.empty() ? 1 : std::max(0.5, 0.5 * std::ceil(2 * mass_quantile(chis, 0.95)));
  script += canvas.panel(0, "Segregation degree: red is coarser than dumped, blue finer", "χ");
  script += kDiverging + fmt::format("set cbrange [{:.6g}:{:.6g}]\nset cbtics 0.5 scale 0.4\n", -most, most);
  script += plot_cells("chi");

  if (!pores.known()) pores = {0, 1};
  if (pores.high - pores.low < 0.02) pores = {pores.low - 0.01, pores.high + 0.01};
  script += canvas.panel(1, "Porosity", "share of voids");
  script += viridis_palette() + fmt::format("set cbrange [{:.6g}:{:.6g}]\n", pores.low, pores.high) +
            "set cbtics autofreq\n";
  script += plot_cells("porosity");

  Range ratios = range_of(inside, ksat);
  if (!ratios.known()) ratios = {1, 1};
  ratios = {std::min(ratios.low, 0.5), std::max(ratios.high, 2.0)};
  script +=
      canvas.panel(2, "Conductivity over that of the rock as dumped, by grading (Kozeny-Carman)", "ratio");
  script += fmt::format("set logscale cb\nset cbrange [{:.6g}:{:.6g}]\n", ratios.low, ratios.high);
  if (ratios.high / ratios.low < 200)
    script += fmt::format("set cbtics ({})\n", log_ticks(ratios.low, ratios.high));
  else
    script += "set format cb '%g'\n";
  script += plot_cells("ksat");
  run_gnuplot(script + "unset multiplot\n", file);
  return {
      "Inside the pile", file,
      "Where coarse and fine rock lie inside the pile, how much void is between them, and how much more or "
      "less water they let through than the rock as it was dumped."};
}

}  // namespace scree
