#include "cli/ensemble/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "sim/material/random.h"

namespace scree {
namespace {

constexpr double kInnerBase = 0.6, kInnerOther = 0.8;  // of the ranges, from which a truth is drawn
constexpr int kLeastPairs = 12;           // simulations with and without an effect that say how strong it is
constexpr int kMostAmplitudes = 8;        // tried
constexpr double kStrengthWithin = 0.1;   // of what is asked for, as a logarithm
constexpr double kStrengthAtMost = 0.25;  // off, as a logarithm, where no amplitude comes nearer
constexpr double kLeastStrength = 0.05;   // of what is asked for, against logarithms of 0
constexpr int kMostTries = 2;             // times the repeats: simulations of a truth
constexpr std::uint64_t kTwinSeeds = 1'000'000, kStrengthSeeds = 1'500'000'000, kSeedsOfOneTwin = 1000;

std::vector<Dataset::Experiment> experiments_of(const DiagnosisModel& model) {
  std::vector<Dataset::Experiment> all;
  for (const ModelExperiment& each : model.experiments) all.push_back(each.experiment);
  return all;
}

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
}

// The runs of all experiments; their results by experiment.
std::vector<std::vector<std::optional<StoredResult>>> done(const std::vector<ExperimentRuns>& runs,
                                                           const RunThrough& run) {
  std::vector<RunRequest> all;
  for (const ExperimentRuns& each : runs) all.insert(all.end(), each.requests.begin(), each.requests.end());
  const auto results = run(all);
  std::vector<std::vector<std::optional<StoredResult>>> split;
  std::size_t next = 0;
  for (const ExperimentRuns& each : runs) {
    split.emplace_back(results.begin() + static_cast<std::ptrdiff_t>(next),
                       results.begin() + static_cast<std::ptrdiff_t>(next + each.requests.size()));
    next += each.requests.size();
  }
  return split;
}

// An amplitude, and how strong simulations show the effect to be there.
struct Strength {
  double amplitude, strength;
};

// What was tried in the search for an amplitude.
struct StrengthSearch {
  std::optional<Strength> best;  // nearest to what is asked for
  double strongest = 0;
  bool too_weak = false;
};

// Looks for the amplitude between 0 and `end` at which the effect is so strong, by lines between logarithms.
// `strength_at` gives nothing where simulations give no measurement: the amplitude is then taken for too
// large.
StrengthSearch search_amplitude(double asked, double end,
                                const std::function<std::optional<double>(double)>& strength_at) {
  StrengthSearch search;
  std::optional<Strength> below, above;
  std::optional<double> fails;  // from there on
  const double least = kLeastStrength * asked;
  const auto off = [&](const Strength& s) { return std::abs(std::log(std::max(s.strength, least) / asked)); };
  double amplitude = end / 4;
  for (int k = 0; k < kMostAmplitudes; ++k) {
    const std::optional<double> strength = strength_at(amplitude);
    if (!strength) {
      fails = amplitude;
      amplitude = below ? std::sqrt(below->amplitude * amplitude) : 0.5 * amplitude;
      if (end < 0 && below) amplitude = -std::abs(amplitude);
      continue;
    }
    const Strength here{amplitude, *strength};
    search.strongest = std::max(search.strongest, here.strength);
    if (!search.best || off(here) < off(*search.best)) search.best = here;
    if (off(here) < kStrengthWithin) break;
    (here.strength < asked ? below : above) = here;
    const double share = asked / std::max(here.strength, least);
    if (!above) {
      search.too_weak = amplitude == end;
      if (search.too_weak) break;
      const double next = amplitude * std::clamp(share, 1.3, 4.0);
      amplitude = fails ? 0.5 * (amplitude + *fails) : std::abs(next) > std::abs(end) ? end : next;
    } else if (!below) {
      amplitude *= std::clamp(share, 0.25, 0.8);
    } else {
      const double low = std::log(std::max(below->strength, least)), high = std::log(above->strength),
                   part = std::clamp((std::log(asked) - low) / (high - low), 0.1, 0.9);
      amplitude = below->amplitude * std::pow(above->amplitude / below->amplitude, part);
    }
  }
  return search;
}

}  // namespace

Twin make_twin(const DiagnosisModel& model, const TwinSpec& spec, const std::filesystem::path& asset_dir,
               const RunThrough& design, const RunThrough& hidden) {
  if (model.experiments.empty())
    throw std::runtime_error(model.name + ": a twin needs the model's experiments and their observables");
  const std::vector<Dataset::Experiment> experiments = experiments_of(model);
  const ModelSpace space = space_of(model, experiments, {});
  // The base model: its scatter, and what its parameters make up for.
  std::vector<PlannedRun> plain = design_of(space, model.simulations);
  std::erase_if(plain, [](const PlannedRun& run) { return !run.at.effects.empty(); });
  std::vector<std::string> names;
  std::vector<ExperimentRuns> planned;
  for (const Dataset::Experiment& each : experiments) {
    names.push_back(each.name);
    planned.push_back(runs_of(model, space, each, plain, asset_dir));
  }
  DesignRuns learnt;
  const auto results = done(planned, design);
  for (std::size_t e = 0; e < planned.size(); ++e)
    learnt.push_back(gather(planned[e], results[e], model.experiments[e].observables).runs);
  const LearntModel surface(space, names, learnt);

  // Covariance of the means that will be measured.
  Eigen::Index n = 0, first = 0;
  for (const ModelExperiment& each : model.experiments)
    n += static_cast<Eigen::Index>(each.observables.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::VectorXd> errors;  // variances, by experiment
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    Eigen::MatrixXd block = surface.surfaces()[e]->scatter();
    errors.push_back(spec.noise * spec.noise * block.diagonal());
    for (const auto& [name, error] : model.experiments[e].errors) {
      const auto& all = model.experiments[e].observables;
      errors.back()[std::find(all.begin(), all.end(), name) - all.begin()] = error * error;
    }
    block.diagonal() += errors.back();
    covariance.block(first, first, block.rows(), block.rows()) = block / spec.repeats;
    first += block.rows();
  }

  const auto runs_at = [&](std::size_t e, ModelPoint at, std::uint64_t seeds, int begin, int count) {
    if (std::none_of(at.effects.begin(), at.effects.end(),
                     [&](const EffectAt& there) { return space.effects[there.effect].acts_in(names[e]); }))
      at.effects.clear();
    std::vector<PlannedRun> each;
    for (int k = begin; k < begin + count; ++k)
      each.push_back({at, seeds + spec.seed * kSeedsOfOneTwin + static_cast<std::uint64_t>(k)});
    Dataset::Experiment made = experiments[e];
    if (!spec.engine.empty()) made.overrides.push_back("engine=" + spec.engine);
    return runs_of(model, space, made, each, asset_dir);
  };

  Twin twin;
  Random random(spec.seed, 0, RandomPurpose::measurement);
  twin.truth.at.base.resize(static_cast<Eigen::Index>(space.base.size()));
  for (double& x : twin.truth.at.base) x = kInnerBase * random.uniform(-1, 1);
  // With and without the effect about the truth's base parameters, of the same seeds.
  const auto strength_of = [&](const EffectAt& there) -> std::optional<double> {
    const int pairs = std::max(spec.repeats, kLeastPairs);
    std::vector<ExperimentRuns> both;
    for (std::size_t e = 0; e < experiments.size(); ++e)
      for (const auto& effects : {std::vector<EffectAt>{there}, std::vector<EffectAt>{}})
        both.push_back(runs_at(e, {twin.truth.at.base, effects}, kStrengthSeeds, 0,
                               space.effects[there.effect].acts_in(names[e]) ? pairs : 0));
    const auto ended = done(both, hidden);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd unsure = Eigen::MatrixXd::Zero(n, n);
    Eigen::Index begin = 0;
    for (std::size_t e = 0; e < experiments.size(); ++e) {
      const std::vector<std::string>& outputs = model.experiments[e].observables;
      const auto width = static_cast<Eigen::Index>(outputs.size());
      const auto &with = ended[2 * e], &without = ended[2 * e + 1];
      std::vector<Eigen::VectorXd> changes;
      for (std::size_t k = 0; k < with.size(); ++k)
        if (const auto one = measured_in(with[k], outputs), other = measured_in(without[k], outputs);
            one && other)
          changes.push_back(*one - *other);
      if (!with.empty() && std::ssize(changes) < kLeastPairs / 2) return {};
      const double count = static_cast<double>(changes.size());
      for (const Eigen::VectorXd& each : changes) change.segment(begin, width) += each / count;
      for (const Eigen::VectorXd& each : changes) {
        const Eigen::VectorXd off = each - change.segment(begin, width);
        unsure.block(begin, begin, width, width) += off * off.transpose() / (count * (count - 1));
      }
      begin += width;
    }
    return detectability(surface, covariance, twin.truth.at.base, change, unsure);
  };
  std::vector<std::pair<std::size_t, double>> strengths;  // by effect
  for (const std::string& name : spec.effects) {
    const std::size_t e = space.find(name);
    if (e == space.effects.size())
      throw std::runtime_error(fmt::format("effect {} acts in none of the model's experiments", name));
    const CandidateEffect& effect = space.effects[e];
    EffectAt there{e, Eigen::VectorXd(static_cast<Eigen::Index>(effect.axes.size()))};
    const double ends[] = {effect.lowest(), effect.highest()};
    double sign = random.uniform() < 0.5 ? -1 : 1;
    if (ends[0] >= 0) sign = 1;
    if (ends[1] <= 0) sign = -1;
    for (Eigen::Index k = 1; k < there.at.size(); ++k) there.at[k] = kInnerOther * random.uniform(-1, 1);
    const auto strength = [&](double amplitude) {
      there.at[0] = amplitude;
      return strength_of(there);
    };
    // The other direction if this one is too weak.
    StrengthSearch found;
    for (int way = 0; way < 2; ++way, sign = -sign)
      if (const double end = sign < 0 ? ends[0] : ends[1]; end * sign > 0) {
        const double before = found.strongest;
        found = search_amplitude(spec.strength, end, strength);
        found.strongest = std::max(found.strongest, before);
        if (!found.too_weak && found.best) break;
      }
    if (!found.best)
      throw std::runtime_error(fmt::format(
          "{}: simulations of the truth gave no measurement at any amplitude that was tried", name));
    if (found.too_weak)
      throw TooWeak(fmt::format(
          "{} shifts these observables by {:.2g} standard uncertainties at most of the amplitudes "
          "tried up to the end of its prior range, not by {:g}; more --repeats, or less --noise, "
          "make it stronger",
          name, found.strongest, spec.strength));
    if (std::abs(std::log(std::max(found.best->strength / spec.strength, kLeastStrength))) > kStrengthAtMost)
      throw TooWeak(
          fmt::format("{}: no amplitude was found at which it shifts these observables by {:g} "
                      "standard uncertainties; the nearest gives {:.2g}",
                      name, spec.strength, found.best->strength));
    there.at[0] = found.best->amplitude;
    strengths.emplace_back(e, found.best->strength);
    twin.truth.at.effects.push_back(there);
  }
  std::sort(twin.truth.at.effects.begin(), twin.truth.at.effects.end(),
            [](const auto& a, const auto& b) { return a.effect < b.effect; });
  std::sort(strengths.begin(), strengths.end());
  for (const auto& [e, strength] : strengths) twin.truth.detectability.push_back(strength);

  // A simulation that gives no measurement (a heap without a flank) is repeated with another seed.
  std::vector<std::vector<DesignRun>> measured(experiments.size());
  std::vector<int> tried(experiments.size(), 0);
  while (true) {
    std::vector<std::size_t> which;
    std::vector<ExperimentRuns> runs;
    for (std::size_t e = 0; e < experiments.size(); ++e) {
      const int lack = spec.repeats - static_cast<int>(measured[e].size());
      if (lack == 0) continue;
      if (tried[e] + lack > kMostTries * spec.repeats)
        throw std::runtime_error(fmt::format("{}: {} of {} simulations of the truth gave no measurement",
                                             names[e], tried[e] - static_cast<int>(measured[e].size()),
                                             tried[e]));
      runs.push_back(runs_at(e, twin.truth.at, kTwinSeeds, tried[e], lack));
      which.push_back(e);
      tried[e] += lack;
    }
    if (runs.empty()) break;
    const auto ended = done(runs, hidden);
    for (std::size_t k = 0; k < which.size(); ++k)
      for (DesignRun& run : gather(runs[k], ended[k], model.experiments[which[k]].observables).runs)
        measured[which[k]].push_back(std::move(run));
  }
  twin.data.title = fmt::format("Measurements {}", spec.seed);
  twin.data.source = "scree twin " + model.name;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    const std::vector<std::string>& outputs = model.experiments[e].observables;
    DatasetDraft::Experiment draft{names[e], experiments[e].file, experiments[e].overrides, {}};
    for (std::size_t c = 0; c < outputs.size(); ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      std::vector<double> values;
      for (const DesignRun& run : measured[e])
        values.push_back(run.outputs[column] + std::sqrt(errors[e][column]) * normal(random));
      draft.observables[outputs[c]] = mean_std(values);
    }
    twin.data.experiments.push_back(std::move(draft));
  }
  return twin;
}

std::string twin_answer(const DiagnosisModel& model, const TwinSpec& spec, const TwinTruth& truth) {
  const ModelSpace space = space_of(model, experiments_of(model), {});
  nlohmann::ordered_json answer;
  answer["seed"] = spec.seed;
  answer["repeats"] = spec.repeats;
  answer["noise"] = spec.noise;
  answer["strength"] = spec.strength;
  if (!spec.engine.empty()) answer["engine"] = spec.engine;
  answer["effects"] = nlohmann::ordered_json::array();
  for (const EffectAt& there : truth.at.effects) {
    const CandidateEffect& effect = space.effects[there.effect];
    nlohmann::ordered_json values;
    for (std::size_t k = 0; k < effect.axes.size(); ++k)
      values[effect.axes[k].key] = effect.value(k, there.at[static_cast<Eigen::Index>(k)]);
    answer["effects"].push_back({{"name", effect.name}, {"values", values}});
  }
  answer["detectability"] = truth.detectability;
  for (std::size_t k = 0; k < space.base.size(); ++k)
    answer["parameters"][space.base[k].key] =
        space.base[k].value(truth.at.base[static_cast<Eigen::Index>(k)]);
  return answer.dump(2) + "\n";
}

}  // namespace scree
