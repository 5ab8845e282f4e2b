#include "analysis/field/printed_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/field/field_numbers.h"
#include "sim/material/input_text.h"
#include "sim/material/csv_table.h"
#include "sim/material/random.h"

namespace scree {
namespace {

constexpr int kMostTries = 1000;

/// The curve with its points moved within their rounding, still rising.
Grading moved(const Grading& curve, double half_digit, Random& random) {
  for (int k = 0; k < kMostTries; ++k) {
    std::vector<Grading::Point> points = curve.points();
    for (Grading::Point& point : points)
      if (point.passing > 0 && point.passing < 1) point.diameter += random.uniform(-half_digit, half_digit);
    const auto falls = [](const auto& a, const auto& b) { return b.diameter <= a.diameter; };
    const bool rises = std::adjacent_find(points.begin(), points.end(), falls) == points.end();
    if (rises && points.front().diameter > 0) return Grading(curve.name(), std::move(points));
  }
  return curve;  // diameters that differ by the last digit only
}

SlopeGradings moved(const SlopeGradings& gradings, Random& random) {
  SlopeGradings out = gradings;
  for (SlopeGradings::Picture& picture : out.pictures)
    for (std::optional<Grading>& curve : picture.curves)
      if (curve) curve = moved(*curve, gradings.half_digit, random);
  return out;
}

PrintedVerdict verdict(const HeldValue& held) {
  if (!held.ours) return PrintedVerdict::not_computable;
  const PrintedValue& printed = held.printed;
  const double slack = printed.rounding * (1 + 1e-6);
  const auto agrees = [&](double low, double high) {
    return (printed.bound_above || high >= printed.value - slack) &&  // not below it
           (printed.bound_below || low <= printed.value + slack);     // not above it
  };
  if (agrees(*held.ours, *held.ours)) return PrintedVerdict::as_printed;
  return agrees(held.low, held.high) ? PrintedVerdict::within_reach : PrintedVerdict::differs;
}

}  // namespace

std::vector<PrintedValue> read_printed_values(const std::filesystem::path& file) {
  CsvTable table(file, {"name", "what", "value", "unit", "relation", "rounding", "source"});
  std::vector<PrintedValue> out;
  while (table.next()) {
    PrintedValue value;
    value.name = table.text("name");
    if (value.name.size() > kLongestName)
      table.fail(fmt::format("name has {} letters; {} are allowed", value.name.size(), kLongestName));
    value.what = table.text("what");
    value.value = table.number("value");
    value.unit = table.text("unit");
    const std::string& relation = table.one_of("relation", {"eq", "approx", "gt", "lt"});
    value.bound_below = relation == "gt";
    value.bound_above = relation == "lt";
    value.rounding = table.optional_number("rounding").value_or(0);
    value.source = table.text("source");
    out.push_back(std::move(value));
  }
  return out;
}

std::vector<HeldValue> hold_against(const SlopeGradings& gradings, const FieldOptions& options,
                                    const std::vector<PrintedValue>& printed, int draws) {
  std::vector<HeldValue> out;
  const FieldAnalysis field = analyse_field(gradings, options);
  for (const PrintedValue& value : printed) {
    HeldValue held{value, field_number(field, value.name), 0, 0, PrintedVerdict::not_computable};
    held.low = held.high = held.ours.value_or(0);
    out.push_back(std::move(held));
  }
  Random random(0, 0, RandomPurpose::measurement);
  for (int k = 0; k < draws && gradings.half_digit > 0; ++k) {
    FieldAnalysis other = analyse_field(moved(gradings, random), options);
    other.bin = field.bin, other.ratio_bin = field.ratio_bin;
    for (HeldValue& held : out)
      if (const auto ours = field_number(other, held.printed.name)) {
        held.low = std::min(held.low, *ours);
        held.high = std::max(held.high, *ours);
      }
  }
  for (HeldValue& held : out) held.verdict = verdict(held);
  return out;
}

}  // namespace scree
