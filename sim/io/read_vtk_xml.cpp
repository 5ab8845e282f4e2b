// VTK XML files (VTK File Formats: .vtp, .vtu): points with a radius or diameter each.
#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <stdexcept>

#include "sim/io/vtk_encoding.h"
#include "sim/io/vtk_points.h"

namespace scree {
namespace {

constexpr std::ptrdiff_t kMostElements = 1'000'000;  // pugixml takes some 100 bytes for each

struct XmlType {
  std::string_view name;
  VtkNumber number;
};
constexpr std::array<XmlType, 10> kTypes{{{"Float32", {'f', 4}},
                                          {"Float64", {'f', 8}},
                                          {"Int8", {'i', 1}},
                                          {"UInt8", {'u', 1}},
                                          {"Int16", {'i', 2}},
                                          {"UInt16", {'u', 2}},
                                          {"Int32", {'i', 4}},
                                          {"UInt32", {'u', 4}},
                                          {"Int64", {'i', 8}},
                                          {"UInt64", {'u', 8}}}};

class VtkXmlFile {
 public:
  VtkXmlFile(const std::filesystem::path& file, std::string_view bytes)
      : file_(file), bytes_(bytes), points_(file) {}

  RawSnapshot read() {
    parse();
    const pugi::xml_node root = document_.child("VTKFile");
    if (!root)
      throw FileError(file_, 0,
                      "XML without VTKFile: VTK's .vtp and .vtu are read; save as one of these, or as CSV");
    const std::string type = root.attribute("type").value();
    if (type != "PolyData" && type != "UnstructuredGrid")
      fail(root, fmt::format("a VTKFile of type '{:.40}': PolyData and UnstructuredGrid are read{}", type,
                             type == "Collection" || type.starts_with("P")
                                 ? "; it names other files, give one of those"
                                 : ""));
    read_encoding(root);
    for (const pugi::xml_node piece : root.child(type.c_str()).children("Piece")) read_piece(piece);
    return points_.grains();
  }

 private:
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& message) const {
    throw FileError(file_, line_of(node.offset_debug()), message);
  }
  int line_of(std::ptrdiff_t offset) const {
    const auto end = std::min(bytes_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return 1 + static_cast<int>(
                   std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
  }

  // The elements; appended data are no XML, they are cut out before.
  void parse() {
    text_ = bytes_;
    const std::size_t tag = text_.find("<AppendedData");
    if (tag != std::string::npos) {
      const std::size_t end = text_.find('>', tag);
      const std::size_t mark = end == std::string::npos ? end : text_.find_first_not_of(" \t\r\n", end + 1);
      if (mark == std::string::npos || text_[mark] != '_')
        throw FileError(file_, line_of(static_cast<std::ptrdiff_t>(tag)), "AppendedData must begin with '_'");
      appended_ = bytes_.substr(mark + 1);
      text_.resize(end + 1);
      text_ += "</AppendedData></VTKFile>";
    }
    require_text(file_, text_);
    for (const char sign : {'<', '='})
      if (std::count(text_.begin(), text_.end(), sign) > kMostElements)
        throw FileError(file_, 0, fmt::format("has more than {} elements or attributes", kMostElements));
    const pugi::xml_parse_result result =
        document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result)
      throw FileError(file_, line_of(result.offset), fmt::format("is no XML: {}", result.description()));
  }

  void read_encoding(const pugi::xml_node& root) {
    const std::string order = root.attribute("byte_order").as_string("LittleEndian"),
                      header = root.attribute("header_type").as_string("UInt32"),
                      compressor = root.attribute("compressor").value();
    if (order != "LittleEndian" && order != "BigEndian")
      fail(root, fmt::format("byte_order '{:.40}': LittleEndian or BigEndian", order));
    if (header != "UInt32" && header != "UInt64")
      fail(root, fmt::format("header_type '{:.40}': UInt32 or UInt64", header));
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail(root, fmt::format("compressor '{:.40}': save with ZLib, or without compression", compressor));
    encoding_ = {order == "BigEndian" ? std::endian::big : std::endian::little,
                 header == "UInt64" ? std::size_t{8} : std::size_t{4}, !compressor.empty()};
    const std::string appended = root.child("AppendedData").attribute("encoding").as_string("base64");
    if (appended != "raw" && appended != "base64")
      fail(root, fmt::format("AppendedData in encoding '{:.40}': raw or base64", appended));
    appended_base64_ = appended == "base64";
  }

  void read_piece(const pugi::xml_node& piece) {
    const double said = number_in(trimmed(piece.attribute("NumberOfPoints").value())).value_or(-1);
    if (said > static_cast<double>(kMostPoints - points_.count()))
      fail(piece, fmt::format("more than {} points", kMostPoints));
    const auto count = integer_in(said, 0, static_cast<double>(kMostPoints));
    if (!count)
      fail(piece,
           fmt::format("NumberOfPoints '{:.40}' is no count", piece.attribute("NumberOfPoints").value()));
    const auto rows = static_cast<std::size_t>(*count);
    if (rows == 0) {
      points_.add_piece({});
      return;
    }
    const pugi::xml_node places = piece.child("Points").child("DataArray");
    if (!places || components_of(places) != 3) fail(piece, "has no Points of 3 components");
    points_.add_piece(values_of(places, 3 * rows));
    for (const pugi::xml_node array : piece.child("PointData").children("DataArray")) {
      const char* name = array.attribute("Name").value();
      if (points_.wants(name, components_of(array), rows)) points_.add(name, values_of(array, rows));
    }
  }

  static std::size_t components_of(const pugi::xml_node& array) {
    return array.attribute("NumberOfComponents").as_uint(1);
  }

  std::vector<double> values_of(const pugi::xml_node& array, std::size_t count) const {
    const std::string_view type = array.attribute("type").value(),
                           format = array.attribute("format").as_string("ascii");
    const XmlType* known =
        std::find_if(kTypes.begin(), kTypes.end(), [&](const XmlType& each) { return each.name == type; });
    if (known == kTypes.end()) fail(array, fmt::format("'{:.40}' is no type of numbers", type));
    const pugi::xml_node text =
        array.find_child([](const pugi::xml_node& child) { return child.type() == pugi::node_pcdata; });
    if (format == "ascii") return written_values(text, count);
    std::string_view data;
    if (format == "appended") {
      const auto offset = number_in(trimmed(array.attribute("offset").value()));
      if (!offset || !(*offset >= 0 && *offset < static_cast<double>(appended_.size())))
        fail(array, fmt::format("offset '{:.40}' is not within the appended data",
                                array.attribute("offset").value()));
      data = appended_.substr(static_cast<std::size_t>(*offset));
    } else if (format == "binary") {
      data = text.value();
    } else {
      fail(array, fmt::format("format '{:.40}': ascii, binary or appended", format));
    }
    const VtkNumber number = known->number;
    std::string bytes;
    try {
      bytes = decoded_array(data, format == "binary" || appended_base64_, encoding_, count * number.size);
    } catch (const std::runtime_error& error) {
      fail(array, fmt::format("array '{:.40}': {}", array.attribute("Name").value(), error.what()));
    }
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k)
      values[k] = number_from(bytes.data() + k * number.size, number, encoding_.order);
    return values;
  }

  std::vector<double> written_values(const pugi::xml_node& text, std::size_t count) const {
    std::vector<double> values;
    try {
      TextCursor cursor(file_, text.value());
      for (std::size_t k = 0; k < count; ++k) values.push_back(cursor.number());
      if (!cursor.word().empty()) cursor.fail(fmt::format("more than the {} values of the array", count));
    } catch (const FileError& error) {  // lines of the text are those of the file from its first on
      throw FileError(file_, line_of(text.offset_debug()) + error.line - 1, error.message);
    }
    return values;
  }

  const std::filesystem::path& file_;
  std::string_view bytes_, appended_;
  std::string text_;  // that the document is made of
  pugi::xml_document document_;
  VtkEncoding encoding_;
  bool appended_base64_ = true;
  VtkPoints points_;
};

}  // namespace

RawSnapshot read_vtk_xml(const std::filesystem::path& file, std::string_view bytes) {
  return VtkXmlFile(file, bytes).read();
}

}  // namespace scree
