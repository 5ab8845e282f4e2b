#pragma once
// The formats that read_snapshot knows, each as it stands in the file.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "sim/io/grain_values.h"
#include "sim/io/snapshot_reader.h"
#include "sim/material/input_text.h"

namespace scree {

/// A file before units, axes and checks.
struct RawSnapshot {
  double time = 0;
  std::vector<Grain> grains;
  std::vector<int> lines;  ///< of each grain; empty where the file has no lines
  bool has_mass = false, has_id = false, has_dump = false;
  bool in_metres = false;          ///< lengths are metres, whatever the unit of length
  bool unknown_mass_unit = false;  ///< masses may be in any unit
  std::vector<Grain> original, fixed;
};

/// Columns of a row that are read; bounds what a line of any length takes.
inline constexpr int kMostColumns = 1000;

/// With it a text of YADE begins.
inline constexpr std::string_view kYadeFormat = "#format ";

/// What a column or an array holds, by the names that programs give it: x, y, z, diameter, radius, mass, id,
/// dump, vx, vy, vz; empty for anything else. Case does not count.
std::string_view meaning_of_column(std::string_view name);

/// `length_unit`: of columns that name none.
RawSnapshot read_csv_snapshot(const std::filesystem::path& file, double length_unit);
/// `text` and `bytes`: of the file, without a byte order mark.
RawSnapshot read_lammps_dump(const std::filesystem::path& file, std::string_view text,
                             std::optional<int> frame);
/// Text of YADE (export.text): its first line names the columns.
RawSnapshot read_yade_text(const std::filesystem::path& file, std::string_view text);
RawSnapshot read_xyz(const std::filesystem::path& file, std::string_view text, std::optional<int> frame);
RawSnapshot read_vtk(const std::filesystem::path& file, std::string_view bytes);
RawSnapshot read_vtk_xml(const std::filesystem::path& file, std::string_view bytes);
RawSnapshot read_trajectory_frame(const std::filesystem::path& file, std::optional<int> frame);

/// Index of a frame from 0 among `count`; throws FileError.
std::size_t frame_index(const std::filesystem::path& file, std::optional<int> frame, std::size_t count);

/// Parts of a text between separators, empty ones left out; those after the first `most` are not looked at.
std::vector<std::string_view> parts_of(std::string_view text, std::string_view separators, std::size_t most);

/// Numbers of a text one after another, lines counted: what dumps, XYZ and VTK files are made of.
class TextCursor {
 public:
  TextCursor(const std::filesystem::path& file, std::string_view text, std::size_t at = 0, int line = 1)
      : file_(file), text_(text), at_(at), line_(line) {}
  bool done() const { return at_ >= text_.size(); }
  std::string_view next_line();               ///< without its end; empty at the end of the text
  std::string_view word();                    ///< the next one, line ends passed over; empty at the end
  std::string_view bytes(std::size_t count);  ///< throws where there are fewer
  double number();                            ///< the next word; throws unless a finite number
  std::string_view rest() const { return text_.substr(std::min(at_, text_.size())); }
  int line() const { return line_; }
  [[noreturn]] void fail(const std::string& message) const { throw FileError(file_, line_, message); }

 private:
  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t at_;
  int line_;
};

}  // namespace scree
