#pragma once
// A folder of its own with small assets, for tests of scenario files.
#include <fmt/format.h>

#include <fstream>
#include <string>
#include <vector>

#include "sim/io/scratch_folder.h"
#include "sim/scene/scenario.h"

namespace scree {

/// DIR/assets (gradings, meshes, reference) and a place for scenario files; removed at the end.
class ScenarioFolder {
  ScratchFolder scratch_;  // before all that lies in it

 public:
  const std::filesystem::path dir = scratch_.path();

  ScenarioFolder() {
    const std::string head = "diameter_mm,passing_pct\n";
    write("assets/gradings/CM0.csv", head + "100,0\n1000,100\n");
    write("assets/gradings/fine.csv", head + "1,0\n1000,100\n");
    write("assets/gradings/giant.csv", head + "1000,0\n5000,100\n");
    write("assets/gradings/bad.csv", head + "100,0\n50,100\n");
    write("assets/gradings/lab.csv", head + "5,0\n20,100\n");
    const std::string faces[] = {facet("0 0 0", "0 1 0", "1 0 0"), facet("0 0 0", "1 0 0", "0 0 1"),
                                 facet("0 0 0", "0 0 1", "0 1 0"), facet("1 0 0", "0 1 0", "0 0 1")};
    const std::string closed = faces[0] + faces[1] + faces[2] + faces[3];
    for (const char* mesh : {"truck_bed", "truck_gate", "bucket_repose", "bucket_segregation", "push_wall"})
      write(fmt::format("assets/meshes/{}.stl", mesh), fmt::format("solid t\n{}endsolid t\n", closed));
    write("assets/meshes/open.stl", fmt::format("solid t\n{}{}{}endsolid t\n", faces[0], faces[1], faces[2]));
    write("assets/meshes/broken.stl", "solid nothing\n");
    write("assets/impulse/equivalent.csv",
          "mu,mu_r,local_damping,friction,rolling,angle_rrlinear_deg,angle_impulse_deg\n0.2,0.4,0.4,0.25,0.5,"
          "27,28\n"
          "0.4,0.4,0.4,0.45,0.5,37,37.5\n");
    write("assets/reference/results.csv", "case,quantity\nA1,chi\nA1,mass\nC1,chi\n");
  }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((dir / name).parent_path());
    std::ofstream(dir / name, std::ios::binary) << text;
    return dir / name;
  }

  ScenarioResult load(const std::string& yaml, const std::vector<std::string>& overrides = {}) const {
    return load_scenario(write("case.yaml", yaml), overrides, dir / "assets");
  }

  /// Messages of a scenario, without "DIR/case.yaml:" and with the assets' path as ASSETS and the folder's as
  /// DIR.
  std::vector<std::string> messages(const std::string& yaml,
                                    const std::vector<std::string>& overrides = {}) const {
    std::vector<std::string> out;
    for (const ScenarioError& error : load(yaml, overrides).errors) {
      std::string text = error.text();
      replace(text, (dir / "case.yaml").string() + ":", "");
      replace(text, (dir / "assets").string(), "ASSETS");
      replace(text, dir.string(), "DIR");
      out.push_back(text);
    }
    return out;
  }

  /// A triangle of an ASCII STL, its corners as text.
  static std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return fmt::format("facet normal 0 0 0\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n",
                       a, b, c);
  }

 private:
  static void replace(std::string& text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  }
};

}  // namespace scree
