#pragma once
// A field analysis beside values that were printed of the same pictures.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/field/field_analysis.h"

namespace scree {

/// A printed number of a field study.
struct PrintedValue {
  std::string name;  ///< of field_number()
  std::string what;  ///< in words
  double value = 0;  ///< m or a pure number
  std::string unit;
  bool bound_below = false, bound_above = false;  ///< ours must not be below, not above
  double rounding = 0;                            ///< half of the last digit printed
  std::string source;
};

/// How ours compares.
enum class PrintedVerdict {
  as_printed,    ///< the same to the last digit printed, or a bound kept
  within_reach,  ///< the rounding of the diameters in the table can make the difference
  differs,
  not_computable,  ///< the table does not give it
};

struct HeldValue {
  PrintedValue printed;
  std::optional<double> ours;
  double low = 0, high = 0;  ///< what ours can be, given the rounding of the diameters
  PrintedVerdict verdict = PrintedVerdict::not_computable;
};

/// Reads name,what,value,unit,relation,rounding,source; relation is eq, approx, gt or lt. Throws
/// std::runtime_error `file:line: what is wrong`.
std::vector<PrintedValue> read_printed_values(const std::filesystem::path& file);

/// Ours beside each. The reach of the rounding is looked for with every diameter of a table of D_x moved at
/// random within half of its last digit, `draws` times; a table of another form has none.
std::vector<HeldValue> hold_against(const SlopeGradings& gradings, const FieldOptions& options,
                                    const std::vector<PrintedValue>& printed, int draws = 60);

}  // namespace scree
