#pragma once
// Gradings of slopes, picture by picture and section by section, as measured.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/material/grading.h"

namespace scree {

/// What pictures of a slope say of its rock. Index 0 of a picture is its whole slope, k is section Sk from
/// the crest.
struct SlopeGradings {
  struct Picture {
    std::string name;
    std::vector<std::optional<Grading>> curves;  ///< sections + 1; none where the file has none
    std::vector<double> given_chi;               ///< printed beside them; NaN where not
  };
  std::vector<Picture> pictures;  ///< in the order of the file
  int sections = 0;
  double half_digit = 0;  ///< m, half of the last digit of the diameters in the file; 0: no table of D_x
};

/// Reads a table with the columns `image` and `section` (0 or `whole`; 1 or S1 is at the crest), one of
///   d10_cm, d50_cm ... d0_cm, d100_cm   diameters D_x, a row a curve; a curve without D0 or D100 goes on
///                                       straight in log d from its last two points
///   diameter_mm, passing_pct            passing curves, a row a point, from 0 to 100
///   diameter_mm                         grains, counted by the volume of spheres
/// in mm, cm or m, and, if there, `chi`. Throws FileError, see sim/material/input_text.h.
SlopeGradings read_slope_gradings(const std::filesystem::path& file);

}  // namespace scree
