#include "analysis/results/output_units.h"

#include <array>
#include <numbers>
#include <regex>
#include <string_view>

#include "sim/material/input_text.h"

namespace scree {
namespace {

struct Unit {
  std::string_view of, name;
  double factor;
};

constexpr std::array<Unit, 21> kUnits{{
    {"m", "m", 1},
    {"m", "cm", 1e-2},
    {"m", "mm", 1e-3},
    {"t", "t", 1},
    {"t", "kg", 1e-3},
    {"deg", "deg", 1},
    {"deg", "rad", 180 / std::numbers::pi},
    {"deg", "degree", 1},
    {"deg", "degrees", 1},
    {"deg", "\u00b0", 1},
    {"", "-", 1},
    {"", "1", 1},
    {"", "%", 1e-2},
    {"", "pct", 1e-2},
    {"", "percent", 1e-2},
    {"s", "s", 1},
    {"s", "min", 60},
    {"m/s", "m/s", 1},
    {"m/s", "cm/s", 1e-2},
    {"J/kg", "J/kg", 1},
    {"J/kg", "kJ/kg", 1e3},
}};

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

}  // namespace

std::string unit_of_output(const std::string& output) {
  if (output == "simulated_seconds") return "s";
  if (output.size() > kLongestName) return "";
  // The part of the pile that a name ends with says nothing of the unit.
  static const std::regex part("_(S[0-9]+(of[0-9]+)?(_dump[0-9]+)?|top|middle|bottom|ring[0-9]+)$");
  const std::string quantity = std::regex_replace(output, part, "");
  if (quantity == "flow_speed" || quantity == "flow_fast") return "m/s";
  if (ends_with(quantity, "_j_per_kg")) return "J/kg";
  if (ends_with(quantity, "_deg")) return "deg";
  if (ends_with(quantity, "_m")) return "m";
  if (ends_with(quantity, "_t")) return "t";
  return "";
}

std::optional<double> unit_factor(const std::string& unit, const std::string& of) {
  if (unit.empty()) return 1;
  for (const Unit& known : kUnits)
    if (known.of == of && known.name == unit) return known.factor;
  return std::nullopt;
}

std::vector<std::string> units_for(const std::string& of) {
  std::vector<std::string> names;
  for (const Unit& known : kUnits)
    if (known.of == of) names.emplace_back(known.name);
  return names;
}

}  // namespace scree
