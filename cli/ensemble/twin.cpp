#include "cli/ensemble/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/diagnose/blocks.h"
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

// The runs of all experiments; their results by experiment.
std::vector<std::vector<std::optional<StoredResult>>> done(const std::vector<ExperimentRuns>& runs,
                                                           const std::string& what, const RunThrough& run) {
  std::vector<RunRequest> all;
  for (const ExperimentRuns& each : runs) all.insert(all.end(), each.requests.begin(), each.requests.end());
  const auto results = run(all, what);
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

// The steps of make_twin, in their order; one source of chance goes through them.
class TwinMaker {
 public:
  TwinMaker(const DiagnosisModel& model, const TwinSpec& spec, const std::filesystem::path& asset_dir,
            const RunThrough& design, const RunThrough& hidden)
      : model_(model),
        spec_(spec),
        asset_dir_(asset_dir),
        hidden_(hidden),
        experiments_(experiments_of(model)),
        space_(twin_space(model, asset_dir_)),
        base_model_(learn_base_model(design)),
        error_variances_(variances_of_errors()),
        covariance_(covariance_of_means()),
        random_(spec.seed, 0, RandomPurpose::measurement) {}

  Twin make() {
    Twin twin;
    ModelPoint& truth = twin.truth.at;
    truth.base.resize(static_cast<Eigen::Index>(space_.base.size()));
    for (double& x : truth.base) x = kInnerBase * random_.uniform(-1, 1);
    std::vector<std::pair<EffectAt, double>> effects;  // and their strength
    for (const std::string& name : spec_.effects) effects.push_back(hide(name, truth.base));
    std::sort(effects.begin(), effects.end(),
              [](const auto& a, const auto& b) { return a.first.effect < b.first.effect; });
    for (const auto& [there, strength] : effects) {
      truth.effects.push_back(there);
      twin.truth.detectability.push_back(strength);
    }
    twin.data = measure(simulate(truth));
    return twin;
  }

 private:
  const std::vector<std::string>& outputs_of(std::size_t experiment) const {
    return model_.experiments[experiment].observables;
  }

  // The base model over its parameters: its scatter, and what parameters make up for.
  LearntModel learn_base_model(const RunThrough& design) const {
    std::vector<PlannedRun> plain = design_of(space_, model_.simulations);
    std::erase_if(plain, [](const PlannedRun& run) { return !run.at.effects.empty(); });
    std::vector<std::string> names;
    std::vector<ExperimentRuns> planned;
    for (const Dataset::Experiment& each : experiments_) {
      names.push_back(each.name);
      planned.push_back(runs_of(model_, space_, each, plain, asset_dir_));
    }
    DesignRuns learnt;
    const auto results = done(planned, "the base model over its parameters", design);
    for (std::size_t e = 0; e < planned.size(); ++e)
      learnt.push_back(gather(planned[e], results[e], outputs_of(e)).runs);
    return {space_, names, learnt};
  }

  // Of one measurement, by experiment and output.
  std::vector<Eigen::VectorXd> variances_of_errors() const {
    std::vector<Eigen::VectorXd> all;
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      all.push_back(spec_.noise * spec_.noise * base_model_.surfaces()[e]->scatter().diagonal());
      const std::vector<std::string>& outputs = outputs_of(e);
      for (const auto& [name, error] : model_.experiments[e].errors)
        all.back()[std::find(outputs.begin(), outputs.end(), name) - outputs.begin()] = error * error;
    }
    return all;
  }

  // Of all numbers that will be measured, one experiment after the other.
  Eigen::MatrixXd covariance_of_means() const {
    std::vector<Eigen::MatrixXd> covariances;
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      Eigen::MatrixXd one = base_model_.surfaces()[e]->scatter();
      one.diagonal() += error_variances_[e];
      covariances.push_back(one / spec_.repeats);
    }
    return block_diagonal(covariances);
  }

  // `count` simulations of an experiment from number `begin` of a block of seeds.
  ExperimentRuns runs_at(std::size_t experiment, ModelPoint at, std::uint64_t seeds, int begin,
                         int count) const {
    Dataset::Experiment made = experiments_[experiment];
    if (std::none_of(at.effects.begin(), at.effects.end(),
                     [&](const EffectAt& there) { return space_.effects[there.effect].acts_in(made.name); }))
      at.effects.clear();
    std::vector<PlannedRun> runs;
    for (int k = begin; k < begin + count; ++k)
      runs.push_back({at, seeds + spec_.seed * kSeedsOfOneTwin + static_cast<std::uint64_t>(k)});
    if (!spec_.engine.empty()) made.overrides.push_back("engine=" + spec_.engine);
    return runs_of(model_, space_, made, runs, asset_dir_);
  }

  // How strong an effect is about these base parameters, by simulations with and without it, of the same
  // seeds; none where too few of them give a measurement.
  std::optional<double> strength_of(const EffectAt& there, const Eigen::VectorXd& base) const {
    const int pairs = std::max(spec_.repeats, kLeastPairs);
    std::vector<ExperimentRuns> both;
    for (std::size_t e = 0; e < experiments_.size(); ++e)
      for (const auto& effects : {std::vector<EffectAt>{there}, std::vector<EffectAt>{}})
        both.push_back(runs_at(e, {base, effects}, kStrengthSeeds, 0,
                               space_.effects[there.effect].acts_in(experiments_[e].name) ? pairs : 0));
    const auto ended = done(both, "the hidden truth: how strong it is", hidden_);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(covariance_.rows());
    Eigen::MatrixXd unsure = Eigen::MatrixXd::Zero(covariance_.rows(), covariance_.rows());
    Eigen::Index begin = 0;
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      const auto width = static_cast<Eigen::Index>(outputs_of(e).size());
      const auto &with = ended[2 * e], &without = ended[2 * e + 1];
      std::vector<Eigen::VectorXd> changes;
      for (std::size_t k = 0; k < with.size(); ++k)
        if (const auto one = measured_in(with[k], outputs_of(e)),
            other = measured_in(without[k], outputs_of(e));
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
    return detectability(base_model_, covariance_, base, change, unsure);
  }

  // An effect where it is as strong as asked for, and how strong it is there. Chance decides the direction;
  // where the effect is too weak that way, it is the other.
  std::pair<EffectAt, double> hide(const std::string& name, const Eigen::VectorXd& base) {
    const std::size_t e = space_.find(name);
    assert(e < space_.effects.size());
    const CandidateEffect& effect = space_.effects[e];
    const double ends[] = {effect.lowest(), effect.highest()};
    double sign = random_.uniform() < 0.5 ? -1 : 1;
    if (ends[0] >= 0) sign = 1;
    if (ends[1] <= 0) sign = -1;
    EffectAt there{e, Eigen::VectorXd(static_cast<Eigen::Index>(effect.axes.size()))};
    for (Eigen::Index k = 1; k < there.at.size(); ++k) there.at[k] = kInnerOther * random_.uniform(-1, 1);
    const auto strength = [&](double amplitude) {
      there.at[0] = amplitude;
      return strength_of(there, base);
    };
    StrengthSearch found;
    for (int way = 0; way < 2; ++way, sign = -sign)
      if (const double end = sign < 0 ? ends[0] : ends[1]; end * sign > 0) {
        const double before = found.strongest;
        found = search_amplitude(spec_.strength, end, strength);
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
          name, found.strongest, spec_.strength));
    if (std::abs(std::log(std::max(found.best->strength / spec_.strength, kLeastStrength))) > kStrengthAtMost)
      throw TooWeak(
          fmt::format("{}: no amplitude was found at which it shifts these observables by {:g} "
                      "standard uncertainties; the nearest gives {:.2g}",
                      name, spec_.strength, found.best->strength));
    there.at[0] = found.best->amplitude;
    return {there, found.best->strength};
  }

  // The repeats of the truth, by experiment. One that gives no measurement (a heap without a flank) is
  // simulated again with another seed.
  std::vector<std::vector<DesignRun>> simulate(const ModelPoint& truth) const {
    std::vector<std::vector<DesignRun>> measured(experiments_.size());
    std::vector<int> tried(experiments_.size(), 0);
    while (true) {
      std::vector<std::size_t> which;
      std::vector<ExperimentRuns> runs;
      for (std::size_t e = 0; e < experiments_.size(); ++e) {
        const int lack = spec_.repeats - static_cast<int>(measured[e].size());
        if (lack == 0) continue;
        if (tried[e] + lack > kMostTries * spec_.repeats)
          throw std::runtime_error(fmt::format("{}: {} of {} simulations of the truth gave no measurement",
                                               experiments_[e].name,
                                               tried[e] - static_cast<int>(measured[e].size()), tried[e]));
        runs.push_back(runs_at(e, truth, kTwinSeeds, tried[e], lack));
        which.push_back(e);
        tried[e] += lack;
      }
      if (runs.empty()) return measured;
      const auto ended = done(runs, "the hidden truth: its measurements", hidden_);
      for (std::size_t k = 0; k < which.size(); ++k)
        for (DesignRun& run : gather(runs[k], ended[k], outputs_of(which[k])).runs)
          measured[which[k]].push_back(std::move(run));
    }
  }

  // Adds errors of measurement.
  DatasetDraft measure(const std::vector<std::vector<DesignRun>>& simulated) {
    DatasetDraft data;
    data.title = fmt::format("Measurements {}", spec_.seed);
    data.source = "scree twin " + model_.name;
    for (std::size_t e = 0; e < experiments_.size(); ++e) {
      DatasetDraft::Experiment draft{
          experiments_[e].name, experiments_[e].file, experiments_[e].overrides, {}};
      for (std::size_t c = 0; c < outputs_of(e).size(); ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        std::vector<double> values;
        for (const DesignRun& run : simulated[e])
          values.push_back(run.outputs[column] + std::sqrt(error_variances_[e][column]) * random_.normal());
        draft.observables[outputs_of(e)[c]] = mean_std(values);
      }
      data.experiments.push_back(std::move(draft));
    }
    return data;
  }

  const DiagnosisModel& model_;
  const TwinSpec& spec_;
  const std::filesystem::path& asset_dir_;
  const RunThrough& hidden_;
  const std::vector<Dataset::Experiment> experiments_;
  const ModelSpace space_;
  const LearntModel base_model_;
  const std::vector<Eigen::VectorXd> error_variances_;
  const Eigen::MatrixXd covariance_;  // of the means that will be measured
  Random random_;
};

}  // namespace

ModelSpace twin_space(const DiagnosisModel& model, const std::filesystem::path& asset_dir) {
  return space_of(model, experiments_of(model), {}, asset_dir);
}

Twin make_twin(const DiagnosisModel& model, const TwinSpec& spec, const std::filesystem::path& asset_dir,
               const RunThrough& design, const RunThrough& hidden) {
  if (model.experiments.empty())
    throw std::runtime_error(model.name + ": a twin needs the model's experiments and their observables");
  return TwinMaker(model, spec, asset_dir, design, hidden).make();
}

std::string twin_answer(const DiagnosisModel& model, const TwinSpec& spec, const TwinTruth& truth,
                        const std::filesystem::path& asset_dir) {
  const ModelSpace space = twin_space(model, asset_dir);
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
