// scree: one program, one file a subcommand.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/streams.h"
#include "scree_version.h"
#include "sim/material/input_bytes.h"
#include "sim/scene/scenario_values.h"

std::atomic<int> interrupted = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler sets it");

namespace {

void on_interrupt(int signal) {
  // A second Ctrl-C does not wait. One from a sweep to its runs, after the end of all (SIGTERM), is the
  // first.
  // A lost terminal says so twice: the shell to its jobs, and the system to those in the foreground.
  if (interrupted == signal && signal != SIGHUP) _exit(kInterrupted);
  interrupted = signal;
}

std::vector<std::string> arguments;  // without the program

constexpr const char* kExamples = R"(
Examples:
  scree run scenarios/quick_dump.yaml                    a first pile, in seconds
  scree run scenarios/canadian_malartic_10m.yaml         four truck loads, and a report beside what was measured
  scree run scenarios/a1_10m.yaml --seeds 5 --set material.mu=0.5
  scree sweep scenarios/sweeps/repose_lab.yaml           the repose angle over 16 pairs of friction
  scree reproduce a1 b1 --seeds 2                        cases of the thesis beside what it prints
  scree study scenarios/studies/disposal_qb.yaml         ways to dispose of a rock, ranked
  scree calibrate scenarios/calibrations/lab_angle.yaml  friction from a measured repose angle
  scree compare runs/canadian_malartic_10m               the comparison of a run, as a table
  scree field --thesis                                   gradings of slopes in pictures: statistics, fines, conductivity
  scree analyse heap.csv --scenario scenarios/repose_lab.yaml   what a pile of another program gives
  scree image slope.jpg --scale 1.2cm/px                 gradings of a photographed slope
  scree diagnose data.yaml --model model.yaml            which effect the model lacks, if any
  scree validate scenarios/a1_10m.yaml                   check a file without running it
  scree effects breakage                                 an effect that a scenario can switch on
  scree schema > scenario.schema.json                    for editors that know JSON Schema
)";

// The first word of the command line that looks like an option of the subcommand and is none; empty: there is
// none.
std::string no_such_option(const CLI::App& app) {
  if (app.get_subcommands().empty()) return "";
  std::vector<std::string> options;
  for (const CLI::Option* option : app.get_subcommands().front()->get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const std::string& word : app.remaining(true))
    if (word.starts_with("--"))
      return fmt::format("no option {}{}", scree::one_line(word), scree::suggestion(word, options));
  return "";
}

}  // namespace

namespace fs = std::filesystem;

fs::path asset_dir() {
  if (const char* given = std::getenv("SCREE_ASSETS"))
    return (fs::path(given) / "").lexically_normal().parent_path();
  // Beside the program, in a folder above it, or where it was built.
  std::error_code error;
  fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (; !error && folder.has_relative_path(); folder = folder.parent_path())
    if (fs::is_directory(folder / "assets" / "gradings", error)) return folder / "assets";
  return fs::path(SCREE_SOURCE_DIR) / "assets";
}

std::string command_line() {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-+=:,/@%";
  std::string text = "scree";
  for (const std::string& argument : arguments) {
    text += ' ';
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
      text += argument;
      continue;
    }
    text += '\'';
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

int main(int argc, char** argv) {
  make_streams_safe();
  arguments = {argv + 1, argv + argc};
  CLI::App app{"scree simulates how mine waste rock segregates when it is dumped.", "scree"};
  app.footer(kExamples);
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("scree {} ({})", SCREE_VERSION, SCREE_REVISION));
  const std::vector<Command> commands = add_commands(app);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      const int code = app.exit(error, text, text);
      fmt::print("{}", text.str());
      return with_all_said(code);
    }
    const bool names_one = argc > 1 && argv[1][0] != '-';
    if (names_one && app.get_subcommands().empty()) {
      std::vector<std::string> names;
      for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
      fmt::print(stderr, "scree: {}: no such subcommand; there are {}\n", scree::one_line(argv[1]),
                 fmt::join(names, ", "));
      return kBadInput;
    }
    const std::string command =
        app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name();
    if (const std::string why = no_such_option(app); !why.empty())
      fmt::print(stderr, "scree {}: {}; see scree {} --help\n", command, why, command);
    else
      fmt::print(stderr, "scree: {} (see scree{}{} --help)\n", scree::one_line(error.what()),
                 command.empty() ? "" : " ", command);
    return kBadInput;
  }

  signal(SIGCHLD, SIG_DFL);  // where it is ignored nobody learns how a run ended
  signal(SIGXFSZ, SIG_IGN);  // a file at its limit is then an error of the write, with a message
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup = {};  // a lost terminal ends like Ctrl-C, but not under nohup
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  try {
    for (const Command& command : commands) {
      if (!*command.app) continue;
      if (std::error_code none; command.reads_assets && !fs::is_directory(asset_dir() / "gradings", none)) {
        fmt::print(stderr,
                   "scree: {}: has no gradings, meshes and reference values; set SCREE_ASSETS to the folder "
                   "`assets` of the project\n",
                   scree::one_line(asset_dir().string()));
        return kBadInput;
      }
      return with_all_said(command.run());
    }
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "scree: the memory of this machine does not suffice\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "scree: {}\n", scree::one_line(error.what()));
    return kFailed;
  }
  return kOk;
}
