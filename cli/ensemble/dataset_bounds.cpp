#include "cli/ensemble/dataset_bounds.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <regex>

#include "analysis/results/output_units.h"
#include "sim/scene/estimate.h"

namespace scree {
namespace {

constexpr double kMostChi = 5;           // chi of sections lies within 1 or so
constexpr double kOutsideGrading = 1.5;  // a factor
constexpr double kApart = 20;            // %; closer diameters may change places by errors of measurement
constexpr double kErrors = 5;            // standard uncertainties
constexpr double kRounding = 1 + 1e-9;   // of a mass in other units

// What is known of an experiment.
struct Known {
  Grading grading;
  double mass_t;
};

class BoundCheck {
 public:
  BoundCheck(const std::filesystem::path& file, Dataset& dataset, std::vector<ScenarioError>& errors)
      : file_(file), dataset_(dataset), errors_(errors) {
    for (const Dataset::Experiment& each : dataset.experiments)
      known_.push_back({effective_model(each.scenario).grading, total_mass(each.scenario) / 1000});
  }

  void run() {
    for (const Dataset::Observable& row : dataset_.observables) check(row);
  }

 private:
  void check(const Dataset::Observable& row) {
    static const std::regex diameter("d([0-9]{2})_m(_.*)"), mass("mass_t_.*|carried_back_t"),
        chi("(.*_)?chi(_.*)?"), signed_number("chi_.*|.*_deg|layer_coarsening_down"),
        share(
            "inside_porosity|largest_at_toe|chi_zero_x_over_l|mass_share_.*|share_above_1m_.*|layer_variance_"
            ".*");
    const Known& known = known_[row.experiment];
    const auto& experiment = dataset_.experiments[row.experiment].scenario.experiment;
    std::smatch parts;
    if (std::regex_match(row.output, parts, diameter))
      return check_diameter(row, std::stod(parts[1]), parts[2], known.grading);
    const double error = kErrors * row.uncertainty;  // a value near a bound may lie beyond it
    if (std::regex_match(row.output, share)) {
      if (row.value < -error || row.value > 1 + error) fail(row, "lies between 0 and 1");
      return;
    }
    if (row.value < -error && !std::regex_match(row.output, signed_number)) fail(row, "must not be below 0");
    if (std::regex_match(row.output, chi) && std::abs(row.value) > kMostChi)
      fail(row, fmt::format("chi lies between -{0:g} and {0:g}", kMostChi));
    if (unit_of_output(row.output) == "deg" && std::abs(row.value) > 90)
      fail(row, "angles lie between -90 and 90 deg");
    if (std::regex_match(row.output, mass) && row.value > known.mass_t * kRounding + error)
      fail(row, fmt::format("only {:g} t are dumped", known.mass_t));
    if (const auto* drop = std::get_if<DropTest>(&experiment);
        drop != nullptr && row.output == "rebound_height_m" && row.value > drop->height)
      fail(row, fmt::format("the rock falls from {:g} m", drop->height));
  }

  void check_diameter(const Dataset::Observable& row, double percent, const std::string& part,
                      const Grading& grading) {
    if (row.value <= 0) return fail(row, "must be above 0");
    const double least = grading.min_diameter(), most = grading.max_diameter();
    if (row.value < least / kOutsideGrading || row.value > most * kOutsideGrading)
      dataset_.notes.push_back(fmt::format("{}:{}: {} is {:g} m, and the grading goes from {:g} to {:g} m",
                                           file_.filename().string(), row.line, dataset_.label(row),
                                           row.value, least, most));
    auto& others = diameters_[{row.experiment, part}];
    for (const auto& [at, other] : others) {
      const bool coarser = percent > at;
      if (std::abs(percent - at) >= kApart &&
          (coarser ? row.value < other->value : row.value > other->value)) {
        fail(row, fmt::format("must not be {} {}, {:g} m in line {}", coarser ? "below" : "above",
                              other->output, other->value, other->line));
        break;
      }
    }
    others[percent] = &row;
  }

  void fail(const Dataset::Observable& row, const std::string& why) {
    const std::string unit = unit_of_output(row.output);
    errors_.push_back({file_.string(), row.line, 0,
                       fmt::format("{} is {:g}{}{}: {}", dataset_.label(row), row.value,
                                   unit.empty() ? "" : " ", unit, why)});
  }

  const std::filesystem::path& file_;
  Dataset& dataset_;
  std::vector<ScenarioError>& errors_;
  std::vector<Known> known_;  // by experiment
  std::map<std::pair<std::size_t, std::string>, std::map<double, const Dataset::Observable*>> diameters_;
};

}  // namespace

void check_bounds(const std::filesystem::path& file, Dataset& dataset, std::vector<ScenarioError>& errors) {
  BoundCheck(file, dataset, errors).run();
}

}  // namespace scree
