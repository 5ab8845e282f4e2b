#include "analysis/image/rock_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "analysis/image/graded_heights.h"
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

double area_of(const std::vector<Grain>& grains) {
  double area = 0;
  for (const Grain& grain : grains) area += std::numbers::pi / 4 * grain.diameter * grain.diameter;
  return area;
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
  // Calls `look` with every grain that may be nearer than a largest diameter, as long as it returns true.
  template <class Look>
  void around(double x, double y, Look look) const {
    for (int r = std::max(row(y) - 1, 0); r <= std::min(row(y) + 1, rows_ - 1); ++r)
      for (int c = std::max(column(x) - 1, 0); c <= std::min(column(x) + 1, columns_ - 1); ++c)
        for (const Grain& grain : cells_[r * columns_ + c])
          if (!look(grain)) return;
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

  // A place that nobody has, at about the height that is wanted and in its band, or none after many tries:
  // the more of them were in vain, the farther off it may be, in the end anywhere.
  std::optional<Vec3> place(double diameter, const GradedHeight& height, const std::vector<Grain>& before) {
    // Most grains that touch join others; some begin clusters of their own all over the picture.
    bool joins = settings_.layout == GrainLayout::touching && !before.empty() && random_.uniform() < 0.8;
    for (int attempt = 0; attempt < 4000; ++attempt) {
      const double slack = settings_.height / 96 * std::exp2(attempt / 600.0);
      Heights allowed{std::max(diameter / 2, height.wanted - slack),
                      std::min(settings_.height - diameter / 2, height.wanted + slack)};
      if (attempt < 2000) allowed = {std::max(allowed.low, height.low), std::min(allowed.high, height.high)};
      joins &= attempt < 3000;
      const std::optional<Vec3> at = joins ? beside(before, diameter, allowed) : anywhere(diameter, allowed);
      if (!at) {
        joins = false;
        continue;
      }
      Vec3 settled = *at;
      if (inside(settled, diameter) && settle(settled, diameter)) return settled;
    }
    return std::nullopt;
  }
  void add(const Grain& grain) { laid_.add(grain); }

 private:
  struct Heights {
    double low, high;  // m down the picture
  };
  Vec3 anywhere(double diameter, const Heights& allowed) {
    const double r = diameter / 2;
    const double x = random_.uniform(r, settings_.width - r);
    return {x, random_.uniform(allowed.low, allowed.high), 0};
  }
  // Touching a grain; none where there is hardly one to be touched at these heights.
  std::optional<Vec3> beside(const std::vector<Grain>& before, double diameter, const Heights& allowed) {
    for (int draw = 0; draw < 500; ++draw) {
      const auto pick = static_cast<std::size_t>(random_.uniform() * static_cast<double>(before.size()));
      const double angle = random_.uniform(0, 2 * std::numbers::pi);
      const double reach = (before[pick].diameter + diameter) / 2 * (1 + 1e-9);
      const Vec3 at = before[pick].position + reach * Vec3(std::cos(angle), std::sin(angle), 0);
      if (at.y() >= allowed.low && at.y() <= allowed.high) return at;
    }
    return std::nullopt;
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
        return true;
      });
      return true;
    }
    // Those that touch are sunk to their middles, so that outline meets outline.
    at.z() = settings_.layout == GrainLayout::touching ? 0 : r;
    bool free = true;
    laid_.around(at.x(), at.y(), [&](const Grain& other) {
      double reach = r + other.diameter / 2;
      if (settings_.layout == GrainLayout::apart) reach += 0.15 * r + gap_;
      return free = std::hypot(at.x() - other.position.x(), at.y() - other.position.y()) >= reach;
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
  struct Wanted {
    double diameter;  // m
    GradedHeight height;
  };
  std::vector<Wanted> wanted;
  const std::vector<double> diameters = diameters_for(grading, settings);
  const std::vector<GradedHeight> heights = graded_heights(diameters, grading, settings);
  for (std::size_t k = 0; k < diameters.size(); ++k) wanted.push_back({diameters[k], heights[k]});
  if (settings.layout == GrainLayout::overlapping) {
    // A pile is no sorted one: any size may lie on any other.
    Random shuffle(settings.seed, 3, RandomPurpose::picture);
    for (std::size_t i = wanted.size(); i > 1; --i)
      std::swap(wanted[i - 1], wanted[static_cast<std::size_t>(shuffle.uniform() * static_cast<double>(i))]);
  }
  RockScene scene{settings.width, settings.height, {}, {}};
  Layout layout(settings, grading);
  for (const auto& [d, height] : wanted) {
    const auto at = layout.place(d, height, scene.grains);
    if (!at) {
      const double laid = area_of(scene.grains) / (settings.width * settings.height);
      throw NoRoom(
          fmt::format("no room for a grain of {:.3g} m after {} of {} grains: take a coverage below {:.2g}",
                      d, scene.grains.size(), wanted.size(), settings.coverage),
          laid);
    }
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

RockScene make_scene_with_room(const Grading& grading, SceneSettings& settings) {
  for (;;) {
    try {
      return make_scene(grading, settings);
    } catch (const NoRoom& none) {
      const double less = std::floor(100 * std::min(none.coverage, settings.coverage - 0.01) + 1e-9) / 100;
      if (!(less > 0)) throw;
      settings.coverage = less;
    }
  }
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
  RockScene scene{
      high.x() - low.x() + 2 * margin, high.y() - low.y() + 2 * margin, pile, ground, slope_deg, -corner.y()};
  for (auto* grains : {&scene.grains, &scene.ground})
    for (Grain& grain : *grains) grain.position = turned(grain.position) - corner;
  return scene;
}

}  // namespace scree
