// scree compare: a finished run beside reference values.
#include <fmt/format.h>

#include <set>

#include "analysis/results/summary.h"
#include "cli/commands.h"
#include "cli/printed_values.h"
#include "cli/table.h"

int run_compare(const std::filesystem::path& dir, const std::vector<std::string>& cases) {
  const std::filesystem::path file = std::filesystem::is_directory(dir) ? dir / "summary.json" : dir;
  scree::StoredRun run;
  try {
    run = scree::read_summary(file);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  }
  if (run.interrupted) {
    fmt::print(stderr,
               "{}: this run was ended before its pile was finished; scree run --resume goes on with it\n",
               file.string());
    return kBadInput;
  }
  const auto printed = printed_values();
  if (!printed) return kBadInput;
  const std::vector<scree::ReferenceValue>& reference = *printed;
  std::set<std::string> known;
  for (const auto& value : reference) known.insert(value.case_name);
  for (const std::string& name : cases)
    if (!known.contains(name)) {
      std::string list;
      for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
      fmt::print(stderr, "--case {}: no such reference case; there are {}\n", name, list);
      return kBadInput;
    }
  const auto& chosen = cases.empty() ? run.cases : cases;
  if (chosen.empty()) {
    fmt::print(stderr, "{}: this run was compared with no reference case; name one with --case\n",
               file.string());
    return kBadInput;
  }
  fmt::print("{} ({} seed{})\n", run.title, run.seeds.size(), run.seeds.size() == 1 ? "" : "s");
  const auto comparison = scree::compare_with_reference(run.outputs, reference, chosen);
  if (comparison.empty()) fmt::print("none of the values of these cases is in this run\n");
  scree::print_comparison(comparison);
  for (const std::string& note : scree::comparison_notes(comparison)) fmt::print("note: {}\n", note);
  return kOk;
}
