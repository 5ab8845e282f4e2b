// Every file of the corpus through the readers that are fuzzed: seeds, and what fuzzing has found.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "scree_version.h"
#include "tests/fuzz/targets.h"

namespace scree::fuzz {

/// How googletest names a target.
void PrintTo(const Target& target, std::ostream* out) {
  *out << target.name;
}

namespace {

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadOrRefused) {
  int files = 0;
  const auto folder = std::filesystem::path(SCREE_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NO_THROW(run(GetParam(), bytes));
    ++files;
  }
  EXPECT_GE(files, 1);
}

INSTANTIATE_TEST_SUITE_P(All, Corpus, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace scree::fuzz
