#include "sim/io/mesh.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

#include "sim/io/mesh_orient.h"
#include "sim/io/ply_check.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_file_bytes = 500'000'000;
constexpr double min_size = 1e-3;               // m
constexpr double weld_tolerance = 1e-7;         // of the diagonal of the bounding box
constexpr std::size_t stl_header_bytes = 84;    // 80 of text, 4 of the number of triangles
constexpr std::size_t stl_triangle_bytes = 50;  // normal and corners as 12 floats, 2 bytes of attributes
constexpr std::size_t glb_header_bytes = 12;    // magic, version, length of all
constexpr std::size_t glb_chunk_bytes = 8;      // length and kind of a chunk, before its content
constexpr std::size_t max_glb_chunks = 1000;    // a file has two, and those of extensions
constexpr const char* allowed_extensions[] = {"stl", "obj", "ply", "gltf", "glb"};

std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string extension_of(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  return extension.empty() ? extension : extension.substr(1);
}

std::string counted(std::size_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string without_full_stop(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

/// Why a file must not be given to the reader at all, or nothing.
std::optional<std::string> refusal(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return fmt::format("no such file ({})", file.string());
  if (!fs::is_regular_file(status)) return "is not a file";
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return fmt::format("cannot be read ({})", error.message());
  if (size == 0) return "is empty";
  if (size > max_file_bytes) {
    return fmt::format("is {} MB, more than {} MB: reduce the number of triangles", size / 1'000'000,
                       max_file_bytes / 1'000'000);
  }
  return std::nullopt;
}

/// A binary STL must have exactly the length that its header announces; a reader that trusts the header
/// would read past the end.
std::optional<std::string> stl_refusal(const fs::path& file) {
  char header[stl_header_bytes] = {};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return "cannot be opened";
  stream.read(header, sizeof header);
  const auto got = static_cast<std::size_t>(stream.gcount());
  const std::uintmax_t size = fs::file_size(file);
  std::uint32_t announced = 0;
  std::memcpy(&announced, header + 80, sizeof announced);
  if (got == sizeof header && stl_header_bytes + stl_triangle_bytes * std::uintmax_t{announced} == size) {
    return std::nullopt;
  }
  const std::string text = lower(std::string(header, got));
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start != std::string::npos && text.compare(start, 5, "solid") == 0 &&
      std::memchr(header, 0, got) == nullptr) {
    return std::nullopt;  // an ASCII STL, as far as the start tells
  }
  if (got < sizeof header) return "is not an STL file: too short";
  return fmt::format("is not an STL file, or cut short: it announces {} and has room for {}",
                     counted(announced, "triangle"), (size - stl_header_bytes) / stl_triangle_bytes);
}

/// A binary glTF must hold the chunks that it announces: a reader makes room for what a chunk says of itself.
/// Khronos Group, glTF 2.0 specification, section 4.4.
std::optional<std::string> glb_refusal(const fs::path& file) {
  const std::uintmax_t size = fs::file_size(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return "cannot be opened";
  std::uint32_t header[3] = {}, chunk[2] = {};
  stream.read(reinterpret_cast<char*>(header), sizeof header);
  if (!stream || std::memcmp(header, "glTF", 4) != 0) return "is not a GLB file";
  if (header[1] != 2) return fmt::format("is GLB of version {}, not 2", header[1]);
  if (header[2] > size) return fmt::format("is cut short: it announces {} bytes and has {}", header[2], size);
  if (header[2] < glb_header_bytes + glb_chunk_bytes) return "is not a GLB file: it announces no chunk";
  std::size_t chunks = 0;
  for (std::uintmax_t at = glb_header_bytes; at < header[2]; at += glb_chunk_bytes + chunk[0]) {
    if (++chunks > max_glb_chunks) return fmt::format("has more than {} chunks", max_glb_chunks);
    if (at + glb_chunk_bytes > header[2]) return "is not a GLB file, or cut short: it ends within a chunk";
    stream.seekg(static_cast<std::streamoff>(at));
    stream.read(reinterpret_cast<char*>(chunk), sizeof chunk);
    if (!stream) return "cannot be read";
    if (at + glb_chunk_bytes + chunk[0] > header[2])
      return fmt::format(
          "is not a GLB file, or cut short: the chunk at byte {} announces {} bytes, more than follow", at,
          chunk[0]);
    if (chunk[0] % 4 != 0)
      return fmt::format("is not a GLB file: the chunk at byte {} has {} bytes, no multiple of 4", at,
                         chunk[0]);
  }
  return std::nullopt;
}

/// Opens what the mesh file refers to (buffers of glTF, materials of OBJ) under the rules for the mesh file.
class CheckedFiles : public Assimp::DefaultIOSystem {
 public:
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (std::strchr(mode, 'r') == nullptr || refusal(file)) return nullptr;
    return DefaultIOSystem::Open(file, mode);
  }
};

bool reads(const aiImporterDesc& importer, const std::string& extension) {
  std::istringstream list(importer.mFileExtensions);
  for (std::string word; list >> word;) {
    if (lower(word) == extension) return true;
  }
  return false;
}

/// assimp looks into a file when its extension does not fit; without the other importers it cannot read
/// another format than the one the name says.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    if (description != nullptr && reads(*description, extension)) continue;
    Assimp::BaseImporter* other = importer.GetImporter(i);
    if (importer.UnregisterLoader(other) == aiReturn_SUCCESS) {
      std::unique_ptr<Assimp::BaseImporter> owned(other);  // unregistering hands the importer over
    }
  }
}

using Transform = Eigen::Matrix4d;

Transform to_eigen(const aiMatrix4x4& m) {
  Transform t;
  t << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return t;
}

/// From the axes of a format to ours, z up. glTF defines +y as up (Khronos Group, glTF 2.0 specification,
/// section 3.4); the others define nothing and are taken as they stand.
Transform to_z_up(const std::string& extension) {
  Transform t = Transform::Identity();
  if (extension == "gltf" || extension == "glb") t.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return t;
}

/// Appends the triangles of a node and its children; returns how many points and lines it left out.
std::size_t collect(const aiScene& scene, const aiNode& node, const Transform& parent, TriangleMesh& mesh) {
  const Transform transform = parent * to_eigen(node.mTransformation);
  const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0;
  std::size_t left_out = 0;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& source = *scene.mMeshes[node.mMeshes[m]];
    const int first = static_cast<int>(mesh.vertices.size());
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiVector3D& p = source.mVertices[v];
      mesh.vertices.push_back((transform * Eigen::Vector4d(p.x, p.y, p.z, 1)).head<3>());
    }
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) {
        ++left_out;
        continue;
      }
      std::array<int, 3> triangle;
      for (int i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= source.mNumVertices)
          throw std::runtime_error("a face names a vertex that is not there");
        triangle[i] = first + static_cast<int>(face.mIndices[i]);
      }
      if (mirrored) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) {
    left_out += collect(scene, *node.mChildren[c], transform, mesh);
  }
  return left_out;
}

/// Whether a face has more than three vertices; throws when one has none.
bool has_polygons(const aiScene& scene) {
  bool found = false;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f) {
      const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices;
      if (corners == 0) throw std::runtime_error("a face has no vertices");
      found = found || corners > 3;
    }
  }
  return found;
}

/// Reads the file as it stands; throws std::exception with the reason.
std::size_t read_with_assimp(const fs::path& file, const std::string& extension, TriangleMesh& mesh) {
  Assimp::Importer importer;
  importer.SetIOHandler(new CheckedFiles);  // owned by the importer from here on
  keep_only(importer, extension);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
  // Faces without vertices would abort the program in assimp's triangulation.
  if (scene != nullptr && has_polygons(*scene)) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) {
    const std::string words = importer.GetErrorString();
    // Of the machine, not of the file, whose words other messages quote.
    if (words == "std::bad_alloc" || words == "std::exception: std::bad_alloc") throw std::bad_alloc();
    throw std::runtime_error(words);
  }
  if (scene->mRootNode == nullptr) return 0;
  return collect(*scene, *scene->mRootNode, to_z_up(extension), mesh);
}

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

/// Keeps the order of those that stay.
void drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> place(mesh.vertices.size(), -1);
  for (const auto& triangle : mesh.triangles) {
    for (const int vertex : triangle) place[vertex] = 0;
  }
  int kept = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < 0) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    place[i] = kept++;
  }
  mesh.vertices.resize(kept);
  for (auto& triangle : mesh.triangles) {
    for (int& vertex : triangle) vertex = place[vertex];
  }
}

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t c : cell) {
      h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 32;
    }
    return h;
  }
};

/// Gives vertices of bit-equal coordinates one number. The first of the file stays.
void weld_equal(TriangleMesh& mesh) {
  std::unordered_map<Cell, int, CellHash> seen;
  std::vector<int> target(mesh.vertices.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    const Vec3 position = mesh.vertices[i] + Vec3::Zero();  // -0 becomes 0
    mesh.vertices[i] = position;
    Cell key;
    std::memcpy(key.data(), position.data(), sizeof key);
    target[i] = seen.try_emplace(key, static_cast<int>(i)).first->second;
  }
  for (auto& triangle : mesh.triangles) {
    for (int& vertex : triangle) vertex = target[vertex];
  }
  drop_unused_vertices(mesh);
}

/// Moves each vertex onto the first earlier one within `tolerance`. A grid of cells of that size finds it.
void weld_near(TriangleMesh& mesh, double tolerance) {
  if (!(tolerance > 0)) return;
  const Vec3 low = bounding_box(mesh).min();
  std::unordered_map<Cell, int, CellHash> newest;  // last kept vertex of a cell
  std::vector<int> previous(mesh.vertices.size(), -1), target(mesh.vertices.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    const Vec3 scaled = (mesh.vertices[i] - low) / tolerance;
    Cell home;
    for (int k = 0; k < 3; ++k) home[k] = static_cast<std::int64_t>(std::floor(scaled[k]));
    int found = static_cast<int>(i);
    for (int n = 0; n < 27; ++n) {
      const auto entry = newest.find({home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1});
      if (entry == newest.end()) continue;
      for (int other = entry->second; other >= 0; other = previous[other]) {
        const bool near = (mesh.vertices[other] - mesh.vertices[i]).squaredNorm() <= tolerance * tolerance;
        if (near) found = std::min(found, other);
      }
    }
    target[i] = found;
    if (found == static_cast<int>(i)) {
      const auto [entry, fresh] = newest.try_emplace(home, found);
      if (!fresh) {
        previous[i] = entry->second;
        entry->second = found;
      }
    }
  }
  for (auto& triangle : mesh.triangles) {
    for (int& vertex : triangle) vertex = target[vertex];
  }
  drop_unused_vertices(mesh);
}

/// A face has no area when its height over its longest side is below the welding tolerance.
std::size_t drop_zero_area(TriangleMesh& mesh, double tolerance) {
  const std::size_t before = mesh.triangles.size();
  std::erase_if(mesh.triangles, [&](const std::array<int, 3>& t) {
    const Vec3 ab = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Vec3 ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
    return ab.cross(ac).norm() <= tolerance * longest;
  });
  drop_unused_vertices(mesh);
  return before - mesh.triangles.size();
}

/// What is wrong with the size, and the scale that would mend it.
std::optional<std::string> size_complaint(double size, double scale, double max_size) {
  if (size > max_size) {
    const std::string fact = fmt::format("is {:.6g} m long, more than {:.6g} m", size, max_size);
    if (1e-3 * size > max_size) return fmt::format("{}: check its unit and set mesh_scale", fact);
    return fmt::format("{}: millimetres read as metres? set mesh_scale: {:.6g}", fact, 1e-3 * scale);
  }
  if (size < min_size) {
    const std::string fact = fmt::format("is {:.6g} m long, less than {:.6g} m", size, min_size);
    if (1e3 * size < min_size || 1e3 * size > max_size) {
      return fmt::format("{}: check its unit and set mesh_scale", fact);
    }
    return fmt::format("{}: metres read as millimetres? set mesh_scale: {:.6g}", fact, 1e3 * scale);
  }
  return std::nullopt;
}

std::string edge_text(const TriangleMesh& mesh, const std::array<int, 2>& edge) {
  const Vec3 &a = mesh.vertices[edge[0]], &b = mesh.vertices[edge[1]];
  return fmt::format("from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) m", a.x(), a.y(), a.z(),
                     b.x(), b.y(), b.z());
}

void report_edges(const TriangleMesh& mesh, const EdgeFindings& found, const std::string& name,
                  MeshReport& report) {
  auto warn = [&](const std::string& text) { report.warnings.push_back(name + ": " + text); };
  if (found.turned_faces > 0) {
    warn(counted(found.turned_faces, "face") + " turned: orientation other than that of the neighbours");
  }
  if (found.turned_parts > 0) {
    warn(counted(found.turned_parts, "closed part") + " turned: its faces looked inwards");
  }
  if (found.open_edges > 0) {
    warn(counted(found.open_edges, "open edge") + ", the first " + edge_text(mesh, found.first_open) +
         ": the mesh has holes, both sides of its faces push");
  }
  if (found.crowded_edges > 0) {
    warn(counted(found.crowded_edges, "edge") + " shared by three or more faces, the first " +
         edge_text(mesh, found.first_crowded) + ": the mesh bounds no solid, both sides of its faces push");
  }
  if (found.twisted_edges > 0) {
    warn("one-sided surface, its faces cannot agree along " + counted(found.twisted_edges, "edge") +
         ", the first " + edge_text(mesh, found.first_twisted) + ": both sides of its faces push");
  }
}

}  // namespace

LoadedMesh load_mesh(const fs::path& file, double scale, double max_size) {
  LoadedMesh result;
  TriangleMesh& mesh = result.mesh;
  mesh.name = file.stem().string();
  const std::string name = file.filename().string();
  auto fail = [&](const std::string& text) {
    result.report.errors.push_back(name + text);
    return result;
  };

  const std::string extension = extension_of(file);
  if (std::find(std::begin(allowed_extensions), std::end(allowed_extensions), extension) ==
      std::end(allowed_extensions)) {
    return fail(": extension is not one of .stl, .obj, .ply, .gltf, .glb");
  }
  if (!std::isfinite(scale) || scale <= 0) {
    return fail(fmt::format(": mesh_scale must be a positive number, not {:.6g}", scale));
  }
  if (const auto complaint = refusal(file)) return fail(": " + *complaint);
  if (extension == "stl") {
    if (const auto complaint = stl_refusal(file)) return fail(": " + *complaint);
  }
  if (extension == "ply") {
    if (const auto complaint = ply_complaint(file)) return fail(": " + *complaint);
  } else if (extension == "glb") {
    if (const auto complaint = glb_refusal(file)) return fail(": " + *complaint);
  }

  std::size_t left_out = 0;
  try {
    left_out = read_with_assimp(file, extension, mesh);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return fail(fmt::format(": cannot be read as {} ({})", extension, without_full_stop(error.what())));
  }
  for (Vec3& vertex : mesh.vertices) vertex *= scale;
  drop_unused_vertices(mesh);
  if (mesh.triangles.empty()) return fail(": has no triangles");
  const auto bad =
      std::count_if(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3& v) { return !v.allFinite(); });
  if (bad > 0)
    return fail(fmt::format(": {} of {} vertices not finite (nan or inf)", bad, mesh.vertices.size()));
  if (const auto complaint = size_complaint(bounding_box(mesh).sizes().maxCoeff(), scale, max_size)) {
    return fail(" " + *complaint);
  }

  if (left_out > 0) {
    result.report.warnings.push_back(name + ": " + counted(left_out, "element") +
                                     " ignored: points and lines bound nothing");
  }
  weld_equal(mesh);
  const double tolerance = weld_tolerance * bounding_box(mesh).diagonal().norm();
  weld_near(mesh, tolerance);
  if (const std::size_t dropped = drop_zero_area(mesh, tolerance); dropped > 0) {
    result.report.warnings.push_back(name + ": " + counted(dropped, "face") + " without area dropped");
  }
  if (mesh.triangles.empty()) return fail(": has no triangles with an area");
  report_edges(mesh, orient_faces(mesh), name, result.report);
  update_closed(mesh);
  return result;
}

TriangleMesh make_box(const Vec3& low, const Vec3& high) {
  assert((low.array() < high.array()).all());
  TriangleMesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {  // bit k of the number: high side of axis k
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                               i & 4 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  update_closed(mesh);
  return mesh;
}

void write_stl(const TriangleMesh& mesh, const fs::path& file) {
  std::string bytes(stl_header_bytes, '\0');
  const std::string title = "scree " + mesh.name;  // must not start with "solid", the mark of ASCII STL
  std::copy_n(title.begin(), std::min<std::size_t>(title.size(), 80), bytes.begin());
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(bytes.data() + 80, &count, sizeof count);
  bytes.reserve(stl_header_bytes + stl_triangle_bytes * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &pa = mesh.vertices[a], &pb = mesh.vertices[b], &pc = mesh.vertices[c];
    const Vec3 normal = (pb - pa).cross(pc - pa).normalized();
    for (const Vec3& vector : {normal, pa, pb, pc}) {
      const Eigen::Vector3f rounded = vector.cast<float>();
      bytes.append(reinterpret_cast<const char*>(rounded.data()), 3 * sizeof(float));
    }
    bytes.append(2, '\0');
  }
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.flush();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace scree
