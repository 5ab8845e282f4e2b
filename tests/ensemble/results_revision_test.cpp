// Whether this program still gives the numbers that stores remember.
#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include "analysis/pile/segregation.h"
#include "cli/ensemble/run_request.h"
#include "scree_version.h"
#include "sim/scene/run.h"

namespace scree {
namespace {

// Hash of where every grain of a small bucket and of a small dump, plain and with effects, ends, to the last
// bit, and of what an analysis of the dumps says. When it changes, and is meant to, raise kResultsRevision,
// so that nobody's store answers with numbers of the older program, and put both here.
TEST(ResultsRevision, IsRaisedWhenNumbersChange) {
  const std::string source = SCREE_SOURCE_DIR;
  struct Small {
    const char* file;
    std::vector<std::string> overrides;
  };
  std::string text;
  const std::vector<std::string> small_dump = {
      "experiment.payload_t=5", "experiment.bench.height_m=3", "experiment.bench.width_m=30",
      "experiment.bench.top_length_m=10", "experiment.bench.floor_length_m=15"};
  std::vector<std::string> with_effects = small_dump;
  for (const char* effect : {"cohesion.bond_number=1", "sticky_tools.bond_number=1", "twisting.mu_t=0.1",
                             "weakening.share=0.3", "restitution.damping_ratio=0.2", "image_blur.width=0.3",
                             "surface_only.share=0.5", "own_reference.share=0.5"})
    with_effects.push_back(std::string("effects.") + effect);
  for (const Small& small : {Small{"repose_lab.yaml", {"experiment.mass_kg=2"}},
                             Small{"quick_dump.yaml", small_dump}, Small{"quick_dump.yaml", with_effects}}) {
    ScenarioResult loaded =
        load_scenario(source + "/scenarios/" + small.file, small.overrides, source + "/assets");
    ASSERT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    const RunOutcome outcome = run_scenario(loaded.scenario, 10001, 1, {});
    for (const Grain& grain : outcome.final_state.grains)
      text +=
          fmt::format("{} {} {} {}\n", grain.id, grain.position.x(), grain.position.y(), grain.position.z());
    if (bench_of(loaded.scenario) == nullptr) continue;
    const Measurement measured = effective_model(loaded.scenario).changes.measurement;
    for (const Section& section :
         analyse_sections(outcome.final_state.grains, outcome.original, 3, 3, measured).sections)
      text +=
          fmt::format("{} {} {} {} {}\n", section.name, section.mass, section.chi, section.d50, section.d90);
  }
  EXPECT_EQ(kResultsRevision, 8);
  EXPECT_EQ(fmt::format("{:016x}", XXH3_64bits(text.data(), text.size())), "3c1edab801da3c56");
}

}  // namespace
}  // namespace scree
