// Legacy VTK files (VTK File Formats, version 2.0 to 5.1): points with a radius or diameter each.
#include <fmt/format.h>

#include "sim/io/vtk_points.h"

namespace scree {
namespace {

constexpr std::size_t kMostValues = 2'000'000'000;

struct VtkType {
  std::string_view name;
  VtkNumber number;
};
constexpr std::array<VtkType, 15> kTypes{{{"float", {'f', 4}},
                                          {"double", {'f', 8}},
                                          {"int", {'i', 4}},
                                          {"unsigned_int", {'u', 4}},
                                          {"char", {'i', 1}},
                                          {"unsigned_char", {'u', 1}},
                                          {"short", {'i', 2}},
                                          {"unsigned_short", {'u', 2}},
                                          {"long", {'i', 8}},
                                          {"unsigned_long", {'u', 8}},
                                          {"vtkIdType", {'i', 4}},
                                          {"vtktypeint32", {'i', 4}},
                                          {"vtktypeint64", {'i', 8}},
                                          {"vtktypeuint64", {'u', 8}},
                                          {"vtktypeuint8", {'u', 1}}}};

class VtkFile {
 public:
  VtkFile(const std::filesystem::path& file, std::string_view bytes) : cursor_(file, bytes), points_(file) {}

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
    return points_.grains();
  }

 private:
  using Values = std::vector<double>;

  void read_part(const std::string& word) {
    if (word == "DATASET") {
      const std::string_view kind = cursor_.word();
      if (kind != "POLYDATA" && kind != "UNSTRUCTURED_GRID")
        cursor_.fail(fmt::format("DATASET {:.40}: POLYDATA or UNSTRUCTURED_GRID is read", kind));
    } else if (word == "POINTS") {
      if (points_.count() > 0) cursor_.fail("POINTS stand twice");
      const std::size_t n = count();
      if (n > kMostPoints) cursor_.fail(fmt::format("more than {} points", kMostPoints));
      const VtkType& type = read_type();
      points_.add_piece(values(times(n, 3), type));
    } else if (word == "VERTICES" || word == "LINES" || word == "POLYGONS" || word == "TRIANGLE_STRIPS" ||
               word == "CELLS") {
      read_cells();
    } else if (word == "CELL_TYPES") {
      skip(count(), kTypes[2]);
    } else if (word == "POINT_DATA" || word == "CELL_DATA") {
      of_points_ = word == "POINT_DATA";
      rows_ = count();
      if (of_points_ && rows_ != points_.count()) cursor_.fail("POINT_DATA has another number than POINTS");
    } else if (word == "SCALARS") {
      const std::string name(cursor_.word());
      const VtkType& type = read_type();
      const std::string_view parts = trimmed(cursor_.next_line());
      const auto n = integer_in(parts.empty() ? 1.0 : number_in(parts).value_or(0), 1, 4);
      if (!n) cursor_.fail("SCALARS: 1 to 4 components");
      if (cursor_.word() != "LOOKUP_TABLE") cursor_.fail("SCALARS: LOOKUP_TABLE is missing");
      cursor_.word();
      read_values(name, static_cast<std::size_t>(*n), rows_, type);
    } else if (word == "LOOKUP_TABLE") {
      cursor_.word();
      const std::size_t n = count();
      skip(times(n, 4), binary_ ? kTypes[5] : kTypes[0]);
    } else if (word == "VECTORS" || word == "NORMALS" || word == "TENSORS") {
      const std::string name(cursor_.word());
      const VtkType& type = read_type();
      read_values(name, word == "TENSORS" ? 9 : 3, rows_, type);
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
    read_values(name, width, rows, read_type());
  }

  // Values of an array, where grains are made of it.
  void read_values(const std::string& name, std::size_t width, std::size_t rows, const VtkType& type) {
    if (of_points_ && points_.wants(name, width, rows))
      points_.add(name, values(rows, type));
    else
      skip(times(width, rows), type);
  }

  void read_cells() {
    const std::size_t first = count(), second = count();
    cursor_.next_line();
    TextCursor ahead = cursor_;
    if (ahead.word() != "OFFSETS") {  // before version 5.1
      skip_data(second, kTypes[2]);
      return;
    }
    cursor_.word();
    skip(first, read_type());
    if (cursor_.word() != "CONNECTIVITY") cursor_.fail("CONNECTIVITY is missing");
    skip(second, read_type());
  }

  void skip_metadata() {
    cursor_.next_line();
    while (!cursor_.done() && !trimmed(cursor_.next_line()).empty()) {
    }
  }

  std::size_t count() {
    const double number = cursor_.number();
    const auto whole = integer_in(number, 0, kMostValues);
    if (!whole) cursor_.fail(fmt::format("{:g} is no count", number));
    return static_cast<std::size_t>(*whole);
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
    Values out;
    if (binary_) {
      const std::size_t size = type.number.size;
      const std::string_view bytes = cursor_.bytes(n * size);
      out.reserve(n);
      for (std::size_t k = 0; k < n; ++k)
        out.push_back(number_from(bytes.data() + k * size, type.number, std::endian::big));
    } else {
      for (std::size_t k = 0; k < n; ++k) out.push_back(cursor_.number());
    }
    return out;
  }

  // The same, of which nothing is kept.
  void skip(std::size_t n, const VtkType& type) {
    if (binary_) cursor_.next_line();
    skip_data(n, type);
  }
  void skip_data(std::size_t n, const VtkType& type) {
    if (binary_)
      cursor_.bytes(n * type.number.size);
    else
      for (std::size_t k = 0; k < n; ++k) cursor_.number();
  }

  TextCursor cursor_;
  VtkPoints points_;
  bool binary_ = false, of_points_ = false;
  std::size_t rows_ = 0;
};

}  // namespace

RawSnapshot read_vtk(const std::filesystem::path& file, std::string_view bytes) {
  return VtkFile(file, bytes).read();
}

}  // namespace scree
