#include "analysis/pile/inside.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/pile/mass_quantile.h"
#include "analysis/pile/permeability.h"
#include "analysis/pile/segregation.h"
#include "analysis/pile/sphere_box.h"
#include "analysis/pile/surface_height.h"

namespace scree {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kGroundShare = 0.01;  // of a box, above which a cell belongs to the ground
constexpr double kRoofed = 0.95;       // of its plan, below which a cell lies at the surface
constexpr double kLeastRock = 0.1;     // of a box, for a grading
constexpr int kLattice = 8;            // points of the surface along a cell

constexpr InsideCell kNoCell{CellPlace::empty, 0, 0, 0, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};

double volume(const Grain& grain) {
  return std::numbers::pi / 6 * std::pow(grain.diameter, 3);
}

/// What collects in a cell while grains are handed out.
struct Content {
  std::vector<double> diameters, masses;
  double dump_moment = 0, fixed_volume = 0;
};

/// The original material, as conductivity and chi are relative to it.
struct Original {
  explicit Original(const std::vector<Grain>& grains) {
    if (grains.empty()) throw std::invalid_argument("the original material has no grain");
    std::vector<double> diameters, masses;
    for (const Grain& grain : grains) {
      diameters.push_back(grain.diameter);
      masses.push_back(grain.mass);
    }
    const PassingCurve curve(std::move(diameters), masses);
    mean_log = curve.mean_log_diameter();
    spread = curve.coarsest_quartile_log_diameter() - mean_log;
    pores = {curve.diameter(0.1), curve.diameter(0.5), curve.diameter(0.6) / curve.diameter(0.1), kNaN};
  }
  double mean_log = 0, spread = 0;
  PoreMaterial pores;
};

class Collector {
 public:
  Collector(Inside& inside) : inside_(inside), contents_(inside.cells.size()) {}

  /// Calls `part(cell index, share of the volume)` for each cell that the grain reaches into.
  template <class Part>
  void share_out(const Grain& grain, Part part) const {
    const VerticalSection& s = inside_.section;
    const double r = grain.diameter / 2, whole = volume(grain);
    const auto first = [&](double at, double origin) {
      return std::max(0, static_cast<int>(std::floor((at - origin) / s.cell)));
    };
    const int i1 = std::min(inside_.nx - 1, first(grain.position.x() + r, inside_.x0));
    const int k1 = std::min(inside_.nz - 1, first(grain.position.z() + r, inside_.z0));
    for (int k = first(grain.position.z() - r, inside_.z0); k <= k1; ++k)
      for (int i = first(grain.position.x() - r, inside_.x0); i <= i1; ++i) {
        const Vec3 low(inside_.x0 + i * s.cell, s.y0 - s.half_width, inside_.z0 + k * s.cell);
        const Vec3 high = low + Vec3(s.cell, 2 * s.half_width, s.cell);
        const double inside = sphere_in_box(grain.position, r, low, high);
        if (inside <= 1e-12 * whole) continue;
        part(static_cast<std::size_t>(k * inside_.nx + i), inside / whole);
      }
  }

  void add(const Grain& grain) {
    share_out(grain, [&](std::size_t at, double share) {
      InsideCell& cell = inside_.cells[at];
      ++cell.grains;
      cell.mass += share * grain.mass;
      cell.solid_volume += share * volume(grain);
      contents_[at].diameters.push_back(grain.diameter);
      contents_[at].masses.push_back(share * grain.mass);
      contents_[at].dump_moment += share * grain.mass * grain.dump;
    });
  }

  void add_fixed(const Grain& ball) {
    share_out(ball,
              [&](std::size_t at, double share) { contents_[at].fixed_volume += share * volume(ball); });
  }

  const Content& content(std::size_t at) const { return contents_[at]; }

 private:
  Inside& inside_;
  std::vector<Content> contents_;
};

CellPlace place_of(const Inside& inside, int i, int k, double fixed_volume, const SurfaceHeight& surface) {
  const VerticalSection& s = inside.section;
  if (inside.at(i, k).mass <= 0) return CellPlace::empty;
  const double left = inside.x0 + i * s.cell, bottom = inside.z0 + k * s.cell, top = bottom + s.cell;
  // Part of the box's face below the ground, which is straight between the points of the lattice but for the
  // crest and the toe.
  double ground = 0;
  for (int n = 0; n < kLattice; ++n)
    ground += std::clamp((s.ground(left + (n + 0.5) * s.cell / kLattice) - bottom) / s.cell, 0.0, 1.0);
  const double box = s.cell * s.cell * 2 * s.half_width;
  if (ground / kLattice + fixed_volume / box > kGroundShare) return CellPlace::ground;
  return surface.share_above(left, left + s.cell, top) < kRoofed ? CellPlace::surface : CellPlace::interior;
}

void describe_grading(InsideCell& cell, const Content& content, const Original& original) {
  const PassingCurve curve(content.diameters, content.masses);
  cell.d10 = curve.diameter(0.1);
  cell.d50 = curve.diameter(0.5);
  cell.cu = curve.diameter(0.6) / cell.d10;
  cell.chi = original.spread > 0 ? (curve.mean_log_diameter() - original.mean_log) / original.spread : kNaN;
  cell.dump = content.dump_moment / cell.mass;
}

/// 90th over 10th percentile.
double contrast(const std::vector<WeighedValue>& values) {
  return mass_quantile(values, 0.9) / mass_quantile(values, 0.1);
}

void describe_conductivity(Inside& inside, PoreMaterial original) {
  std::vector<WeighedValue> by_grading, whole;
  for (InsideCell& cell : inside.cells) {
    if (std::isnan(cell.d10)) continue;
    PoreMaterial here{cell.d10, cell.d50, cell.cu, 1};
    original.void_ratio = here.void_ratio;
    cell.ksat_grading = conductivity_ratio_kozeny_carman(here, original);
    by_grading.push_back({cell.ksat_grading, 1});
    // Neither formula holds where soft grains overlap so much that no void is left.
    if (!(cell.porosity > 0 && inside.original_void_ratio > 0)) continue;
    here.void_ratio = void_ratio(cell.porosity);
    original.void_ratio = inside.original_void_ratio;
    cell.ksat_kozeny_carman = conductivity_ratio_kozeny_carman(here, original);
    cell.ksat_taylor = conductivity_ratio_taylor(here, original);
    whole.push_back({cell.ksat_kozeny_carman, 1});
  }
  inside.ksat_grading_contrast = contrast(by_grading);
  inside.ksat_contrast = contrast(whole);
}

/// Grid around the grains that reach into the band.
void lay_cells(Inside& inside, const std::vector<Grain>& pile) {
  const VerticalSection& s = inside.section;
  double left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;
  for (const Grain& grain : pile) {
    const double r = grain.diameter / 2;
    if (std::abs(grain.position.y() - s.y0) >= s.half_width + r) continue;
    left = std::min(left, grain.position.x() - r), right = std::max(right, grain.position.x() + r);
    low = std::min(low, grain.position.z() - r), high = std::max(high, grain.position.z() + r);
  }
  if (!(left < right)) return;
  const double i0 = std::floor(left / s.cell), k0 = std::floor(low / s.cell);
  inside.x0 = i0 * s.cell, inside.z0 = k0 * s.cell;
  inside.nx = static_cast<int>(std::ceil(right / s.cell) - i0);
  inside.nz = static_cast<int>(std::ceil(high / s.cell) - k0);
  inside.cells.assign(static_cast<std::size_t>(inside.nx) * static_cast<std::size_t>(inside.nz), kNoCell);
}

}  // namespace

const InsideCell& Inside::at(int i, int k) const {
  if (i < 0 || i >= nx || k < 0 || k >= nz)
    throw std::out_of_range(fmt::format("no cell ({}, {}) in a section of {} by {}", i, k, nx, nz));
  return cells[static_cast<std::size_t>(k * nx + i)];
}

Inside analyse_inside(const std::vector<Grain>& pile, const std::vector<Grain>& fixed,
                      const std::vector<Grain>& original_grains, const VerticalSection& section,
                      const InsideOptions& options) {
  check(section);
  if (options.fewest_grains < 1)
    throw std::invalid_argument(fmt::format("{} grains: at least 1 is needed", options.fewest_grains));
  if (options.original_void_ratio && !(*options.original_void_ratio > 0))
    throw std::invalid_argument(fmt::format("void ratio {} must be above 0", *options.original_void_ratio));
  const Original original(original_grains);

  Inside inside;
  inside.section = section;
  inside.mean_porosity = inside.mean_abs_chi = kNaN;
  inside.ksat_grading_contrast = inside.ksat_contrast = kNaN;
  inside.original_void_ratio = options.original_void_ratio.value_or(kNaN);
  lay_cells(inside, pile);
  if (inside.cells.empty()) return inside;
  Collector collector(inside);
  for (const Grain& grain : pile) collector.add(grain);
  for (const Grain& ball : fixed) collector.add_fixed(ball);

  const SurfaceHeight surface(pile, section.y0 - section.half_width, section.y0 + section.half_width,
                              section.cell / kLattice);
  const double box = section.cell * section.cell * 2 * section.half_width;
  double solid = 0, room = 0, mass = 0, moment = 0;
  for (int k = 0; k < inside.nz; ++k)
    for (int i = 0; i < inside.nx; ++i) {
      const auto at = static_cast<std::size_t>(k * inside.nx + i);
      const Content& content = collector.content(at);
      InsideCell& cell = inside.cells[at];
      cell.place = place_of(inside, i, k, content.fixed_volume, surface);
      if (cell.place == CellPlace::interior) {
        cell.porosity = 1 - cell.solid_volume / box;
        solid += cell.solid_volume, room += box;
      }
      if (cell.grains < options.fewest_grains || cell.solid_volume < kLeastRock * box) continue;
      describe_grading(cell, content, original);
      if (std::isfinite(cell.chi)) mass += cell.mass, moment += cell.mass * std::abs(cell.chi);
    }
  if (mass > 0) inside.mean_abs_chi = moment / mass;
  if (room > 0) inside.mean_porosity = 1 - solid / room;
  if (!options.original_void_ratio && inside.mean_porosity > 0)
    inside.original_void_ratio = void_ratio(inside.mean_porosity);
  describe_conductivity(inside, original.pores);
  return inside;
}

}  // namespace scree
