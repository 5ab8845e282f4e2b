#pragma once
// Settings of Bullet's solver that make it give what rrlinear gives: the calibration of one engine by the
// other.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/ensemble/file_reader.h"

namespace scree {

struct EquivalenceSpec {
  std::string name;  ///< the file's stem
  std::filesystem::path scenario;
  std::vector<std::string> fixed;  ///< overrides "key=value"
  std::vector<std::uint64_t> seeds;
  std::string output;                           ///< number that both engines are to give, in degrees
  std::vector<double> mu, mu_r, local_damping;  ///< nodes, rising
  FileReader::Span friction, rolling;           ///< Bullet's, searched
  int points = 24;                              ///< first simulations with Bullet, for each local damping
  int rounds = 3;                               ///< of checks and corrections at the nodes
  double within = 2;                            ///< degrees; a node that stays farther off is left out
};

struct EquivalenceSpecResult {
  EquivalenceSpec spec;
  std::vector<ScenarioError> errors;
};

/// Whether a calibration file asks for equivalent engines: it has a key `equivalent`.
bool is_equivalence(const std::filesystem::path& file);

/// Reads:
///   scenario: repose_lab.yaml
///   seeds: [1, 2]
///   set: {experiment.mass_kg: 40}
///   equivalent:
///     output: angle_deg
///     nodes: {material.mu: [0.1, 0.2], material.mu_r: [0.1, 0.2], material.local_damping: [0.4]}
///     search: {numerics.impulse_friction: {from: 0.05, to: 1}, numerics.impulse_rolling: {from: 0, to: 1}}
///     points: 24
///     rounds: 3
///     within: 2
EquivalenceSpecResult load_equivalence(const std::filesystem::path& file);

/// A simulation that is asked for: its overrides and seed.
struct EquivalenceRun {
  std::vector<std::string> overrides;
  std::uint64_t seed = 0;
};

/// Does simulations and returns the output of each, NaN where there is none.
using EquivalenceSimulator = std::function<std::vector<double>(const std::vector<EquivalenceRun>& runs)>;

/// A node of the table that comes out.
struct EquivalenceNode {
  double mu = 0, mu_r = 0, local_damping = 0;
  double angle_rrlinear = 0;         ///< degrees, of the emulator of all nodes' runs
  double angle_impulse = 0;          ///< degrees, of the emulator that has learnt the last check
  double friction = 0, rolling = 0;  ///< Bullet's
  bool found = false;                ///< both are within the bound, and Bullet's is known as closely
};

/// Simulates the nodes with rrlinear and a Sobol design with Bullet, emulates both engines' angles over their
/// coefficients (runs scatter by more than the bound; neighbours help), takes for each node those on the ray
/// through (mu, mu_r) that give rrlinear's angle (the ones nearest to mu and mu_r), simulates them, and
/// corrects with what was learnt. Throws what `simulate` throws,
/// and std::runtime_error when too few simulations gave a number.
std::vector<EquivalenceNode> fit_equivalence(const EquivalenceSpec& spec,
                                             const EquivalenceSimulator& simulate);

/// The table as sim/material/equivalence.h reads it; `comment` lines go before the header.
std::string equivalence_csv(const std::vector<EquivalenceNode>& nodes,
                            const std::vector<std::string>& comment);

}  // namespace scree
