#include "cli/ensemble/equivalence_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/results/results.h"
#include "analysis/statistics/emulator.h"
#include "cli/ensemble/design.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int kRaySteps = 400;  // looks along the ray of a node

std::vector<std::string> overrides(const EquivalenceSpec& spec, double local_damping) {
  std::vector<std::string> list = spec.fixed;
  list.push_back(fmt::format("material.local_damping={:.6g}", local_damping));
  return list;
}

EquivalenceRun rrlinear_run(const EquivalenceSpec& spec, const EquivalenceNode& node, std::uint64_t seed) {
  EquivalenceRun run{overrides(spec, node.local_damping), seed};
  run.overrides.push_back("engine=rrlinear");
  run.overrides.push_back(fmt::format("material.mu={:.6g}", node.mu));
  run.overrides.push_back(fmt::format("material.mu_r={:.6g}", node.mu_r));
  return run;
}

EquivalenceRun bullet_run(const EquivalenceSpec& spec, double local_damping, double friction, double rolling,
                          std::uint64_t seed) {
  EquivalenceRun run{overrides(spec, local_damping), seed};
  run.overrides.push_back("engine=impulse");
  run.overrides.push_back(fmt::format("numerics.impulse_friction={:.6g}", friction));
  run.overrides.push_back(fmt::format("numerics.impulse_rolling={:.6g}", rolling));
  return run;
}

/// An engine's angle over its two coefficients, at one local damping, from runs with scatter.
class AngleMap {
 public:
  AngleMap(double x_from, double x_to, double y_from, double y_to)
      : from_{x_from, y_from}, width_{x_to - x_from, y_to - y_from} {}

  void add(double friction, double rolling, double angle) {
    if (!std::isfinite(angle)) return;
    at_.push_back(place(friction, rolling));
    angles_.push_back(angle);
  }
  void learn() {
    if (angles_.size() < static_cast<std::size_t>(Emulator::kLeastPoints))
      throw std::runtime_error(fmt::format("{} simulations gave an angle; at least {} are needed",
                                           angles_.size(), Emulator::kLeastPoints));
    Eigen::MatrixXd x(static_cast<Eigen::Index>(at_.size()), 2);
    for (std::size_t k = 0; k < at_.size(); ++k) x.row(static_cast<Eigen::Index>(k)) = at_[k].transpose();
    emulator_.emplace(
        x, Eigen::Map<const Eigen::VectorXd>(angles_.data(), static_cast<Eigen::Index>(angles_.size())));
  }
  Prediction at(double friction, double rolling) const { return emulator_->at(place(friction, rolling)); }

 private:
  Eigen::Vector2d place(double friction, double rolling) const {
    const auto share = [&](double value, int k) {
      return width_[k] > 0 ? (value - from_[k]) / width_[k] : 0.0;
    };
    return {share(friction, 0), share(rolling, 1)};
  }

  std::array<double, 2> from_, width_;
  std::vector<Eigen::Vector2d> at_;
  std::vector<double> angles_;
  std::optional<Emulator> emulator_;
};

/// Sets the node's coefficients of Bullet to those on its ray that give rrlinear's angle and are nearest to
/// (mu, mu_r), or, if Bullet never gives that angle there, to those that come nearest to it; false if these
/// stay farther off than `within`.
bool solve(const EquivalenceSpec& spec, const AngleMap& bullet, EquivalenceNode& node) {
  double best = nan, nearest = nan, least = spec.within, before_factor = nan, before = nan;
  for (int k = 0; k <= kRaySteps; ++k) {
    const double factor = 0.2 * std::pow(25.0, static_cast<double>(k) / kRaySteps);  // 0.2 to 5
    const double friction = factor * node.mu, rolling = factor * node.mu_r;
    const bool inside = friction >= spec.friction.from && friction <= spec.friction.to &&
                        rolling >= spec.rolling.from && rolling <= spec.rolling.to;
    const double here = inside ? bullet.at(friction, rolling).mean - node.angle_rrlinear : nan;
    if (before * here <= 0) {
      const double root = before_factor + (factor - before_factor) * before / (before - here);
      if (std::isfinite(root) && !(std::abs(std::log(root)) > std::abs(std::log(best)))) best = root;
    }
    if (std::abs(here) <= least) {
      least = std::abs(here);
      nearest = factor;
    }
    before_factor = factor;
    before = here;
  }
  if (!std::isfinite(best)) best = nearest;
  if (!std::isfinite(best)) return false;
  node.friction = best * node.mu;
  node.rolling = best * node.mu_r;
  return true;
}

std::vector<double> rising(const YamlNode& nodes, const char* key, FileReader& reader) {
  const YamlEntry* entry = nodes.find(key);
  std::vector<double> values;
  if (entry == nullptr) {
    reader.fail(nodes.place, fmt::format("nodes: {} is missing", key));
    return values;
  }
  if (entry->value.kind != YamlKind::sequence || entry->value.items.empty())
    reader.fail(entry->value.place, fmt::format("{}: a list of numbers is expected", key));
  else
    for (const YamlNode& item : entry->value.items)
      if (const auto value = reader.number(item, key)) values.push_back(*value);
  if (!std::is_sorted(values.begin(), values.end(), std::less_equal<>()))
    reader.fail(entry->value.place, fmt::format("{}: the numbers must rise", key));
  return values;
}

}  // namespace

bool is_equivalence(const fs::path& file) {
  std::vector<ScenarioError> errors;
  const auto root = read_yaml(file, errors);
  return root && root->find("equivalent") != nullptr;
}

EquivalenceSpecResult load_equivalence(const fs::path& file) {
  EquivalenceSpecResult result;
  EquivalenceSpec& spec = result.spec;
  FileReader reader(result.errors);
  spec.name = file.stem().string();
  const auto root = read_yaml(file, result.errors);
  if (!root) return result;
  reader.allow(*root, {"scenario", "seeds", "set", "equivalent"}, " beside equivalent");
  if (const auto scenario = scenario_at(*root, file, true, reader)) spec.scenario = *scenario;
  spec.fixed = read_variation(*root, {}, reader).fixed;
  if (const YamlNode* list = reader.list_at(*root, "seeds", true, "a list of integers"))
    spec.seeds = reader.seeds(*list);
  const YamlNode* part = reader.map_at(*root, "equivalent", true, "a map");
  if (part == nullptr) return result;
  reader.allow(*part, {"output", "nodes", "search", "points", "rounds", "within"}, " in equivalent");
  const YamlEntry* output = part->find("output");
  spec.output = output == nullptr ? "angle_deg" : reader.scalar(output->value, "output").value_or("");
  if (const YamlNode* nodes = reader.map_at(*part, "nodes", true, "a map of lists of numbers")) {
    reader.allow(*nodes, {"material.mu", "material.mu_r", "material.local_damping"}, " in nodes");
    spec.mu = rising(*nodes, "material.mu", reader);
    spec.mu_r = rising(*nodes, "material.mu_r", reader);
    spec.local_damping = rising(*nodes, "material.local_damping", reader);
  }
  if (const YamlNode* search =
          reader.map_at(*part, "search", true, "a map from keys to {from: .., to: ..}")) {
    const std::vector<FileReader::Span> spans = reader.spans(*search);
    for (const FileReader::Span& span : spans) {
      if (span.key == "numerics.impulse_friction") spec.friction = span;
      if (span.key == "numerics.impulse_rolling") spec.rolling = span;
    }
    if (spans.size() != 2 || spec.friction.key.empty() || spec.rolling.key.empty())
      reader.fail(search->place, "search: numerics.impulse_friction and numerics.impulse_rolling are needed");
  }
  reader.integer(*part, "points", static_cast<int>(Emulator::kLeastPoints), 200, spec.points);
  reader.integer(*part, "rounds", 1, 20, spec.rounds);
  if (const YamlEntry* within = part->find("within"))
    spec.within = reader.number(within->value, "within").value_or(spec.within);
  if (!(spec.within > 0)) reader.fail(part->place, "within: degrees, more than 0");
  const double most =
      spec.points + static_cast<double>(spec.mu.size() * spec.mu_r.size() * spec.seeds.size()) * spec.rounds;
  if (most > static_cast<double>(Emulator::kMostPoints))
    reader.fail(
        part->place,
        fmt::format("up to {} simulations with Bullet (points, nodes, seeds, rounds); {} are the most", most,
                    Emulator::kMostPoints));
  return result;
}

std::vector<EquivalenceNode> fit_equivalence(const EquivalenceSpec& spec,
                                             const EquivalenceSimulator& simulate) {
  std::vector<EquivalenceNode> all;
  for (const double local_damping : spec.local_damping) {
    std::vector<EquivalenceNode> nodes;
    std::vector<EquivalenceRun> runs;
    for (const double mu : spec.mu)
      for (const double mu_r : spec.mu_r) {
        nodes.push_back({mu, mu_r, local_damping});
        for (const std::uint64_t seed : spec.seeds) runs.push_back(rrlinear_run(spec, nodes.back(), seed));
      }
    std::vector<std::array<double, 2>> design;
    for (const auto& unit : sobol(spec.points, 2)) {
      design.push_back({spec.friction.from + unit[0] * (spec.friction.to - spec.friction.from),
                        spec.rolling.from + unit[1] * (spec.rolling.to - spec.rolling.from)});
      runs.push_back(bullet_run(spec, local_damping, design.back()[0], design.back()[1],
                                spec.seeds[(design.size() - 1) % spec.seeds.size()]));
    }
    const std::vector<double> first = simulate(runs);
    AngleMap rrlinear(spec.mu.front(), spec.mu.back(), spec.mu_r.front(), spec.mu_r.back());
    AngleMap bullet(spec.friction.from, spec.friction.to, spec.rolling.from, spec.rolling.to);
    auto angle = first.begin();
    for (const EquivalenceNode& node : nodes)
      for (std::size_t k = 0; k < spec.seeds.size(); ++k) rrlinear.add(node.mu, node.mu_r, *angle++);
    for (const auto& [friction, rolling] : design) bullet.add(friction, rolling, *angle++);
    rrlinear.learn();
    bullet.learn();
    for (EquivalenceNode& node : nodes) node.angle_rrlinear = rrlinear.at(node.mu, node.mu_r).mean;

    for (int round = 0; round < spec.rounds; ++round) {
      std::vector<EquivalenceNode*> asked;
      runs.clear();
      for (EquivalenceNode& node : nodes) {
        if (node.found || !solve(spec, bullet, node)) continue;
        asked.push_back(&node);
        for (const std::uint64_t seed : spec.seeds)
          runs.push_back(bullet_run(spec, local_damping, node.friction, node.rolling, seed));
      }
      if (asked.empty()) break;
      const std::vector<double> checks = simulate(runs);
      angle = checks.begin();
      for (const EquivalenceNode* node : asked)
        for (std::size_t k = 0; k < spec.seeds.size(); ++k)
          bullet.add(node->friction, node->rolling, *angle++);
      bullet.learn();
      for (EquivalenceNode* node : asked) {
        const Prediction learnt = bullet.at(node->friction, node->rolling);
        node->angle_impulse = learnt.mean;
        node->found =
            std::abs(learnt.mean - node->angle_rrlinear) <= spec.within && learnt.std <= spec.within;
      }
    }
    all.insert(all.end(), nodes.begin(), nodes.end());
  }
  return all;
}

std::string equivalence_csv(const std::vector<EquivalenceNode>& nodes,
                            const std::vector<std::string>& comment) {
  std::string text;
  for (const std::string& line : comment) text += "# " + line + "\n";
  text += "mu,mu_r,local_damping,friction,rolling,angle_rrlinear_deg,angle_impulse_deg\n";
  for (const EquivalenceNode& node : nodes) {
    text += fmt::format("{:g},{:g},{:g},", node.mu, node.mu_r, node.local_damping);
    text += node.found ? fmt::format("{:.4f},{:.4f},{:.2f},{:.2f}\n", node.friction, node.rolling,
                                     node.angle_rrlinear, node.angle_impulse)
                       : fmt::format(",,{:.2f},\n", node.angle_rrlinear);
  }
  return text;
}

}  // namespace scree
