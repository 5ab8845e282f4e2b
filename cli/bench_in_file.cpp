#include "cli/bench_in_file.h"

#include <yaml-cpp/yaml.h>

#include <string>

#include "sim/io/h5_file.h"

namespace {

constexpr std::size_t kLongestScenario = 1 << 20;  // bytes; the program's own are some thousand

// /parameters/scenario; empty where there is none.
std::string scenario_in(const std::filesystem::path& file) {
  using scree::H5Handle;
  scree::ask_for_memory();
  const scree::QuietHdf5 quiet;
  const H5Handle trajectory(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (trajectory < 0) return "";
  const H5Handle set(H5Dopen2(trajectory, "/parameters/scenario", H5P_DEFAULT), H5Dclose);
  if (set < 0) return "";
  const H5Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  const std::size_t length = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || length > kLongestScenario ||
      H5Sget_simple_extent_npoints(space) != 1)
    return "";
  std::string text(length, '\0');
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

}  // namespace

std::optional<BenchInFile> bench_in_file(const std::filesystem::path& file) {
  try {
    const YAML::Node scenario = YAML::Load(scenario_in(file));
    const YAML::Node bench = scenario["experiment"]["bench"];
    const BenchInFile found{bench["height_m"].as<double>(), scenario["output"]["sections"].as<int>()};
    if (found.height > 0 && found.sections > 0) return found;
  } catch (const YAML::Exception&) {
    // Not of this program, or without a bench: nothing is known of it.
  }
  return std::nullopt;
}
