#include <cstdio>

#include "cli/commands.h"
#include "sim/scene/scenario.h"

int run_schema() {
  std::fputs(scree::scenario_schema().c_str(), stdout);
  return 0;
}
