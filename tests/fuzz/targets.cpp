#include "tests/fuzz/targets.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "analysis/cases/reproduction.h"
#include "analysis/results/summary.h"
#include "cli/ensemble/calibration_file.h"
#include "cli/ensemble/dataset_file.h"
#include "cli/ensemble/dataset_tables.h"
#include "cli/ensemble/model_file.h"
#include "cli/ensemble/study_file.h"
#include "cli/ensemble/sweep_file.h"
#include "cli/ensemble/sweep_results.h"
#include "cli/snapshot_outputs.h"
#include "scree_version.h"
#include "sim/io/mesh.h"
#include "sim/io/results_store.h"
#include "sim/io/scratch_folder.h"
#include "sim/io/snapshot_reader.h"
#include "sim/material/equivalence.h"
#include "sim/material/grading.h"
#include "sim/scene/scenario.h"

namespace scree::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostGrains = 2000;  // that are analysed, too: speed

const fs::path& assets() {
  static const fs::path folder = fs::path(SCREE_SOURCE_DIR) / "assets";
  return folder;
}

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A folder of this process, with the files that others refer to; the working folder from the first use on.
class Scratch {
 public:
  Scratch() {
    fs::current_path(folder_.path());
    write("drop.yaml",
          "material: {mu: 0.4, mu_r: 0.4}\ngrading: Lab_18_24mm\nexperiment: {type: drop_test, diameter_m: "
          "0.02, "
          "height_m: 0.2}\n");
    write("dump.yaml",
          "material: {mu: 0.4, mu_r: 0.4}\ngrading: CM0\nexperiment: {type: end_dump, dumps: 1}\n");
    write("observables.csv",
          "experiment,observable,value,unit,std,repeats,uncertainty\ndrop,rebound_height_m,0.1,m,0.04,20,\n"
          "again,rebound_height_m,0.1,m,0.04,20,\n");
    write("dataset.yaml",
          "experiments: {drop: {scenario: drop.yaml}, again: {scenario: drop.yaml}}\n"
          "observables: observables.csv\ncovariance: covariance.csv\n");
    write("covariance.csv", "name,drop/rebound_height_m\ndrop/rebound_height_m,0.00008\n");
    write("sweep.yaml",
          "scenario: drop.yaml\nseeds: [1, 2]\n"
          "design: {type: grid, parameters: {material.mu: [0.1, 0.2]}}\n");
  }
  ~Scratch() {
    std::error_code none;
    fs::current_path("/", none);
  }

 private:
  ScratchFolder folder_;
};

/// What readers promise to throw.
template <class Work>
void refusing(const Work& work) {
  try {
    work();
  } catch (const std::runtime_error&) {  // FileError among them
  }
}

void snapshot(const char* file) {
  refusing([&] {
    SnapshotRead read = read_snapshot(file, {});
    if (read.snapshot.grains.size() > kMostGrains || read.original.size() > kMostGrains) return;
    Scenario heap;
    heap.experiment = ReposeLift{};
    std::vector<std::string> notes;
    try {
      outputs_of_snapshot(heap, std::move(read), notes);
    } catch (const std::invalid_argument&) {  // as its header says
    }
  });
}

void mesh(const char* file) {
  const LoadedMesh loaded = load_mesh(file);
  for (const auto& triangle : loaded.mesh.triangles)
    for (const int vertex : triangle)
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= loaded.mesh.vertices.size())
        throw std::logic_error("a triangle of a vertex that is not there");
}

void store(const char* file) {
  refusing([&] { ResultsStore(file, ResultsStore::Access::look).find("0123"); });
}

void sweep_table(const char* file) {
  static const Sweep sweep = load_sweep("sweep.yaml", assets()).sweep;
  refusing([&] { read_sweep_csv(sweep, file); });
}

constexpr std::array<Target, 23> kTargets{{
    {"scenario", "scenario.yaml", [](const char* file) { load_scenario(file, {}, assets()); }, nullptr},
    {"override", "", nullptr,
     [](std::string_view bytes) { load_scenario("dump.yaml", {std::string(bytes)}, assets()); }},
    {"sweep", "a.yaml", [](const char* file) { load_sweep(file, assets()); }, nullptr},
    {"calibration", "a.yaml", [](const char* file) { load_calibration(file); }, nullptr},
    {"study", "a.yaml", [](const char* file) { load_study(file, assets()); }, nullptr},
    {"dataset", "a.yaml", [](const char* file) { load_dataset(file, assets()); }, nullptr},
    {"observables", "observables.csv", [](const char*) { load_dataset("dataset.yaml", assets()); }, nullptr},
    {"covariance", "covariance.csv", [](const char*) { load_dataset("dataset.yaml", assets()); }, nullptr},
    {"model", "a.yaml", [](const char* file) { load_model(file, assets()); }, nullptr},
    {"grading", "a.csv", [](const char* file) { refusing([&] { read_grading(file); }); }, nullptr},
    {"reference", "a.csv", [](const char* file) { refusing([&] { read_reference(file); }); }, nullptr},
    {"trends", "a.csv", [](const char* file) { refusing([&] { read_trends(file); }); }, nullptr},
    {"equivalence", "a.csv", [](const char* file) { refusing([&] { Equivalence::read(file); }); }, nullptr},
    {"mesh_stl", "a.stl", mesh, nullptr},
    {"mesh_obj", "a.obj", mesh, nullptr},
    {"mesh_ply", "a.ply", mesh, nullptr},
    {"mesh_gltf", "a.gltf", mesh, nullptr},
    {"mesh_glb", "a.glb", mesh, nullptr},
    {"snapshot", "a.csv", snapshot, nullptr},
    {"trajectory", "a.h5", snapshot, nullptr},
    {"sweep_table", "a.csv", sweep_table, nullptr},
    {"summary", "", nullptr,
     [](std::string_view bytes) { refusing([&] { parse_summary(std::string(bytes)); }); }},
    {"store", "a.sqlite", store, nullptr},
}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

const Target* find_target(std::string_view name) {
  for (const Target& target : kTargets)
    if (target.name == name) return &target;
  return nullptr;
}

void run(const Target& target, std::string_view bytes) {
  static const Scratch scratch;
  if (target.parse != nullptr) return target.parse(bytes);
  write(target.file, bytes);
  target.read(target.file);
}

}  // namespace scree::fuzz
