#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/image/photo_analysis.h"

namespace scree {
namespace {

constexpr double kMostOfASection = 0.5;  // of its mass: the rest of its grains decide over little
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

ImageGrading grading_of(std::string name, const std::vector<double>& diameters,
                        const std::vector<double>& masses) {
  ImageGrading out;
  out.name = std::move(name);
  out.grains = static_cast<int>(diameters.size());
  out.chi = kNone;
  if (diameters.empty()) {
    out.d10 = out.d15 = out.d30 = out.d50 = out.d60 = out.d80 = out.d90 = out.d95 = out.cu = out.cc = kNone;
    return out;
  }
  const PassingCurve& curve = out.curve.emplace(diameters, masses);
  out.mass = curve.mass();
  out.d10 = curve.diameter(0.10);
  out.d15 = curve.diameter(0.15);
  out.d30 = curve.diameter(0.30);
  out.d50 = curve.diameter(0.50);
  out.d60 = curve.diameter(0.60);
  out.d80 = curve.diameter(0.80);
  out.d90 = curve.diameter(0.90);
  out.d95 = curve.diameter(0.95);
  out.cu = out.d60 / out.d10;
  out.cc = out.d30 * out.d30 / (out.d10 * out.d60);
  return out;
}

}  // namespace

std::vector<ImageGrading> gradings_of(const std::vector<double>& diameters, const std::vector<double>& masses,
                                      const std::vector<int>& section, int sections) {
  std::vector<ImageGrading> out{grading_of("whole", diameters, masses)};
  for (int k = 0; k < sections; ++k) {
    std::vector<double> d, m;
    for (std::size_t i = 0; i < diameters.size(); ++i)
      if (section[i] == k) {
        d.push_back(diameters[i]);
        m.push_back(masses[i]);
      }
    out.push_back(grading_of(fmt::format("S{}", k + 1), d, m));
  }
  if (!out[0].curve) return out;
  // Thesis, chapter 3: against the mean log d of all, over how far that of the coarsest quartile is above it.
  const double d0 = out[0].curve->mean_log_diameter(), dcq = out[0].curve->coarsest_quartile_log_diameter();
  for (ImageGrading& grading : out)
    if (grading.curve && dcq > d0) grading.chi = (grading.curve->mean_log_diameter() - d0) / (dcq - d0);
  return out;
}

std::vector<ImageGrading> gradings_of(const std::vector<ImageGrain>& grains, int sections, SizeModel model) {
  std::vector<double> diameters, masses;
  std::vector<int> section;
  for (const ImageGrain& grain : grains) {
    const GrainSize& size = grain.size[static_cast<std::size_t>(model)];
    diameters.push_back(size.diameter);
    masses.push_back(size.mass * grain.weight);
    section.push_back(grain.section);
  }
  return gradings_of(diameters, masses, section, sections);
}

std::vector<std::string> single_grain_notes(const std::vector<ImageGrain>& grains,
                                            const std::vector<ImageGrading>& gradings, SizeModel model) {
  std::vector<double> heaviest(gradings.size(), 0.0);
  for (const ImageGrain& grain : grains) {
    const double mass = grain.size[static_cast<std::size_t>(model)].mass * grain.weight;
    for (const std::size_t k : {std::size_t{0}, static_cast<std::size_t>(grain.section) + 1})
      heaviest[k] = std::max(heaviest[k], mass);
  }
  std::vector<std::string> notes;
  for (std::size_t k = gradings.size() > 2 ? 0 : 1; k < gradings.size(); ++k)
    if (heaviest[k] > kMostOfASection * gradings[k].mass)
      notes.push_back(
          fmt::format("one grain is {:.0f} % of the mass of {}: its D_x and chi are those of this grain",
                      100 * heaviest[k] / gradings[k].mass, k == 0 ? "the whole" : gradings[k].name));
  return notes;
}

}  // namespace scree
