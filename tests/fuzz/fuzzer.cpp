// The entry point that libFuzzer calls; SCREE_FUZZ_TARGET names what is fuzzed.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const scree::fuzz::Target* target = scree::fuzz::find_target(SCREE_FUZZ_TARGET);
  scree::fuzz::run(*target, {reinterpret_cast<const char*>(data), size});
  return 0;
}
