#include "analysis/image/rock_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "sim/material/random.h"

namespace scree {
namespace {

// Diameters whose outlines cover the wanted area. The grading is one of mass: mass is sought by bisection.
std::vector<double> diameters_for(const Grading& grading, const SceneSettings& settings) {
  const double wanted = settings.coverage * settings.width * settings.height;
  const auto area_of = [](const std::vector<double>& diameters) {
    double area = 0;
    for (const double d : diameters) area += std::numbers::pi / 4 * d * d;
    return area;
  };
  // Area over mass is a number of the grading alone, but for the draw.
  double mass = wanted * grading.diameter(0.5) * settings.density / 1.5;
  std::vector<double> diameters;
  for (int k = 0; k < 4; ++k) {
    diameters = generate_diameters(grading, mass, {settings.density}, settings.seed, 1);
    const double area = area_of(diameters);
    if (std::abs(area - wanted) < 0.02 * wanted) break;
    mass *= wanted / area;
  }
  return diameters;
}

// Grains laid so far, found by the cell that their centre is in.
class LaidGrains {
 public:
  LaidGrains(double width, double height, double largest)
      : cell_(largest),
        columns_(static_cast<int>(width / cell_) + 1),
        rows_(static_cast<int>(height / cell_) + 1),
        cells_(columns_ * rows_) {}

  void add(const Grain& grain) {
    cells_[row(grain.position.y()) * columns_ + column(grain.position.x())].push_back(grain);
  }
  // Calls `look` with every grain that may be nearer than a largest diameter.
  template <class Look>
  void around(double x, double y, Look look) const {
    for (int r = std::max(row(y) - 1, 0); r <= std::min(row(y) + 1, rows_ - 1); ++r)
      for (int c = std::max(column(x) - 1, 0); c <= std::min(column(x) + 1, columns_ - 1); ++c)
        for (const Grain& grain : cells_[r * columns_ + c]) look(grain);
  }

 private:
  int column(double x) const { return std::clamp(static_cast<int>(x / cell_), 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>(y / cell_), 0, rows_ - 1); }
  double cell_;
  int columns_, rows_;
  std::vector<std::vector<Grain>> cells_;
};

class Layout {
 public:
  Layout(const SceneSettings& settings, const Grading& grading)
      : settings_(settings),
        gap_(0.5 * grading.min_diameter()),
        random_(settings.seed, 2, RandomPurpose::picture),
        laid_(settings.width, settings.height, 1.15 * grading.max_diameter() + grading.min_diameter()) {}

  // A place that nobody has, or none after many tries.
  std::optional<Vec3> place(double diameter, double rank, const std::vector<Grain>& before) {
    for (int attempt = 0; attempt < 4000; ++attempt) {
      // Most grains that touch join others; some begin clusters of their own all over the picture.
      const bool joins = settings_.layout == GrainLayout::touching && !before.empty() && attempt < 3000 &&
                         random_.uniform() < 0.8;
      Vec3 at = joins ? beside(before, diameter) : anywhere(diameter);
      // Coarse grains are taken more often at the foot, fine ones at the top.
      const double down = at.y() / settings_.height;
      if (random_.uniform() * (1 + std::abs(settings_.segregation)) >
          1 + settings_.segregation * (2 * rank - 1) * (2 * down - 1))
        continue;
      if (!inside(at, diameter) || !settle(at, diameter)) continue;
      return at;
    }
    return std::nullopt;
  }
  void add(const Grain& grain) { laid_.add(grain); }

 private:
  Vec3 anywhere(double diameter) {
    const double r = diameter / 2;
    const double x = random_.uniform(r, settings_.width - r);
    return {x, random_.uniform(r, settings_.height - r), 0};
  }
  Vec3 beside(const std::vector<Grain>& before, double diameter) {
    const auto pick = static_cast<std::size_t>(random_.uniform() * static_cast<double>(before.size()));
    const double angle = random_.uniform(0, 2 * std::numbers::pi);
    const double reach = (before[pick].diameter + diameter) / 2 * (1 + 1e-9);
    return before[pick].position + reach * Vec3(std::cos(angle), std::sin(angle), 0);
  }
  bool inside(const Vec3& at, double diameter) const {
    const double r = diameter / 2;
    if (at.x() < r || at.y() < r || at.x() > settings_.width - r || at.y() > settings_.height - r)
      return false;
    return at.x() + r < settings_.width - settings_.target_margin || at.y() - r > settings_.target_margin;
  }
  // Gives the place its height; false where another grain is in the way.
  bool settle(Vec3& at, double diameter) const {
    const double r = diameter / 2;
    if (settings_.layout == GrainLayout::overlapping) {
      at.z() = r;
      laid_.around(at.x(), at.y(), [&](const Grain& below) {
        const double reach = r + below.diameter / 2;
        const double apart = std::hypot(at.x() - below.position.x(), at.y() - below.position.y());
        if (apart < reach)
          at.z() = std::max(at.z(), below.position.z() + std::sqrt(reach * reach - apart * apart));
      });
      return true;
    }
    // Those that touch are sunk to their middles, so that outline meets outline.
    at.z() = settings_.layout == GrainLayout::touching ? 0 : r;
    bool free = true;
    laid_.around(at.x(), at.y(), [&](const Grain& other) {
      double reach = r + other.diameter / 2;
      if (settings_.layout == GrainLayout::apart) reach += 0.15 * r + gap_;
      free &= std::hypot(at.x() - other.position.x(), at.y() - other.position.y()) >= reach;
    });
    return free;
  }

  const SceneSettings& settings_;
  double gap_;  // between grains that lie apart, m
  Random random_;
  LaidGrains laid_;
};

}  // namespace

RockScene make_scene(const Grading& grading, const SceneSettings& settings) {
  const double largest = grading.max_diameter();
  if (largest > 0.5 * std::min(settings.width, settings.height))
    throw std::invalid_argument(fmt::format(
        "the largest grain, {:.3g} m, is more than half of the picture of {:.3g} m x {:.3g} m: take "
        "more pixels, or more metres a pixel",
        largest, settings.width, settings.height));
  std::vector<double> diameters = diameters_for(grading, settings);
  if (settings.layout == GrainLayout::overlapping) {
    // A pile is no sorted one: any size may lie on any other.
    Random shuffle(settings.seed, 3, RandomPurpose::picture);
    for (std::size_t i = diameters.size(); i > 1; --i)
      std::swap(diameters[i - 1],
                diameters[static_cast<std::size_t>(shuffle.uniform() * static_cast<double>(i))]);
  }
  RockScene scene{settings.width, settings.height, {}, {}};
  Layout layout(settings, grading);
  for (const double d : diameters) {
    const auto at = layout.place(d, grading.passing(d), scene.grains);
    if (!at)
      throw std::invalid_argument(
          fmt::format("no room for a grain of {:.3g} m after {} of {} grains: take a coverage below {:.2g}",
                      d, scene.grains.size(), diameters.size(), settings.coverage));
    Grain grain;
    grain.id = static_cast<std::int64_t>(scene.grains.size()) + 1;
    grain.position = *at;
    grain.diameter = d;
    grain.mass = settings.density * std::numbers::pi / 6 * d * d * d;
    layout.add(grain);
    scene.grains.push_back(grain);
  }
  return scene;
}

RockScene view_of_slope(const std::vector<Grain>& pile, const std::vector<Grain>& ground, double slope_deg,
                        double margin) {
  if (pile.empty()) throw std::invalid_argument("a view needs at least one grain");
  const double angle = slope_deg * std::numbers::pi / 180;
  // Down the slope, out of it to the camera, and to the right of who stands at the toe.
  const Vec3 down(std::cos(angle), 0, -std::sin(angle)), out(std::sin(angle), 0, std::cos(angle));
  const Vec3 right = out.cross(down);
  const auto turned = [&](const Vec3& p) { return Vec3(p.dot(right), p.dot(down), p.dot(out)); };
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Grain& grain : pile) {
    const Vec3 at = turned(grain.position);
    low = low.cwiseMin((at.array() - grain.diameter / 2).matrix());
    high = high.cwiseMax((at.array() + grain.diameter / 2).matrix());
  }
  const Vec3 corner(low.x() - margin, low.y() - margin, low.z());
  RockScene scene{high.x() - low.x() + 2 * margin, high.y() - low.y() + 2 * margin, pile, ground};
  for (auto* grains : {&scene.grains, &scene.ground})
    for (Grain& grain : *grains) grain.position = turned(grain.position) - corner;
  return scene;
}

}  // namespace scree
