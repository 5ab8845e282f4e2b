// Piles out of extended XYZ: what a run writes for OVITO, what OVITO and ASE write, and what cannot be read.
#include "sim/io/trajectory.h"
#include "tests/io/snapshot_fixture.h"

namespace scree {
namespace {

// The pile as OVITO exports it; positions are moved by `offset`.
std::string xyz(double offset = 0) {
  std::string text =
      "5\nLattice=\"10.0 0.0 0.0 0.0 10.0 0.0 0.0 0.0 40.0\" Properties=id:I:1:species:S:1:pos:R:3:"
      "force:R:3:radius:R:1:mass:R:1 Time=2.5\n";
  for (const Grain& g : pile())
    text += fmt::format("{} Rock {} {} {} 0 nan 0 {} {}\n", g.id, g.position.x() + offset, g.position.y(),
                        g.position.z(), 0.5 * g.diameter, g.mass);
  return text;
}
std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST_F(SnapshotReader, ReadsWhatARunWritesForOvito) {
  TrajectoryWriter writer(folder / "particles.h5", pile(), {});
  Snapshot moved{1, pile()};
  for (Grain& grain : moved.grains) grain.position.x() += 3;
  writer.write(moved, 1);
  Snapshot last{2.5, pile()};
  last.grains[1].velocity = Vec3(1, -2, 3);
  writer.write(last, 2);
  writer.close();
  SnapshotOptions options;
  options.density = 2000;
  const SnapshotRead read = read_snapshot(folder / "particles.xyz", options);
  expect_the_pile(read);
  EXPECT_EQ(read.snapshot.time, 2.5);
  EXPECT_TRUE(read.has_dumps);
  EXPECT_EQ(read.snapshot.grains[4].dump, 2);
  EXPECT_EQ(read.snapshot.grains[4].id, 14);
  EXPECT_EQ(read.snapshot.grains[1].velocity, Vec3(1, -2, 3));
  options.frame = 1;
  expect_the_pile(read_snapshot(folder / "particles.xyz", options), Vec3(3, 0, 0));
  options.frame = 3;
  try {
    read_snapshot(folder / "particles.xyz", options);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("frame 3: the file has frames 1 to 2"));
  }
}

TEST_F(SnapshotReader, ReadsXyzOfOtherPrograms) {
  const SnapshotRead one = read(xyz());
  expect_the_pile(one);
  EXPECT_EQ(one.snapshot.time, 2.5);
  EXPECT_FALSE(one.has_dumps);
  expect_the_pile(read(xyz(3) + xyz() + "\n\n"));
  expect_the_pile(
      read(replaced(xyz(), "Properties=", "comment=\"two Properties=words\" stress properties=")));
  // Quoted, with line ends of Windows.
  std::string text = "1\r\nProperties=\"pos:R:3:diameter:R:1\"\r\n 1\t2 3   0.5\r\n";
  EXPECT_EQ(read(text).snapshot.grains[0].diameter, 0.5);
  EXPECT_EQ(read(text).snapshot.grains[0].position, Vec3(1, 2, 3));
  SnapshotOptions millimetres;
  millimetres.length_unit = 1e-3;
  EXPECT_EQ(read(text, millimetres).snapshot.grains[0].diameter, 0.5e-3);
}

TEST_F(SnapshotReader, BrokenXyzIsNamed) {
  EXPECT_THAT(error("2\na comment\nRock 0 0 0\nRock 1 1 1\n"), HasSubstr(":2: no Properties="));
  EXPECT_THAT(error(replaced(xyz(), "radius", "charge")), HasSubstr(":2: no radius: Properties need"));
  EXPECT_THAT(error(replaced(xyz(), "pos:R:3", "poz:R:3")), HasSubstr(":2: Properties have no pos:R:3"));
  EXPECT_THAT(error(replaced(xyz(), "pos:R:3", "pos:R:2")), HasSubstr("Properties have no pos:R:3"));
  EXPECT_THAT(error(replaced(xyz(), "pos:R:3", "pos:R")), HasSubstr("must be name:type:columns"));
  EXPECT_THAT(error(replaced(xyz(), "pos:R:3", "pos:R:x")), HasSubstr("'pos' has 'x' columns"));
  EXPECT_THAT(error(replaced(xyz(), "pos:R:3", "pos:R:1e9")), HasSubstr("'pos' has '1e9' columns"));
  EXPECT_THAT(error(replaced(xyz(), "pos:R:3", "a:R:900:pos:R:3:b:R:900")),
              HasSubstr("more than 1000 columns"));
  EXPECT_THAT(error(replaced(xyz(), "12 Rock", "12")), HasSubstr(":5: grain 3 of 5: 9 values, Properties"));
  EXPECT_THAT(error(replaced(xyz(), "12 Rock 1 ", "12 Rock x ")), HasSubstr(":5: 'x' is no finite number"));
  EXPECT_THAT(error(replaced(xyz(), "5\n", "6\n")),
              HasSubstr("the file ends after 5 of 6 grains of frame 1"));
  EXPECT_THAT(error(replaced(xyz(), "5\n", "1e18\n")), HasSubstr("ends after 5 of 1e+18 grains"));
  EXPECT_THAT(error(replaced(xyz(), "5\n", "4\n")),
              HasSubstr(":7: '14 Rock 2 -1 1.5 0 nan 0 0.375 441.78646' is no number of grains"));
  EXPECT_THAT(error(replaced(xyz(), "12 Rock", "12 Rock Rock Rock")),
              HasSubstr(":5: grain 3 of 5: more values, Properties have 10"));
  std::string many = "1\nProperties=pos:R:3:radius:R:1";
  for (int k = 0; k < 997; ++k) many += ":a:R:1";  // 1001 columns
  EXPECT_THAT(error(many + "\n0 0 0 1\n"), HasSubstr(":2: Properties: more than 1000 columns"));
  EXPECT_THAT(error("-5\nProperties=pos:R:3:radius:R:1\n"), HasSubstr(":1: '-5' is no number of grains"));
  EXPECT_THAT(error("0\nProperties=pos:R:3:radius:R:1\n"), HasSubstr("has no grains"));
  EXPECT_THAT(error("5\n"), HasSubstr("the file ends after 0 of 5 grains"));
}

}  // namespace
}  // namespace scree
