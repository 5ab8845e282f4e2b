// scree study: disposal options of one rock, ranked.
#include "analysis/cases/study.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/ensemble/study_file.h"
#include "cli/ensemble/sweep_results.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"

namespace fs = std::filesystem;

namespace {

std::vector<scree::StudyOption> options_of(const scree::Study& study,
                                           const std::vector<scree::PointResults>& points) {
  std::vector<scree::StudyOption> options;
  for (std::size_t k = 0; k < points.size(); ++k) {
    scree::StudyOption option;
    option.name = points[k].point->values.front();
    option.tonnes_per_load = study.options[k].tonnes_per_load;
    option.cost_per_t = study.options[k].cost_per_t;
    option.runs = scree::finished(points[k]);
    options.push_back(std::move(option));
  }
  return options;
}

}  // namespace

int run_study(const StudyOptions& options) {
  if (!is_of_kind(options.file, scree::FileKind::study)) return kBadInput;
  const scree::StudyResult loaded = scree::load_study(options.file, asset_dir());
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return kBadInput;
  const scree::Study& study = loaded.study;
  const std::string& by = options.rank_by.empty() ? study.rank_by : options.rank_by;
  const scree::StudyCriterion* criterion = scree::study_criterion(by);
  if (criterion == nullptr) {
    std::string names;
    for (const auto& each : scree::study_criteria())
      names += fmt::format("{}{}", names.empty() ? "" : ", ", each.name);
    fmt::print(stderr, "--rank-by {}: no such criterion; there are {}\n", by, names);
    return kBadInput;
  }
  if (!options.out.empty() && !may_fill(options.out, options.force)) return kBadInput;
  const std::vector<scree::RunRequest> requests = scree::requests_of(study.sweep, asset_dir());
  const auto store = open_store(options.ensemble.store, options.list ? StoreUse::list : StoreUse::change);
  if (!store) return kBadInput;
  scree::EnsembleProgress progress;
  if (!options.list) progress = run_with_progress(requests, *store, options.ensemble);
  const auto ranked = options_of(study, scree::look_up(study.sweep, requests, *store));
  for (const std::string& line : scree::study_in_words(ranked, *criterion)) fmt::print("{}\n", line);
  if (interrupted) {
    fmt::print(stderr, "interrupted; the same command goes on from here\n");
    return kInterrupted;
  }
  const fs::path out = options.out.empty() ? free_run_folder(study.sweep.name) : options.out;
  if (!prepare_folder(out, options.force)) return kBadInput;
  const int code = tell_report(
      out, scree::write_study(study.sweep.name, study.currency, ranked, *criterion, loaded.warnings, out));
  return progress.failed > 0 ? kFailed : code;
}
