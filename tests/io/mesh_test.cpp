#include "sim/io/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "scree_version.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const fs::path assets = SCREE_SOURCE_DIR "/assets/meshes";

/// Signed volume from triple products; positive when the faces look outwards.
double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  }
  return sum / 6;
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

Vec3 normal(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a).normalized();
}

void expect_box(const TriangleMesh& mesh, const Vec3& low, const Vec3& high) {
  const Eigen::AlignedBox3d box = bounds(mesh);
  // STL holds single precision.
  EXPECT_LT((box.min() - low).cwiseAbs().maxCoeff(), 1e-6 * high.norm());
  EXPECT_LT((box.max() - high).cwiseAbs().maxCoeff(), 1e-6 * high.norm());
}

/// The asset, without any complaint.
TriangleMesh asset(const std::string& name) {
  const LoadedMesh loaded = load_mesh(assets / (name + ".stl"));
  EXPECT_THAT(loaded.report.errors, IsEmpty());
  EXPECT_THAT(loaded.report.warnings, IsEmpty());
  EXPECT_TRUE(loaded.mesh.closed);
  EXPECT_EQ(loaded.mesh.name, name);
  return loaded.mesh;
}

/// Distances of the inner faces (those that look at the z axis) from that axis: all the same. Returns it.
double inner_radius(const TriangleMesh& mesh) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 n = normal(mesh, t);
    const double distance = -n.dot(mesh.vertices[t[0]]);
    if (std::abs(n.z()) > 0.1 || distance < 0) continue;
    low = std::min(low, distance);
    high = std::max(high, distance);
  }
  EXPECT_NEAR(low, high, 1e-6 * high);
  return low;
}

/// Area of the polygon of n sides around a circle.
double polygon_area(int n, double radius) {
  return n * std::tan(std::numbers::pi / n) * radius * radius;
}

/// A folder of its own for each test.
class MeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::path(::testing::TempDir()) / ("scree_mesh_" + std::to_string(getpid()) + "_" + info->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  fs::path write(const std::string& name, const TriangleMesh& mesh) const {
    write_stl(mesh, folder_ / name);
    return folder_ / name;
  }
  std::string bytes_of(const fs::path& file) const {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  fs::path folder_;
};

TriangleMesh cube() {
  return make_box(Vec3(-1, 0, 2), Vec3(1, 2, 4));
}  // 8 m^3

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const int first = static_cast<int>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return both;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

std::string ascii_stl(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "solid test\n";
  for (const auto& t : mesh.triangles) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (const int v : t) text << "  vertex " << mesh.vertices[v].transpose() << '\n';
    text << " endloop\nendfacet\n";
  }
  text << "endsolid test\n";
  return text.str();
}

std::string obj(const TriangleMesh& mesh) {
  std::ostringstream text;
  for (const Vec3& v : mesh.vertices) text << "v " << v.transpose() << '\n';
  for (const auto& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return text.str();
}

std::string ply(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) text << v.transpose() << '\n';
  for (const auto& t : mesh.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return text.str();
}

/// As glTF has it, whose y is up.
TriangleMesh y_up(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v = Vec3(v.x(), v.z(), -v.y());
  return mesh;
}

/// Positions as floats, then indices as 16 bit.
std::string gltf_buffer(const TriangleMesh& mesh) {
  std::string bytes;
  for (const Vec3& v : mesh.vertices) {
    const Eigen::Vector3f f = v.cast<float>();
    bytes.append(reinterpret_cast<const char*>(f.data()), 12);
  }
  for (const auto& t : mesh.triangles) {
    for (const int v : t) {
      const auto index = static_cast<std::uint16_t>(v);
      bytes.append(reinterpret_cast<const char*>(&index), 2);
    }
  }
  return bytes;
}

/// glTF 2.0 whose buffer has the key given ("\"uri\": ..., ", or nothing in GLB) and whose node has the
/// transform given.
std::string gltf(const TriangleMesh& mesh, const std::string& uri, const std::string& transform) {
  const std::size_t points = 12 * mesh.vertices.size(), indices = 6 * mesh.triangles.size();
  const Vec3 low = bounds(mesh).min(), high = bounds(mesh).max();
  std::ostringstream text;
  text
      << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{)" << transform
      << R"("mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{)"
      << uri << R"("byteLength": )" << points + indices
      << R"(}], "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": )" << points
      << R"(}, {"buffer": 0, "byteOffset": )" << points << R"(, "byteLength": )" << indices
      << R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )"
      << mesh.vertices.size() << R"(, "min": [)" << low.x() << ',' << low.y() << ',' << low.z()
      << R"(], "max": [)" << high.x() << ',' << high.y() << ',' << high.z()
      << R"(]}, {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": )"
      << 3 * mesh.triangles.size() << "}]}";
  return text.str();
}

std::string little_endian(std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  return std::string(reinterpret_cast<const char*>(&word), 4);
}

std::string glb(const TriangleMesh& mesh) {
  std::string json = gltf(mesh, "", ""), buffer = gltf_buffer(mesh);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  return "glTF" + little_endian(2) + little_endian(28 + json.size() + buffer.size()) +
         little_endian(json.size()) + "JSON" + json + little_endian(buffer.size()) + std::string("BIN\0", 4) +
         buffer;
}

void expect_cube(const LoadedMesh& loaded) {
  EXPECT_THAT(loaded.report.errors, IsEmpty());
  EXPECT_THAT(loaded.report.warnings, IsEmpty());
  EXPECT_EQ(loaded.mesh.vertices.size(), 8u);
  EXPECT_EQ(loaded.mesh.triangles.size(), 12u);
  EXPECT_TRUE(loaded.mesh.closed);
  if (loaded.mesh.vertices.size() == 8) {
    expect_box(loaded.mesh, Vec3(-1, 0, 2), Vec3(1, 2, 4));
    EXPECT_DOUBLE_EQ(volume(loaded.mesh), 8);
  }
}

void expect_error(const LoadedMesh& loaded, const fs::path& file, const std::string& part) {
  ASSERT_EQ(loaded.report.errors.size(), 1u);
  const std::string& text = loaded.report.errors[0];
  EXPECT_THAT(text, StartsWith(file.filename().string()));
  EXPECT_THAT(text, HasSubstr(part));
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

// ---------------------------------------------------------------- assets

TEST(MeshAssets, TruckBedHoldsItsLoadBox) {
  const TriangleMesh bed = asset("truck_bed");
  expect_box(bed, Vec3(-8.3, -4.3, -0.3), Vec3(0, 4.3, 4));
  EXPECT_NEAR(volume(bed), 8.3 * 8.6 * 4.3 - 8.0 * 8.0 * 4.0, 1e-4);  // outer box less the load box
  // Planes that look into the bed: x = -8, y = -4, y = 4, z = 0.
  for (const auto& [direction, offset] : {std::pair{Vec3(1, 0, 0), -8.0}, std::pair{Vec3(0, 1, 0), -4.0},
                                          std::pair{Vec3(0, -1, 0), -4.0}, std::pair{Vec3(0, 0, 1), 0.0}}) {
    double area = 0;
    for (const auto& t : bed.triangles) {
      const Vec3 &a = bed.vertices[t[0]], &b = bed.vertices[t[1]], &c = bed.vertices[t[2]];
      const bool in_plane = std::abs(a.dot(direction) - offset) < 1e-6;
      if (in_plane && normal(bed, t).dot(direction) > 0.999) area += (b - a).cross(c - a).norm() / 2;
    }
    EXPECT_NEAR(area, direction.z() == 1 ? 64.0 : 32.0, 1e-5);  // 8 x 8 m floor, 8 x 4 m walls
  }
}

TEST(MeshAssets, TruckGateCoversTheEndOfTheBed) {
  const TriangleMesh gate = asset("truck_gate");
  expect_box(gate, Vec3(0, -4.3, -0.3), Vec3(0.2, 4.3, 4));
  EXPECT_NEAR(volume(gate), 0.2 * 8.6 * 4.3, 1e-5);
}

TEST(MeshAssets, DozerBladeIsHollowTowardsItsPush) {
  const TriangleMesh blade = asset("dozer_blade");
  // Arc of radius 4 m over 30 degrees about (4, 0): height 4 sin 30 = 2 m, the back 4.2 sin 30 = 2.1 m.
  expect_box(blade, Vec3(-0.2, -4, 0), Vec3(4 - 4 * std::cos(std::numbers::pi / 6), 4, 2.1));
  const double step = std::numbers::pi / 6 / 12;
  EXPECT_NEAR(volume(blade), 8 * 12 * 0.5 * std::sin(step) * (4.2 * 4.2 - 4.0 * 4.0), 1e-4);
  const auto at_edge = std::count_if(blade.vertices.begin(), blade.vertices.end(), [](const Vec3& v) {
    return std::abs(v.x()) < 1e-6 && std::abs(v.z()) < 1e-6;
  });
  EXPECT_EQ(at_edge, 2);
}

TEST(MeshAssets, ReposeBucketIsATubeOfItsInnerDiameter) {
  const TriangleMesh bucket = asset("bucket_repose");
  EXPECT_NEAR(inner_radius(bucket), 0.35 / 2, 1e-7);
  EXPECT_NEAR(bounds(bucket).min().z(), 0, 1e-7);
  EXPECT_NEAR(bounds(bucket).max().z(), 0.60, 1e-7);
  EXPECT_NEAR(volume(bucket), (polygon_area(64, 0.180) - polygon_area(64, 0.175)) * 0.60, 1e-8);
  // A tube: V - E + F = 0 with E = 3 F / 2.
  EXPECT_EQ(2 * bucket.vertices.size(), bucket.triangles.size());
}

TEST(MeshAssets, SegregationBucketHasABottom) {
  const TriangleMesh bucket = asset("bucket_segregation");
  EXPECT_NEAR(inner_radius(bucket), 0.27 / 2, 1e-7);
  EXPECT_NEAR(bounds(bucket).min().z(), -0.005, 1e-7);
  EXPECT_NEAR(bounds(bucket).max().z(), 0.30, 1e-7);
  EXPECT_NEAR(volume(bucket), polygon_area(64, 0.140) * 0.305 - polygon_area(64, 0.135) * 0.30, 1e-8);
  // A sphere in topology: V - E + F = 2.
  EXPECT_EQ(2 * bucket.vertices.size(), bucket.triangles.size() + 4);
}

TEST(MeshAssets, FieldCylinderIsATubeOfItsInnerDiameter) {
  const TriangleMesh cylinder = asset("cylinder_field");
  EXPECT_NEAR(inner_radius(cylinder), 4.5, 1e-5);
  EXPECT_NEAR(bounds(cylinder).min().z(), 0, 1e-6);
  EXPECT_NEAR(bounds(cylinder).max().z(), 30, 1e-5);
  EXPECT_NEAR(volume(cylinder), (polygon_area(96, 4.8) - polygon_area(96, 4.5)) * 30, 1e-2);
  EXPECT_EQ(2 * cylinder.vertices.size(), cylinder.triangles.size());
}

// ---------------------------------------------------------------- formats

TEST_F(MeshFile, BoxIsClosedAndLooksOutwards) {
  EXPECT_TRUE(cube().closed);
  EXPECT_DOUBLE_EQ(volume(cube()), 8);
}

TEST_F(MeshFile, AllFormatsGiveTheSameCube) {
  const std::string uri = R"("uri": "cube.bin", )";
  write("cube.bin", gltf_buffer(y_up(cube())));
  expect_cube(load_mesh(write("binary.stl", cube())));
  expect_cube(load_mesh(write("ascii.stl", ascii_stl(cube()))));
  expect_cube(load_mesh(write("cube.obj", obj(cube()))));
  expect_cube(load_mesh(write("cube.ply", ply(cube()))));
  expect_cube(load_mesh(write("cube.gltf", gltf(y_up(cube()), uri, ""))));
  expect_cube(load_mesh(write("cube.glb", glb(y_up(cube())))));
  expect_cube(load_mesh(write("UPPER.STL", cube())));
}

TEST_F(MeshFile, QuadsBecomeTriangles) {
  std::string text = obj(cube());
  text.resize(text.find('f'));
  text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  expect_cube(load_mesh(write("cube.obj", text)));
}

TEST_F(MeshFile, NodeTransformsOfGltfAreApplied) {
  write("cube.bin", gltf_buffer(y_up(cube())));
  const std::string uri = R"("uri": "cube.bin", )";
  const LoadedMesh moved = load_mesh(
      write("moved.gltf", gltf(y_up(cube()), uri, R"("translation": [10, 0, 0], "scale": [2, 1, 1], )")));
  EXPECT_THAT(moved.report.errors, IsEmpty());
  expect_box(moved.mesh, Vec3(8, 0, 2), Vec3(12, 2, 4));
  // A mirror image still looks outwards, and nothing had to be repaired.
  const LoadedMesh mirrored =
      load_mesh(write("mirror.gltf", gltf(y_up(cube()), uri, R"("scale": [-1, 1, 1], )")));
  EXPECT_THAT(mirrored.report.warnings, IsEmpty());
  EXPECT_DOUBLE_EQ(volume(mirrored.mesh), 8);
}

// glTF 2.0 defines y as up (section 3.4): a box 1 wide (x), 2 high (y) and 3 deep (z), which a node raises
// by 5.
TEST_F(MeshFile, GltfStandsUpright) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3});
  write("box.bin", gltf_buffer(box));
  const LoadedMesh loaded =
      load_mesh(write("box.gltf", gltf(box, R"("uri": "box.bin", )", R"("translation": [0, 5, 0], )")));
  EXPECT_THAT(loaded.report.errors, IsEmpty());
  expect_box(loaded.mesh, Vec3(0, -3, 5), Vec3(1, 0, 7));
  EXPECT_NEAR(volume(loaded.mesh), 6, 1e-5);
  expect_box(load_mesh(write("box.glb", glb(box))).mesh, Vec3(0, -3, 0), Vec3(1, 0, 2));
}

TEST_F(MeshFile, ScaleIsMetresPerUnit) {
  const LoadedMesh loaded = load_mesh(write("cube.stl", cube()), 0.5);
  expect_box(loaded.mesh, Vec3(-0.5, 0, 1), Vec3(0.5, 1, 2));
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    expect_error(load_mesh(folder_ / "cube.stl", bad), "cube.stl", "mesh_scale must be a positive number");
  }
}

TEST_F(MeshFile, WhatIsWrittenIsReadBack) {
  const TriangleMesh first = load_mesh(write("cube.stl", cube())).mesh;
  const TriangleMesh second = load_mesh(write("again.stl", first)).mesh;
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_THROW(write_stl(first, folder_ / "no_folder" / "cube.stl"), std::runtime_error);
}

// ---------------------------------------------------------------- repairs and warnings

TEST_F(MeshFile, CornersWithinTheToleranceAreWelded) {
  TriangleMesh soup;  // every face with corners of its own, off by some 1e-9 of the size
  std::mt19937 random(1);
  for (const auto& t : cube().triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int v : t) {
      const double jitter = 1e-9 * static_cast<double>(random() % 100) / 100;
      soup.vertices.push_back(cube().vertices[v] - Vec3(0, 1, 3) + Vec3(jitter, -jitter, jitter));
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  // The low corner moves to the origin, where single precision keeps the jitter.
  for (Vec3& v : soup.vertices) v += Vec3(1, 1, 1);
  const LoadedMesh loaded = load_mesh(write("soup.stl", soup));
  EXPECT_EQ(loaded.mesh.vertices.size(), 8u);
  EXPECT_TRUE(loaded.mesh.closed);
  EXPECT_THAT(loaded.report.warnings, IsEmpty());
}

TEST_F(MeshFile, CornersBeyondTheToleranceStayApart) {
  TriangleMesh slit = cube();
  slit.vertices.push_back(slit.vertices[0] + Vec3(1e-5, 0, 0));  // 3e-6 of the diagonal
  slit.triangles[0][0] = 8;
  const LoadedMesh loaded = load_mesh(write("slit.stl", slit));
  EXPECT_EQ(loaded.mesh.vertices.size(), 9u);
  EXPECT_FALSE(loaded.mesh.closed);
}

TEST_F(MeshFile, HolesAreTold) {
  TriangleMesh open = cube();
  open.triangles.erase(open.triangles.begin() + 2, open.triangles.begin() + 4);  // the top, z = 4
  const LoadedMesh loaded = load_mesh(write("open.stl", open));
  EXPECT_THAT(loaded.report.errors, IsEmpty());
  EXPECT_FALSE(loaded.mesh.closed);
  ASSERT_EQ(loaded.report.warnings.size(), 1u);
  EXPECT_THAT(loaded.report.warnings[0], StartsWith("open.stl: 4 open edges, the first from ("));
  EXPECT_THAT(loaded.report.warnings[0], HasSubstr(", 4) m: the mesh has holes"));
}

TEST_F(MeshFile, FacesWithoutAreaAreDropped) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));
  mesh.triangles.push_back({0, 1, 8});  // three corners on a line
  const LoadedMesh loaded = load_mesh(write("slivers.stl", mesh));
  EXPECT_THAT(loaded.report.warnings, ElementsAre("slivers.stl: 3 faces without area dropped"));
  EXPECT_TRUE(loaded.mesh.closed);
  EXPECT_EQ(loaded.mesh.vertices.size(), 8u);
  EXPECT_EQ(loaded.mesh.triangles.size(), 12u);
}

TEST_F(MeshFile, OnlyFacesWithoutAreaIsAnError) {
  TriangleMesh mesh = cube();
  mesh.triangles = {{0, 0, 1}};
  expect_error(load_mesh(write("line.stl", mesh)), "line.stl", "no triangles with an area");
}

TEST_F(MeshFile, ATurnedFaceIsTurnedBack) {
  TriangleMesh mesh = cube();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const LoadedMesh loaded = load_mesh(write("mixed.stl", mesh));
  EXPECT_THAT(loaded.report.warnings,
              ElementsAre("mixed.stl: 2 faces turned: orientation other than that of the neighbours"));
  EXPECT_TRUE(loaded.mesh.closed);
  EXPECT_DOUBLE_EQ(volume(loaded.mesh), 8);
}

TEST_F(MeshFile, AMeshInsideOutIsTurned) {
  const LoadedMesh loaded = load_mesh(write("inside_out.stl", inside_out(cube())));
  EXPECT_THAT(loaded.report.warnings,
              ElementsAre("inside_out.stl: 1 closed part turned: its faces looked inwards"));
  EXPECT_TRUE(loaded.mesh.closed);
  EXPECT_DOUBLE_EQ(volume(loaded.mesh), 8);
}

TEST_F(MeshFile, EachPartIsTurnedOnItsOwn) {
  const TriangleMesh small = make_box(Vec3(5, 0, 0), Vec3(6, 1, 1));  // 1 m^3
  const LoadedMesh small_wrong = load_mesh(write("a.stl", joined(cube(), inside_out(small))));
  EXPECT_THAT(small_wrong.report.warnings,
              ElementsAre("a.stl: 1 closed part turned: its faces looked inwards"));
  EXPECT_DOUBLE_EQ(volume(small_wrong.mesh), 9);
  const LoadedMesh large_wrong = load_mesh(write("b.stl", joined(inside_out(cube()), small)));
  EXPECT_THAT(large_wrong.report.warnings,
              ElementsAre("b.stl: 1 closed part turned: its faces looked inwards"));
  EXPECT_DOUBLE_EQ(volume(large_wrong.mesh), 9);
}

TEST_F(MeshFile, AHollowStaysAHollow) {
  const TriangleMesh core = make_box(Vec3(-0.5, 0.5, 2.5), Vec3(0.5, 1.5, 3.5));  // 1 m^3 within the cube
  const TriangleMesh shell = joined(cube(), inside_out(core));
  const LoadedMesh right = load_mesh(write("shell.stl", shell));
  EXPECT_THAT(right.report.warnings, IsEmpty());
  EXPECT_DOUBLE_EQ(volume(right.mesh), 7);
  EXPECT_TRUE(right.mesh.closed);
  const LoadedMesh wrong = load_mesh(write("shell_wrong.stl", inside_out(shell)));
  EXPECT_EQ(wrong.report.warnings.size(), 1u);
  EXPECT_DOUBLE_EQ(volume(wrong.mesh), 7);
}

TEST_F(MeshFile, EdgesOfThreeFacesAreTold) {
  TriangleMesh mesh = cube();
  mesh.vertices.push_back(Vec3(0, -1, 1));
  mesh.triangles.push_back({0, 1, 8});  // a fin on an edge of the cube
  const LoadedMesh loaded = load_mesh(write("fin.stl", mesh));
  EXPECT_FALSE(loaded.mesh.closed);
  ASSERT_EQ(loaded.report.warnings.size(), 2u);
  EXPECT_THAT(loaded.report.warnings[0], StartsWith("fin.stl: 2 open edges"));
  EXPECT_THAT(loaded.report.warnings[1],
              StartsWith("fin.stl: 1 edge shared by three or more faces, the first from ("));
}

TEST_F(MeshFile, AOneSidedSurfaceIsTold) {
  TriangleMesh strip;  // Moebius strip of five triangles on five vertices
  for (int i = 0; i < 5; ++i) {
    const double a = 2 * std::numbers::pi * i / 5;
    strip.vertices.emplace_back(std::cos(a), std::sin(a), 0.1 * i);
    strip.triangles.push_back({i, (i + 1) % 5, (i + 2) % 5});
  }
  const LoadedMesh loaded = load_mesh(write("strip.stl", strip));
  EXPECT_FALSE(loaded.mesh.closed);
  ASSERT_FALSE(loaded.report.warnings.empty());
  EXPECT_THAT(loaded.report.warnings.back(), StartsWith("strip.stl: one-sided surface"));
}

// ---------------------------------------------------------------- errors

TEST_F(MeshFile, VerticesMustBeFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    TriangleMesh mesh = cube();
    mesh.vertices[3].y() = bad;
    expect_error(load_mesh(write("nan.stl", mesh)), "nan.stl", "vertices not finite");
  }
}

TEST_F(MeshFile, MillimetresReadAsMetresAreNamed) {
  const fs::path file = write("truck_bed.stl", make_box(Vec3::Zero(), Vec3(8000, 8000, 4000)));
  EXPECT_THAT(
      load_mesh(file).report.errors,
      ElementsAre(
          "truck_bed.stl is 8000 m long, more than 1000 m: millimetres read as metres? set mesh_scale: "
          "0.001"));
  EXPECT_THAT(load_mesh(file, 0.001).report.errors, IsEmpty());
  EXPECT_THAT(load_mesh(file, 1, 8000).report.errors, IsEmpty());
  expect_error(load_mesh(file, 1000), file, "check its unit and set mesh_scale");
}

TEST_F(MeshFile, BelowAMillimetreIsAnError) {
  const fs::path file = write("bucket.stl", make_box(Vec3::Zero(), Vec3(0.25, 0.25, 0.5)));
  EXPECT_THAT(
      load_mesh(file, 0.001).report.errors,
      ElementsAre(
          "bucket.stl is 0.0005 m long, less than 0.001 m: metres read as millimetres? set mesh_scale: 1"));
}

TEST_F(MeshFile, MissingEmptyAndForeignFilesAreErrors) {
  expect_error(load_mesh(folder_ / "none.stl"), "none.stl", "no such file");
  expect_error(load_mesh(write("empty.stl", "")), "empty.stl", "is empty");
  expect_error(load_mesh(write("empty.obj", "")), "empty.obj", "is empty");
  expect_error(load_mesh(write("bed.fbx", "x")), "bed.fbx", "not one of .stl, .obj, .ply, .gltf, .glb");
  expect_error(load_mesh(write("bed", "x")), "bed", "not one of .stl, .obj, .ply, .gltf, .glb");
  fs::create_directories(folder_ / "folder.stl");
  expect_error(load_mesh(folder_ / "folder.stl"), "folder.stl", "is not a file");
  const fs::path huge = write("huge.stl", "x");
  fs::resize_file(huge, 500'000'001);  // sparse
  expect_error(load_mesh(huge), huge, "more than 500 MB");
}

TEST_F(MeshFile, TextAndCutFilesAreNotStl) {
  expect_error(load_mesh(write("note.stl", "hello")), "note.stl", "is not an STL file");
  expect_error(load_mesh(write("letter.stl", std::string(300, 'x'))), "letter.stl", "is not an STL file");
  expect_error(load_mesh(write("solid.stl", "solid state physics, a story without triangles")), "solid.stl",
               "");
  const std::string whole = bytes_of(write("cube.stl", cube()));
  for (const std::size_t length : {40u, 84u, 100u, 134u, 683u}) {
    expect_error(load_mesh(write("cut.stl", whole.substr(0, length))), "cut.stl", "is not an STL file");
  }
  // 85899346 * 50 overflows 32 bits to 4: the length must not be reckoned in them.
  std::string overflow = whole.substr(0, 88);
  const std::uint32_t count = 85899346;
  overflow.replace(80, 4, reinterpret_cast<const char*>(&count), 4);
  expect_error(load_mesh(write("overflow.stl", overflow)), "overflow.stl", "announces 85899346 triangles");
}

TEST_F(MeshFile, CutPlyFilesAreErrors) {
  const std::string whole = ply(cube());
  const std::size_t body = whole.find("end_header");
  expect_error(load_mesh(write("head.ply", whole.substr(0, body))), "head.ply", "its header does not end");
  expect_error(load_mesh(write("body.ply", whole.substr(0, body + 40))), "body.ply",
               "announces 20 lines of data");
  std::string binary = whole.substr(0, body) + "end_header\n" + gltf_buffer(cube()).substr(0, 96);
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  // The corners are there, of 12 faces not even the byte that says how many corners each has.
  expect_error(load_mesh(write("binary.ply", binary)), "binary.ply",
               "announces at least 12 more bytes of data and has 0");
}

TEST_F(MeshFile, OnlyTheFormatOfTheExtensionIsTried) {
  const std::string contents[] = {bytes_of(write("cube.stl", cube())), obj(cube()), ply(cube()),
                                  glb(y_up(cube()))};
  const std::string extensions[] = {"stl", "obj", "ply", "glb"};
  for (int content = 0; content < 4; ++content) {
    for (int name = 0; name < 4; ++name) {
      const std::string file = "renamed." + extensions[name];
      const LoadedMesh loaded = load_mesh(write(file, contents[content]));
      if (content == name) {
        expect_cube(loaded);
      } else {
        expect_error(loaded, file, "");
      }
    }
  }
  // A format that assimp knows by its content, under an allowed name.
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string& extension : extensions) {
    expect_error(load_mesh(write("off." + extension, off)), "off." + extension, "");
  }
}

TEST_F(MeshFile, FacesOfVerticesThatAreNotThereAreErrors) {
  expect_error(load_mesh(write("far.obj", obj(cube()) + "f 1 2 99\n")), "far.obj", "cannot be read as obj");
  TriangleMesh mesh = cube();
  mesh.triangles[0][0] = 99;
  expect_error(load_mesh(write("far.ply", ply(mesh))), "far.ply", "cannot be read as ply");
  // assimp leaves such faces of glTF out; the hole that stays is told.
  const LoadedMesh far = load_mesh(write("far.glb", glb(mesh)));
  EXPECT_FALSE(far.mesh.closed);
  ASSERT_EQ(far.report.warnings.size(), 1u);
  EXPECT_THAT(far.report.warnings[0], HasSubstr("3 open edges"));
}

TEST_F(MeshFile, DamagedFilesNeverThrow) {
  const std::pair<std::string, std::string> files[] = {{"a.stl", ascii_stl(cube())},
                                                       {"b.stl", bytes_of(write("b.stl", cube()))},
                                                       {"c.obj", obj(cube())},
                                                       {"d.ply", ply(cube())},
                                                       {"e.glb", glb(cube())}};
  std::mt19937 random(7);
  for (const auto& [name, whole] : files) {
    for (int round = 0; round < 40; ++round) {
      std::string damaged = whole.substr(0, round % 2 ? whole.size() : random() % whole.size());
      for (int k = 0; k < 3 && !damaged.empty(); ++k)
        damaged[random() % damaged.size()] = static_cast<char>(random());
      EXPECT_NO_THROW(load_mesh(write(name, damaged)));
    }
  }
}

TEST(MeshEdges, UpdateClosedSeesHolesAndDirections) {
  TriangleMesh mesh = cube();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_FALSE(update_closed(mesh));
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_TRUE(update_closed(mesh));
  mesh.triangles.pop_back();
  EXPECT_FALSE(update_closed(mesh));
  TriangleMesh nothing;
  EXPECT_FALSE(update_closed(nothing));
}

}  // namespace
}  // namespace scree
