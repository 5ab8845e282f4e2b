// Printed values, and runs held against them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "analysis/results/outputs.h"
#include "scree_version.h"

namespace scree {
namespace {

std::vector<ReferenceValue> stored() {
  return read_reference(std::filesystem::path(SCREE_SOURCE_DIR) / "assets/reference/results.csv");
}

const ReferenceValue* find(const std::vector<ReferenceValue>& rows, const std::string& name,
                           const std::string& quantity, const std::string& section, const std::string& kind) {
  for (const auto& row : rows)
    if (row.case_name == name && row.quantity == quantity && row.section == section && row.kind == kind &&
        row.relation != "min" && row.relation != "max")
      return &row;
  return nullptr;
}

/// A seed with a table of n sections whose chi is 0, 0.1, 0.2 ... plus `shift`.
SeedResult seed_with_sections(std::vector<int> counts, double shift = 0) {
  SeedResult seed;
  for (const int n : counts) {
    SectionTable table;
    table.original_above_1m = 0.6;
    for (int k = 0; k < n; ++k) {
      Section section;
      section.name = std::string("S").append(std::to_string(k + 1));
      section.chi = 0.1 * k + shift;
      section.d50 = 1 + k;
      section.d50_rel = 2 + k;
      section.mass = 1000.0 * (k + 1);
      section.share_above_1m = (k + 1) / (0.5 * n * (n + 1));
      table.sections.push_back(section);
    }
    seed.sections.push_back(table);
  }
  return seed;
}

TEST(MeanStd, LeavesNaNOut) {
  const double nan = std::nan("");
  const MeanStd three = mean_std({1, nan, 2, 3});
  EXPECT_EQ(three.n, 3);
  EXPECT_DOUBLE_EQ(three.mean, 2);
  EXPECT_DOUBLE_EQ(three.std, 1);  // sqrt((1 + 0 + 1) / (3 - 1))
  EXPECT_TRUE(std::isnan(mean_std({5}).std));
  EXPECT_TRUE(std::isnan(mean_std({nan}).mean));
  EXPECT_EQ(mean_std({}).n, 0);
}

TEST(Reference, StoredFileHoldsThePrintedValues) {
  const auto rows = stored();
  const auto* chi = find(rows, "A1", "chi", "S1", "pfc3d");
  ASSERT_TRUE(chi);
  EXPECT_DOUBLE_EQ(chi->value, -1.04);
  EXPECT_DOUBLE_EQ(chi->std.value(), 0.33);
  const auto* angle = find(rows, "lab_repose_0.2_0.2", "angle", "whole", "pfc3d");
  ASSERT_TRUE(angle);
  EXPECT_DOUBLE_EQ(angle->value, 25.25);
  EXPECT_EQ(angle->unit, "deg");
  const auto* measured = find(rows, "lab_repose_0.2_0.2", "angle", "whole", "measured");
  ASSERT_TRUE(measured);
  EXPECT_DOUBLE_EQ(measured->value, 25.4);
  EXPECT_DOUBLE_EQ(find(rows, "lab_segregation", "d50", "bottom", "measured")->value, 0.059);  // 59 mm
  int pairs = 0;
  for (const auto& row : rows) pairs += row.case_name.starts_with("lab_repose_") && row.kind == "pfc3d";
  EXPECT_EQ(pairs, 16);
  for (const char* section : {"S1", "S2", "S3", "S4", "S5", "S6"})
    for (const char* quantity : {"chi", "d10_rel", "d50_rel", "d80_rel", "d90_rel", "d95_rel"})
      EXPECT_TRUE(find(rows, "cm_field_6sec", quantity, section, "measured")) << section << ' ' << quantity;
}

TEST(Reference, RoundingIsThatOfThePrintedDigits) {
  const auto rows = stored();
  EXPECT_DOUBLE_EQ(find(rows, "A1", "share_above_1m", "S6", "pfc3d")->rounding, 0.005) << "40 %";
  EXPECT_DOUBLE_EQ(find(rows, "A1", "mass_t", "S6", "pfc3d")->rounding, 0.5) << "375 t";
  EXPECT_DOUBLE_EQ(find(rows, "A1", "xl_chi_zero", "whole", "pfc3d")->rounding, 0.05) << "0.7";
  EXPECT_DOUBLE_EQ(find(rows, "lab_segregation", "d50", "top", "measured")->rounding, 0.00005) << "26.3 mm";
  EXPECT_DOUBLE_EQ(find(rows, "cm_field_6sec", "chi", "S1", "measured")->rounding, 0) << "derived";
}

TEST(Reference, HasThePrintedRangesOfSections) {
  const auto rows = stored();
  const auto* scatter = find(rows, "A1", "chi_scatter", "S1", "pfc3d");
  ASSERT_TRUE(scatter);
  EXPECT_DOUBLE_EQ(scatter->value, 0.22);  // line 1812
  EXPECT_DOUBLE_EQ(scatter->upper.value(), 0.48);
  // Of five repeats: the value over sqrt 8.
  EXPECT_NEAR(scatter->std.value(), 0.22 / std::sqrt(8), 1e-6);
  EXPECT_NEAR(scatter->upper_std.value(), 0.48 / std::sqrt(8), 1e-6);
  for (const char* section : {"S1", "S2", "S3", "S4", "S5", "S6"}) {
    const auto* across = find(rows, "lateral_S8", "lateral_chi_std", section, "pfc3d");
    ASSERT_TRUE(across);
    EXPECT_EQ(meaning_of(*across), Meaning::at_most);
    EXPECT_DOUBLE_EQ(across->value, 0.1);  // line 1914
    const auto *near = find(rows, "C1", "d50_rel", section, "pfc3d"),
               *measured = find(rows, "cm_field_6sec", "d50_rel", section, "measured");
    ASSERT_TRUE(near && measured);
    EXPECT_NEAR(near->value, measured->value - 0.1, 1e-5);  // line 1825, six digits
    EXPECT_NEAR(near->upper.value(), measured->value + 0.1, 1e-5);
  }
}

TEST(Reference, BoundsOfARangeKeepWhatIsTheirs) {
  const auto file = std::filesystem::path(testing::TempDir()) / "scree_range.csv";
  std::ofstream(file)
      << "case,quantity,section,kind,value,std,unit,relation,source,dumps,rounding,repeats\n"
         "A,chi,S1,pfc3d,-0.5,0.2,-,max,line 2,,0.05,5\nA,chi,S1,pfc3d,-1,0.1,-,min,line 1,,0.5,5\n";
  const auto rows = read_reference(file);
  std::filesystem::remove(file);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].value, -1);
  EXPECT_EQ(rows[0].std, 0.1);
  EXPECT_EQ(rows[0].rounding, 0.5);
  EXPECT_EQ(rows[0].upper, -0.5);
  EXPECT_EQ(rows[0].upper_std, 0.2);
  EXPECT_EQ(rows[0].upper_rounding, 0.05);
  EXPECT_EQ(rows[0].repeats, 5);
  EXPECT_EQ(rows[0].source, "line 1; line 2");
}

TEST(Reference, EachValueStandsOnce) {
  std::map<std::string, int> seen;
  for (const auto& row : stored())
    EXPECT_EQ(++seen[row.case_name + row.quantity + row.section + row.kind + row.relation], 1)
        << row.case_name << ' ' << row.quantity << ' ' << row.section;
}

TEST(Reference, MalformedLineIsNamed) {
  const auto file = std::filesystem::path(testing::TempDir()) / "scree_bad_reference.csv";
  const std::string header =
      "case,quantity,section,kind,value,std,unit,relation,source,dumps,rounding,repeats\n";
  const std::map<std::string, std::string> bad{
      {"", ": the file is empty"},
      {"a,b\n", ":1: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,C.1,,,,x\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,C.1,,,\nA1,chi,S1,pfc3d,one,,-,eq,C.1,,,\n", ":3: "},
      {header + "A1,chi,S1,pfc3d,,,-,eq,C.1,,,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,-0.1,-,eq,C.1,,,\n", ":2: "},
      {header + "A1,chi,S1,guess,1,,-,eq,C.1,,,\n", ":2: "},
      {header + "A1,d50,S1,pfc3d,1,,mm,eq,C.1,,,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,equals,C.1,,,\n", ":2: "},
      {header + ",chi,S1,pfc3d,1,,-,eq,C.1,,,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,C.1,2.5,,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,C.1,0,,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,C.1,,-1,\n", ":2: "},
      {header + "A1,chi,S1,pfc3d,1,,-,eq,C.1,,,0\n", ":2: repeats 0 is no whole number"},
  };
  for (const auto& [text, place] : bad) {
    std::ofstream(file) << text;
    try {
      read_reference(file);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("scree_bad_reference.csv" + place)) << text;
    }
  }
  std::filesystem::remove(file);
  EXPECT_THROW(read_reference(file), std::runtime_error);
}

TEST(Compare, TakesTheTableWithTheCasesNumberOfDumps) {
  // cm_field_3sec: three dumps in PFC3D; the measured slope states none and is held against the finished
  // pile.
  std::vector<SeedResult> seeds{seed_with_sections({3, 3})};
  SectionTable &end = seeds[0].sections[0], &third = seeds[0].sections[1];
  end.dumps = 4, third.dumps = 3;
  end.sections[2].chi = 0.4, third.sections[2].chi = 0.3;
  int checked = 0;
  for (const auto& row : compare_with_reference(outputs_of(seeds), stored(), {"cm_field_3sec"}))
    if (row.reference.section == "bottom" && row.reference.quantity == "chi") {
      EXPECT_DOUBLE_EQ(row.simulated, row.reference.kind == "pfc3d" ? 0.3 : 0.4);
      ++checked;
    }
  EXPECT_EQ(checked, 2);
}

TEST(Compare, SaysWhenTheFinishedPileStandsForAnother) {
  std::vector<SeedResult> seeds{seed_with_sections({3})};
  seeds[0].sections[0].dumps = 4;
  const auto compared = compare_with_reference(outputs_of(seeds), stored(), {"cm_field_3sec"});
  for (const auto& row : compared)
    EXPECT_EQ(row.finished_instead, row.reference.kind == "pfc3d")
        << "measured slopes state no number of loads";
  EXPECT_THAT(
      comparison_notes(compared),
      testing::ElementsAre("cm_field_3sec: printed of the pile after load 3, which was not kept; held "
                           "against the finished pile (output.after_dumps: [3] keeps it)"));
  seeds[0].sections.push_back(seeds[0].sections[0]);
  seeds[0].sections[1].dumps = 3;
  EXPECT_TRUE(
      comparison_notes(compare_with_reference(outputs_of(seeds), stored(), {"cm_field_3sec"})).empty());
}

TEST(Compare, ScatterOfRepeatsWithThatOfSeeds) {
  // chi(S1) -0.4 and 0.4: deviation 0.5657, which scatters by 0.5657 / sqrt 2 = 0.4; printed 0.27 of five
  // repeats scatters by 0.27 / sqrt 8 = 0.0955.
  const ReferenceValue row{"case", "chi_scatter", "S1", "pfc3d", 0.27, 0.0955, "-", "eq", "T"};
  const std::vector<Outputs> seeds =
      outputs_of({seed_with_sections({6}, -0.4), seed_with_sections({6}, 0.4)});
  const auto compared = compare_with_reference(seeds, {row}, {"case"});
  ASSERT_EQ(compared.size(), 1u);
  EXPECT_NEAR(compared[0].simulated, 0.5657, 1e-4);
  EXPECT_NEAR(compared[0].simulated_std.value(), 0.4, 1e-12);
  EXPECT_NEAR(compared[0].z.value(), (0.5657 - 0.27) / std::hypot(0.4, 0.0955), 1e-4);
  EXPECT_TRUE(compare_with_reference({seeds[0]}, {row}, {"case"}).empty()) << "one seed has no scatter";
}

TEST(Compare, TakesTheTableWithTheCasesNumberOfSections) {
  const auto rows = stored();
  const std::vector<SeedResult> seeds{seed_with_sections({6, 3, 9})};
  const auto three = compare_with_reference(outputs_of(seeds), rows, {"cm_field_3sec"});
  ASSERT_FALSE(three.empty());
  for (const auto& row : three)
    if (row.reference.section == "bottom" && row.reference.quantity == "chi") {
      EXPECT_DOUBLE_EQ(row.simulated, 0.2);
    }
  const auto six = compare_with_reference(outputs_of(seeds), rows, {"A1"});
  std::map<std::string, double> simulated;
  for (const auto& row : six) simulated[row.reference.quantity + row.reference.section] = row.simulated;
  EXPECT_DOUBLE_EQ(simulated.at("chiS6"), 0.5);
  EXPECT_DOUBLE_EQ(simulated.at("mass_tS6"), 6);  // 6000 kg
  EXPECT_DOUBLE_EQ(simulated.at("share_above_1mS6"), 6. / 21);
  EXPECT_DOUBLE_EQ(simulated.at("share_above_1m_origwhole"), 0.6);
  // qb_field_9sec reads the table of 9: D50 of S2 is 2 m in it, of S9 9 m.
  for (const auto& row : compare_with_reference(outputs_of(seeds), rows, {"qb_field_9sec"}))
    if (row.reference.quantity == "d50") {
      EXPECT_DOUBLE_EQ(row.simulated, row.reference.section == "S2" ? 2 : 9);
    }
}

TEST(Compare, SkipsWhatTheRunDoesNotHaveAndBounds) {
  const auto rows = stored();
  EXPECT_TRUE(compare_with_reference({outputs_of(seed_with_sections({6}))}, rows, {"cm_field_3sec"}).empty());
  EXPECT_TRUE(
      compare_with_reference({outputs_of(seed_with_sections({6}))}, rows, {"lab_repose_0.2_0.2"}).empty());
  for (const auto& row :
       compare_with_reference({outputs_of(seed_with_sections({6}))}, rows, {"cm_field_6sec"}))
    EXPECT_EQ(meaning_of(row.reference), Meaning::value) << "measured bounds are of single places";
  EXPECT_THROW(compare_with_reference({}, rows, {"no_such_case"}), std::invalid_argument);
}

TEST(Compare, ZOfDeviationsOfBothSides) {
  ReferenceValue row{"case", "chi", "S1", "pfc3d", 0.5, 0.3, "-", "eq", "T"};
  const std::vector<SeedResult> seeds{seed_with_sections({6}, -0.4), seed_with_sections({6}, 0.4)};
  // mean 0, deviation sqrt(0.32) = 0.566 (n - 1); z = -0.5 / sqrt(0.09 + 0.32)
  auto compared = compare_with_reference(outputs_of(seeds), {row}, {"case"});
  ASSERT_EQ(compared.size(), 1u);
  EXPECT_NEAR(compared[0].simulated_std.value(), std::sqrt(0.32), 1e-12);
  EXPECT_NEAR(compared[0].z.value(), -0.5 / std::sqrt(0.41), 1e-12);
  row.std.reset();
  compared = compare_with_reference({outputs_of(seeds[0])}, {row}, {"case"});
  EXPECT_FALSE(compared[0].simulated_std.has_value());
  EXPECT_FALSE(compared[0].z.has_value());
}

TEST(Compare, ARangeIsPassedWithTheDeviationOfTheBoundThatIsPassed) {
  const auto rows = stored();
  const ReferenceValue range = *find(rows, "A1", "chi_scatter", "S1", "pfc3d");
  // chi of S1 at -d and d: a scatter of d sqrt 2, which scatters by d.
  const auto z_of = [&](double d) {
    return compare_with_reference(outputs_of({seed_with_sections({6}, -d), seed_with_sections({6}, d)}),
                                  {range}, {"A1"})[0]
        .z.value();
  };
  EXPECT_NEAR(z_of(0.4), (0.4 * std::sqrt(2) - 0.48) / std::hypot(0.4, 0.169706), 1e-6);
  EXPECT_NEAR(z_of(0.1), (0.1 * std::sqrt(2) - 0.22) / std::hypot(0.1, 0.0777817), 1e-6);
  EXPECT_EQ(z_of(0.25), 0) << "0.35 lies between";
}

TEST(Compare, AnglesOfReposeAndSlope) {
  SeedResult seed;
  seed.repose.emplace();
  seed.repose->angle = 26;
  const auto repose = compare_with_reference({outputs_of(seed)}, stored(), {"lab_repose_0.2_0.2"});
  ASSERT_EQ(repose.size(), 2u);  // simulated and measured
  EXPECT_DOUBLE_EQ(repose[0].simulated, 26);
  seed.slope_angle = 25;
  EXPECT_EQ(compare_with_reference({outputs_of(seed)}, stored(), {"lab_segregation"}).size(), 2u);
}

TEST(Outputs, ChiChangesSignBetweenSections) {
  // chi -0.25, -0.15, -0.05, 0.05 at x/L (2k - 1) / 12: the sign changes midway between 5/12 and 7/12.
  SeedResult seed = seed_with_sections({6}, -0.25);
  for (int k = 0; k < 6; ++k) seed.sections[0].sections[k].x_over_l = (2 * k + 1) / 12.0;
  EXPECT_NEAR(outputs_of(seed).at("chi_zero_x_over_l"), 0.5, 1e-12);
  EXPECT_FALSE(outputs_of(seed_with_sections({6}, 1)).contains("chi_zero_x_over_l"));
}

TEST(Outputs, EveryNumberOfADumpIsOneThatIsPromised) {
  SeedResult seed = seed_with_sections({6, 3});
  seed.sections.push_back(seed.sections[0]);
  seed.sections[0].dumps = seed.sections[1].dumps = 4, seed.sections[2].dumps = 2;
  seed.slope_angle = 37;
  const OutputScope dump{"end_dump", 6, {3}, {2}};
  for (const auto& [name, value] : outputs_of(seed)) EXPECT_EQ(why_not_given(dump, name), "") << name;
  EXPECT_TRUE(outputs_of(seed).contains("chi_S4_dump2"));
  EXPECT_NE(why_not_given(dump, "chi_S0"), "");
  EXPECT_NE(why_not_given(dump, "chi_top"), "");
  EXPECT_NE(why_not_given({"repose_lift", 6, {}, {}}, "chi_S1"), "");
  EXPECT_EQ(why_not_given({"bucket_dump", 6, {}, {}}, "d50_m_middle"), "");
}

TEST(Outputs, OfSectionsAndPilesThatTheScenarioDoesNotHaveAreRefused) {
  const OutputScope dump{"end_dump", 6, {3}, {2}};
  for (const char* name : {"chi_S6", "chi_S3of3", "chi_S1_dump2", "d50_m_S3of3_dump2", "lateral_chi_std_S6"})
    EXPECT_EQ(why_not_given(dump, name), "") << name;
  for (const char* name : {"chi_S7", "chi_S4of3", "chi_S1of5", "chi_S1of6", "chi_S1_dump3", "flow_speed_S7"})
    EXPECT_EQ(why_not_given(dump, name),
              "this scenario cuts the slope into 6 sections, without 'of' (output.sections) and 3 "
              "(output.further_sections), "
              "and keeps the pile after loads 2 (output.after_dumps) and the finished one, without '_dump'")
        << name;
  EXPECT_THAT(
      why_not_given({"push_dump", 6, {}, {}}, "chi_S1of5_dump1"),
      testing::HasSubstr("no others (output.further_sections), and keeps no pile before the last load"));
  EXPECT_THAT(why_not_given(dump, "chi_S1of99999999999999999999"), testing::HasSubstr("does not give it"));
}

}  // namespace
}  // namespace scree
