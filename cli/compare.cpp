// scree compare: a finished run beside reference values.
#include <fmt/format.h>

#include "analysis/summary.h"
#include "cli/commands.h"
#include "cli/table.h"

int run_compare(const std::filesystem::path& dir, const std::vector<std::string>& cases) {
  fmt::print("{} {}\n", dir.string(), cases.size());
  return kOk;
}
