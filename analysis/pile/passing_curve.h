#pragma once
#include <vector>

namespace scree {

/// Passing curve of a set of grains, by mass; exact (one step a grain), or as an image shows it.
class PassingCurve {
 public:
  /// Masses (kg) and diameters (m) of the same length; throws std::invalid_argument when empty or when blur
  /// is below 0. With `blur` each grain counts over a normal distribution of ln d of this deviation;
  /// diameters are those of the curve through the grains smeared likewise, which goes over into the exact one
  /// as the blur becomes 0.
  PassingCurve(const std::vector<double>& diameters, const std::vector<double>& masses, double blur = 0);
  /// Passing share (0 to 1) at a diameter (m).
  double passing(double diameter) const;
  /// Diameter (m) at a passing share; linear in log10(d) between grains.
  double diameter(double passing) const;
  double mass() const { return sharp_.mass(); }  ///< kg
  /// Mass-weighted mean of log10(diameter): the limit of log d = sum (P_i - P_i-1) log10 sqrt(D_i D_i-1) for
  /// fine sieves.
  double mean_log_diameter() const;
  /// The same of the coarsest quartile, P_CQ = 4 P - 3 above D75.
  double coarsest_quartile_log_diameter() const;

 private:
  struct Steps {
    std::vector<double> diameters;   // rising
    std::vector<double> cumulative;  // kg, finer or equal
    void add(double diameter, double mass);
    double mass() const { return cumulative.back(); }
  };
  static Steps steps_of(const std::vector<double>& diameters, const std::vector<double>& masses);
  double blurred_diameter(double wanted) const;  // kg finer
  const Steps& seen() const { return blur_ > 0 ? blurred_ : sharp_; }

  double blur_;
  Steps sharp_, blurred_;  // the latter with the parts that a blurred grain is counted in
};

}  // namespace scree
