#include "analysis/field/field_numbers.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <string_view>
#include <vector>

#include "analysis/pile/permeability.h"

namespace scree {
namespace {

using Parts = std::smatch;
using Number = std::optional<double>;

/// Names of one form, and what they mean.
struct Form {
  std::regex pattern;
  Number (*number)(const FieldAnalysis&, const Parts&);
};

const std::vector<double>* values_of(const FieldAnalysis& field, const std::string& quantity,
                                     const std::string& section) {
  const FieldSection* at = field.section(section);
  if (at == nullptr) return nullptr;
  const auto found = at->values.find(quantity);
  return found == at->values.end() ? nullptr : &found->second;
}

Number finite(double value) {
  return std::isfinite(value) ? Number(value) : std::nullopt;
}

Number statistic(const FieldAnalysis& field, const Parts& parts) {
  const auto* values = values_of(field, parts[1], parts[3]);
  if (values == nullptr) return std::nullopt;
  const Spread spread = spread_over(*values);
  const std::string which = parts[2];
  return finite(which == "mean"     ? spread.moments.mean
                : which == "std"    ? spread.moments.std
                : which == "median" ? spread.median
                : which == "min"    ? spread.min
                                    : spread.max);
}

std::optional<Histogram> bins_of(const FieldAnalysis& field, const std::string& quantity,
                                 const std::string& section) {
  const auto* values = values_of(field, quantity, section);
  if (values == nullptr || spread_over(*values).moments.n == 0) return std::nullopt;
  return histogram(*values, field.bin_of(quantity));
}

Number mode(const FieldAnalysis& field, const Parts& parts) {
  const auto bins = bins_of(field, parts[1], parts[3]);
  if (!bins) return std::nullopt;
  return parts[2] == "mode" ? bins->middle(bins->mode()) : bins->shares[bins->mode()];
}

Number frequency(const FieldAnalysis& field, const Parts& parts) {
  const auto bins = bins_of(field, parts[1], parts[3]);
  return bins ? Number(bins->share_at(std::stod(parts[2]))) : std::nullopt;
}

Number between(const FieldAnalysis& field, const Parts& parts) {
  const auto* values = values_of(field, parts[1], parts[4]);
  if (values == nullptr) return std::nullopt;
  const double low = std::stod(parts[2]), high = std::stod(parts[3]);
  double inside = 0, all = 0;
  for (const double value : *values) {
    if (!std::isfinite(value)) continue;
    all += 1;
    if (value >= low && value <= high) inside += 1;
  }
  return finite(inside / all);
}

Number picture(const FieldAnalysis& field, const Parts& parts) {
  const auto* values = values_of(field, parts[1], parts[3]);
  const auto at = std::find(field.pictures.begin(), field.pictures.end(), parts[2].str());
  if (values == nullptr || at == field.pictures.end()) return std::nullopt;
  return finite((*values)[static_cast<std::size_t>(at - field.pictures.begin())]);
}

Number increase(const FieldAnalysis& field, const Parts& parts) {
  const auto *first = values_of(field, parts[1], parts[2]), *last = values_of(field, parts[1], parts[3]);
  if (first == nullptr || last == nullptr) return std::nullopt;
  return finite(mean_std(*last).mean / mean_std(*first).mean - 1);
}

Number slope(const FieldAnalysis& field, const Parts& parts) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const FieldSection& section : field.sections) {
    const auto* values = values_of(field, parts[1], section.name);
    if (values == nullptr) return std::nullopt;
    const double mean = mean_std(*values).mean;
    n += 1, x += section.x_over_l, y += mean;
    xx += section.x_over_l * section.x_over_l, xy += section.x_over_l * mean;
  }
  return finite((n * xy - x * y) / (n * xx - x * x));
}

std::optional<std::vector<double>> ratios(const FieldAnalysis& field, const std::string& quantity,
                                          const std::string& crest, const std::string& toe) {
  if (values_of(field, quantity, crest) == nullptr || values_of(field, quantity, toe) == nullptr)
    return std::nullopt;
  return ratio_over_pictures(*field.section(toe), *field.section(crest), quantity);
}

Number ratio(const FieldAnalysis& field, const Parts& parts) {
  const auto all = ratios(field, parts[1], parts[3], parts[4]);
  return all ? finite(sample_quantile(*all, parts[2] == "min" ? 0 : 1)) : std::nullopt;
}

Number ratio_above(const FieldAnalysis& field, const Parts& parts) {
  const auto all = ratios(field, parts[1], parts[3], parts[4]);
  if (!all) return std::nullopt;
  const double bound = std::stod(parts[2]);
  return static_cast<double>(std::count_if(all->begin(), all->end(), [&](double r) { return r > bound; }));
}

Number place(const FieldAnalysis& field, const Parts& parts) {
  const double wanted = std::stod(parts[2]);
  double x = NAN, y = NAN;
  for (const FieldSection& section : field.sections) {
    const auto* values = values_of(field, parts[1], section.name);
    if (values == nullptr) return std::nullopt;
    const double here = mean_std(*values).mean, at = section.x_over_l;
    if (!std::isfinite(here)) continue;  // no picture tells
    if (y < wanted && here >= wanted) return x + (at - x) * (wanted - y) / (here - y);
    x = at, y = here;
  }
  return std::nullopt;
}

Number fit(const FieldAnalysis& field, const Parts& parts) {
  const FieldSection* section = field.section(parts[3]);
  if (section == nullptr) return std::nullopt;
  const OriginFit& line = parts[1].matched ? section->chi_given_fit : section->chi_fit;
  return finite(parts[2] == "fit" ? line.slope : line.r2);
}

Number passing_std(const FieldAnalysis& field, const Parts& parts) {
  const FieldSection* section = field.section(parts[2]);
  if (section == nullptr || section->envelope.empty()) return std::nullopt;
  const auto& all = section->envelope;
  if (parts[1] == "max") {
    return finite(
        std::max_element(all.begin(), all.end(), [](const EnvelopePoint& a, const EnvelopePoint& b) {
          return a.std < b.std;
        })->std);
  }
  const double diameter = std::stod(parts[1].str().substr(3));
  return finite(std::min_element(all.begin(), all.end(), [&](const EnvelopePoint& a, const EnvelopePoint& b) {
                  return std::abs(a.diameter - diameter) < std::abs(b.diameter - diameter);
                })->std);
}

// The curve that a name begins with: median, mean, meandiameter, and the same with "filled".
CurveKind kind_of(const std::string& which) {
  return which.starts_with("meandiameter") ? CurveKind::mean_diameters
         : which.starts_with("mean")       ? CurveKind::means
                                           : CurveKind::medians;
}
bool has_fines(const std::string& which) {
  return which.ends_with("filled");
}
const Grading* curve_of(const FieldAnalysis& field, const std::string& which, const std::string& section) {
  const FieldSection* at = field.section(section);
  return at == nullptr ? nullptr : at->curve(kind_of(which), has_fines(which));
}

Number of_curve(const FieldAnalysis& field, const Parts& parts) {
  const Grading* curve = curve_of(field, parts[1], parts[3]);
  if (curve == nullptr) return std::nullopt;
  const std::string what = parts[2];
  if (what == "cu") return curve->cu();
  if (what == "cc") return curve->cc();
  return curve->diameter(std::stod(what.substr(1)) / 100);
}

Number share(const FieldAnalysis& field, const Parts& parts) {
  const Grading* curve = curve_of(field, parts[1], parts[4]);
  if (curve == nullptr) return std::nullopt;
  return curve->passing(std::stod(parts[3])) - curve->passing(std::stod(parts[2]));
}

Number conductivity(const FieldAnalysis& field, const Parts& parts) {
  const Grading* curve = curve_of(field, parts[1], parts[3]);
  const auto dumped = field.as_dumped(kind_of(parts[1]), has_fines(parts[1]));
  if (curve == nullptr || !dumped) return std::nullopt;
  return parts[2] == "kcm" ? conductivity_ratio_kozeny_carman(pore_material(*curve), pore_material(*dumped))
                           : conductivity_ratio_taylor(pore_material(*curve), pore_material(*dumped));
}

const std::vector<Form>& forms() {
  const std::string section = "_(whole|S[0-9]+)", value = "_(-?[0-9]+(?:\\.[0-9]+)?)",
                    curve = "((?:median|mean|meandiameter)(?:filled)?)";
  static const std::vector<Form> all{
      {std::regex("(.+)_(mean|std|median|min|max)" + section), statistic},
      {std::regex("(.+)_(mode|modefrequency)" + section), mode},
      {std::regex("(.+)_frequency" + value + section), frequency},
      {std::regex("(.+)_between" + value + value + section), between},
      {std::regex("(.+)_picture_([^_]+)" + section), picture},
      {std::regex("(.+)_increase" + section + section), increase},
      {std::regex("(.+)_slope"), slope},
      {std::regex("(.+)_ratio(min|max)" + section + section), ratio},
      {std::regex("(.+)_ratioabove" + value + section + section), ratio_above},
      {std::regex("(.+)_place" + value), place},
      {std::regex("chi(given)?_(fit|r2)" + section), fit},
      {std::regex("passingstd_(max|at_[0-9]+(?:\\.[0-9]+)?)" + section), passing_std},
      {std::regex(curve + "_(d[0-9]{1,2}|d100|cu|cc)" + section), of_curve},
      {std::regex(curve + "_share" + value + value + section), share},
      {std::regex(curve + "_(kcm|taylor)" + section), conductivity},
  };
  return all;
}

}  // namespace

std::optional<double> field_number(const FieldAnalysis& field, const std::string& name) {
  for (const Form& form : forms()) {
    Parts parts;
    if (!std::regex_match(name, parts, form.pattern)) continue;
    if (const Number number = form.number(field, parts)) return number;
  }
  return std::nullopt;
}

}  // namespace scree
