#include "sim/scene/scenario.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/material/input_bytes.h"
#include "sim/scene/scenario_read.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxErrors = 200;
constexpr std::size_t kMaxChain = 16;

/// A file and those it extends, as one tree.
class Chain {
 public:
  explicit Chain(std::vector<ScenarioError>& errors) : errors_(errors) {}

  std::vector<std::string> files;  ///< as named in messages, the given file first
  bool incomplete = false;         ///< a parent could not be read

  std::optional<YamlNode> read(const fs::path& file) {
    files.push_back(file.string());
    std::error_code none;
    seen_.push_back(fs::weakly_canonical(file, none));
    auto root = read_yaml(file, errors_);
    const auto is_extends = [](const YamlEntry& entry) { return entry.key == "extends"; };
    if (!root || root->find("extends") == nullptr) return root;
    const YamlNode parent_name = root->find("extends")->value;
    std::erase_if(root->entries, is_extends);
    auto parent = read_parent(parent_name, file);
    if (!parent) {
      incomplete = true;
      return root;
    }
    merge_yaml(*parent, std::move(*root));
    return parent;
  }

 private:
  std::optional<YamlNode> read_parent(const YamlNode& name, const fs::path& child) {
    if (name.kind != YamlKind::scalar || name.text.empty()) {
      report(errors_, name.place, "extends: the path of one scenario file is expected");
      return std::nullopt;
    }
    const fs::path path = (child.parent_path() / name.text).lexically_normal();
    std::error_code none;
    if (!fs::is_regular_file(path, none)) {
      report(errors_, name.place, fmt::format("extends: no file {}", shown(path.string())));
      return std::nullopt;
    }
    if (std::find(seen_.begin(), seen_.end(), fs::weakly_canonical(path, none)) != seen_.end()) {
      std::string circle;
      for (const fs::path& file : seen_) circle += file.filename().string() + " -> ";
      report(errors_, name.place,
             fmt::format("extends: goes in a circle: {}{}", circle, path.filename().string()));
      return std::nullopt;
    }
    if (seen_.size() >= kMaxChain) {
      report(errors_, name.place, fmt::format("extends: a chain of more than {} files", kMaxChain));
      return std::nullopt;
    }
    return read(path);
  }

  std::vector<ScenarioError>& errors_;
  std::vector<fs::path> seen_;
};

/// The tree of "material.mu=0.5": {material: {mu: 0.5}}.
std::optional<YamlNode> override_tree(const std::string& text, std::vector<ScenarioError>& errors) {
  const std::string_view kept = std::string_view(text).substr(0, text.find('\n')).substr(0, 100);
  const Place place{std::make_shared<const std::string>("--set " + std::string(kept)), 0, 0};
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    report(errors, place, "key=value is expected, for example material.mu=0.5");
    return std::nullopt;
  }
  auto node = parse_yaml(text.substr(equals + 1), place, errors);
  if (!node) return std::nullopt;
  if (text.find_first_not_of(' ', equals + 1) == std::string::npos) node->kind = YamlKind::null;
  std::string keys = text.substr(0, equals);
  if (keys == "extends") {
    report(errors, place, "extends can stand in a file only");
    return std::nullopt;
  }
  std::size_t depth = 0;
  while (true) {
    const auto dot = keys.rfind('.');
    const std::string key = dot == std::string::npos ? keys : keys.substr(dot + 1);
    if (key.empty() || ++depth > kMaxDepth) {
      report(errors, place, "not a key; write it as in material.mu=0.5");
      return std::nullopt;
    }
    YamlNode map;
    map.kind = YamlKind::map;
    map.place = place;
    map.entries.push_back({key, place, std::move(*node)});
    node = std::move(map);
    if (dot == std::string::npos) return node;
    keys.resize(dot);
  }
}

/// By file (the given one first, overrides last), then by place; not too many.
void put_in_order(std::vector<ScenarioError>& errors, const std::vector<std::string>& files) {
  const auto rank = [&](const ScenarioError& e) { return std::find(files.begin(), files.end(), e.file); };
  std::stable_sort(errors.begin(), errors.end(), [&](const ScenarioError& a, const ScenarioError& b) {
    return std::tuple(rank(a), a.line, a.column) < std::tuple(rank(b), b.line, b.column);
  });
  if (errors.size() <= kMaxErrors) return;
  ScenarioError rest = errors[kMaxErrors];
  rest.message = fmt::format("and {} more errors from here on", errors.size() - kMaxErrors);
  errors.resize(kMaxErrors);
  errors.push_back(std::move(rest));
}

}  // namespace

std::string ScenarioError::text() const {
  if (column > 0) return one_line(fmt::format("{}:{}:{}: {}", file, line, column, message));
  return one_line(line > 0 ? fmt::format("{}:{}: {}", file, line, message)
                           : fmt::format("{}: {}", file, message));
}

std::string why_not_set(const std::string& text, const fs::path& asset_dir) {
  std::vector<ScenarioError> errors;
  const auto tree = override_tree(text, errors);
  if (!tree) return errors.front().message;
  Scenario any;
  std::vector<std::string_view> types;
  for (const Field& field : scenario_keys(any))
    if (const auto* experiment = std::get_if<OneOf>(&field.target)) types = experiment->names;
  const Place elsewhere{std::make_shared<const std::string>(), 0, 0};
  std::string first, closest;
  for (const std::string_view type : types) {
    Scenario scenario;
    ReadNotes notes;
    auto root = parse_yaml(fmt::format("experiment: {{type: {}}}", type), elsewhere, notes.errors);
    merge_yaml(*root, *tree);
    read_keys(*root, scenario, asset_dir, true, notes);
    const auto error = std::find_if(notes.errors.begin(), notes.errors.end(),
                                    [](const ScenarioError& e) { return e.file.starts_with("--set "); });
    if (error == notes.errors.end()) return "";
    const std::string& why = error->message;
    if (first.empty()) first = why;
    const bool has_key = !why.starts_with("unknown key") && !why.starts_with("key ");
    if (closest.empty() && (has_key || why.find("did you mean") != std::string::npos)) closest = why;
  }
  return closest.empty() ? first : closest;
}

ScenarioResult load_scenario(const fs::path& file, const std::vector<std::string>& overrides,
                             const fs::path& asset_dir, ReadFor use) {
  ScenarioResult result;
  result.scenario.name = file.stem().string();
  ReadNotes notes;
  Chain chain(notes.errors);
  auto root = chain.read(file);
  for (const std::string& text : overrides) {
    auto tree = override_tree(text, notes.errors);
    if (tree && root) merge_yaml(*root, std::move(*tree));
  }
  if (root) {
    read_keys(*root, result.scenario, asset_dir, chain.incomplete, notes);
    check_scenario(result.scenario, asset_dir, use, notes, result.warnings);
    find_bullet_settings(result.scenario, asset_dir, notes);
  }
  put_in_order(notes.errors, chain.files);
  result.errors = std::move(notes.errors);
  if (result.errors.empty()) result.scenario.resolved_yaml = write_scenario(result.scenario, asset_dir);
  return result;
}

}  // namespace scree
