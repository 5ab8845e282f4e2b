#include "cli/ensemble/output_scope.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

OutputScope output_scope(const Scenario& scenario) {
  return {std::string(experiment_type(scenario)), scenario.output.sections, scenario.output.further_sections,
          scenario.output.after_dumps, false};
}

MeasuredSections measured_sections(const Scenario& scenario, int sections) {
  const std::vector<int>& further = scenario.output.further_sections;
  if (scenario.output.sections == sections) return {};
  if (std::find(further.begin(), further.end(), sections) != further.end())
    return {{}, fmt::format("of{}", sections)};
  return {{fmt::format("output.sections={}", sections)}, {}};
}

std::string why_not_given(const Scenario& scenario, const std::string& output) {
  return why_not_given(output_scope(scenario), output);
}

std::string why_not_measured(const Scenario& scenario, const std::string& output) {
  OutputScope scope = output_scope(scenario);
  scope.measured = true;
  return why_not_given(scope, output);
}

std::string why_not_given(const Sweep& sweep, const std::string& output) {
  std::string why;
  for (const SweepPoint& point : sweep.points) {
    const std::string here = why_not_given(point.scenario, output);
    if (here.empty()) return here;
    if (why.empty()) why = here;
  }
  return why;
}

}  // namespace scree
