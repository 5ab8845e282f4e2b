// scree reproduce: the cases of the thesis, and every value printed for them beside ours.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "analysis/cases/reproduction.h"
#include "cli/commands.h"
#include "cli/ensemble/sweep_results.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/printed_values.h"

namespace fs = std::filesystem;

namespace {

fs::path case_dir() {
  return asset_dir().parent_path() / "scenarios" / "thesis";
}

// Files of the cases asked for; none, with a message, if one is not there.
std::vector<fs::path> case_files(const std::vector<std::string>& asked) {
  std::vector<std::string> known;
  for (const auto& item : fs::directory_iterator(case_dir()))
    if (item.path().extension() == ".yaml") known.push_back(item.path().stem());
  std::sort(known.begin(), known.end());
  std::vector<fs::path> files;
  for (std::string name : asked.empty() ? known : asked) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      fmt::print(stderr, "{}: no such case; there are {}\n", name, fmt::join(known, ", "));
      return {};
    }
    const fs::path file = case_dir() / (name + ".yaml");
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }
  return files;
}

std::vector<scree::CaseResult> results_of(const std::vector<scree::PointResults>& points,
                                          const std::vector<scree::ReferenceValue>& reference) {
  std::vector<scree::CaseResult> cases;
  for (const scree::PointResults& point : points) {
    const scree::Scenario& scenario = point.point->scenario;
    scree::CaseResult result;
    result.name = point.point->values.front();
    result.title = scenario.title;
    if (const auto* push = std::get_if<scree::PushDump>(&scenario.experiment))
      result.blade_velocity = push->blade.velocity;
    result.runs = scree::finished(point);
    for (const scree::Outputs& seed : result.runs.seeds) {
      const auto number = [&](const char* name) {
        const auto found = seed.find(name);
        return found == seed.end() ? 0.0 : found->second;
      };
      result.largest_overlap = std::max(result.largest_overlap, number("largest_overlap_ratio"));
      result.lost_mass += number("lost_mass_t");
    }
    result.comparison = scree::compare_with_reference(result.runs.seeds, reference, scenario.compare);
    cases.push_back(std::move(result));
  }
  return cases;
}

}  // namespace

int run_reproduce(const ReproduceOptions& options) {
  const std::vector<fs::path> files = case_files(options.cases);
  if (files.empty()) return kBadInput;
  const scree::SweepResult loaded = scree::load_cases(files, options.seeds, asset_dir());
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return kBadInput;
  const scree::Sweep& sweep = loaded.sweep;
  if (!options.out.empty() && !may_fill(options.out, options.force)) return kBadInput;
  if (!options.csv.empty() && !may_replace(options.csv, {options.from, store_file(options.ensemble.store)}))
    return kBadInput;

  const auto reference = printed_values();
  const auto differences = printed_trends();
  if (!reference || !differences) return kBadInput;
  std::vector<scree::PointResults> points;
  scree::EnsembleProgress progress;
  if (!options.from.empty()) {
    try {
      points = scree::read_sweep_csv(sweep, options.from, false);
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "{}\n", error.what());
      return kBadInput;
    }
  } else {
    const std::vector<scree::RunRequest> requests = scree::requests_of(sweep, asset_dir());
    const auto store = open_store(options.ensemble.store, options.list ? StoreUse::list : StoreUse::change);
    if (!store) return kBadInput;
    if (!options.list) progress = run_with_progress(requests, *store, options.ensemble);
    points = scree::look_up(sweep, requests, *store);
  }

  const auto cases = results_of(points, *reference);
  const auto trends = scree::compare_trends(cases, *differences);
  if (!options.csv.empty()) {
    scree::write_sweep_csv(sweep, points, options.csv);
    fmt::print("table: {}\n", options.csv.string());
  }
  const scree::ReproductionWords words = scree::reproduction_in_words(cases, trends);
  for (const auto* lines : {&words.runs, &words.trends, &words.apart, &words.counts})
    for (const std::string& line : *lines) fmt::print("{}\n", line);
  if (interrupted) {
    fmt::print(stderr, "interrupted; the same command goes on from here\n");
    return kInterrupted;
  }
  const fs::path out = options.out.empty() ? free_run_folder("reproduction") : options.out;
  if (!prepare_folder(out, options.force)) return kBadInput;
  const int code = tell_report(out, scree::write_reproduction(cases, trends, out));
  return progress.failed > 0 ? kFailed : code;
}
