#include "analysis/diagnose/model_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {

double CandidateEffect::scale() const {
  return std::max(std::abs(axes[0].high - absent), std::abs(axes[0].low - absent));
}

double CandidateEffect::value(std::size_t axis, double coordinate) const {
  if (axis == 0) return amplitude(coordinate);
  const EffectAxis& a = axes[axis];
  return 0.5 * (a.low + a.high + coordinate * (a.high - a.low));
}

double CandidateEffect::along(double coordinate) const {
  if (!one_sign()) return coordinate;
  return std::copysign(std::sqrt(std::abs(coordinate)), coordinate);
}

bool CandidateEffect::acts_in(const std::string& experiment) const {
  return std::find(acts.begin(), acts.end(), experiment) != acts.end();
}

bool CandidateEffect::goes_with(const CandidateEffect& other) const {
  return excludes != other.name && other.excludes != name;
}

double ModelSpace::distance(const ModelPoint& a, const ModelPoint& b) const {
  constexpr double kNearlyAbsent = 0.01;
  if (a.effects.size() != b.effects.size()) return std::numeric_limits<double>::infinity();
  double most = (a.base - b.base).cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < a.effects.size(); ++k) {
    const EffectAt &one = a.effects[k], &other = b.effects[k];
    if (one.effect != other.effect) return std::numeric_limits<double>::infinity();
    most = std::max(most, (one.at - other.at).cwiseAbs().maxCoeff());
    const auto along = [&](const EffectAt& e) {
      return effects[e.effect].along(std::abs(e.amplitude()) > kNearlyAbsent
                                         ? e.amplitude()
                                         : std::copysign(kNearlyAbsent, e.amplitude()));
    };
    if (std::abs(one.amplitude()) > kNearlyAbsent || std::abs(other.amplitude()) > kNearlyAbsent)
      most = std::max(most, std::abs(along(one) - along(other)));
  }
  return most;
}

Eigen::VectorXd ModelSpace::nominal() const {
  Eigen::VectorXd at(static_cast<Eigen::Index>(base.size()));
  for (std::size_t k = 0; k < base.size(); ++k)
    at[static_cast<Eigen::Index>(k)] = base[k].coordinate(base[k].nominal);
  return at;
}

std::size_t ModelSpace::find(const std::string& effect) const {
  return static_cast<std::size_t>(
      std::find_if(effects.begin(), effects.end(), [&](const auto& each) { return each.name == effect; }) -
      effects.begin());
}

}  // namespace scree
