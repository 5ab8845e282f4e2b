#include "cli/ensemble/scenario_patch.h"

#include <fmt/format.h>

#include "sim/scene/yaml_tree.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Maps within maps, in the order in which their keys came.
struct Node {
  std::string name;
  std::string value;
  std::vector<Node> children;

  void set(const std::string& key, const std::string& text) {
    const auto dot = key.find('.');
    Node& child = at(key.substr(0, dot));
    if (dot == std::string::npos)
      child.value = text;
    else
      child.set(key.substr(dot + 1), text);
  }
  Node& at(const std::string& key) {
    for (Node& child : children)
      if (child.name == key) return child;
    return children.emplace_back(Node{key, {}, {}});
  }
  void write(std::string& text, int depth) const {
    for (const Node& child : children) {
      text += fmt::format("{:{}}{}:{}\n", "", 2 * depth, child.name,
                          child.children.empty() ? " " + child.value : std::string());
      child.write(text, depth + 1);
    }
  }
};

}  // namespace

std::string nested_yaml(const std::vector<std::string>& overrides) {
  Node root;
  for (const std::string& each : overrides) {
    const auto at = each.find('=');
    root.set(each.substr(0, at), each.substr(at + 1));
  }
  std::string text;
  root.write(text, 0);
  return text;
}

std::string relative_yaml_text(const fs::path& path, const fs::path& from) {
  return yaml_text(fs::absolute(path)
                       .lexically_normal()
                       .lexically_relative(fs::absolute(from).lexically_normal())
                       .generic_string());
}

std::string scenario_patch(const fs::path& scenario, const fs::path& from,
                           const std::vector<std::string>& overrides,
                           const std::vector<std::string>& comment) {
  std::string text;
  for (const std::string& line : comment) text += "# " + line + "\n";
  text += fmt::format("extends: {}\n", relative_yaml_text(scenario, from));
  return text + nested_yaml(overrides);
}

}  // namespace scree
