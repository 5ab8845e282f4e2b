// Piles out of VTK XML: in every encoding, as VTK 9.1 writes it, and what cannot be read.
#include <sys/resource.h>
#include <zlib.h>

#include <cstring>

#include "scree_version.h"
#include "tests/io/snapshot_fixture.h"

namespace scree {
namespace {

template <class Number>
void put_number(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string base64(const std::string& bytes) {
  static const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t bits = 0;
    for (std::size_t j = k; j < k + 3; ++j)
      bits = bits << 8 | (j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += k + j > bytes.size() ? '=' : letters[bits >> (18 - 6 * j) & 63];
  }
  return text;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  return out.substr(0, size);
}

// An array of doubles with the header of plain bytes, or as one block of zlib with the header given, by
// default the true one.
std::string plain(const std::vector<double>& values, std::uint32_t said) {
  std::string bytes;
  put_number(bytes, said);
  for (const double value : values) put_number(bytes, value);
  return base64(bytes);
}
std::string packed(const std::vector<double>& values, std::vector<std::uint32_t> header = {}) {
  std::string bytes;
  for (const double value : values) put_number(bytes, value);
  const std::string block = deflated(bytes);
  if (header.empty())
    header = {1, 32768, static_cast<std::uint32_t>(bytes.size()), static_cast<std::uint32_t>(block.size())};
  std::string start;
  for (const std::uint32_t number : header) put_number(start, number);
  return base64(start) + base64(block);
}

// A file of two grains; `radius` stands in the array of that name.
std::string two(const std::string& radius, const std::string& format = "binary", const std::string& more = "",
                const std::string& points = "2") {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" {}>\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\">\n<PointData>\n<DataArray type=\"Float64\" Name=\"radius\" format=\"{}\">"
      "{}</DataArray>\n</PointData>\n<Points>\n<DataArray type=\"Float32\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n0 0 1\n1 0 1\n</DataArray>\n</Points>\n</Piece>\n</PolyData>\n</VTKFile>\n",
      more, points, format, radius);
}
const std::string kZlib = "compressor=\"vtkZLibDataCompressor\"";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}
std::string with_byte(std::string text, std::size_t at, char byte) {
  text.at(at) = byte;
  return text;
}

fs::path written_by_vtk(const std::string& name) {
  return fs::path(SCREE_SOURCE_DIR) / "tests/fuzz/corpus/snapshot" / name;
}

TEST_F(SnapshotReader, ReadsEveryEncodingOfVtk) {
  for (const char* name :
       {"ascii.vtp", "binary.vtu", "binary_zlib.vtu", "appended_raw.vtu", "appended_raw_zlib.vtp",
        "appended_base64.vtp", "appended_base64_zlib.vtp", "appended_big.vtu"}) {
    SCOPED_TRACE(name);
    const SnapshotRead read = read_snapshot(written_by_vtk(name), {});
    expect_the_pile(read);
    EXPECT_EQ(read.snapshot.grains[4].id, 14);
  }
}

TEST_F(SnapshotReader, ReadsPiecesAndHeadersOfTheirOwn) {
  const std::vector<double> radii{0.5, 0.25};
  for (const std::string& text :
       {two("0.5 0.25", "ascii"), two(plain(radii, 16)), two(packed(radii), "binary", kZlib),
        "\xEF\xBB\xBF" + two("0.5 0.25", "ascii")}) {
    const SnapshotRead read = this->read(text);
    ASSERT_EQ(read.snapshot.grains.size(), 2u);
    EXPECT_EQ(read.snapshot.grains[1].diameter, 0.5);
    EXPECT_EQ(read.snapshot.grains[1].position, Vec3(1, 0, 1));
  }
  // A header encoded by itself, as VTK does before blocks.
  std::string header, data;
  put_number(header, std::uint32_t{16});
  for (const double radius : radii) put_number(data, radius);
  EXPECT_EQ(read(two(base64(header) + base64(data))).snapshot.grains[0].diameter, 1);
  std::string pieces = two("0.5 0.25", "ascii");
  const std::size_t from = pieces.find("<Piece"), to = pieces.find("</PolyData>");
  pieces.insert(to, replaced(pieces.substr(from, to - from), "0 0 1", "0 5 1"));
  pieces.insert(to, "<Piece NumberOfPoints=\"0\"/>\n");
  const SnapshotRead four = read(pieces);
  ASSERT_EQ(four.snapshot.grains.size(), 4u);
  EXPECT_EQ(four.snapshot.grains[2].position, Vec3(0, 5, 1));
}

TEST_F(SnapshotReader, BrokenXmlIsNamed) {
  EXPECT_THAT(error("<?xml version=\"1.0\"?>\n<VTKFile>"), HasSubstr("pile.txt:2: is no XML"));
  EXPECT_THAT(error("<?xml version=\"1.0\"?>\n<Xdmf/>"), HasSubstr("XML without VTKFile"));
  EXPECT_THAT(error("<?xml?>"), HasSubstr("is no XML"));
  EXPECT_THAT(error("<VTKFile type=\"Collection\"/>"), HasSubstr("it names other files, give one of those"));
  EXPECT_THAT(error("<VTKFile type=\"ImageData\"/>"), HasSubstr("of type 'ImageData': PolyData and"));
  EXPECT_THAT(error("<VTKFile type=\"PolyData\"/>"), HasSubstr("has no points"));
  EXPECT_THAT(error(two("1 1", "ascii", "compressor=\"vtkLZ4DataCompressor\"")),
              HasSubstr(":2: compressor 'vtkLZ4DataCompressor': save with ZLib"));
  EXPECT_THAT(error(two("1 1", "ascii", "header_type=\"Int8\"")), HasSubstr("UInt32 or UInt64"));
  EXPECT_THAT(error(replaced(two("1 1", "ascii"), "LittleEndian", "Middle")),
              HasSubstr("byte_order 'Middle'"));
  EXPECT_THAT(error(replaced(two("1 1", "ascii"), "Float64", "Float16")),
              HasSubstr(":6: 'Float16' is no type"));
  EXPECT_THAT(error(two("1 1", "hex")), HasSubstr(":6: format 'hex'"));
  EXPECT_THAT(error(two("1", "ascii")), HasSubstr(":6: the file ends before its data do"));
  EXPECT_THAT(error(two("1\n1\n1", "ascii")), HasSubstr(":8: more than the 2 values of the array"));
  EXPECT_THAT(error(two("1\nx", "ascii")), HasSubstr(":7: 'x' is no finite number"));
  EXPECT_THAT(error(replaced(two("1 1", "ascii"), "\"radius\"", "\"colour\"")), HasSubstr("found: colour"));
  EXPECT_THAT(error(replaced(two("1 1", "ascii"), "<Points>", "<Dots>")), HasSubstr("is no XML"));
  EXPECT_THAT(error(replaced(two("1 1", "ascii"), "NumberOfComponents=\"3\"", "")),
              HasSubstr("no Points of 3 components"));
  EXPECT_THAT(error(replaced(two("1 1", "ascii"), "</PointData>",
                             "<DataArray type=\"Float64\" Name=\"radii\">1 1</DataArray></PointData>")),
              HasSubstr("two arrays of the points are 'radius'"));
  SnapshotOptions options;
  options.frame = 2;
  EXPECT_THAT(error(two("1 1", "ascii"), options), HasSubstr("frame 2: a VTK file has one"));
}

TEST_F(SnapshotReader, XmlWithSizesThatLieIsNamed) {
  const std::vector<double> radii{0.5, 0.25};
  EXPECT_THAT(error(two("1 1", "ascii", "", "-2")), HasSubstr(":4: NumberOfPoints '-2' is no count"));
  EXPECT_THAT(error(two("1 1", "ascii", "", "1e30")), HasSubstr(":4: more than 5000000 points"));
  EXPECT_THAT(error(two("1 1", "ascii", "", "5000000")), HasSubstr("the file ends before its data do"));
  EXPECT_THAT(error(two(plain(radii, 8))), HasSubstr("array 'radius': 8 bytes, an array of 16 is needed"));
  EXPECT_THAT(error(two(plain({0.5}, 16))), HasSubstr("the data end before the array does"));
  EXPECT_THAT(error(two("")), HasSubstr("the data end before the array does"));
  EXPECT_THAT(error(two("!" + plain(radii, 16))), HasSubstr("the data are no base64"));
  // Blocks, bytes of each, of the last, and packed.
  const auto zlib = [&](const std::vector<std::uint32_t>& header) {
    return error(two(packed(radii, header), "binary", kZlib));
  };
  EXPECT_THAT(zlib({0, 16, 0, 20}), HasSubstr("0 blocks of 16 bytes and a last of 0 are no array of 16"));
  EXPECT_THAT(zlib({1, 0, 0, 20}), HasSubstr("are no array of 16 bytes"));
  EXPECT_THAT(zlib({1, 32, 24, 20}), HasSubstr("are no array of 16 bytes"));
  EXPECT_THAT(zlib({4000000000u, 16, 0, 20}), HasSubstr("are no array of 16 bytes"));
  EXPECT_THAT(zlib({1, 16, 0, 4000000000u}), HasSubstr("the data end before the array does"));
  EXPECT_THAT(zlib({1, 16, 0, 5}), HasSubstr("block 1 of 1 is damaged"));
  EXPECT_THAT(zlib({2, 8, 0, 5, 5}), HasSubstr("block 1 of 2 is damaged"));
  // A block of more than is said.
  EXPECT_THAT(error(two(packed({1, 1, 1}, {1, 16, 0, 40}), "binary", kZlib)), HasSubstr("array 'radius': "));
  // Points by the million that a few bytes cannot hold.
  std::string many = replaced(two("1 1", "ascii", kZlib, "5000000"), "format=\"ascii\">\n0 0 1\n1 0 1\n",
                              "format=\"binary\">" + packed(radii, {1, 60000000, 0, 16}));
  EXPECT_THAT(error(many), HasSubstr("the data end before the array does"));
}

// Address space, bytes (proc(5), statm).
[[maybe_unused]] std::size_t memory_of_this_process() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// A file of points at 0 with radius 1, a byte a number.
std::string packed_points(std::size_t count, int pieces) {
  const auto array = [](const char* attributes, const std::string& bytes) {
    const std::string block = deflated(bytes);
    std::string header;
    for (const std::size_t number : {std::size_t{1}, bytes.size(), std::size_t{0}, block.size()})
      put_number(header, static_cast<std::uint32_t>(number));
    return fmt::format("<DataArray type=\"Int8\" {} format=\"binary\">{}</DataArray>", attributes,
                       base64(header) + base64(block));
  };
  const std::string piece =
      fmt::format("<Piece NumberOfPoints=\"{}\"><PointData>{}</PointData><Points>{}</Points></Piece>\n",
                  count, array("Name=\"radius\"", std::string(count, 1)),
                  array("NumberOfComponents=\"3\"", std::string(3 * count, 0)));
  std::string text = fmt::format("<VTKFile type=\"PolyData\" {}>\n<PolyData>\n", kZlib);
  for (int k = 0; k < pieces; ++k) text += piece;
  return text + "</PolyData>\n</VTKFile>\n";
}

TEST_F(SnapshotReader, PointsPackedIntoFewBytesAreBounded) {
  EXPECT_EQ(read(packed_points(1000, 3)).snapshot.grains.size(), 3000u);
  EXPECT_THAT(error(packed_points(2'000'000, 3)), HasSubstr(":5: more than 5000000 points"));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // As many as are read. A point takes 24 bytes as three numbers and 80 as a grain, at once.
  const std::string most = packed_points(5'000'000, 1);
  EXPECT_LT(most.size(), 40'000u);
  EXPECT_EXIT(
      {
        rlimit limit{};
        limit.rlim_cur = limit.rlim_max = memory_of_this_process() + 5'000'000u * 110u;
        setrlimit(RLIMIT_AS, &limit);
        std::exit(read(most).snapshot.grains.size() == 5'000'000u ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
#endif
}

TEST_F(SnapshotReader, BrokenAppendedDataAreNamed) {
  for (const char* name :
       {"appended_raw.vtu", "appended_raw_zlib.vtp", "appended_base64.vtp", "appended_big.vtu"}) {
    SCOPED_TRACE(name);
    std::ifstream in(written_by_vtk(name), std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(in), {}};
    const std::size_t data = good.find("_", good.find("<AppendedData"));
    EXPECT_EQ(error(good), "");
    EXPECT_THAT(error(good.substr(0, data)), HasSubstr("AppendedData must begin with '_'"));
    EXPECT_THAT(error(with_byte(good, data, 'x')), HasSubstr("AppendedData must begin with '_'"));
    EXPECT_THAT(error(replaced(good, "<AppendedData encoding=\"", "<AppendedData encoding=\"no")),
                HasSubstr("raw or base64"));
    const std::size_t at = good.find("offset=\"", good.find("<Points>")) + 8;
    EXPECT_THAT(error(good.substr(0, data + 11 + std::stoul(good.substr(at)))),
                HasSubstr("the data end before the array does"));
    for (const char* offset : {"-1", "999999", "1e300", "x", ""})
      EXPECT_THAT(error(std::string(good).replace(at, good.find('"', at) - at, offset)),
                  HasSubstr(fmt::format("offset '{}' is not within the appended data", offset)));
  }
}

}  // namespace
}  // namespace scree
