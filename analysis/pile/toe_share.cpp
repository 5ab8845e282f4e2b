#include "analysis/pile/toe_share.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "analysis/pile/segregation.h"

namespace scree {

double share_reaching_toe(const std::vector<Grain>& pile, double crest_height,
                          const std::vector<Grain>& original, double quantile) {
  if (!(quantile >= 0 && quantile <= 1))
    throw std::invalid_argument(fmt::format("quantile {} must lie between 0 and 1", quantile));
  std::vector<double> diameters, masses;
  for (const Grain& grain : original) {
    diameters.push_back(grain.diameter);
    masses.push_back(grain.mass);
  }
  return share_reaching_toe_above(pile, crest_height, PassingCurve(diameters, masses).diameter(quantile));
}

double share_reaching_toe_above(const std::vector<Grain>& pile, double crest_height, double diameter) {
  if (!(crest_height > 0))
    throw std::invalid_argument(fmt::format("crest height {} m must be above 0", crest_height));
  double coarse = 0, at_toe = 0;
  for (const Grain& grain : pile) {
    if (!(grain.diameter > diameter)) continue;
    coarse += grain.mass;
    if (grain.position.z() <= crest_height / 6) at_toe += grain.mass;
  }
  return coarse > 0 ? at_toe / coarse : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace scree
