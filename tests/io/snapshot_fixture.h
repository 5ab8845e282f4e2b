#pragma once
// One pile, to be read out of files of every format.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "sim/io/snapshot_reader.h"
#include "sim/material/input_text.h"

namespace scree {

namespace fs = std::filesystem;
using testing::HasSubstr;

inline std::vector<Grain> pile() {
  std::vector<Grain> grains;
  for (int k = 0; k < 5; ++k) {
    Grain grain;
    grain.id = 10 + k;
    grain.position = Vec3(0.5 * k, -0.25 * k, 1 + 0.125 * k);
    grain.diameter = 0.25 + 0.125 * k;
    grain.mass = 2000 * std::numbers::pi / 6 * std::pow(grain.diameter, 3);
    grain.dump = 1 + k / 3;
    grains.push_back(grain);
  }
  return grains;
}

class SnapshotReader : public testing::Test {
 protected:
  SnapshotReader() { fs::create_directories(folder); }
  ~SnapshotReader() override { fs::remove_all(folder); }
  fs::path put(const std::string& text, const std::string& name = "pile.txt") {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  SnapshotRead read(const std::string& text, const SnapshotOptions& options = {}) {
    return read_snapshot(put(text), options);
  }
  std::string error(const std::string& text, const SnapshotOptions& options = {}) {
    try {
      read(text, options);
    } catch (const FileError& failure) {
      return failure.what();
    }
    return "";
  }
  // The pile of above, whatever it was read from: places and sizes.
  static void expect_the_pile(const SnapshotRead& read, const Vec3& shift = Vec3::Zero()) {
    const auto expected = pile();
    ASSERT_EQ(read.snapshot.grains.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const Grain& grain = read.snapshot.grains[k];
      EXPECT_NEAR((grain.position - expected[k].position - shift).norm(), 0, 1e-6) << k;
      EXPECT_NEAR(grain.diameter, expected[k].diameter, 1e-6) << k;
      EXPECT_NEAR(grain.mass, expected[k].mass, 1e-3) << k;
    }
  }
  std::string csv(const char* header, double length = 1, bool with_mass = true) const {
    std::string text = std::string(header) + "\n";
    for (const Grain& g : pile())
      text += fmt::format("{},{},{},{},{},{}{}\n", g.id, g.position.x() * length, g.position.y() * length,
                          g.position.z() * length, g.diameter * length, g.dump,
                          with_mass ? fmt::format(",{}", g.mass) : "");
    return text;
  }
  const fs::path folder = fs::temp_directory_path() / ("scree_snapshot_" + std::to_string(getpid()));
};

}  // namespace scree
