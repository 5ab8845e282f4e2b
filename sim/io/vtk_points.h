#pragma once
// What both kinds of VTK files hold, legacy and XML: points, each with a radius or diameter.
#include <bit>
#include <string>
#include <vector>

#include "sim/io/snapshot_formats.h"

namespace scree {

/// A kind of numbers in a file.
struct VtkNumber {
  char kind;  ///< f, i, u
  std::size_t size;
};

/// The number that begins at `bytes`.
double number_from(const char* bytes, VtkNumber kind, std::endian order);

/// Points and those of their arrays that a grain is made of.
class VtkPoints {
 public:
  explicit VtkPoints(const std::filesystem::path& file) : file_(file) {}
  std::size_t count() const { return positions_.size() / 3; }
  /// x, y, z of one point after another; added to those that are there.
  void add_positions(const std::vector<double>& values);
  /// True for an array that a grain is made of, whose values, one for each of `rows` points, are to be added
  /// then. Throws FileError when those points have such an array already.
  bool wants(std::string_view name, std::size_t components, std::size_t rows);
  /// Values of an array that is wanted, added to those that are there.
  void add(std::string_view name, const std::vector<double>& values);
  /// Throws FileError: no points, no radius or diameter, an array that not all of the points have.
  RawSnapshot grains() const;

 private:
  std::vector<double>* array_of(std::string_view name);
  const std::filesystem::path& file_;
  std::vector<double> positions_, diameter_, radius_, mass_, id_, dump_;
  std::vector<std::string> names_;  // of arrays, for a message
};

}  // namespace scree
