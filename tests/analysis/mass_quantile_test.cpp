#include "analysis/pile/mass_quantile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

TEST(MassQuantile, IsWeighedByMass) {
  const std::vector<WeighedValue> values{{3, 1}, {1, 6}, {2, 3}};
  EXPECT_EQ(mass_quantile(values, 0), 1);
  EXPECT_EQ(mass_quantile(values, 0.6), 1);
  EXPECT_EQ(mass_quantile(values, 0.61), 2);
  EXPECT_EQ(mass_quantile(values, 0.9), 2);
  EXPECT_EQ(mass_quantile(values, 1), 3);
}

TEST(MassQuantile, OfNothingIsNoNumber) {
  EXPECT_TRUE(std::isnan(mass_quantile({}, 0.5)));
  EXPECT_THROW(mass_quantile({{1, 1}}, 1.01), std::invalid_argument);
  EXPECT_THROW(mass_quantile({{1, 0}}, 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace scree
