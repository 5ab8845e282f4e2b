// scree field: gradings of a slope's sections in many pictures: statistics, fines, conductivity, a dataset.
#include "cli/field.h"

#include <fmt/format.h>

#include <optional>

#include "analysis/field/field_analysis.h"
#include "analysis/field/field_report.h"
#include "analysis/field/printed_values.h"
#include "cli/commands.h"
#include "cli/ensemble/field_dataset.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/written_dataset.h"
#include "sim/scene/scenario.h"

namespace fs = std::filesystem;

namespace {

/// The options with the files that the thesis's chapter was made from.
FieldCliOptions with_thesis(FieldCliOptions options) {
  if (!options.thesis) return options;
  const auto take = [](fs::path& path, const fs::path& file) {
    if (path.empty()) path = file;
  };
  take(options.gradings, asset_dir() / "field" / "canadian_malartic.csv");
  take(options.sieved, asset_dir() / "gradings" / "G0.csv");
  take(options.printed, asset_dir() / "reference" / "field.csv");
  if (options.limit.empty()) options.limit = "0.254m";
  return options;
}

/// Every input of the command, read and checked.
struct Inputs {
  scree::SlopeGradings gradings;
  scree::FieldOptions options;
  std::vector<scree::PrintedValue> printed;
};

/// None, with a message, if something is wrong.
std::optional<Inputs> read_inputs(const FieldCliOptions& options) {
  const auto refuse = [](const std::string& message) {
    fmt::print(stderr, "{}\n", message);
    return std::nullopt;
  };
  if (options.gradings.empty()) return refuse("scree: a table of gradings is needed, or --thesis");
  if (options.sieved.empty() != options.limit.empty())
    return refuse(
        "--sieved and --limit belong together: a grading file, and the diameter below which it counts");
  if (!options.observables.empty() && options.scenario.empty())
    return refuse("--observables: a dataset names the scenario that simulates it: --scenario FILE");
  Inputs inputs;
  inputs.options.void_ratio = options.void_ratio;
  if (!options.limit.empty()) {
    const auto limit = length_in("--limit", options.limit);
    if (!limit) return std::nullopt;
    inputs.options.limit = *limit;
  }
  try {
    inputs.gradings = scree::read_slope_gradings(options.gradings);
    if (!options.original.empty()) inputs.options.original = scree::read_grading(options.original);
    if (!options.sieved.empty()) inputs.options.sieved = scree::read_grading(options.sieved);
    if (!options.printed.empty()) inputs.printed = scree::read_printed_values(options.printed);
  } catch (const std::runtime_error& error) {
    return refuse(error.what());
  }
  return inputs;
}

// The dataset of the sections; none, with a message, if its scenario cannot be had.
std::optional<WrittenDataset> dataset_of(const FieldCliOptions& options, const scree::FieldAnalysis& field,
                                         int sections) {
  if (!is_of_kind(options.scenario, scree::FileKind::scenario)) return std::nullopt;
  scree::ScenarioResult loaded =
      scree::load_scenario(options.scenario, {}, asset_dir(), scree::ReadFor::numbers);
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return std::nullopt;
  const scree::FieldDatasetRequest request{options.scenario,
                                           scree::measured_sections(loaded.scenario, sections),
                                           options.gradings.filename().string(), options.observables};
  return WrittenDataset(options.out / "dataset", [&field, request](const fs::path& folder) {
    return scree::write_field_dataset(field, request, folder);
  });
}

}  // namespace

int run_field(const FieldCliOptions& given) {
  FieldCliOptions options = with_thesis(given);
  const auto inputs = read_inputs(options);
  if (!inputs) return kBadInput;
  scree::FieldAnalysis field;
  std::vector<scree::HeldValue> printed;
  try {
    field = scree::analyse_field(inputs->gradings, inputs->options);
    if (!inputs->printed.empty())
      printed = scree::hold_against(inputs->gradings, inputs->options, inputs->printed);
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "{}: {}\n", options.gradings.string(), error.what());
    return kBadInput;
  }
  if (options.out.empty()) options.out = free_run_folder(options.gradings.stem().string());
  if (!may_fill(options.out, options.force)) return kBadInput;
  std::optional<WrittenDataset> dataset;
  if (!options.scenario.empty()) {
    dataset = dataset_of(options, field, inputs->gradings.sections);
    if (!dataset || dataset->check() != kOk) return kBadInput;
  }
  if (!prepare_folder(options.out, options.force)) return kBadInput;
  for (const std::string& line : scree::field_in_words(field, printed)) fmt::print("{}\n", line);
  if (dataset) dataset->put_in_place();
  return tell_report(
      options.out, scree::write_field_report(options.gradings.stem().string(), field, printed, options.out));
}
