#include "analysis/results/finished_runs.h"

#include <fmt/format.h>

namespace scree {

std::string runs_in_words(const std::string& name, const FinishedRuns& runs) {
  return fmt::format(
      "{}: {} run{} done, {} not run, {} failed, {} left out because they did not come to rest", name,
      runs.seeds.size(), runs.seeds.size() == 1 ? "" : "s", runs.missing, runs.failed, runs.restless);
}

MeanStd spread_of(const std::vector<Outputs>& seeds,
                  const std::function<std::optional<double>(const Outputs&)>& number) {
  std::vector<double> values;
  for (const Outputs& seed : seeds)
    if (const auto value = number(seed)) values.push_back(*value);
  return mean_std(values);
}

MeanStd spread_of(const std::vector<Outputs>& seeds, const std::string& output) {
  return spread_of(seeds, [&](const Outputs& seed) {
    const auto found = seed.find(output);
    return found == seed.end() ? std::nullopt : std::optional(found->second);
  });
}

}  // namespace scree
