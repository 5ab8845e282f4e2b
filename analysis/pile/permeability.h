#pragma once
// Saturated hydraulic conductivity of rock from its grading and void ratio.

namespace scree {

/// What the formulae need of a material.
struct PoreMaterial {
  double d10 = 0;         ///< m
  double d50 = 0;         ///< m
  double cu = 1;          ///< coefficient of uniformity D60 / D10, at least 1
  double void_ratio = 0;  ///< e, volume of voids over volume of grains
};

/// Void ratio e = n / (1 - n) of a porosity n. Throws std::invalid_argument unless 0 < n < 1.
double void_ratio(double porosity);

/// Saturated hydraulic conductivity (m/s) for water of 20 C after the modified Kozeny-Carman formula,
///
///     k = C_G (gamma_w / mu_w) e^(3 + x) / (1 + e) C_U^(1/3) D10^2,   C_G = 0.1, x = 2,
///
/// of Mbonimpa, Aubertin, Chapuis and Bussiere, Geotechnical and Geological Engineering 20 (2002) 235. C_G
/// belongs to the units of the source: k in cm/s, D10 in cm, gamma_w in kN/m3, mu_w in Pa s; in SI units
/// throughout it is 0.01. The formula was fitted to sand, silt and gravel with laminar flow: for metre-sized
/// blocks only ratios mean something. Throws std::invalid_argument for numbers that no material has.
double conductivity_kozeny_carman(const PoreMaterial& material);

/// Conductivity of `material` over that of `original` by the modified Kozeny-Carman formula. Throws as above.
double conductivity_ratio_kozeny_carman(const PoreMaterial& material, const PoreMaterial& original);

/// Saturated hydraulic conductivity (m/s) for water of 20 C after Taylor, Fundamentals of Soil Mechanics
/// (1948),
///
///     k = C_1 (gamma_w / mu_w) e^3 / (1 + e) D50^2,   C_1 = 0.004, all in SI units.
///
/// C_1 is that of the thesis and has no unit: it lies near the 1 / 180 of Kozeny and Carman for spheres.
/// Throws as above.
double conductivity_taylor(const PoreMaterial& material);

/// The power of the diameter in the thesis's printed ratios. With it C_1 would have to be a root of a length.
inline constexpr double kThesisTaylorPower = 1.5;

/// Conductivity of `material` over that of `original` by Taylor's formula, with another power of D50 than its
/// own 2. Throws as above.
double conductivity_ratio_taylor(const PoreMaterial& material, const PoreMaterial& original,
                                 double power = kThesisTaylorPower);

}  // namespace scree
