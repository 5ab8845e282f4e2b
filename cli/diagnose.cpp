// scree diagnose: where simulation and measurement disagree, and which effect the model lacks.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "analysis/diagnose/fitted_parameters.h"
#include "analysis/diagnose/outcome.h"
#include "analysis/diagnose/words.h"
#include "cli/commands.h"
#include "cli/ensemble/diagnosis_session.h"
#include "cli/ensemble/scenario_patch.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/progress.h"
#include "cli/run_folder.h"
#include "cli/run_through.h"
#include "sim/io/text_file.h"
#include "sim/material/input_bytes.h"
#include "sim/scene/estimate.h"
#include "sim/scene/scenario_values.h"

namespace fs = std::filesystem;

namespace {

// What the design costs, and what of it is there.
void print_plan(const scree::DiagnosisSession& session, const scree::ResultsStore& store) {
  std::set<std::string> all, still_to_come;  // experiments may share simulations
  double left = 0;
  bool known = true;
  for (std::size_t e = 0; e < session.design().size(); ++e) {
    // Readings of one pile are one simulation; a pile is not kept after its readings.
    std::set<std::string> piles, to_come;
    std::size_t timed = 0, readings = 0;
    double seconds = 0;
    for (const scree::RunRequest& request : session.design()[e].requests) {
      const auto result = store.find(request.key);
      const bool done = result && result->state == scree::RunState::done,
                 reading = request.pile != request.key;
      piles.insert(request.pile);
      readings += reading;
      if (!done) to_come.insert(request.pile);
      if (done && !reading) {
        ++timed;
        seconds += result->wall_seconds;
      }
    }
    const std::size_t here = piles.size() - to_come.size();
    fmt::print("{:<20} {:>5} simulations, {} in the store", session.data().experiments[e].name, piles.size(),
               here);
    if (timed > 0)
      fmt::print(", {} each", scree::spell_duration(seconds / static_cast<double>(timed)));
    else
      fmt::print(", about {:.0f} spheres each",
                 scree::estimated_spheres(session.data().experiments[e].scenario));
    if (readings > 0) fmt::print("; {} more readings of their piles", readings);
    fmt::print("\n");
    all.insert(piles.begin(), piles.end());
    const std::size_t before = still_to_come.size();
    still_to_come.insert(to_come.begin(), to_come.end());
    const std::size_t more = still_to_come.size() - before;
    if (timed > 0)
      left += seconds / static_cast<double>(timed) * static_cast<double>(more);
    else
      known = more == 0 && known;
  }
  fmt::print(
      "{} simulations, {} of them in the store; then one to {} rounds of up to {} about what may be named, "
      "and last {} of each model that the answer shows if its fit has moved\n",
      all.size(), all.size() - still_to_come.size(), session.most_rounds(), session.most_in_a_round(),
      session.of_a_model());
  for (const std::string& note : session.data().notes) fmt::print("note: {}\n", note);
  if (known)
    fmt::print("about {} are left, one run after another\n", scree::spell_duration(left));
  else
    fmt::print("nothing is known of the time of some experiments yet: their first simulations will tell\n");
}

// The fitted model, as a scenario of every experiment.
void write_patches(const scree::DiagnosisSession& session, const scree::DiagnosisModel& model,
                   const scree::DiagnosisOutcome& outcome, const fs::path& out) {
  const scree::SimulatedModel* fitted = scree::handed_over(outcome);
  if (fitted == nullptr) return;
  std::vector<std::string> comment{
      outcome.augmented ? "The fitted model with the effect that was named." : "The re-calibrated model.",
      "Values as simulated in full; the answer says the middles of the intervals:"};
  for (const std::string& value : scree::simulated_in_words(outcome)) comment.push_back("  " + value);
  for (const scree::Dataset::Experiment& experiment : session.data().experiments) {
    const fs::path file = out / (experiment.name + ".yaml");
    scree::write_text_file(
        file,
        scree::scenario_patch(experiment.file, out,
                              scree::overrides_at(model, session.space(), experiment, fitted->at), comment));
    fmt::print("scenario: {}\n", file.string());
  }
}

scree::DiagnosisOrigin origin_of(const DiagnoseOptions& options, const scree::DiagnosisModel& model,
                                 const std::vector<scree::Dataset>& datasets) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const auto whole = [](const fs::path& file) { return fs::absolute(file).lexically_normal(); };
  scree::DiagnosisOrigin origin{model.title,
                                whole(options.model),
                                {},
                                program_version(),
                                fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now)),
                                command_line()};
  for (std::size_t k = 0; k < datasets.size(); ++k)
    origin.data.push_back({datasets[k].title, datasets[k].source, whole(options.datasets[k])});
  return origin;
}

}  // namespace

int run_diagnose(const DiagnoseOptions& options) {
  if (!is_of_kind(options.model, scree::FileKind::model)) return kBadInput;
  const scree::DiagnosisModelResult loaded = scree::load_model(options.model, asset_dir());
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  std::vector<scree::Dataset> datasets;
  if (given_twice(options.datasets)) return kBadInput;
  for (const fs::path& file : options.datasets) {
    if (!is_of_kind(file, scree::FileKind::dataset)) return kBadInput;
    scree::DatasetResult dataset = scree::load_dataset(file, asset_dir());
    if (!nothing_wrong(dataset.errors)) return kBadInput;
    for (const scree::Dataset::Experiment& experiment : dataset.dataset.experiments) {
      if (!nothing_wrong(scree::why_not_simulated(loaded.model, experiment, asset_dir()))) return kBadInput;
    }
    datasets.push_back(std::move(dataset.dataset));
  }
  for (const std::string& name : options.without)
    if (scree::find_effect(name) == nullptr) {
      fmt::print(stderr, "--without {}: no such effect{}; the model looks for {}\n", name,
                 scree::suggestion(name, loaded.model.effects), scree::join(loaded.model.effects));
      return kBadInput;
    }
  const scree::DiagnosisOrigin origin = origin_of(options, loaded.model, datasets);
  scree::DiagnosisSession session(loaded.model, scree::join_datasets(datasets), options.without, asset_dir(),
                                  cores_or(options.ensemble.jobs));
  if (!options.plan && !options.out.empty() && !may_fill(options.out, options.force)) return kBadInput;
  const auto store = open_store(options.ensemble.store, options.plan ? StoreUse::plan : StoreUse::change);
  if (!store) return kBadInput;
  if (options.plan) {
    print_plan(session, *store);
    return kOk;
  }
  scree::DiagnosisOutcome outcome;
  try {
    outcome = session.run(run_through(*store, options.ensemble));
  } catch (const scree::Stopped& stopped) {
    fmt::print(stderr, "{}\n", stopped.what());
    return kInterrupted;
  }
  const fs::path out = options.out.empty() ? free_run_folder(loaded.model.name) : options.out;
  if (!prepare_folder(out, options.force)) return kBadInput;
  for (const std::string& line : scree::diagnosis_in_words(outcome)) fmt::print("{}\n", line);
  for (const std::string& note : outcome.notes) fmt::print("note: {}\n", note);
  const std::vector<std::string> missing = scree::write_diagnosis(origin, outcome, out);
  write_patches(session, loaded.model, outcome, out);
  return tell_report(out, missing);
}
