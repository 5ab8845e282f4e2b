#include "cli/ensemble/run_request.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "scree_version.h"
#include "sim/scene/scenario_read.h"

namespace scree {
namespace {

std::string hash_of(const std::string& text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hash_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
  return hash_of(bytes.str());
}

// Stands for a file in the text that is hashed.
void replace_by_content(std::filesystem::path& file) {
  if (!file.empty()) file = "content-" + hash_of_file(file);
}

}  // namespace

std::string results_version() {
  return fmt::format("{} results {}", SCREE_VERSION, kResultsRevision);
}

RunRequest run_request(Scenario scenario, std::uint64_t seed, const std::string& version,
                       const std::filesystem::path& asset_dir) {
  scenario.seeds = {seed};
  scenario.title = "One run of an ensemble";
  scenario.compare.clear();
  scenario.output.trajectory = false;
  scenario.output.frame_interval = 0;
  RunRequest request;
  request.seed = seed;
  request.scenario = write_scenario(scenario, asset_dir);

  replace_by_content(scenario.grading_file);
  if (auto* dump = std::get_if<EndDump>(&scenario.experiment)) {
    replace_by_content(dump->truck.bed_mesh);
    replace_by_content(dump->truck.gate_mesh);
  } else if (auto* push = std::get_if<PushDump>(&scenario.experiment)) {
    replace_by_content(push->blade.mesh);
  } else if (auto* bucket = std::get_if<BucketDump>(&scenario.experiment)) {
    replace_by_content(bucket->container_mesh);
  } else if (auto* lift = std::get_if<ReposeLift>(&scenario.experiment)) {
    replace_by_content(lift->container_mesh);
  }
  for (ToolSpec& tool : scenario.tools) replace_by_content(tool.mesh);
  std::string bullet;  // "equivalent" in the scenario stands for these
  if (scenario.bullet)
    bullet = fmt::format("bullet {} {}\n", scenario.bullet->friction, scenario.bullet->rolling);
  const auto key = [&] {
    return hash_of("scree " + version + "\n" + bullet + write_scenario(scenario, asset_dir));
  };
  request.key = key();
  const auto measuring =
      std::erase_if(scenario.effects, [](const EffectUse& use) { return use.effect->measures; });
  request.pile = measuring > 0 ? key() : request.key;
  return request;
}

}  // namespace scree
