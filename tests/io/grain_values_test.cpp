// What is asked of a grain's values, in every format alike: sizes that agree, numbers that are whole, columns
// of one meaning once.
#include "sim/io/grain_values.h"

#include <limits>

#include "tests/io/snapshot_fixture.h"

namespace scree {
namespace {

// A column, and its value in each row.
struct Column {
  const char* name;
  std::vector<const char*> values;
};
using Table = std::vector<Column>;

// Grains at x = 0, 1, ... with these columns, in a format.
using Writer = std::string (*)(const Table&);

std::string rows_of(const Table& table, const char* start, char separator) {
  std::string text;
  for (std::size_t k = 0; k < table.front().values.size(); ++k) {
    text += fmt::format("{}{}{}0{}0", start, k, separator, separator);
    for (const Column& column : table) text += fmt::format("{}{}", separator, column.values[k]);
    text += '\n';
  }
  return text;
}

std::string csv_of(const Table& table) {
  std::string text = "x,y,z";
  for (const Column& column : table) text += fmt::format(",{}", column.name);
  return text + "\n" + rows_of(table, "", ',');
}

std::string lammps_of(const Table& table) {
  std::string text = fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: ATOMS x y z",
                                 table.front().values.size());
  for (const Column& column : table) text += fmt::format(" {}", column.name);
  return text + "\n" + rows_of(table, "", ' ');
}

std::string xyz_of(const Table& table) {
  std::string text = fmt::format("{}\nProperties=species:S:1:pos:R:3", table.front().values.size());
  for (const Column& column : table) text += fmt::format(":{}:R:1", column.name);
  return text + "\n" + rows_of(table, "Rock ", ' ');
}

std::string vtk_of(const Table& table) {
  const std::size_t count = table.front().values.size();
  std::string text = fmt::format(
      "# vtk DataFile Version 3.0\npile\nASCII\nDATASET POLYDATA\nPOINTS {} double\n{}POINT_DATA {}\nFIELD f "
      "{}\n",
      count, rows_of({{"", std::vector<const char*>(count, "")}}, "", ' '), count, table.size());
  for (const Column& column : table)
    text += fmt::format("{} 1 {} double\n{}\n", column.name, count, fmt::join(column.values, " "));
  return text;
}

std::string piece_of(const Table& table) {
  const std::size_t count = table.front().values.size();
  std::string text = fmt::format("<Piece NumberOfPoints=\"{}\">\n<PointData>\n", count);
  for (const Column& column : table)
    text += fmt::format("<DataArray type=\"Float64\" Name=\"{}\">{}</DataArray>\n", column.name,
                        fmt::join(column.values, " "));
  return text + fmt::format(
                    "</PointData>\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">\n{}"
                    "</DataArray></Points>\n</Piece>\n",
                    rows_of({{"", std::vector<const char*>(count, "")}}, "", ' '));
}

std::string vtp_of(const std::vector<Table>& pieces) {
  std::string text = "<VTKFile type=\"PolyData\">\n<PolyData>\n";
  for (const Table& piece : pieces) text += piece_of(piece);
  return text + "</PolyData>\n</VTKFile>\n";
}

std::string vtp_of(const Table& table) {
  return vtp_of(std::vector<Table>{table});
}

struct Format {
  const char* name;
  Writer write;
  const char* second_grain;  // how an error names it
};

const std::vector<Format> kFormats{{"CSV", csv_of, "pile.txt:3: "},
                                   {"LAMMPS", lammps_of, "pile.txt:7: "},
                                   {"XYZ", xyz_of, "pile.txt:4: "},
                                   {"VTK", vtk_of, "pile.txt: grain 2: "},
                                   {"VTK XML", vtp_of, "pile.txt: grain 2: "}};

TEST_F(SnapshotReader, RadiusAndDiameterMustAgree) {
  for (const Format& format : kFormats) {
    SCOPED_TRACE(format.name);
    for (const bool diameter_first : {true, false}) {
      const auto text = [&](const char* diameter, const char* radius) {
        Table table{{"diameter", {"1", diameter}}, {"radius", {"0.5", radius}}};
        if (!diameter_first) std::swap(table[0], table[1]);
        return format.write(table);
      };
      EXPECT_EQ(read(text("0.5", "0.25")).snapshot.grains[1].diameter, 0.5);
      // Two roundings of 0.33333: the diameter is taken. 0.3333 / 0.334 is beyond a thousandth.
      EXPECT_EQ(read(text("0.3333", "0.1667")).snapshot.grains[1].diameter, 0.3333);
      EXPECT_THAT(
          error(text("0.3333", "0.167")),
          HasSubstr(std::string(format.second_grain) +
                    "diameter 0.3333 is not twice the radius 0.167; leave out the one that is wrong"));
      EXPECT_THAT(error(text("0.5", "0.5")), HasSubstr("diameter 0.5 is not twice the radius 0.5"));
      EXPECT_THAT(error(text("0.5", "0")), HasSubstr("diameter 0.5 is not twice the radius 0"));
    }
  }
  // In units of their own; where a radius is not known it says nothing.
  EXPECT_EQ(read("x,y,z,d_cm,r_mm\n0,0,0,50,250\n1,0,0,50,\n").snapshot.grains[1].diameter, 0.5);
  EXPECT_THAT(error("x,y,z,d_cm,r_mm\n0,0,0,50,25\n"),
              HasSubstr("diameter 0.5 is not twice the radius 0.025"));
}

TEST_F(SnapshotReader, IdsAndDumpsAreWholeNumbers) {
  for (const Format& format : kFormats) {
    SCOPED_TRACE(format.name);
    const auto text = [&](const char* id, const char* dump) {
      return format.write({{"radius", {"1", "1"}}, {"id", {"7", id}}, {"dump", {"1", dump}}});
    };
    const SnapshotRead good = read(text("9007199254740991", "1000000"));  // 2^53 - 1
    EXPECT_EQ(good.snapshot.grains[1].id, 9007199254740991);
    EXPECT_EQ(good.snapshot.grains[1].dump, 1'000'000);
    EXPECT_EQ(read(text("-3", "2")).snapshot.grains[0].id, -3);
    for (const char* id : {"0.6", "9007199254740993", "-1e300"})
      EXPECT_THAT(error(text(id, "1")), HasSubstr(std::string(format.second_grain) +
                                                  "id must be an integer between -2^53 and 2^53, found"));
    for (const char* dump : {"0.6", "1.5", "0", "-1", "1000001"})
      EXPECT_THAT(error(text("8", dump)), HasSubstr(std::string(format.second_grain) +
                                                    "dump must be an integer from 1 to 1000000, found"));
  }
}

TEST_F(SnapshotReader, IntegersAreWithinBounds) {
  EXPECT_EQ(integer_in(3, 1, 3), 3);
  EXPECT_EQ(integer_in(-2, -2, 3), -2);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double none : {0.0, 4.0, 2.5, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(integer_in(none, 1, 3), std::nullopt) << none;
}

TEST_F(SnapshotReader, ColumnsOfOneMeaningStandOnce) {
  for (const Format& format : kFormats) {
    SCOPED_TRACE(format.name);
    EXPECT_THAT(error(format.write({{"radius", {"1"}}, {"r", {"1"}}})),
                testing::ContainsRegex("two (columns|arrays of the points) are 'radius'"));
    EXPECT_THAT(error(format.write({{"radius", {"1"}}, {"dump", {"1"}}, {"load", {"1"}}})),
                testing::ContainsRegex("two (columns|arrays of the points) are 'dump'"));
  }
  EXPECT_THAT(error("1\nProperties=pos:R:3:position:R:3:radius:R:1\n0 0 0 1 1 1 1\n"),
              HasSubstr(":2: Properties: two columns are 'pos'"));
  EXPECT_THAT(error("1\nProperties=pos:R:3:velo:R:3:velocity:R:3:radius:R:1\n0 0 0 1 1 1 2 2 2 1\n"),
              HasSubstr(":2: Properties: two columns are 'velo'"));
  EXPECT_THAT(error(lammps_of({{"radius", {"1"}}, {"x", {"1"}}})),
              HasSubstr(":5: two columns are 'x': x and x"));
  // Ways to write the same place stand beside each other: the plain one is taken.
  const double plain = read(lammps_of({{"radius", {"1"}}})).snapshot.grains[0].position.x();
  EXPECT_EQ(read(lammps_of({{"radius", {"1"}}, {"xu", {"7"}}})).snapshot.grains[0].position.x(), plain);
}

TEST_F(SnapshotReader, ArraysArePiecesOwn) {
  const Table with{{"radius", {"1", "2"}}}, other{{"colour", {"1", "2"}}};
  const Table twice{{"radius", {"3", "4"}}, {"r", {"5", "6"}}};
  EXPECT_EQ(read(vtp_of(std::vector<Table>{with, with})).snapshot.grains[3].diameter, 4);
  EXPECT_THAT(error(vtp_of(std::vector<Table>{other, twice})),
              HasSubstr("piece 2: two arrays of the points are 'radius'"));
  EXPECT_THAT(error(vtp_of(std::vector<Table>{with, other})),
              HasSubstr("the points of piece 2 have no array 'radius', those of piece 1 have one"));
  EXPECT_THAT(error(vtp_of(std::vector<Table>{other, with})),
              HasSubstr("the points of piece 1 have no array 'radius', those of piece 2 have one"));
  EXPECT_THAT(error(vtp_of(std::vector<Table>{with, {{"radius", {"1"}}, {"mass", {"1"}}}, with})),
              HasSubstr("the points of piece 1 have no array 'mass', those of piece 2 have one"));
  // A legacy file: its arrays are as long as its points, which stand once.
  const std::string legacy = vtk_of(with);
  EXPECT_THAT(error(std::string(legacy).replace(legacy.find("radius 1 2"), 10, "radius 1 1")),
              HasSubstr("array 'radius' has 1 values for 2 points"));
  EXPECT_THAT(error(legacy + "POINTS 2 double\n5 5 5 6 6 6\nFIELD more 1\nr 1 4 double\n1 1 1 1\n"),
              HasSubstr("POINTS stand twice"));
}

TEST_F(SnapshotReader, AByteOrderMarkIsPassedOver) {
  for (const Format& format : kFormats) {
    SCOPED_TRACE(format.name);
    EXPECT_EQ(read("\xEF\xBB\xBF" + format.write({{"radius", {"1"}}})).snapshot.grains[0].diameter, 2);
  }
  EXPECT_THAT(error("\xEF\xBB\xBF-5\nProperties=pos:R:3:radius:R:1\n"),
              HasSubstr("pile.txt:1: '-5' is no number of grains, with which a frame of XYZ begins"));
}

}  // namespace
}  // namespace scree
