// Conductivity formulae against numbers worked by hand.
#include "analysis/pile/permeability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

TEST(Permeability, KozenyCarmanByHand) {
  // In the units of the source: 0.1 * 9.789 / 1.002e-3 * 0.5^5 / 1.5 * 8^(1/3) * 0.1^2 = 0.40706 cm/s.
  EXPECT_NEAR(conductivity_kozeny_carman({0.001, 0.006, 8, 0.5}), 0.40706e-2, 1e-6);
}

TEST(Permeability, KozenyCarmanInSiUnitsHasATenthOfItsConstant) {
  // 0.01 (gamma / mu) with gamma in N/m3 and D10 in m gives the same m/s as 0.1 with kN/m3, cm and cm/s.
  const double e = 0.4, cu = 12, d10 = 0.003;
  const double si = 0.01 * (9789 / 1.002e-3) * std::pow(e, 5) / (1 + e) * std::cbrt(cu) * d10 * d10;
  EXPECT_NEAR(conductivity_kozeny_carman({d10, 0.02, cu, e}), si, 1e-12 * si);
}

TEST(Permeability, TaylorLiesNearKozenyAndCarmanForSpheres) {
  // One size: k = (gamma / mu) D^2 / 180 e^3 / (1 + e) (Carman 1937); 1 / 180 = 0.0056 against 0.004.
  const double e = 0.6, d = 0.002;
  const double carman = 9789 / 1.002e-3 * d * d / 180 * std::pow(e, 3) / (1 + e);
  EXPECT_NEAR(conductivity_taylor({d, d, 1, e}) / carman, 0.72, 1e-3);
}

TEST(Permeability, SandIsAsHazenSays) {
  // Hazen (1911) for loose clean sand: k = 100 D10^2 in cm/s with D10 in cm; here 0.02 cm.
  const double hazen = 100 * 0.02 * 0.02 / 100;  // m/s
  const double k = conductivity_kozeny_carman({0.0002, 0.0005, 3, 0.7});
  EXPECT_GT(k, hazen / 2);
  EXPECT_LT(k, hazen * 2);
}

TEST(Permeability, RatiosFollowTheirPowers) {
  const PoreMaterial original{0.01, 0.1, 20, 0.3};
  PoreMaterial coarse = original;
  coarse.d10 *= 2, coarse.d50 *= 2;
  EXPECT_NEAR(conductivity_ratio_kozeny_carman(coarse, original), 4, 1e-12);
  EXPECT_NEAR(conductivity_ratio_taylor(coarse, original), std::pow(2, 1.5), 1e-12);
  EXPECT_NEAR(conductivity_ratio_taylor(coarse, original, 2), 4, 1e-12);
  EXPECT_NEAR(conductivity_taylor(coarse) / conductivity_taylor(original), 4, 1e-12);

  PoreMaterial graded = original;
  graded.cu *= 8;
  EXPECT_NEAR(conductivity_ratio_kozeny_carman(graded, original), 2, 1e-12);
  EXPECT_NEAR(conductivity_ratio_taylor(graded, original), 1, 1e-12);

  PoreMaterial loose = original;
  loose.void_ratio = 0.6;
  EXPECT_NEAR(conductivity_ratio_kozeny_carman(loose, original), 32 * 1.3 / 1.6, 1e-12);
  EXPECT_NEAR(conductivity_ratio_taylor(loose, original), 8 * 1.3 / 1.6, 1e-12);
}

TEST(Permeability, GrowsWithVoids) {
  double before = 0;
  for (double porosity = 0.1; porosity < 0.7; porosity += 0.05) {
    const double k = conductivity_kozeny_carman({0.01, 0.1, 20, void_ratio(porosity)});
    EXPECT_GT(k, before);
    before = k;
  }
  EXPECT_NEAR(void_ratio(0.25), 1.0 / 3, 1e-15);
}

TEST(Permeability, RefusesWhatNoMaterialHas) {
  const PoreMaterial good{0.01, 0.1, 20, 0.3};
  for (const PoreMaterial& bad :
       {PoreMaterial{0, 0.1, 20, 0.3}, PoreMaterial{0.01, 0, 20, 0.3}, PoreMaterial{0.01, 0.1, 0.9, 0.3},
        PoreMaterial{0.01, 0.1, 20, 0}, PoreMaterial{0.01, 0.005, 20, 0.3},
        PoreMaterial{0.01, 0.1, 20, std::nan("")}}) {
    EXPECT_THROW(conductivity_kozeny_carman(bad), std::invalid_argument);
    EXPECT_THROW(conductivity_ratio_kozeny_carman(good, bad), std::invalid_argument);
    EXPECT_THROW(conductivity_ratio_taylor(bad, good), std::invalid_argument);
  }
  EXPECT_THROW(void_ratio(0), std::invalid_argument);
  EXPECT_THROW(void_ratio(1), std::invalid_argument);
}

}  // namespace
}  // namespace scree
