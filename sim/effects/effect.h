#pragma once
// Effects: named pieces of physics that the base model lacks. A scenario switches one on under `effects:`;
// `scree diagnose` looks for those that data ask for.
//
// An effect is one file: its words, its parameters, and a function that says what it changes in a model. The
// first parameter is its amplitude; at the value `absent` nothing is changed and a run gives the same numbers
// as without the effect, bit by bit.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/contact/contact_effects.h"
#include "sim/effects/measurement.h"
#include "sim/world/breakage.h"
#include "sim/world/clumps.h"
#include "sim/world/vibration.h"

namespace scree {

/// What effects change in a model; with the defaults nothing.
struct Modifications {
  ContactEffects contact;
  double flight_damping = 1;              ///< share of local damping that acts in flight
  double normal_damping_ratio = 0;        ///< added to the material's
  double ground_mu = 1, ground_mu_r = 1;  ///< factors of the friction of floor, bench, walls and base layer
  double tool_surface_energy = 0;         ///< of truck beds, blades, buckets and users' tools, J/m2
  double density_exponent = 0;            ///< density is times (d / D50)^this
  double fines_share = 0;                 ///< of the mass, finer than the grading's smallest size
  double fines_ratio = 1;                 ///< the grading's smallest diameter over that of the fines
  double release_speed = 0;               ///< m/s, along the bed, of a load when its gate opens
  Vibration vibration;                    ///< of the ground
  Breakage breakage;
  Clumps clumps;
  Measurement measurement;  ///< how the finished pile is measured
};

/// What of the model effects need to know.
struct EffectContext {
  double d50 = 1;         ///< m, of the grading, or the size given for it
  double smallest = 0;    ///< m, smallest diameter of the grading
  double density = 2760;  ///< kg/m3
  double gravity = 9.81;  ///< m/s2

  /// Surface energy (J/m2) with which two spheres of D50 pull each other with `bond_number` times their
  /// weight.
  double surface_energy(double bond_number) const;
  /// Weight of a grain of D50, N.
  double weight() const;
  /// A pull of `bond_number` times that weight: "12 N, or 8 kPa over", to be followed by the section.
  std::string pull_in_words(double bond_number) const;
};

/// What of a scenario decides whether an effect changes anything in it.
struct EffectScene {
  std::string_view experiment;  ///< its type
  bool gate_opens = true;       ///< loads leave a truck when its gate opens
  bool damped_flight = true;    ///< local damping acts in flight
};

/// What an effect needs of a scenario beside the type of its experiment.
struct EffectNeed {
  bool EffectScene::*given;
  std::string_view words;  ///< key and value: "experiment.truck.release open_gate"
};

struct EffectParameter {
  std::string_view key;          ///< in a scenario file; ends with its unit, if it has one
  std::string_view unit;         ///< empty: none
  double low, high;              ///< allowed
  double standard;               ///< taken where the key is left out
  double prior_low, prior_high;  ///< where diagnose looks for it
  std::string_view doc;
};

struct Effect {
  std::string_view name;      ///< key under `effects:`
  std::string_view title;     ///< for a reader: "cohesion between grains"
  std::string_view doc;       ///< one sentence: what it is in the field or in the laboratory
  std::string_view equation;  ///< what the simulator computes
  std::string_view source;    ///< literature
  std::vector<EffectParameter> parameters;
  double absent;  ///< amplitude at which nothing is changed
  /// Experiments in which it changes anything; empty: all.
  std::vector<std::string_view> experiments;
  std::optional<EffectNeed> needs = {};  ///< without it nothing is changed either
  void (*apply)(std::span<const double> values, const EffectContext& context, Modifications& model);
  bool measures = false;           ///< acts on what is analysed, not on the motion
  std::string_view excludes = {};  ///< name of an effect that it cannot go with
  /// What the amplitude comes to in absolute units, for an effect whose amplitude does not show it.
  std::string (*in_units)(std::span<const double> values, const EffectContext& context) = nullptr;
};

/// All effects there are, in the order of the documentation.
const std::vector<Effect>& all_effects();

/// The effect of this name; null if there is none.
const Effect* find_effect(std::string_view name);

/// An effect as a scenario uses it.
struct EffectUse {
  const Effect* effect;
  std::vector<double> values;  ///< of its parameters
};

/// Why an effect changes nothing in such a scene: "in an experiment of type drop_test"; empty: it acts.
std::string why_inert(const Effect& effect, const EffectScene& scene);

/// Name, values of all parameters, and what they come to in absolute units: "cohesion: bond_number 1; ...".
std::string effect_in_words(const EffectUse& use, const EffectContext& context);

/// What all of these together change.
Modifications modifications(std::span<const EffectUse> uses, const EffectContext& context);

}  // namespace scree
