#pragma once
// Units of outputs, and of values that are held against them.
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// The unit of an output of outputs.h, told by its name: deg, m, t, s, m/s, J/kg, or empty for a pure number.
std::string unit_of_output(const std::string& output);

/// What a value in `unit` is multiplied with to be one in `of` (a unit as unit_of_output gives it). Empty
/// units are the output's own. None for a unit that does not fit.
std::optional<double> unit_factor(const std::string& unit, const std::string& of);

/// The units that fit, for messages.
std::vector<std::string> units_for(const std::string& of);

}  // namespace scree
