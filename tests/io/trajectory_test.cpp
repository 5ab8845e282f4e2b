#include "sim/io/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace scree {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / ("scree_trajectory_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

Grain grain(std::int64_t id, Vec3 position, double diameter, int dump) {
  Grain out;
  out.id = id;
  out.position = position;
  out.velocity = Vec3::Zero();
  out.diameter = diameter;
  out.mass = 10.0 * static_cast<double>(id);
  out.dump = dump;
  return out;
}

/// Two dumps: grains 1 and 2, then grain 7.
std::vector<Grain> all_grains() {
  return {grain(1, {0, 0, 10}, 0.5, 1), grain(2, {1, 0, 10}, 0.25, 1), grain(7, {-2, 1, 12}, 1.0, 2)};
}

Snapshot frame(double time, std::vector<Grain> grains) {
  return {time, std::move(grains)};
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A file opened for reading, with what the tests ask of it.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Reader() { H5Fclose(file_); }
  std::vector<hsize_t> shape(const char* name) const {
    const hid_t set = H5Dopen2(file_, name, H5P_DEFAULT), space = H5Dget_space(set);
    std::vector<hsize_t> out(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, out.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return out;
  }
  std::vector<double> values(const char* name) const {
    std::size_t count = 1;
    for (const hsize_t n : shape(name)) count *= n;
    std::vector<double> out(count);
    const hid_t set = H5Dopen2(file_, name, H5P_DEFAULT);
    H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data());
    H5Dclose(set);
    return out;
  }
  std::string attribute(const char* object, const char* name) const {
    const hid_t made = H5Aopen_by_name(file_, object, name, H5P_DEFAULT, H5P_DEFAULT);
    if (made < 0) return "missing";
    const hid_t type = H5Aget_type(made);
    std::string out(H5Tget_size(type), '\0');
    H5Aread(made, type, out.data());
    H5Tclose(type);
    H5Aclose(made);
    return out.c_str();
  }
  std::vector<int> numbers(const char* object, const char* name, std::size_t count) const {
    std::vector<int> out(count);
    const hid_t made = H5Aopen_by_name(file_, object, name, H5P_DEFAULT, H5P_DEFAULT);
    H5Aread(made, H5T_NATIVE_INT, out.data());
    H5Aclose(made);
    return out;
  }
  bool has(const char* name) const { return H5Lexists(file_, name, H5P_DEFAULT) > 0; }

 private:
  hid_t file_;
};

/// Grain 7 not yet dumped in frame 0; grain 2 lost in frame 1.
void write_two_frames(TrajectoryWriter& writer) {
  Grain falling = grain(1, {0.5, 0, 9}, 0.5, 1);
  falling.velocity = {1, 0, -2};
  writer.write(frame(0.5, {falling, grain(2, {1, 0, 8}, 0.25, 1)}), 100);
  writer.write(frame(1.0, {grain(1, {1, 0, 8}, 0.5, 1), grain(7, {0, 1, 9}, 1.0, 2)}), 200);
}

TEST(Trajectory, KeepsOneRowAGrainForTheWholeFile) {
  const auto path = fresh_folder("rows") / "particles.h5";
  TrajectoryWriter writer(path, all_grains());
  write_two_frames(writer);
  writer.close();
  EXPECT_EQ(writer.frames(), 2);

  const Reader file(path);
  EXPECT_THAT(file.shape("particles/rock/position/value"), ElementsAre(2, 3, 3));
  EXPECT_THAT(file.shape("particles/rock/velocity/value"), ElementsAre(2, 3, 3));
  EXPECT_THAT(file.values("particles/rock/id"), ElementsAre(1, 2, 7));
  EXPECT_THAT(file.values("particles/rock/mass"), ElementsAre(10, 20, 70));
  EXPECT_THAT(file.values("particles/rock/dump"), ElementsAre(1, 1, 2));
  EXPECT_THAT(file.values("particles/rock/position/time"), ElementsAre(0.5, 1.0));
  EXPECT_THAT(file.values("particles/rock/velocity/step"), ElementsAre(100, 200));
  EXPECT_THAT(file.values("particles/rock/position/value"),
              ElementsAre(0.5, 0, 9, 1, 0, 8, -2, 1, 12,  // grain 7 waits at its future place
                          1, 0, 8, 1, 0, 8, 0, 1, 9));    // grain 2 stays at its last place
  EXPECT_THAT(file.values("particles/rock/diameter/value"), ElementsAre(0.5, 0.25, 0, 0.5, 0, 1));
  EXPECT_EQ(file.values("particles/rock/velocity/value")[2], -2);
}

// What is written after the state was saved is cut off, in all three files, and written again.
TEST(Trajectory, GoesOnFromWhereItWasSaved) {
  const auto whole = fresh_folder("whole") / "particles.h5", path = fresh_folder("resumed") / "particles.h5";
  const std::vector<Grain> base{grain(0, {0, 0, 0}, 2.0, 0)};
  {
    TrajectoryWriter writer(whole, all_grains(), base);
    write_two_frames(writer);
    writer.write(frame(1.5, {grain(7, {0, 1, 4}, 1.0, 2)}), 300);
  }
  std::string state;
  {
    TrajectoryWriter writer(path, all_grains(), base);
    write_two_frames(writer);
    StateWriter save(
        [&](const void* data, std::size_t size) { state.append(static_cast<const char*>(data), size); });
    writer.save(save);
    for (int k = 0; k < 40; ++k) writer.write(frame(2.0 + k, {grain(1, {9, 9, 9}, 0.5, 1)}), 400 + k);
  }
  for (int round = 0; round < 2; ++round) {  // and killed again at once
    std::size_t at = 0;
    StateReader load(
        [&](void* data, std::size_t size) {
          std::copy_n(state.data() + at, size, static_cast<char*>(data));
          at += size;
        },
        state.size());
    TrajectoryWriter writer(path, all_grains(), load);
    EXPECT_EQ(writer.frames(), 2);
    writer.write(frame(1.5, {grain(7, {0, 1, 4}, 1.0, 2)}), 300);
  }
  const Reader expected(whole), got(path);
  for (const char* name :
       {"position/value", "velocity/value", "diameter/value", "position/time", "position/step"}) {
    const std::string set = std::string("particles/rock/") + name;
    EXPECT_EQ(got.shape(set.c_str()), expected.shape(set.c_str())) << name;
    EXPECT_EQ(got.values(set.c_str()), expected.values(set.c_str())) << name;
  }
  for (const char* ending : {".xyz", ".xdmf"})
    EXPECT_EQ(text_of(std::filesystem::path(path).replace_extension(ending)),
              text_of(std::filesystem::path(whole).replace_extension(ending)));
  TrajectoryWriter::forget_saved(path);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".undo"));
}

TEST(Trajectory, FollowsTheH5mdLayout) {
  const auto path = fresh_folder("layout") / "particles.h5";
  TrajectoryWriter writer(path, all_grains(), {grain(0, {0, 0, 0}, 2.0, 0)},
                          {"A. Author", "9.9", "title: x", 10001});
  write_two_frames(writer);
  writer.close();

  const Reader file(path);
  EXPECT_THAT(file.numbers("h5md", "version", 2), ElementsAre(1, 1));
  EXPECT_EQ(file.attribute("h5md/author", "name"), "A. Author");
  EXPECT_EQ(file.attribute("h5md/creator", "version"), "9.9");
  EXPECT_EQ(file.numbers("particles/rock/box", "dimension", 1)[0], 3);
  EXPECT_EQ(file.attribute("particles/rock/box", "boundary"), "none");
  EXPECT_EQ(file.attribute("particles/rock/position/value", "unit"), "m");
  EXPECT_EQ(file.attribute("particles/rock/velocity/value", "unit"), "m s-1");
  EXPECT_EQ(file.attribute("particles/rock/diameter/time", "unit"), "s");
  EXPECT_EQ(file.attribute("particles/rock/mass", "unit"), "kg");
  EXPECT_THAT(file.values("particles/base/position"), ElementsAre(0, 0, 0));
  EXPECT_THAT(file.values("particles/base/diameter"), ElementsAre(2));
  EXPECT_THAT(file.values("parameters/seed"), ElementsAre(10001));
  EXPECT_TRUE(file.has("parameters/scenario"));
}

TEST(Trajectory, IsReadableWithoutClose) {
  const auto folder = fresh_folder("open");
  TrajectoryWriter writer(folder / "particles.h5", all_grains());
  write_two_frames(writer);
  // A copy of the bytes on disk is what a killed run leaves behind.
  std::filesystem::copy_file(folder / "particles.h5", folder / "copy.h5");
  EXPECT_THAT(Reader(folder / "copy.h5").shape("particles/rock/position/value"), ElementsAre(2, 3, 3));
  EXPECT_THAT(text_of(folder / "particles.xdmf"), HasSubstr("</Xdmf>"));
}

/// Opening and closing tags match in order; enough to catch a broken writer.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::string tag = xml.substr(at + 1, xml.find('>', at) - at - 1);
    if (tag.front() == '?' || tag.back() == '/') continue;
    if (tag.front() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    } else {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    }
  }
  return open.empty();
}

TEST(Trajectory, XdmfRefersToTheDataAsTheyAre) {
  const auto folder = fresh_folder("xdmf");
  TrajectoryWriter writer(folder / "particles.h5", all_grains(), {grain(0, {0, 0, 0}, 2.0, 0)});
  write_two_frames(writer);
  writer.close();

  const std::string xdmf = text_of(folder / "particles.xdmf");
  EXPECT_TRUE(well_formed(xdmf)) << xdmf;
  EXPECT_THAT(xdmf, HasSubstr("CollectionType=\"Temporal\""));
  EXPECT_THAT(xdmf, HasSubstr("<Time Value=\"0.5\"/>"));
  EXPECT_THAT(xdmf, HasSubstr("TopologyType=\"Polyvertex\" NumberOfElements=\"3\""));
  EXPECT_THAT(xdmf, HasSubstr("Dimensions=\"2 3 3\" NumberType=\"Float\" Precision=\"4\" "
                              "Format=\"HDF\">particles.h5:/particles/rock/position/value"));
  EXPECT_THAT(xdmf, HasSubstr("particles.h5:/particles/base/diameter"));
}

TEST(Trajectory, XyzHoldsTheGrainsInTheModelOnly) {
  const auto folder = fresh_folder("xyz");
  TrajectoryWriter writer(folder / "particles.h5", all_grains());
  write_two_frames(writer);
  writer.write(frame(1.5, {grain(1, {1, 0, 8}, 0.5, 1)}), 300);
  writer.close();

  std::istringstream lines(text_of(folder / "particles.xyz"));
  std::vector<int> counts;
  std::string line, last;
  while (std::getline(lines, line)) {
    counts.push_back(std::stoi(line));
    std::getline(lines, line);
    EXPECT_THAT(line, HasSubstr("Properties=species:S:1:pos:R:3:radius:R:1:id:I:1:dump:I:1:velo:R:3"));
    EXPECT_THAT(line, HasSubstr("pbc=\"F F F\""));
    for (int i = 0; i < counts.back(); ++i) ASSERT_TRUE(std::getline(lines, last));
  }
  EXPECT_THAT(counts, ElementsAre(2, 2, 1));
  EXPECT_EQ(last, "Rock 1 0 8 0.25 1 1 0 0 0");
}

TEST(Trajectory, SaysWhatIsWrong) {
  const auto folder = fresh_folder("errors");
  try {
    TrajectoryWriter writer(folder / "no_such_folder" / "particles.h5", all_grains());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("particles.h5: No such file or directory"));
  }
  EXPECT_THROW(TrajectoryWriter(folder / "a.h5", {}), std::invalid_argument);
  EXPECT_THROW(TrajectoryWriter(folder / "b.h5", {grain(1, {0, 0, 0}, 1, 1), grain(1, {0, 0, 0}, 1, 1)}),
               std::invalid_argument);
  TrajectoryWriter writer(folder / "c.h5", all_grains());
  EXPECT_THROW(writer.write(frame(0, {grain(99, {0, 0, 0}, 1, 1)}), 1), std::invalid_argument);
}

}  // namespace
}  // namespace scree
