#include "analysis/image/image_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/report/report_text.h"

namespace scree {
namespace {

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string grading_row(std::size_t image, std::size_t section, const ImageGrading& grading,
                        const std::string& name) {
  const PassingCurve& curve = *grading.curve;
  std::string row = fmt::format("{},{}", image, section);
  for (const double cm : {curve.diameter(1), grading.d95, grading.d90, grading.d80, grading.d60, grading.d50,
                          grading.d30, grading.d15, grading.d10, curve.diameter(0)})
    row += fmt::format(",{:.2f}", 100 * cm);
  return row + fmt::format(",{:.2f},{:.2f},{},{},{},{}\n", grading.cu, grading.cc,
                           std::isfinite(grading.chi) ? fmt::format("{:.3f}", grading.chi) : "",
                           grading.grains, number(grading.mass), name);
}

constexpr const char* kGradingColumns =
    "image,section,d100_cm,d95_cm,d90_cm,d80_cm,d60_cm,d50_cm,d30_cm,d15_cm,d10_cm,d0_cm,cu,cc,chi,grains,"
    "mass_kg,"
    "picture\n";

}  // namespace

std::string grains_csv(const std::vector<AnalysedPhoto>& photos, SizeModel model, double shape_factor) {
  std::string text = fmt::format(
      "# Outlines of photographs; sizes by the model {}. elongation b/a, circularity 4 pi area / "
      "perimeter^2, roundness "
      "4 area / (pi feret_max^2), flatness c/b = {:g} taken for all\n"
      "image,section,x_px,y_px,diameter_m,mass_kg,a_m,b_m,angle_deg,feret_max_m,feret_min_m,area_cm2,"
      "circularity,"
      "elongation,roundness,weight\n",
      name_of(model), shape_factor);
  for (std::size_t i = 0; i < photos.size(); ++i)
    for (const ImageGrain& grain : photos[i].found.grains) {
      const GrainShape& shape = grain.shape;
      const GrainSize& size = grain.size[static_cast<std::size_t>(model)];
      const double m = grain.m_per_px;
      text += fmt::format(
          "{},{},{:.1f},{:.1f},{:.5g},{:.5g},{:.5g},{:.5g},{:.1f},{:.5g},{:.5g},{:.5g},{:.3f},{:.3f},{:.3f},"
          "{:.4f}\n",
          i + 1, grain.section + 1, shape.x, shape.y, size.diameter, size.mass, shape.major * m,
          shape.minor * m, shape.angle_deg, shape.feret_max * m, shape.feret_min * m,
          1e4 * shape.area * m * m, shape.circularity(), shape.elongation(), shape.roundness(), grain.weight);
    }
  return text;
}

std::string gradings_csv(const std::vector<AnalysedPhoto>& photos) {
  std::string text = kGradingColumns;
  for (std::size_t i = 0; i < photos.size(); ++i)
    for (std::size_t k = 0; k < photos[i].gradings.size(); ++k)
      if (photos[i].gradings[k].curve)
        text += grading_row(i + 1, k, photos[i].gradings[k], csv_field(photos[i].name));
  return text;
}

std::string models_csv(const std::vector<AnalysedPhoto>& photos, int sections) {
  std::string text = std::string("model,") + kGradingColumns;
  for (const SizeModel model : kSizeModels)
    for (std::size_t i = 0; i < photos.size(); ++i) {
      const std::vector<ImageGrading> gradings = gradings_of(photos[i].found.grains, sections, model);
      for (std::size_t k = 0; k < gradings.size(); ++k)
        if (gradings[k].curve)
          text += fmt::format("{},{}", name_of(model),
                              grading_row(i + 1, k, gradings[k], csv_field(photos[i].name)));
    }
  return text;
}

std::string passing_csv(const std::vector<AnalysedPhoto>& photos) {
  std::string text = "image,section,diameter_mm,passing_pct\n";
  for (std::size_t i = 0; i < photos.size(); ++i)
    for (std::size_t k = 0; k < photos[i].gradings.size(); ++k) {
      const auto& curve = photos[i].gradings[k].curve;
      if (!curve) continue;
      const int first = static_cast<int>(std::floor(24 * std::log10(curve->diameter(0)))) - 1,
                last = static_cast<int>(std::ceil(24 * std::log10(curve->diameter(1))));
      for (int step = first; step <= last; ++step) {
        const double d = std::pow(10.0, step / 24.0);
        text += fmt::format("{},{},{:.5g},{:.3f}\n", i + 1, k, 1000 * d, 100 * curve->passing(d));
      }
    }
  return text;
}

std::string bias_csv(const ImageBias& bias) {
  std::string text = fmt::format(
      "# Known grains of virtual photographs, by true diameter. Outlines {}, of which {} belong to a known "
      "grain.\n"
      "diameter_low_m,diameter_high_m,visible,detected,detected_share,size_ratio,ln_ratio_std\n",
      bias.outlines, bias.matched);
  for (const BiasClass& size : bias.classes)
    text += fmt::format("{:.5g},{:.5g},{},{},{:.4f},{},{}\n", size.low, size.high, size.visible,
                        size.detected, static_cast<double>(size.detected) / size.visible, number(size.ratio),
                        number(size.deviation));
  return text;
}

}  // namespace scree
