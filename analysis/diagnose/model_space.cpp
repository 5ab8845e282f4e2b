#include "analysis/diagnose/model_space.h"

#include <algorithm>
#include <cmath>

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
  if (lowest() < 0 && highest() > 0) return coordinate;
  return std::copysign(std::sqrt(std::abs(coordinate)), coordinate);
}

bool CandidateEffect::acts_in(const std::string& experiment) const {
  return std::find(acts.begin(), acts.end(), experiment) != acts.end();
}

bool CandidateEffect::goes_with(const CandidateEffect& other) const {
  return excludes != other.name && other.excludes != name;
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
