#include "cli/ensemble/observable_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <vector>

#include "analysis/outputs.h"

namespace scree {
namespace {

bool contains(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

int loads_of(const Scenario& scenario) {
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment)) return dump->dumps;
  if (const auto* push = std::get_if<PushDump>(&scenario.experiment)) return push->dumps;
  return 1;
}

}  // namespace

std::string why_not_given_by(const Scenario& scenario, const std::string& output) {
  if (const std::string why = why_not_given(std::string(experiment_type(scenario)), output); !why.empty())
    return why;
  static const std::regex section(".*_S([0-9]{1,4})(of([0-9]{1,4}))?(_dump([0-9]{1,6}))?");
  std::smatch parts;
  if (!std::regex_match(output, parts, section)) return "";
  const OutputSpec& spec = scenario.output;
  int count = spec.sections;
  if (parts[3].matched) {
    count = std::stoi(parts[3]);
    if (count == spec.sections)
      return fmt::format("{} sections are the scenario's own number: leave out 'of{}'", count, count);
    if (!contains(spec.further_sections, count))
      return fmt::format("the scenario is not cut into {} sections; add them to output.further_sections",
                         count);
  }
  if (std::stoi(parts[1]) > count)
    return fmt::format("the scenario has {} sections: S1 to S{}", count, count);
  if (!parts[5].matched) return "";
  const int dump = std::stoi(parts[5]), last = loads_of(scenario);
  if (dump == last) return fmt::format("load {} is the last: leave out '_dump{}'", dump, dump);
  if (!contains(spec.after_dumps, dump))
    return fmt::format("the pile after load {} is not analysed; add it to output.after_dumps", dump);
  return "";
}

}  // namespace scree
