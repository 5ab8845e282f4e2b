// scree twin: data with a hidden effect, and the sealed answer.
#include "cli/ensemble/twin.h"

#include <fmt/format.h>

#include <chrono>
#include <map>

#include "cli/commands.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/run_through.h"
#include "sim/io/text_file.h"
#include "sim/material/random.h"
#include "sim/scene/scenario_values.h"

namespace fs = std::filesystem;

namespace {

const std::map<std::string, double> kStrengths{{"weak", 2}, {"medium", 4}, {"strong", 8}};

// Sets what is left to chance; false, with a message, if a word is none.
bool draw(const TwinOptions& options, const scree::ModelSpace& space, scree::TwinSpec& spec) {
  std::vector<std::string> effects;
  for (const scree::CandidateEffect& effect : space.effects) effects.push_back(effect.name);
  scree::Random random(spec.seed, 1, scree::RandomPurpose::measurement);
  std::vector<std::string> asked = options.effects;
  if (asked.empty()) asked.push_back("random");
  if (asked.size() > 1 && std::find(asked.begin(), asked.end(), "none") != asked.end()) {
    fmt::print(stderr, "--effect none: stands alone\n");
    return false;
  }
  const auto add = [&](const std::string& effect) {  // once
    if (std::find(spec.effects.begin(), spec.effects.end(), effect) == spec.effects.end())
      spec.effects.push_back(effect);
  };
  for (const std::string& name : asked) {
    if (name == "none") continue;
    if (name == "random") {
      if (options.engine == "impulse") continue;  // has no effects
      // Of all effects that act, and none.
      const auto pick = static_cast<std::size_t>(random.uniform() * static_cast<double>(effects.size() + 1));
      if (pick < effects.size()) add(effects[pick]);
      continue;
    }
    const auto left_out = std::find_if(space.left_out.begin(), space.left_out.end(),
                                       [&](const auto& l) { return l.effect == name; });
    if (left_out != space.left_out.end()) {
      fmt::print(stderr, "--effect {}: cannot be hidden in the model's experiments: {}\n", name,
                 left_out->why);
      return false;
    }
    if (std::find(effects.begin(), effects.end(), name) == effects.end()) {
      fmt::print(stderr, "--effect {}: none of the model's{}; there are none, random, {}\n", name,
                 scree::suggestion(name, effects), scree::join(effects));
      return false;
    }
    add(name);
  }
  if (options.strength == "random") {
    const double pick = random.uniform();
    spec.strength = pick < 1.0 / 3 ? 2 : pick < 2.0 / 3 ? 4 : 8;
  } else if (const auto known = kStrengths.find(options.strength); known != kStrengths.end()) {
    spec.strength = known->second;
  } else if (const auto number = number_of(options.strength); number && *number > 0) {
    spec.strength = *number;
  } else {
    fmt::print(stderr, "--strength {}: weak, medium, strong, random, or a number above 0\n",
               options.strength);
    return false;
  }
  return true;
}

// Whether the answer may be written there: what is refused here is not refused after all simulations.
bool may_seal(const fs::path& answer, const fs::path& out, bool force) {
  std::error_code none;
  const fs::path inside = fs::weakly_canonical(fs::absolute(answer), none)
                              .lexically_relative(fs::weakly_canonical(fs::absolute(out), none));
  if (!inside.empty() && *inside.begin() != "..") {
    fmt::print(stderr, "--answer {}: lies in the dataset's folder, which is given away\n", answer.string());
    return false;
  }
  if (!answer.has_filename()) {
    fmt::print(stderr, "--answer {}: the name of a file is wanted\n", answer.string());
    return false;
  }
  if (fs::is_regular_file(answer, none) && !force) {
    fmt::print(stderr, "{}: is there already; choose another --answer, or --force to write over it\n",
               answer.string());
    return false;
  }
  const fs::path folder = answer.has_parent_path() ? answer.parent_path() : ".";
  return !fs::exists(folder, none) || may_write(answer);  // one that is not there is made
}

}  // namespace

int run_twin(const TwinOptions& options) {
  if (!is_of_kind(options.model, scree::FileKind::model)) return kBadInput;
  scree::DiagnosisModelResult loaded = scree::load_model(options.model, asset_dir());
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  const scree::DiagnosisModel& model = loaded.model;
  if (model.experiments.empty()) {
    fmt::print(stderr, "{}: a twin needs `experiments` with their observables\n", options.model.string());
    return kBadInput;
  }
  scree::TwinSpec spec;
  spec.repeats = options.repeats;
  spec.noise = options.noise;
  spec.engine = options.engine;
  spec.seed = options.seed
                  ? *options.seed
                  : static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count() /
                                               1000 % 1000000000);
  if (!draw(options, scree::twin_space(model, asset_dir()), spec)) return kBadInput;
  if (options.engine == "impulse" && !spec.effects.empty()) {
    fmt::print(stderr, "--engine impulse: has no effects; take --effect none\n");
    return kBadInput;
  }
  fs::path out = options.out.empty() ? free_run_folder("twin") : options.out;
  if (!out.has_filename()) out = out.parent_path();  // measured/
  const bool by_dots = out.filename() == "." || out.filename() == "..";
  const std::string name =
      by_dots ? fs::weakly_canonical(fs::absolute(out) / "").parent_path().string() : out.string();
  const fs::path answer = options.answer.empty() ? fs::path(name + ".answer.json") : options.answer;
  if (!may_seal(answer, out, options.force)) return kBadInput;
  const bool was_there = fs::exists(out);
  if (!prepare_folder(out, options.force)) return kBadInput;
  const auto store = open_store(options.ensemble.store, StoreUse::change);
  // What made the truth is not where diagnose looks.
  const fs::path hidden_file = answer.string() + ".runs.sqlite";
  const bool were_runs = fs::exists(hidden_file);
  const auto hidden = open_store(hidden_file, StoreUse::change);
  if (!store || !hidden) return kBadInput;
  try {
    const scree::Twin twin = scree::make_twin(model, spec, asset_dir(), run_through(*store, options.ensemble),
                                              run_through(*hidden, options.ensemble));
    const std::vector<std::string> left_out = scree::write_dataset(twin.data, out);
    if (!left_out.empty()) fmt::print("note: without scatter, left out: {}\n", fmt::join(left_out, ", "));
    scree::write_text_file(answer, scree::twin_answer(model, spec, twin.truth, asset_dir()));
  } catch (const scree::TooWeak& error) {
    fmt::print(stderr, "{}\n", error.what());
    std::error_code left;  // an empty folder or a store more is no reason to fail
    if (!was_there) fs::remove(out, left);
    if (!were_runs) fs::remove(hidden_file, left);
    return kBadInput;
  } catch (const scree::Stopped&) {
    fmt::print(stderr, "interrupted; to go on: {}{}{}\n", command_line(),
               options.seed ? "" : fmt::format(" --seed {}", spec.seed),
               options.out.empty() ? fmt::format(" --out {}", out.string()) : "");
    return kInterrupted;
  }
  fmt::print("dataset: {}\nsealed answer: {}\n", (out / "dataset.yaml").string(), answer.string());
  return kOk;
}
