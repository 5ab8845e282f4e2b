#include "cli/ensemble/file_kind.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "sim/scene/yaml_tree.h"

namespace scree {
namespace {

struct Kind {
  FileKind kind;
  const char *words, *taken_by;
  std::vector<const char*> keys;  ///< one of which a file of this kind has at its top
  const char* never = "";         ///< a key that it has not
};

// In the order in which they are asked.
const std::array<Kind, 6>& kinds() {
  static const std::array<Kind, 6> all{{
      {FileKind::dataset, "a dataset", "scree diagnose takes it", {"observables"}},
      {FileKind::scenario, "a scenario", "scree run takes it", {"experiment"}},
      {FileKind::sweep, "a sweep", "scree sweep takes it", {"design"}},
      {FileKind::calibration, "a calibration", "scree calibrate takes it", {"targets", "equivalent"}},
      {FileKind::study, "a study", "scree study takes it", {"options"}},
      {FileKind::model, "a model file", "scree diagnose --model takes it", {"parameters"}, "scenario"},
  }};
  return all;
}

const Kind* known(FileKind kind) {
  for (const Kind& each : kinds())
    if (each.kind == kind) return &each;
  return nullptr;
}

}  // namespace

FileKind kind_of(const std::filesystem::path& file) {
  std::vector<ScenarioError> errors;
  const auto root = read_yaml(file, errors);
  if (!root) return FileKind::unknown;
  for (const Kind& each : kinds())
    for (const char* key : each.keys)
      if (root->find(key) != nullptr && root->find(each.never) == nullptr) return each.kind;
  return FileKind::unknown;
}

std::string why_another_kind(const std::filesystem::path& file, FileKind wanted) {
  const FileKind is = kind_of(file);
  if (is == wanted || is == FileKind::unknown) return {};
  return fmt::format("{}: is {}, and {} is wanted here; {}", file.string(), known(is)->words,
                     known(wanted)->words, known(is)->taken_by);
}

}  // namespace scree
