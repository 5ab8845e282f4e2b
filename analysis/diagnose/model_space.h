#pragma once
// Where a diagnosis looks: the parameters of the base model, and the effects that may be missing.
#include <Eigen/Dense>
#include <string>
#include <vector>

namespace scree {

/// A parameter of the base model; its coordinate is -1 at `from` and 1 at `to`.
struct BaseAxis {
  std::string key;  ///< of the scenario: material.mu
  double nominal = 0, from = 0, to = 1;

  double coordinate(double value) const { return (2 * value - from - to) / (to - from); }
  double value(double coordinate) const { return 0.5 * (from + to + coordinate * (to - from)); }
};

/// One parameter of an effect with its prior range.
struct EffectAxis {
  std::string key;  ///< effects.cohesion.bond_number
  std::string unit;
  double low = 0, high = 1;
};

/// An effect that may be missing. The coordinate of its amplitude is 0 where the effect is absent and 1, or
/// -1, at the end of the prior range that is farther off; those of its other parameters are -1 to 1.
struct CandidateEffect {
  std::string name, title;
  double absent = 0;              ///< amplitude at which it does nothing
  std::vector<EffectAxis> axes;   ///< the amplitude first; others have a range
  std::vector<std::string> acts;  ///< experiments in which it changes anything
  bool measures = false;          ///< it changes how a pile is measured, and not the pile
  std::string excludes = {};      ///< name of an effect that it cannot go with

  double scale() const;
  double amplitude(double coordinate) const { return absent + coordinate * scale(); }
  double coordinate(double amplitude) const { return (amplitude - absent) / scale(); }
  double lowest() const { return coordinate(axes[0].low); }    ///< coordinates of the ends of its range
  double highest() const { return coordinate(axes[0].high); }  ///< (amplitude)
  bool one_sign() const { return lowest() >= 0 || highest() <= 0; }
  /// How far along an amplitude is, for distances between models: its coordinate, of effects of one sign the
  /// square root of it (with that sign). Several do most of what they can in the lowest part of their range.
  double along(double coordinate) const;
  /// Value of a parameter (0: the amplitude) at a coordinate.
  double value(std::size_t axis, double coordinate) const;
  bool acts_in(const std::string& experiment) const;
  bool goes_with(const CandidateEffect& other) const;  ///< neither excludes the other
};

/// An effect that is there, at these coordinates of its parameters.
struct EffectAt {
  std::size_t effect = 0;  ///< index into ModelSpace::effects
  Eigen::VectorXd at;      ///< a coordinate an axis

  double amplitude() const { return at[0]; }
};

/// A model: the base parameters and the effects that are there.
struct ModelPoint {
  Eigen::VectorXd base;           ///< a coordinate an axis
  std::vector<EffectAt> effects;  ///< by rising index
};

/// An effect that is not looked for.
struct LeftOut {
  std::string effect, why;  ///< "experiment dump has it"
};

struct ModelSpace {
  std::vector<BaseAxis> base;
  std::vector<CandidateEffect> effects;
  std::vector<LeftOut> left_out = {};

  /// Largest difference of a coordinate, for amplitudes of that and of how far along they are; infinite
  /// between models of different effects. Amplitudes below a hundredth of the range are all the same.
  double distance(const ModelPoint& a, const ModelPoint& b) const;

  Eigen::VectorXd nominal() const;  ///< coordinates
  /// Index of an effect; the number of effects if there is none of this name.
  std::size_t find(const std::string& effect) const;
};

}  // namespace scree
