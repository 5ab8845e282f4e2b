#include "cli/ensemble/diagnosis_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "analysis/diagnose/words.h"
#include "analysis/report/report_text.h"
#include "analysis/results/outputs.h"
#include "cli/ensemble/design.h"
#include "cli/ensemble/run_request.h"
#include "cli/ensemble/tried_models.h"
#include "sim/effects/effect.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Seeds of simulations; those of `scree twin` are others (twin.cpp).
constexpr std::uint64_t kBaseSeeds = 500'000, kEffectSeeds = 510'000, kCheckSeeds = 700'000;
constexpr std::uint64_t kSeedsOfOneEffect = 1000;
constexpr double kRivalBy = 20;  // ratio of probabilities up to which a rival is simulated, too
constexpr std::size_t kMostRivals = 2;
constexpr std::size_t kMostNext = 5;  // measurements proposed

// A number from a name (FNV-1a): an effect's design does not depend on which others a model looks for.
std::uint64_t hash_of(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

// The block of seeds of an effect's design, one of a hundred: that of its name, or the first behind it that
// no effect before it in the list of all has, so that new effects go to its end. Rival effects are simulated
// with other random numbers.
std::uint64_t seed_block(const std::string& name) {
  std::set<std::uint64_t> taken;
  for (const Effect& effect : all_effects()) {
    std::uint64_t block = hash_of(effect.name) % 100;
    while (!taken.insert(block).second) block = (block + 1) % 100;
    if (effect.name == name) return block;
  }
  throw std::invalid_argument("no effect is called " + name);
}

Eigen::VectorXd coordinates(const std::vector<double>& unit, std::size_t first, std::size_t count) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) x[static_cast<Eigen::Index>(k)] = 2 * unit[first + k] - 1;
  return x;
}

// Amplitudes spread over the range, none of them 0. Of effects of one sign the square roots are even: several
// do most of what they can in the lowest part of their range.
double amplitude(const CandidateEffect& effect, int k, int count) {
  const double low = effect.lowest(), high = effect.highest();
  const double share = static_cast<double>(k) / (count - 1), root = static_cast<double>(k + 1) / count;
  if (low >= 0) return high * root * root;
  if (high <= 0) return low * root * root;
  const double here = low + share * (high - low);
  return std::abs(here) > 1e-6 ? here : 0.5 * high / count;
}

// Readings of the piles over the base parameters with these effects on measurement, spread over their
// amplitudes and other parameters.
void read_piles(const ModelSpace& space, const SimulationCounts& counts,
                const std::vector<std::size_t>& effects, int readings, std::vector<PlannedRun>& runs) {
  std::string names;
  std::size_t axes = 0;
  for (const std::size_t e : effects) names += space.effects[e].name, axes += space.effects[e].axes.size();
  const auto points = latin_hypercube(readings, static_cast<int>(axes), hash_of(names));
  for (int k = 0; k < readings; ++k) {
    const PlannedRun& plain = runs[static_cast<std::size_t>(counts.nominal + k % counts.base)];
    PlannedRun reading{{plain.at.base, {}}, plain.seed, true};
    std::size_t axis = 0;
    for (const std::size_t e : effects) {
      const CandidateEffect& effect = space.effects[e];
      const auto& unit = points[static_cast<std::size_t>(k)];
      Eigen::VectorXd at(static_cast<Eigen::Index>(effect.axes.size()));
      at << amplitude(effect, static_cast<int>(unit[axis] * readings), readings),
          coordinates(unit, axis + 1, effect.axes.size() - 1);
      axis += effect.axes.size();
      reading.at.effects.push_back({e, at});
    }
    runs.push_back(std::move(reading));
  }
}

// What the model says of a key that the experiment sets otherwise: the model's word is taken.
std::vector<std::string> set_aside(const DiagnosisModel& model, const Dataset::Experiment& experiment) {
  const std::vector<std::string>& fixed = model.variation.fixed;
  std::vector<std::string> notes;
  for (const std::string& each : experiment.overrides) {
    const std::string key = each.substr(0, each.find('='));
    if (model.places.contains(key) && std::find(fixed.begin(), fixed.end(), each) == fixed.end())
      notes.push_back(fmt::format("experiment {} sets {}; what the model says of {} is taken",
                                  experiment.name, each, key));
  }
  return notes;
}

bool same(const DiagnosisVerdict& a, const DiagnosisVerdict& b, const Diagnosis& of_a,
          const Diagnosis& of_b) {
  if (a.kind != b.kind || a.named.size() != b.named.size()) return false;
  for (std::size_t k = 0; k < a.named.size(); ++k)
    if (of_a.judgements[a.named[k]].hypothesis.effects != of_b.judgements[b.named[k]].hypothesis.effects)
      return false;
  return true;
}

// The first of those that are named.
const Judgement* named_first(const Diagnosis& d) {
  return d.verdict.named.empty() ? nullptr : &d.judgements[d.verdict.named.front()];
}

// Effects and pairs whose fit can be simulated, as far as is known; most probable first.
std::vector<const Judgement*> open_to_simulation(const Diagnosis& d, const TriedModels& tried) {
  std::vector<const Judgement*> all;
  for (const Judgement& j : d.judgements)
    if (!j.hypothesis.effects.empty() && !tried.failed(j)) all.push_back(&j);
  return all;
}

// The first of them, whether it explains the data or not.
const Judgement* leading(const Diagnosis& d, const TriedModels& tried) {
  const std::vector<const Judgement*> open = open_to_simulation(d, tried);
  return open.empty() ? nullptr : open.front();
}

// The leading one, its rivals, and what would be named, which may be another: a hypothesis of which little
// was simulated explains almost anything.
std::vector<const Judgement*> worth_simulating(const std::vector<const Judgement*>& open,
                                               const Judgement* named) {
  std::vector<const Judgement*> all;
  for (const Judgement* j : open)
    if (all.size() <= kMostRivals && (all.empty() || j->probability * kRivalBy > all.front()->probability))
      all.push_back(j);
  if (named != nullptr && std::find(all.begin(), all.end(), named) == all.end()) all.push_back(named);
  return all;
}

}  // namespace

std::vector<PlannedRun> design_of(const ModelSpace& space, const SimulationCounts& counts) {
  std::vector<PlannedRun> runs;
  std::uint64_t seed = kBaseSeeds;
  for (int k = 0; k < counts.nominal; ++k) runs.push_back({{space.nominal(), {}}, ++seed});
  const std::size_t p = space.base.size();
  for (const auto& unit : sobol(counts.base, static_cast<int>(p)))
    runs.push_back({{coordinates(unit, 0, p), {}}, ++seed});
  for (std::size_t e = 0; e < space.effects.size(); ++e) {
    const CandidateEffect& effect = space.effects[e];
    const std::size_t others = effect.axes.size() - 1;
    const std::uint64_t own = hash_of(effect.name);
    if (effect.measures) {
      read_piles(space, counts, {e}, counts.effect, runs);
      for (std::size_t before = 0; before < e; ++before)
        if (const CandidateEffect& other = space.effects[before]; other.measures && other.goes_with(effect))
          read_piles(space, counts, {before, e}, (counts.effect + 1) / 2, runs);
      continue;
    }
    seed = kEffectSeeds + seed_block(effect.name) * kSeedsOfOneEffect;
    auto points = latin_hypercube(counts.effect, static_cast<int>(p + others), own);
    for (int k = 0; k < counts.effect; ++k) {
      const auto& unit = points[static_cast<std::size_t>(k)];
      Eigen::VectorXd at(static_cast<Eigen::Index>(1 + others));
      at << amplitude(effect, k, counts.effect), coordinates(unit, p, others);
      runs.push_back({{coordinates(unit, 0, p), {{e, at}}}, ++seed});
    }
  }
  return runs;
}

ExperimentRuns runs_of(const DiagnosisModel& model, const ModelSpace& space,
                       const Dataset::Experiment& experiment, const std::vector<PlannedRun>& planned,
                       const fs::path& asset_dir) {
  ExperimentRuns result;
  for (const PlannedRun& run : planned) {
    const auto& effects = run.at.effects;
    const auto acting = std::count_if(effects.begin(), effects.end(), [&](const EffectAt& e) {
      return space.effects[e.effect].acts_in(experiment.name);
    });
    if (!effects.empty() && acting < (run.where_all_act ? std::ssize(effects) : 1)) continue;
    const ScenarioResult loaded = load_scenario(
        experiment.file, overrides_at(model, space, experiment, run.at), asset_dir, ReadFor::numbers);
    if (!loaded.errors.empty())
      throw std::runtime_error(
          fmt::format("experiment {}: {}", experiment.name, loaded.errors.front().text()));
    result.runs.push_back(run);
    result.requests.push_back(run_request(loaded.scenario, run.seed, results_version(), asset_dir));
  }
  return result;
}

std::optional<Eigen::VectorXd> measured_in(const std::optional<StoredResult>& result,
                                           const std::vector<std::string>& outputs) {
  if (!result || result->state != RunState::done || !result->at_rest()) return {};
  Eigen::VectorXd values(static_cast<Eigen::Index>(outputs.size()));
  for (std::size_t c = 0; c < outputs.size(); ++c) {
    const auto found = result->outputs.find(outputs[c]);
    if (found == result->outputs.end() || !std::isfinite(found->second)) return {};
    values[static_cast<Eigen::Index>(c)] = found->second;
  }
  return values;
}

GatheredRuns gather(const ExperimentRuns& planned, const std::vector<std::optional<StoredResult>>& results,
                    const std::vector<std::string>& outputs) {
  GatheredRuns gathered;
  for (std::size_t k = 0; k < planned.runs.size(); ++k)
    if (const auto values = measured_in(results[k], outputs))
      gathered.runs.push_back({planned.runs[k].at, *values, planned.requests[k].pile});
    else
      gathered.left_out.push_back(planned.runs[k].at);
  return gathered;
}

JoinedData join_datasets(const std::vector<Dataset>& datasets) {
  JoinedData joined;
  std::map<std::string, int> names;
  std::set<std::string> taken;
  for (const Dataset& dataset : datasets)
    for (const Dataset::Experiment& experiment : dataset.experiments) ++names[experiment.name];
  std::vector<std::pair<const Dataset*, std::size_t>> rows;  // by joined value: where it stands
  for (const Dataset& dataset : datasets) {
    for (const std::string& note : dataset.notes) joined.notes.push_back(dataset.name + ": " + note);
    for (std::size_t e = 0; e < dataset.experiments.size(); ++e) {
      Dataset::Experiment experiment = dataset.experiments[e];
      if (names[experiment.name] > 1) experiment.name = dataset.name + "." + experiment.name;
      const std::string name = experiment.name;  // datasets may share a name, too
      for (int k = 2; !taken.insert(experiment.name).second; ++k)
        experiment.name = fmt::format("{}-{}", name, k);
      bool measured = false;
      for (std::size_t k = 0; k < dataset.observables.size(); ++k) {
        const Dataset::Observable& row = dataset.observables[k];
        if (row.experiment != e) continue;
        joined.measured.values.push_back({joined.experiments.size(), row.output,
                                          experiment.name + "/" + row.output, row.value, row.uncertainty,
                                          row.std, row.repeats});
        rows.emplace_back(&dataset, k);
        measured = true;
      }
      if (!measured) continue;
      joined.measured.experiments.push_back(experiment.name);
      joined.experiments.push_back(std::move(experiment));
    }
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  joined.measured.covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const auto& [first, i] = rows[static_cast<std::size_t>(a)];
      const auto& [second, j] = rows[static_cast<std::size_t>(b)];
      if (first == second)
        joined.measured.covariance(a, b) =
            first->covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  return joined;
}

DiagnosisSession::DiagnosisSession(const DiagnosisModel& model, JoinedData data,
                                   const std::vector<std::string>& without, fs::path asset_dir, int threads)
    : model_(model),
      data_(std::move(data)),
      asset_dir_(std::move(asset_dir)),
      threads_(threads),
      space_(space_of(model, data_.experiments, without, asset_dir_)) {
  for (const Dataset::Experiment& experiment : data_.experiments)
    for (std::string& note : set_aside(model, experiment)) data_.notes.push_back(std::move(note));
  for (const auto& [effect, why] : space_.left_out)
    data_.notes.push_back(fmt::format("not looked for: {}: {}", effect, why));
  if (data_.measured.values.size() <= space_.base.size())
    data_.notes.push_back(fmt::format(
        "{} and {}: these alone can explain almost anything within their ranges, and no fit of an effect can "
        "be tested; measure more",
        counted_text(data_.measured.values.size(), "measured number"),
        counted_text(space_.base.size(), "uncertain parameter")));
  design_ = in_every_experiment(design_of(space_, model.simulations));
  for (std::size_t e = 0; e < design_.size(); ++e)
    for (std::size_t before = 0; before < e; ++before)
      if (design_[e].requests.front().key == design_[before].requests.front().key)
        data_.notes.push_back(fmt::format(
            "experiments {} and {} are the same simulation: it is run once, and what its fits do not know "
            "counts "
            "as if they were two; put the measurements of both into one experiment where that matters",
            data_.experiments[before].name, data_.experiments[e].name));
  learnt_.resize(data_.experiments.size());
  gave_nothing_.resize(data_.experiments.size());
  forecasts_.resize(data_.experiments.size());
  failure_.resize(data_.experiments.size());
  everything_.resize(data_.experiments.size());
}

std::vector<ExperimentRuns> DiagnosisSession::in_every_experiment(
    const std::vector<PlannedRun>& planned) const {
  std::vector<ExperimentRuns> runs;
  for (const Dataset::Experiment& experiment : data_.experiments)
    runs.push_back(runs_of(model_, space_, experiment, planned, asset_dir_));
  return runs;
}

int DiagnosisSession::most_rounds() const {
  // One effect, then pairs, and then a name that is not borne out have so many each.
  return 3 * model_.simulations.rounds;
}

int DiagnosisSession::most_in_a_round() const {
  // The calibrated model, the leading effect, its rivals, and what would be named, and what the data leave
  // open of them.
  const int models = 3 + static_cast<int>(kMostRivals);
  return models * of_a_model() + 2 * static_cast<int>(design_.size()) * model_.simulations.effect;
}

int DiagnosisSession::of_a_model() const {
  return static_cast<int>(design_.size()) * model_.simulations.check;
}

void DiagnosisSession::learn_from(const std::vector<ExperimentRuns>& runs, const std::string& what,
                                  const RunThrough& run, DiagnosisOutcome& outcome) {
  // The short experiments wait for nothing: all runs of all experiments go together.
  std::vector<RunRequest> all;
  for (const ExperimentRuns& each : runs) all.insert(all.end(), each.requests.begin(), each.requests.end());
  const std::vector<std::optional<StoredResult>> results = run(all, stage_ + ": " + what);
  std::size_t next = 0;
  for (std::size_t e = 0; e < runs.size(); ++e) {
    const std::vector<std::optional<StoredResult>> here(
        results.begin() + static_cast<std::ptrdiff_t>(next),
        results.begin() + static_cast<std::ptrdiff_t>(next + runs[e].requests.size()));
    next += runs[e].requests.size();
    std::vector<std::string> outputs;
    for (const MeasuredValue& value : data_.measured.values)
      if (value.experiment == e) outputs.push_back(value.output);
    GatheredRuns gathered = gather(runs[e], here, outputs);
    failure_[e].clear();
    for (const auto& each : here)
      if (each && each->state == RunState::failed) failure_[e] = each->message;
    gave_nothing_[e].insert(gave_nothing_[e].end(), gathered.left_out.begin(), gathered.left_out.end());
    if (!gathered.left_out.empty())
      outcome.notes.push_back(fmt::format(
          "{}: {} of {} simulations failed, did not come to rest or lack a measured number; left out",
          data_.experiments[e].name, gathered.left_out.size(), here.size()));
    for (std::size_t k = 0; k < here.size(); ++k)
      if (measured_in(here[k], outputs)) used_.insert(runs[e].requests[k].key);
    outcome.simulations = static_cast<int>(used_.size());
    for (DesignRun& each : gathered.runs) learnt_[e].push_back(std::move(each));
    for (std::size_t k = 0; k < here.size(); ++k)
      if (here[k] && here[k]->state == RunState::done && here[k]->at_rest())
        everything_[e].push_back({runs[e].runs[k].at, here[k]->outputs, runs[e].requests[k].pile});
  }
}

SimulatedModel DiagnosisSession::simulate(const ModelPoint& point, const RunThrough& run,
                                          DiagnosisOutcome& outcome) {
  std::vector<PlannedRun> planned;
  for (int k = 0; k < model_.simulations.check; ++k) planned.push_back({point, kCheckSeeds + ++checks_});
  std::vector<ExperimentRuns> runs;
  std::vector<std::size_t> before;
  for (std::size_t e = 0; e < data_.experiments.size(); ++e) {
    // An experiment in which the effects do nothing is simulated all the same: it shows the fitted
    // parameters.
    ExperimentRuns here = runs_of(model_, space_, data_.experiments[e], planned, asset_dir_);
    if (here.runs.empty()) {
      std::vector<PlannedRun> plain = planned;
      for (PlannedRun& each : plain) each.at.effects.clear();
      here = runs_of(model_, space_, data_.experiments[e], plain, asset_dir_);
    }
    runs.push_back(std::move(here));
    before.push_back(learnt_[e].size());
  }
  Hypothesis effects;
  for (const EffectAt& each : point.effects) effects.effects.push_back(each.effect);
  learn_from(runs, name_of(space_, effects) + ", at its fit", run, outcome);
  SimulatedModel simulated;
  simulated.at = point;
  simulated.runs = model_.simulations.check;
  const auto n = static_cast<Eigen::Index>(data_.measured.values.size());
  simulated.mean.resize(n);
  simulated.std.resize(n);
  Eigen::Index next = 0;
  for (std::size_t e = 0; e < learnt_.size(); ++e) {
    const auto count = static_cast<Eigen::Index>(learnt_[e].size() - before[e]);
    simulated.runs = std::min(simulated.runs, static_cast<int>(count));
    const Eigen::Index width = static_cast<Eigen::Index>(data_.measured.of(e).size());
    if (count < 2)
      throw TooFewRuns(fmt::format("{}: {} of {} simulations of the fitted model give the numbers measured{}",
                                   data_.experiments[e].name, count, model_.simulations.check,
                                   failure_[e].empty() ? "" : "; the last that failed: " + failure_[e]));
    Eigen::MatrixXd y(count, width);
    for (Eigen::Index k = 0; k < count; ++k)
      y.row(k) = learnt_[e][before[e] + static_cast<std::size_t>(k)].outputs.transpose();
    const Eigen::VectorXd mean = y.colwise().mean();
    simulated.mean.segment(next, width) = mean;
    simulated.std.segment(next, width) =
        ((y.rowwise() - mean.transpose()).colwise().squaredNorm() / static_cast<double>(count - 1))
            .cwiseSqrt();
    next += width;
  }
  return simulated;
}

std::vector<SimulatedPoints> DiagnosisSession::simulated() const {
  std::vector<SimulatedPoints> all;
  for (std::size_t e = 0; e < learnt_.size(); ++e) {
    all.push_back({{}, gave_nothing_[e]});
    for (const DesignRun& run : learnt_[e]) all.back().measured.push_back(run.at);
  }
  return all;
}

void DiagnosisSession::explore(const std::vector<ModelPoint>& points, const RunThrough& run,
                               DiagnosisOutcome& outcome) {
  std::vector<PlannedRun> planned;
  for (const ModelPoint& point : points) planned.push_back({point, kCheckSeeds + ++checks_});
  learn_from(in_every_experiment(planned), "where the effects that lead are least known", run, outcome);
}

std::vector<NextMeasurement> DiagnosisSession::tell_apart(const DiagnosisOutcome& outcome) const {
  constexpr double kRepeats = 5;
  const Diagnosis& d = outcome.diagnosis;
  std::vector<NextMeasurement> all;
  for (std::size_t e = 0; e < everything_.size(); ++e) {
    std::set<std::string> measured, names;
    for (const MeasuredValue& value : data_.measured.values)
      if (value.experiment == e) measured.insert(value.output);
    for (const WholeRun& each : everything_[e])
      for (const auto& [name, value] : each.outputs) names.insert(name);
    for (const std::string& name : names) {
      if (measured.contains(name) || is_of_the_run(name)) continue;
      std::vector<DesignRun> runs;
      for (const WholeRun& each : everything_[e])
        if (const auto found = each.outputs.find(name);
            found != each.outputs.end() && std::isfinite(found->second))
          runs.push_back({each.at, Eigen::VectorXd::Constant(1, found->second), each.pile});
      const auto plain =
          std::count_if(runs.begin(), runs.end(), [](const auto& run) { return run.at.effects.empty(); });
      if (plain < ResponseSurface::least_base_runs(space_.base.size()) ||
          runs.size() < everything_[e].size() * 4 / 5)
        continue;
      const ResponseSurface surface(space_, data_.experiments[e].name, runs, threads_);
      NextMeasurement next{data_.experiments[e].name + "/" + name, 0, {}};
      std::vector<double> variance;
      for (const std::size_t k : d.verdict.named) {
        const SurfacePrediction here = surface.at(d.judgements[k].best);
        next.foretold.push_back(here.mean[0]);
        variance.push_back(here.covariance(0, 0));
      }
      for (std::size_t a = 0; a < next.foretold.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
          const double total = variance[a] + variance[b] + surface.scatter()(0, 0) / kRepeats;
          if (total > 0)
            next.difference =
                std::max(next.difference, std::abs(next.foretold[a] - next.foretold[b]) / std::sqrt(total));
        }
      all.push_back(std::move(next));
    }
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.difference > b.difference; });
  if (all.size() > kMostNext) all.resize(kMostNext);
  return all;
}

// Means over the simulations of the design.
SimulatedModel DiagnosisSession::nominal_of_design() const {
  SimulatedModel nominal;
  const auto n = static_cast<Eigen::Index>(data_.measured.values.size());
  nominal.at.base = space_.nominal();
  nominal.runs = model_.simulations.nominal;
  nominal.mean.resize(n);
  nominal.std.resize(n);
  Eigen::Index next = 0;
  for (const auto& runs : learnt_) {
    std::vector<const DesignRun*> these;
    for (const DesignRun& each : runs)
      if (each.at.effects.empty() && each.at.base == space_.nominal()) these.push_back(&each);
    if (these.empty())
      throw std::runtime_error(
          fmt::format("{}: no simulation with the nominal parameters gives the numbers that were measured",
                      data_.measured.experiments[static_cast<std::size_t>(&runs - learnt_.data())]));
    nominal.runs = std::min(nominal.runs, static_cast<int>(these.size()));
    for (Eigen::Index c = 0; c < runs.front().outputs.size(); ++c, ++next) {
      double sum = 0, square = 0;
      for (const DesignRun* each : these) sum += each->outputs[c];
      const double count = static_cast<double>(these.size()), mean = sum / count;
      for (const DesignRun* each : these) square += (each->outputs[c] - mean) * (each->outputs[c] - mean);
      nominal.mean[next] = mean;
      nominal.std[next] = std::sqrt(square / std::max(count - 1, 1.0));
    }
  }
  return nominal;
}

LearntModel DiagnosisSession::learn() const {
  std::vector<Widening> factors;
  for (const auto& of_one : forecasts_) factors.push_back(widening(of_one));
  try {
    return {space_, data_.measured.experiments, learnt_, factors, threads_};
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(error.what());
  }
}

void DiagnosisSession::compare(const LearntModel& model, const std::vector<std::size_t>& known) {
  for (std::size_t e = 0; e < learnt_.size(); ++e) {
    const std::vector<DesignRun> fresh(learnt_[e].begin() + static_cast<std::ptrdiff_t>(known[e]),
                                       learnt_[e].end());
    for (const Forecast& each : model.surfaces()[e]->forecasts(fresh)) forecasts_[e].push_back(each);
  }
}

DiagnosisOutcome DiagnosisSession::run(const RunThrough& run) {
  DiagnosisOutcome outcome;
  outcome.space = space_;
  outcome.notes = data_.notes;
  stage_ = "before the data are looked at";
  learn_from(design_, "the base model and every effect", run, outcome);
  outcome.nominal = nominal_of_design();
  LearntModel model = learn();
  Diagnosis d = diagnose(space_, data_.measured, model, {}, Pairs::where_none_explains, nullptr, threads_);
  TriedModels tried(space_, d, model, [&](const ModelPoint& at) { return simulate(at, run, outcome); });
  Contradicted without;
  outcome.settled = d.verdict.kind == DiagnosisVerdict::Kind::nothing;
  int last_round = model_.simulations.rounds;
  Pairs pairs = Pairs::where_none_explains;
  while (!outcome.settled) {
    if (Contradicted now = tried.contradicted(); now != without) {
      without = std::move(now);
      d = diagnose(space_, data_.measured, model, without, pairs, &d, threads_);
    }
    // Once a pair leads they stay, and have rounds of their own: there are many of them, and little was
    // simulated of each.
    if (const Judgement* best = leading(d, tried);
        pairs != Pairs::always && best != nullptr && best->hypothesis.effects.size() > 1) {
      pairs = Pairs::always;
      last_round = outcome.rounds + model_.simulations.rounds;
    }
    // A name that its own simulations have not borne out is fitted to them again.
    const Judgement* named = named_first(d);
    const bool again = named != nullptr && !tried.failed(*named) && !tried.bears_out(*named);
    const int further = again ? model_.simulations.rounds : 0;
    if (outcome.rounds >= std::min(last_round + further, most_rounds())) break;
    ++outcome.rounds;
    stage_ = fmt::format("round {} of at most {}", outcome.rounds, most_rounds());
    std::vector<std::size_t> known;
    for (const auto& runs : learnt_) known.push_back(runs.size());
    if (!one_round(d, model, tried, run, outcome)) {
      outcome.settled = named == nullptr || tried.bears_out(*named);
      break;
    }
    compare(model, known);
    model = learn();
    Diagnosis fresh = diagnose(space_, data_.measured, model, without, pairs, nullptr, threads_);
    const bool unchanged = same(d.verdict, fresh.verdict, d, fresh);
    d = std::move(fresh);
    outcome.settled = unchanged && tried.up_to_date(d.calibration);
    for (const Judgement* j : {leading(d, tried), named_first(d)})
      if (j != nullptr && tried.more_than_calibration())
        outcome.settled = outcome.settled && tried.up_to_date(*j);
    if (const Judgement* j = named_first(d)) outcome.settled = outcome.settled && tried.bears_out(*j);
  }
  stage_ = "trying the answer";
  say_what_stands(d, tried, outcome);
  outcome.nominal.gap = simulated_gap(d, model, outcome.nominal.mean, std::max(outcome.nominal.runs, 1));
  if (tried.last(d.calibration) != nullptr) {
    try {
      tried.simulate(d.calibration);  // rounds may have ended before it lay at its last fit
    } catch (const TooFewRuns& error) {
      outcome.notes.push_back(fmt::format(
          "the re-calibrated model could not be tried by full simulations at its last fit, an earlier one is "
          "shown: {}",
          error.what()));
    }
    outcome.calibrated = *tried.last(d.calibration);
    outcome.calibrated->gap = tried.gap_of(*outcome.calibrated);
  }
  if (const Judgement* named = named_first(d)) {
    outcome.augmented = tried.best(*named);
    outcome.held_out_calibrated = held_out(space_, d, model, {{}, false, 0});
    outcome.held_out_augmented = held_out(space_, d, model, named->hypothesis);
  }
  for (const auto& [effects, failure] : tried.failures())
    outcome.notes.push_back(fmt::format("{} could not be tried by full simulations at its last fit: {}",
                                        name_of(space_, {effects, false, 0}), failure.why));
  outcome.diagnosis = std::move(d);
  if (outcome.diagnosis.verdict.kind == DiagnosisVerdict::Kind::group) outcome.next = tell_apart(outcome);
  return outcome;
}

bool DiagnosisSession::one_round(const Diagnosis& d, const LearntModel& model, TriedModels& tried,
                                 const RunThrough& run, DiagnosisOutcome& outcome) {
  bool fresh = tried.simulate(d.calibration);
  if (!tried.more_than_calibration()) return fresh;
  for (const Judgement* j : worth_simulating(open_to_simulation(d, tried), named_first(d)))
    if (tried.simulate(*j)) fresh = true;
  const std::vector<const Judgement*> open = open_to_simulation(d, tried);  // some may have failed now
  if (open.empty()) return fresh;
  const std::vector<SimulatedPoints> so_far = simulated();
  std::vector<ModelPoint> points =
      where_to_learn(space_, d, model, open.front()->hypothesis, model_.simulations.effect, so_far);
  for (const auto& [rival, count] : shared_by_rivals(open, *open.front(), model_.simulations.effect))
    for (ModelPoint& at : where_to_learn(space_, d, model, rival->hypothesis, count, so_far))
      points.push_back(std::move(at));
  explore(points, run, outcome);
  return true;
}

void DiagnosisSession::say_what_stands(Diagnosis& d, TriedModels& tried, DiagnosisOutcome& outcome) {
  const auto stands = [&](std::size_t k) {
    const Judgement& j = d.judgements[k];
    tried.simulate(j);
    if (tried.may_be_said(j)) return true;
    if (tried.failed(j)) {
      refute(d, k, std::nullopt);
      return false;
    }
    try {
      tried.simulate_again(j);
      if (tried.may_be_said(j)) return true;
    } catch (const TooFewRuns&) {
    }
    const Gap gap = tried.gap_of(*tried.last(j));
    outcome.notes.push_back(fmt::format(
        "{}: full simulations with the fitted values do not give the data (p = {:.2g}); it is no answer",
        name_of(space_, j.hypothesis), gap.p));
    refute(d, k, gap);
    return false;
  };
  if (d.verdict.kind == DiagnosisVerdict::Kind::calibration && d.calibration.gap.p > kFitsAbove)
    for (std::size_t k = 0; k < d.judgements.size(); ++k)
      if (const Hypothesis& h = d.judgements[k].hypothesis; h.effects.empty() && !h.unknown) {
        stands(k);
        break;
      }
  for (std::size_t next = 0; next < d.verdict.named.size();)
    next = stands(d.verdict.named[next]) ? next + 1 : 0;
}

}  // namespace scree
