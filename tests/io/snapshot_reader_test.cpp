// Piles out of files of other programs: one pile in every format, and what cannot be read.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "sim/io/trajectory.h"
#include "tests/io/snapshot_fixture.h"

namespace scree {
namespace {

// The pile as a VTK file; numbers as text, or big-endian.
std::string vtk(bool binary, bool polydata) {
  const auto grains = pile();
  std::string text = fmt::format("# vtk DataFile Version 3.0\na pile\n{}\nDATASET {}\n",
                                 binary ? "BINARY" : "ASCII", polydata ? "POLYDATA" : "UNSTRUCTURED_GRID");
  const auto add = [&](double value, bool is_int = false) {
    if (!binary) {
      text += fmt::format("{} ", value);
      return;
    }
    const auto bits = is_int ? static_cast<std::uint32_t>(static_cast<std::int32_t>(value))
                             : std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(bits >> shift & 0xFF);
  };
  text += "POINTS 5 float\n";
  for (const Grain& g : grains)
    for (int axis = 0; axis < 3; ++axis) add(g.position[axis]);
  text += polydata ? "\nVERTICES 5 10\n" : "\nCELLS 5 10\n";
  for (int k = 0; k < 5; ++k) add(1, true), add(k, true);
  if (!polydata) {
    text += "\nCELL_TYPES 5\n";
    for (int k = 0; k < 5; ++k) add(1, true);
  }
  text += "\nCELL_DATA 5\nSCALARS pressure float 1\nLOOKUP_TABLE default\n";
  for (int k = 0; k < 5; ++k) add(-1);
  text += "\nPOINT_DATA 5\nVECTORS velocity float\n";
  for (int k = 0; k < 15; ++k) add(k);
  text += "\nSCALARS radius float 1\nLOOKUP_TABLE default\n";
  for (const Grain& g : grains) add(0.5 * g.diameter);
  text += "\nFIELD FieldData 2\nid 1 5 int\n";
  for (const Grain& g : grains) add(static_cast<double>(g.id), true);
  text += "\nmass 1 5 float\n";
  for (const Grain& g : grains) add(g.mass);
  return text + "\n";
}

std::string lammps_frame(int step, double offset, const char* columns) {
  std::string text = fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n5\nITEM: BOX BOUNDS ff ff ff\n-10 10\n-10 10\n0 40\nITEM: "
      "ATOMS {}\n",
      step, columns);
  const bool scaled = std::string(columns).find("xs") != std::string::npos;
  const auto grains = pile();
  for (std::size_t k = grains.size(); k-- > 0;) {  // LAMMPS keeps no order
    const Grain& g = grains[k];
    Vec3 p = g.position + Vec3(offset, 0, 0);
    if (scaled) p = Vec3((p.x() + 10) / 20, (p.y() + 10) / 20, p.z() / 40);
    text += fmt::format("{} 1 Si {:.12g} {:.12g} {:.12g} {} {}\n", g.id, p.x(), p.y(), p.z(),
                        0.5 * g.diameter, g.mass);
  }
  return text;
}

TEST_F(SnapshotReader, CsvNamesItsColumnsAndUnits) {
  expect_the_pile(read(csv("id,x,y,z,diameter,dump,mass")));
  expect_the_pile(read(csv("ID, X ,Y,Z,Diameter,Dump,Mass [kg]")));
  expect_the_pile(read(csv("id,x_mm,y_mm,z_mm,d_mm,load,mass_kg", 1000)));
  expect_the_pile(read(csv("id,pos_x,pos_y,pos_z,diameter,dump,mass")));
  expect_the_pile(read(csv("id,pos_x_mm,pos_y_mm,pos_z_mm,diameter_mm,dump,mass [kg]", 1000)));
  expect_the_pile(read(csv("id,x [cm],y (cm),z_cm,diameter [cm],dump,mass_kg", 100)));
  SnapshotOptions millimetres;
  millimetres.length_unit = 1e-3;
  millimetres.density = 2000;
  expect_the_pile(read(csv("id,x,y,z,diameter,dump", 1000, false), millimetres));
  expect_the_pile(read(csv("id,Points:0,Points:1,Points:2,diameter,other", 1000, false), millimetres));
  std::string blanks = csv("id,x,y,z,diameter,dump,mass");
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  expect_the_pile(read(blanks));
  const SnapshotRead dumps = read(csv("id,x,y,z,diameter,dump,mass"));
  EXPECT_TRUE(dumps.has_dumps);
  EXPECT_EQ(dumps.snapshot.grains[4].dump, 2);
  EXPECT_EQ(dumps.snapshot.grains[4].id, 14);
  EXPECT_FALSE(read("x,y,z,radius\n0,0,0,1\n").has_dumps);
  EXPECT_EQ(read("x;y;z;radius\n0,5;0;0;1,25\n").snapshot.grains[0].diameter, 2.5);
}

// A mass without a unit is in kilograms beside lengths in metres; beside others it may be anything.
TEST_F(SnapshotReader, MassWithoutAUnitIsThatOfMetres) {
  SnapshotOptions by_density, millimetres;
  by_density.density = millimetres.density = 2000;
  millimetres.length_unit = 1e-3;
  // Masses of which none is what the pile has.
  const auto other_masses = [&](const char* header, double length) {
    std::string text = csv(header, length, false);
    for (std::size_t at = text.find('\n'); (at = text.find('\n', at + 1)) != std::string::npos; at += 4)
      text.insert(at, ",1e9");
    return text;
  };
  const auto expect_masses_of_density = [&](const SnapshotRead& read) {
    expect_the_pile(read);
    EXPECT_THAT(read.notes, testing::ElementsAre(HasSubstr("the unit of the file's own is not known")));
  };
  expect_masses_of_density(read(other_masses("id,x,y,z,diameter,dump,mass", 1000), millimetres));
  expect_masses_of_density(read(other_masses("id,x_mm,y_mm,z_mm,d_mm,dump,mass", 1000), by_density));
  expect_the_pile(read(csv("id,x,y,z,diameter,dump,mass_kg", 1000), millimetres));
  EXPECT_TRUE(read(csv("id,x,y,z,diameter,dump,mass")).notes.empty());
}

// Layouts of export.text and export.textExt of YADE.
TEST_F(SnapshotReader, TextOfYade) {
  const auto yade = [](const char* format, const char* comment, bool with_id, const char* behind) {
    std::string text = fmt::format("#format {}\n{}", format, comment);
    for (const Grain& g : pile())
      text += fmt::format("{}{}\t{}\t{}\t{}{}\n", with_id ? fmt::format("{}\t", g.id) : "", g.position.x(),
                          g.position.y(), g.position.z(), 0.5 * g.diameter, behind);
    return text;
  };
  SnapshotOptions options;
  options.density = 2000;
  expect_the_pile(read(yade("x_y_z_r", "", false, ""), options));
  expect_the_pile(read(yade("x_y_z_r_matId", "# a pile\n", false, "\t0"), options));
  expect_the_pile(read(yade("x_y_z_r_attrs", "# x y z r a b\n", false, "\t1\tword"), options));
  const SnapshotRead with_id = read(yade("id_x_y_z_r_matId", "", true, "\t0"), options);
  expect_the_pile(with_id);
  EXPECT_EQ(with_id.snapshot.grains[4].id, 14);
  options = {};
  options.length_unit = 1e-3;
  EXPECT_EQ(read("#format x_y_z_r\r\n0 0 0 500\r\n\r\n", options).snapshot.grains[0].diameter, 1);
  EXPECT_THAT(error("#format jointedPM\n0 0 0 1\n"),
              HasSubstr(":1: format 'jointedPM' does not name x, y, z and r"));
  EXPECT_THAT(error("#format x_y_z_r\n0 0 0 1\n0 0 1\n"),
              HasSubstr(":3: 3 values, the format has 4 columns"));
  EXPECT_THAT(error("#format x_y_z_r\n0 0 0 1 5\n"), HasSubstr(":2: 5 values, the format has 4 columns"));
  EXPECT_THAT(error("#format x_y_z_r\n0 0 0 one\n"), HasSubstr(":2: 'one' is no finite number"));
  EXPECT_THAT(error("#format x_x_y_z_r\n0 0 0 0 1\n"), HasSubstr("two columns are 'x'"));
  EXPECT_THAT(error("-0.0561\t0.1\t0.2\t0.3\n0\t0.1\t0.2\t0.3\n"), HasSubstr(":1: no header"));
}

TEST_F(SnapshotReader, FormatsAgree) {
  for (const bool binary : {false, true})
    for (const bool polydata : {false, true}) expect_the_pile(read(vtk(binary, polydata)));
  expect_the_pile(read(lammps_frame(0, 0, "id type element x y z radius mass")));
  expect_the_pile(read(lammps_frame(0, 0, "id type element xs ys zs radius mass")));
  expect_the_pile(read(lammps_frame(0, 0, "id type element xu yu zu radius mass")));

  TrajectoryWriter writer(folder / "particles.h5", pile(), {pile().front()});
  Snapshot first{0.5, {pile()[0]}}, second{1.5, pile()};
  second.grains.erase(second.grains.begin() + 1);  // lost
  writer.write(first, 1);
  writer.write({1, pile()}, 2);
  writer.write(second, 3);
  writer.close();
  SnapshotOptions middle;
  middle.frame = 2;
  const SnapshotRead h5 = read_snapshot(folder / "particles.h5", middle);
  expect_the_pile(h5);
  EXPECT_EQ(h5.snapshot.time, 1);
  EXPECT_EQ(h5.snapshot.grains[4].dump, 2);
  EXPECT_EQ(h5.fixed.size(), 1u);
  const SnapshotRead last = read_snapshot(folder / "particles.h5", {});
  EXPECT_EQ(last.snapshot.grains.size(), 4u);
  EXPECT_EQ(last.original.size(), 5u) << "what was lost was dumped";
  middle.frame = 1;
  EXPECT_EQ(read_snapshot(folder / "particles.h5", middle).original.size(), 1u);
}

TEST_F(SnapshotReader, VtkOfVersionFiveHasOffsets) {
  std::string text =
      "# vtk DataFile Version 5.1\npile\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0 1 1 "
      "1\nMETADATA\nINFORMATION 0\n\n"
      "VERTICES 3 2\nOFFSETS vtktypeint64\n0 1 2\nCONNECTIVITY vtktypeint64\n0 1\n"
      "POINT_DATA 2\nFIELD FieldData 1\nDiameter 1 2 double\n0.5 0.25\nMETADATA\nINFORMATION 0\n\n";
  const SnapshotRead two = read(text);
  EXPECT_EQ(two.snapshot.grains[1].diameter, 0.25);
  EXPECT_EQ(two.snapshot.grains[1].position, Vec3(1, 1, 1));
}

TEST_F(SnapshotReader, FramesAreChosen) {
  const char* columns = "id type element x y z radius mass";
  const std::string two = lammps_frame(0, 3, columns) + lammps_frame(100, 0, columns);
  expect_the_pile(read(two));
  SnapshotOptions options;
  options.frame = 1;
  expect_the_pile(read(two, options), Vec3(3, 0, 0));
  options.frame = 3;
  EXPECT_THAT(error(two, options), HasSubstr("frame 3: the file has frames 1 to 2"));
  EXPECT_THAT(error(csv("id,x,y,z,diameter,dump,mass"), options), HasSubstr("frame 3: a table has one"));
}

TEST_F(SnapshotReader, AxesTurnAndShift) {
  SnapshotOptions options;
  options.up = SnapshotOptions::Up::y;
  options.shift = Vec3(0, 0, 10);
  const SnapshotRead turned = read("x,y,z,diameter\n1,2,3,1\n", options);
  EXPECT_EQ(turned.snapshot.grains[0].position, Vec3(1, -3, 12));
}

TEST_F(SnapshotReader, MassesOfSpheresAreStated) {
  SnapshotOptions options;
  options.density = 3000;
  const SnapshotRead one = read("x,y,z,diameter\n0,0,0,0.1\n", options);
  EXPECT_NEAR(one.snapshot.grains[0].mass, 3000 * std::numbers::pi / 6 * 1e-3, 1e-12);
  EXPECT_THAT(one.notes, testing::ElementsAre(HasSubstr("3000 kg/m3")));
}

TEST_F(SnapshotReader, WhatCannotBeReadIsNamed) {
  EXPECT_THAT(error(""), HasSubstr("the file is empty"));
  EXPECT_THAT(error(std::string("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16)), HasSubstr("is a picture, no text"));
  EXPECT_THAT(error("x,y,z\n1,2,3\n"), HasSubstr("no radius: a column diameter or radius"));
  EXPECT_THAT(error("x,y,diameter\n1,2,3\n"), HasSubstr("no column z"));
  EXPECT_THAT(error("x,y,z,diameter\n"), HasSubstr("has no grains"));
  EXPECT_THAT(error("x,y,z,diameter\n0,0,0,1\n0,nan,0,1\n"), HasSubstr("pile.txt:3: y: nan is not finite"));
  EXPECT_THAT(error("x,y,z,diameter\n0,0,0,-1\n"),
              HasSubstr("grain 1 (line 2): diameter -1 must be above 0"));
  EXPECT_THAT(error("x,y,z,radius\n0,0,0,0\n"), HasSubstr("diameter 0 must be above 0"));
  EXPECT_THAT(error("x,y,z,radius\n0,2e6,0,1\n"),
              HasSubstr("farther than 1e+06 m; is the unit of length right?"));
  EXPECT_THAT(error("x,y,z,radius\n0,,0,1\n"), HasSubstr("y is empty"));
  EXPECT_THAT(error("x,y,z,radius,mass\n0,0,0,1,0\n"), HasSubstr("mass 0 must be above 0"));
  EXPECT_THAT(error("x,y,z,radius,id\n0,0,0,1,7\n0,0,2,1,7\n"), HasSubstr("id 7 stands twice"));
  EXPECT_THAT(error("x,y,z,radius,id\n0,0,0,1,7.5\n"), HasSubstr("id must be an integer"));
  EXPECT_THAT(error("x,y,z,radius,dump\n0,0,0,1,0\n"),
              HasSubstr("dump must be an integer from 1 to 1000000, found 0"));
  EXPECT_THAT(error("x [ft],y,z,radius\n0,0,0,1\n"), HasSubstr("none of m, cm, mm, um"));
  EXPECT_THAT(error("x,y,z,radius,x_mm\n0,0,0,1,1\n"), HasSubstr("two columns are 'x'"));
  EXPECT_THAT(error("\x89HDF\r\n\x1A\n and nothing else"), HasSubstr("damaged HDF5"));
  SnapshotOptions options;
  EXPECT_THROW(read_snapshot(folder / "none.csv", options), FileError);
  EXPECT_THROW(read_snapshot(folder, options), FileError);
}

TEST_F(SnapshotReader, BrokenDumpsAreNamed) {
  const std::string good = lammps_frame(0, 0, "id type element x y z radius mass");
  EXPECT_THAT(error(lammps_frame(0, 0, "id type element x y z r2 mass")),
              HasSubstr("no radius: dump the atoms"));
  EXPECT_THAT(error(lammps_frame(0, 0, "id type element x y q radius mass")), HasSubstr("no x, y, z"));
  EXPECT_THAT(error(good.substr(0, good.size() - 60)), HasSubstr("atom "));
  EXPECT_THAT(error("ITEM: TIMESTEP\n0\n"), HasSubstr("no ITEM: ATOMS"));
  std::string broken = good;
  broken.replace(broken.find("Si") + 3, 1, "?");
  EXPECT_THAT(error(broken), HasSubstr("no finite number"));
}

TEST_F(SnapshotReader, BrokenVtkIsNamed) {
  for (const bool binary : {false, true}) {
    const std::string good = vtk(binary, true);
    EXPECT_THAT(error(good.substr(0, good.find("POINTS") + 30)), HasSubstr("ends before its data do"));
    EXPECT_THAT(error(good.substr(0, good.find("SCALARS radius"))), HasSubstr("no radius: an array"));
  }
  std::string text = vtk(false, true);
  text.replace(text.find("POLYDATA"), 8, "STRUCTURED_POINTS");
  EXPECT_THAT(error(text), HasSubstr("POLYDATA or UNSTRUCTURED_GRID"));
  EXPECT_THAT(error(vtk(false, true) + "radius 1 5 float\n1 1 1 1 1\n"), HasSubstr("'radius' is not known"));
  EXPECT_THAT(error(vtk(false, true) + "FIELD more 1\nr 1 5 float\n1 1 1 1 1\n"),
              HasSubstr("two arrays of the points are 'radius'"));
  EXPECT_THAT(error("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 1e30 float\n"),
              HasSubstr("is no count"));
  EXPECT_THAT(error("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 nan 0\n"),
              HasSubstr("'nan' is no finite number"));
}

}  // namespace
}  // namespace scree
