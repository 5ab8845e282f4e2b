#include "analysis/pile/permeability.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

constexpr double kGeometry = 0.1;        // C_G, with the units of the source
constexpr double kTaylor = 0.004;        // C_1
constexpr double kTortuosity = 2;        // x
constexpr double kUnitWeight = 9.789;    // of water at 20 C, kN/m3
constexpr double kViscosity = 1.002e-3;  // of water at 20 C, Pa s
constexpr double kCentimetres = 100;     // in a metre

void check(const PoreMaterial& m) {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0 && std::isfinite(value)))
      throw std::invalid_argument(fmt::format("{} = {} must be a number above 0", name, value));
  };
  positive(m.d10, "D10");
  positive(m.d50, "D50");
  positive(m.void_ratio, "void ratio");
  if (!(m.cu >= 1 && std::isfinite(m.cu)))
    throw std::invalid_argument(fmt::format("C_U = {} must be at least 1", m.cu));
  if (m.d50 < m.d10)
    throw std::invalid_argument(fmt::format("D50 = {} m is smaller than D10 = {} m", m.d50, m.d10));
}

/// Taylor's formula but for its constant and the properties of water, which drop out of a ratio.
double taylor(const PoreMaterial& m, double power) {
  check(m);
  return std::pow(m.d50, power) * std::pow(m.void_ratio, 3) / (1 + m.void_ratio);
}

}  // namespace

double void_ratio(double porosity) {
  if (!(porosity > 0 && porosity < 1))
    throw std::invalid_argument(fmt::format("porosity {} must lie between 0 and 1", porosity));
  return porosity / (1 - porosity);
}

double conductivity_kozeny_carman(const PoreMaterial& m) {
  check(m);
  const double d10_cm = m.d10 * kCentimetres;
  return kGeometry * (kUnitWeight / kViscosity) * std::pow(m.void_ratio, 3 + kTortuosity) /
         (1 + m.void_ratio) * std::cbrt(m.cu) * d10_cm * d10_cm / kCentimetres;
}

double conductivity_ratio_kozeny_carman(const PoreMaterial& material, const PoreMaterial& original) {
  return conductivity_kozeny_carman(material) / conductivity_kozeny_carman(original);
}

double conductivity_taylor(const PoreMaterial& m) {
  return kTaylor * (1000 * kUnitWeight / kViscosity) * taylor(m, 2);
}

double conductivity_ratio_taylor(const PoreMaterial& material, const PoreMaterial& original, double power) {
  return taylor(material, power) / taylor(original, power);
}

}  // namespace scree
