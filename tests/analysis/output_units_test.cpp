// Units of outputs, told by their names.
#include "analysis/results/output_units.h"

#include <gtest/gtest.h>

#include <numbers>

namespace scree {
namespace {

TEST(OutputUnits, FollowFromTheName) {
  for (const char* name : {"angle_deg", "slope_angle_deg", "height_over_radius_deg"})
    EXPECT_EQ(unit_of_output(name), "deg") << name;
  for (const char* name : {"d50_m_S1", "d10_m_top", "d80_m_S2of3_dump1", "height_m", "point1_toe_width_m"})
    EXPECT_EQ(unit_of_output(name), "m") << name;
  for (const char* name : {"mass_t_S6", "mass_t_bottom", "lost_mass_t"})
    EXPECT_EQ(unit_of_output(name), "t") << name;
  for (const char* name : {"chi_S1", "chi_ring1", "d50_rel_S1", "mass_share_ring3", "profile_25", "spread_95",
                           "share_above_1m_S6", "share_above_1m_orig", "lateral_chi_std_S1"})
    EXPECT_EQ(unit_of_output(name), "") << name;
  EXPECT_EQ(unit_of_output("flow_speed_S1"), "m/s");
  EXPECT_EQ(unit_of_output("arrival_energy_j_per_kg"), "J/kg");
}

TEST(OutputUnits, AreConverted) {
  EXPECT_EQ(unit_factor("mm", "m"), 1e-3);
  EXPECT_EQ(unit_factor("kg", "t"), 1e-3);
  EXPECT_EQ(unit_factor("%", ""), 1e-2);
  EXPECT_DOUBLE_EQ(unit_factor("rad", "deg").value() * std::numbers::pi, 180);
  EXPECT_EQ(unit_factor("", "deg"), 1);
  EXPECT_FALSE(unit_factor("mm", "deg"));
  EXPECT_FALSE(unit_factor("ft", "m"));
}

}  // namespace
}  // namespace scree
