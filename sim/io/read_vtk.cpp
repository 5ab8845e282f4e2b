// Legacy VTK files (VTK File Formats, version 2.0 to 5.1): points with a radius or diameter each.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

constexpr std::size_t kMostValues = 2'000'000'000;

struct VtkType {
  std::string_view name;
  char kind;  // f, i, u
  std::size_t size;
};
constexpr std::array<VtkType, 15> kTypes{{{"float", 'f', 4},
                                          {"double", 'f', 8},
                                          {"int", 'i', 4},
                                          {"unsigned_int", 'u', 4},
                                          {"char", 'i', 1},
                                          {"unsigned_char", 'u', 1},
                                          {"short", 'i', 2},
                                          {"unsigned_short", 'u', 2},
                                          {"long", 'i', 8},
                                          {"unsigned_long", 'u', 8},
                                          {"vtkIdType", 'i', 4},
                                          {"vtktypeint32", 'i', 4},
                                          {"vtktypeint64", 'i', 8},
                                          {"vtktypeuint64", 'u', 8},
                                          {"vtktypeuint8", 'u', 1}}};

double from_big_endian(const char* bytes, const VtkType& type) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < type.size; ++k) bits = bits << 8 | static_cast<unsigned char>(bytes[k]);
  if (type.kind == 'f')
    return type.size == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                          : std::bit_cast<double>(bits);
  if (type.kind == 'u') return static_cast<double>(bits);
  const unsigned unused = 64 - 8 * static_cast<unsigned>(type.size);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

// 0 for what is none: no id or dump has it.
std::int64_t whole(double number) {
  return std::abs(number) <= 1e9 ? static_cast<std::int64_t>(number) : 0;
}

class VtkFile {
 public:
  VtkFile(const std::filesystem::path& file, std::string_view bytes) : file_(file), cursor_(file, bytes) {}

  RawSnapshot read() {
    cursor_.next_line();
    cursor_.next_line();  // title
    const std::string_view form = trimmed(cursor_.next_line());
    if (form != "ASCII" && form != "BINARY") cursor_.fail("the third line must be ASCII or BINARY");
    binary_ = form == "BINARY";
    while (true) {
      const std::string word(cursor_.word());
      if (word.empty()) break;
      read_part(word);
    }
    return grains();
  }

 private:
  using Values = std::vector<double>;

  void read_part(const std::string& word) {
    if (word == "DATASET") {
      const std::string_view kind = cursor_.word();
      if (kind != "POLYDATA" && kind != "UNSTRUCTURED_GRID")
        cursor_.fail(fmt::format("DATASET {:.40}: POLYDATA or UNSTRUCTURED_GRID is read", kind));
    } else if (word == "POINTS") {
      points_ = count();
      const VtkType& type = read_type();
      positions_ = values(times(points_, 3), type);
    } else if (word == "VERTICES" || word == "LINES" || word == "POLYGONS" || word == "TRIANGLE_STRIPS" ||
               word == "CELLS") {
      read_cells();
    } else if (word == "CELL_TYPES") {
      values(count(), kTypes[2]);
    } else if (word == "POINT_DATA" || word == "CELL_DATA") {
      of_points_ = word == "POINT_DATA";
      rows_ = count();
      if (of_points_ && rows_ != points_) cursor_.fail("POINT_DATA has another number than POINTS");
    } else if (word == "SCALARS") {
      const std::string name(cursor_.word());
      const VtkType& type = read_type();
      const std::string_view parts = trimmed(cursor_.next_line());
      const auto n = parts.empty() ? 1.0 : number_in(parts).value_or(0);
      if (!(n >= 1 && n <= 4)) cursor_.fail("SCALARS: 1 to 4 components");
      if (cursor_.word() != "LOOKUP_TABLE") cursor_.fail("SCALARS: LOOKUP_TABLE is missing");
      cursor_.word();
      keep(name, values(times(rows_, static_cast<std::size_t>(n)), type), static_cast<std::size_t>(n));
    } else if (word == "LOOKUP_TABLE") {
      cursor_.word();
      const std::size_t n = count();
      values(times(n, 4), binary_ ? kTypes[5] : kTypes[0]);
    } else if (word == "VECTORS" || word == "NORMALS" || word == "TENSORS") {
      const std::string name(cursor_.word());
      const VtkType& type = read_type();
      const std::size_t width = word == "TENSORS" ? 9 : 3;
      keep(name, values(times(rows_, width), type), width);
    } else if (word == "FIELD") {
      cursor_.word();
      const std::size_t arrays = count();
      for (std::size_t k = 0; k < arrays; ++k) read_array();
    } else if (word == "METADATA") {
      skip_metadata();
    } else {
      cursor_.fail(fmt::format("'{:.40}' is not known in a legacy VTK file", word));
    }
  }

  void read_array() {
    std::string name(cursor_.word());
    while (name == "METADATA") {
      skip_metadata();
      name = cursor_.word();
    }
    const std::size_t width = count(), rows = count();
    Values array = values(times(width, rows), read_type());
    if (of_points_ && rows == points_) keep(name, std::move(array), width);
  }

  void read_cells() {
    const std::size_t first = count(), second = count();
    cursor_.next_line();
    TextCursor ahead = cursor_;
    if (ahead.word() != "OFFSETS") {  // before version 5.1
      data(second, kTypes[2]);
      return;
    }
    cursor_.word();
    values(first, read_type());
    if (cursor_.word() != "CONNECTIVITY") cursor_.fail("CONNECTIVITY is missing");
    values(second, read_type());
  }

  void skip_metadata() {
    cursor_.next_line();
    while (!cursor_.done() && !trimmed(cursor_.next_line()).empty()) {
    }
  }

  std::size_t count() {
    const double number = cursor_.number();
    if (!(number >= 0 && number <= kMostValues && number == std::floor(number)))
      cursor_.fail(fmt::format("{:g} is no count", number));
    return static_cast<std::size_t>(number);
  }
  std::size_t times(std::size_t a, std::size_t b) const {
    if (b > 0 && a > kMostValues / b) cursor_.fail("too many values");
    return a * b;
  }

  const VtkType& read_type() {
    const std::string_view word = cursor_.word();
    for (const VtkType& type : kTypes)
      if (type.name == word) return type;
    cursor_.fail(fmt::format("'{:.40}' is no type of numbers", word));
  }

  // Values that begin on the next line.
  Values values(std::size_t n, const VtkType& type) {
    if (binary_) cursor_.next_line();
    return data(n, type);
  }
  Values data(std::size_t n, const VtkType& type) {
    Values out;
    if (binary_) {
      const std::string_view bytes = cursor_.bytes(n * type.size);
      out.reserve(n);
      for (std::size_t k = 0; k < n; ++k) out.push_back(from_big_endian(bytes.data() + k * type.size, type));
    } else {
      for (std::size_t k = 0; k < n; ++k) out.push_back(cursor_.number());
    }
    return out;
  }

  void keep(const std::string& name, Values array, std::size_t width) {
    if (!of_points_) return;
    names_.push_back(name);
    if (width != 1) return;
    const std::string_view meaning = meaning_of_column(name);
    if (meaning == "diameter") diameter_ = std::move(array);
    if (meaning == "radius") radius_ = std::move(array);
    if (meaning == "mass") mass_ = std::move(array);
    if (meaning == "id") id_ = std::move(array);
    if (meaning == "dump") dump_ = std::move(array);
  }

  RawSnapshot grains() const {
    if (points_ == 0) throw FileError(file_, 0, "has no POINTS");
    if (diameter_.empty() && radius_.empty())
      throw FileError(file_, 0,
                      fmt::format("no radius: an array radius or diameter of the points is needed, found: {}",
                                  names_.empty() ? "none" : fmt::format("{}", fmt::join(names_, ", "))));
    RawSnapshot raw;
    raw.has_mass = !mass_.empty(), raw.has_id = !id_.empty(), raw.has_dump = !dump_.empty();
    for (std::size_t k = 0; k < points_; ++k) {
      Grain grain;
      grain.position = {positions_[3 * k], positions_[3 * k + 1], positions_[3 * k + 2]};
      grain.diameter = diameter_.empty() ? 2 * radius_[k] : diameter_[k];
      if (raw.has_mass) grain.mass = mass_[k];
      if (raw.has_id) grain.id = whole(id_[k]);
      if (raw.has_dump) grain.dump = static_cast<int>(whole(dump_[k]));
      raw.grains.push_back(grain);
    }
    return raw;
  }

  const std::filesystem::path& file_;
  TextCursor cursor_;
  bool binary_ = false, of_points_ = false;
  std::size_t points_ = 0, rows_ = 0;
  Values positions_, diameter_, radius_, mass_, id_, dump_;
  std::vector<std::string> names_;
};

}  // namespace

RawSnapshot read_vtk(const std::filesystem::path& file, std::string_view bytes) {
  return VtkFile(file, bytes).read();
}

}  // namespace scree
