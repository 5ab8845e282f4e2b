#pragma once
// Grains as a measurement counts them: the one place where effects on measurement change diameters.
#include <vector>

#include "sim/effects/measurement.h"
#include "sim/io/snapshot.h"

namespace scree {

/// Diameters (m) and their masses (kg), of the same length.
struct CountedGrains {
  std::vector<double> diameters, masses;
};

/// What is counted of these grains: first the share that is seen, by the true diameter; then the biased
/// diameter. Its spread is the passing curve's. The masses add up to those of the grains: a part of a pile is
/// weighed, or its volume surveyed, and its grading is that of what is seen. `seen`: of each grain, the share
/// of its outline (seen_shares()); empty: grains that are measured through and through. Nothing is counted of
/// grains that are all covered where only the surface counts.
CountedGrains count_grains(const std::vector<const Grain*>& grains, const Measurement& measured,
                           const std::vector<double>& seen = {});

}  // namespace scree
