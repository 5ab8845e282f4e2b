// scree: one program, one file a subcommand.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>

#include "cli/commands.h"
#include "scree_version.h"

volatile std::sig_atomic_t interrupted = 0;

namespace {

void on_interrupt(int) {
  if (interrupted) _exit(kInterrupted);  // a second Ctrl-C does not wait
  interrupted = 1;
}

constexpr const char* kExamples = R"(
Examples:
  scree run scenarios/quick_dump.yaml                    a first pile, in seconds
  scree run scenarios/canadian_malartic_10m.yaml         four truck loads, and a report beside what was measured
  scree run scenarios/a1_10m.yaml --seeds 5 --set material.mu=0.5
  scree compare runs/canadian_malartic_10m               the comparison of a run, as a table
  scree validate scenarios/a1_10m.yaml                   check a file without running it
  scree schema > scenario.schema.json                    for editors that know JSON Schema
)";

}  // namespace

std::filesystem::path asset_dir() {
  if (const char* given = std::getenv("SCREE_ASSETS")) return given;
  // Beside the program, in a folder above it, or where it was built.
  std::error_code error;
  std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (; !error && folder.has_relative_path(); folder = folder.parent_path())
    if (std::filesystem::is_directory(folder / "assets" / "gradings")) return folder / "assets";
  return std::filesystem::path(SCREE_SOURCE_DIR) / "assets";
}

int main(int argc, char** argv) {
  CLI::App app{"scree simulates how mine waste rock segregates when it is dumped.", "scree"};
  app.footer(kExamples);
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("scree {} ({})", SCREE_VERSION, SCREE_REVISION));

  RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "Run a scenario and write its report");
  run_app->add_option("file", run.file, "Scenario file (YAML)")->required();
  run_app
      ->add_option("--seeds", run.seeds,
                   "Number of seeds: those of the scenario first, then the integers that follow the last")
      ->check(CLI::Range(1, 1000));
  run_app
      ->add_option("--threads", run.threads,
                   "Worker threads; default: as many as cores. The numbers do not depend on it")
      ->check(CLI::Range(1, 256));
  run_app->add_option("--out", run.out,
                      "Folder for the results; default: runs/NAME, or runs/NAME-2 ... when it exists");
  run_app->add_option("--set", run.overrides, "Change a value: --set material.mu=0.5 (may be repeated)")
      ->take_all();
  run_app->add_flag("--force", run.force, "Write into --out even if it holds something");
  run_app->footer(
      "\nExamples:\n  scree run scenarios/quick_dump.yaml\n"
      "  scree run scenarios/a1_10m.yaml --seeds 5 --out runs/a1_five --set experiment.dumps=2\n");

  std::filesystem::path compare_dir;
  std::vector<std::string> compare_cases;
  CLI::App* compare_app = app.add_subcommand("compare", "Show a finished run beside the reference values");
  compare_app->add_option("dir", compare_dir, "Run folder")->required();
  compare_app->add_option("--case", compare_cases, "Reference cases; default: those of the scenario")
      ->take_all();

  std::filesystem::path validate_file;
  std::vector<std::string> validate_overrides;
  CLI::App* validate_app =
      app.add_subcommand("validate", "Check a scenario file and say everything that is wrong");
  validate_app->add_option("file", validate_file, "Scenario file (YAML)")->required();
  validate_app->add_option("--set", validate_overrides, "Change a value before checking")->take_all();

  CLI::App* schema_app = app.add_subcommand("schema", "Print the JSON Schema of scenario files");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    const bool names_one = argc > 1 && argv[1][0] != '-';
    if (names_one && app.get_subcommands().empty()) {
      fmt::print(stderr, "scree: {}: no such subcommand; there are run, compare, validate and schema\n",
                 argv[1]);
      return kBadInput;
    }
    fmt::print(stderr, "scree: {} (see scree --help)\n", error.what());
    return kBadInput;
  }

  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  try {
    if (*run_app) return run_run(run);
    if (*compare_app) return run_compare(compare_dir, compare_cases);
    if (*validate_app) return run_validate(validate_file, validate_overrides);
    if (*schema_app) return run_schema();
  } catch (const std::exception& error) {
    fmt::print(stderr, "scree: {}\n", error.what());
    return kFailed;
  }
  return kOk;
}
