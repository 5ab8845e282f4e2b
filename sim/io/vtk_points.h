#pragma once
// What both kinds of VTK files hold, legacy and XML: points, each with a radius or diameter.
#include <bit>
#include <set>
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

/// Points of a file: a run may have 2 million (kMaxSpheres), piles of other programs may be larger. With it
/// memory is bounded by some 110 bytes a point (170 where there are several pieces), however few bytes a file
/// of them is packed into.
inline constexpr std::size_t kMostPoints = 5'000'000;

/// Grains out of points and their arrays, piece by piece; a legacy file is one piece. Values go into the
/// grains as they are given, nothing else is kept.
class VtkPoints {
 public:
  explicit VtkPoints(const std::filesystem::path& file) : file_(file) {}
  std::size_t count() const { return raw_.grains.size(); }
  std::size_t count_of_piece() const { return count() - start_; }
  /// The next piece: x, y, z of one point after another. Arrays that follow are those of these points. Throws
  /// FileError when the piece before lacks an array that others have.
  void add_piece(const std::vector<double>& positions);
  /// True for an array that a grain is made of, whose values, one for each of `rows` points, are to be added
  /// then. Throws FileError when the points of this piece have such an array already, or are not as many.
  bool wants(std::string_view name, std::size_t components, std::size_t rows);
  /// Values of an array that is wanted. Throws FileError for a value that no grain can have.
  void add(std::string_view name, const std::vector<double>& values);
  /// Ends the last piece. Throws FileError: no points, no radius or diameter, an array that not all of the
  /// pieces have.
  RawSnapshot grains();

 private:
  using Meanings = std::set<std::string_view>;
  void end_piece();
  [[noreturn]] void fail(const std::string& message) const;  // names the piece where there are several
  const std::filesystem::path& file_;
  RawSnapshot raw_;
  std::size_t start_ = 0;            // where the points of this piece begin
  int piece_ = 0, first_piece_ = 0;  // from 1; the first that has points
  Meanings of_piece_, of_first_;     // arrays that they have
  std::vector<std::string> names_;   // of arrays, for a message
};

}  // namespace scree
