#pragma once
// Numbers of a field analysis by name, so that printed values can be held against them.
#include <optional>
#include <string>

#include "analysis/field/field_analysis.h"

namespace scree {

/// A number by its name; lengths in m, shares 0 to 1. SECTION is whole or S1 ...; QUANTITY one of
/// field_quantities(). None if the name means nothing here.
///   QUANTITY_mean_SECTION, _std_, _median_, _min_, _max_     over pictures
///   QUANTITY_mode_SECTION, QUANTITY_modefrequency_SECTION     of the histogram: middle and share of the mode
///   QUANTITY_frequency_VALUE_SECTION                          share of the bin that holds VALUE
///   QUANTITY_between_LOW_HIGH_SECTION                         share of pictures from LOW to HIGH
///   QUANTITY_picture_NAME_SECTION                             of one picture
///   QUANTITY_increase_S1_S6                                   of means, last over first, less 1
///   QUANTITY_slope                                            of means over x/L, least squares
///   QUANTITY_ratiomin_S1_S6, _ratiomax_                       last over first, over pictures
///   QUANTITY_ratioabove_VALUE_S1_S6                           number of pictures whose ratio is above VALUE
///   QUANTITY_place_VALUE                                      x/L where means reach VALUE, linear between
///   chi_fit_SECTION, chi_r2_SECTION, chigiven_fit_, _r2_      chi over D90 / D15, through the origin
///   passingstd_max_SECTION, passingstd_at_DIAMETER_SECTION    deviation of the share passing over pictures
///   median_D_SECTION, mean_D_, meandiameter_D_                D: d10, cu ... of that curve (CurveKind)
///   medianfilled_D_SECTION, ...                               of that curve with fines
///   median_share_LOW_HIGH_SECTION, ...                        share of that curve between diameters (m)
///   medianfilled_kcm_SECTION, _taylor_, ...                   conductivity of that curve over that of the
///                                                             rock as dumped
std::optional<double> field_number(const FieldAnalysis& field, const std::string& name);

}  // namespace scree
