// scree schema: every key of a scenario, for editors (JSON Schema) or readers (a page of docs).
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "sim/scene/scenario.h"

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHead = R"(# Scenarios: every key

A scenario is a YAML file; `scree validate FILE` names what is wrong in one, `--set KEY=VALUE` changes a key for one call
(`--set experiment.bench.height_m=15`). Keys that are left out have their default; those without one must be given, or belong to something
that may be left out. Files named are relative to the scenario, or to `assets`. Effects have a page of their own ([effects.md](effects.md)),
and so have the numbers that a run gives ([datasets.md](datasets.md#names-of-numbers)).

This page is what `scree schema --document` prints; `scree schema` prints the same for editors, as JSON Schema.
)";

std::string bounds(const Json& key) {
  const auto bound = [&](const char* with, const char* without, const char* open) {
    if (key.contains(with)) return fmt::format("{:g}", key[with].get<double>());
    return key.contains(without) ? fmt::format("{} {:g}", open, key[without].get<double>()) : std::string();
  };
  const std::string low = bound("minimum", "exclusiveMinimum", "above"),
                    high = bound("maximum", "exclusiveMaximum", "below");
  std::string text = key.value("type", "") == "integer" ? "whole numbers" : "numbers";
  if (!low.empty()) text += fmt::format(", {} to {}", low, high);
  return text;
}

// What a key may be, in a cell of a table.
std::string values(const Json& key) {
  std::string text;
  const auto add = [&](const std::string& more) {
    text += text.empty() ? more : fmt::format(", or {}", more);
  };
  if (key.contains("enum"))
    for (const Json& word : key["enum"])
      text += fmt::format("{}{}", text.empty() ? "" : ", ", word.get<std::string>());
  else if (key.contains("const"))
    add(key["const"].dump());
  else if (key.contains("anyOf"))
    for (const Json& one : key["anyOf"]) add(values(one));
  else if (key.value("type", "") == "array")
    add(key.contains("items") && !key["items"].contains("properties")
            ? fmt::format("a list of {}", values(key["items"]))
            : std::string("a list"));
  else if (key.value("type", "") == "boolean")
    add("true, false");
  else if (key.value("type", "") == "string")
    add("text");
  else
    add(bounds(key));
  return text;
}

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\\|");
  return text;
}

// " Of end_dump, push_dump.": the types of experiment that take a key; empty where all do.
std::string takers(const Json& map, const std::string& name) {
  if (!map.contains("allOf")) return {};
  std::string types;
  bool all = true;
  for (const Json& rule : map["allOf"]) {
    const Json& refused = rule["then"]["properties"];
    if (refused.contains(name) && refused[name] == false)
      all = false;
    else
      types += fmt::format("{}{}", types.empty() ? "" : ", ",
                           rule["if"]["properties"]["type"]["const"].get<std::string>());
  }
  return all ? std::string() : fmt::format(" Of {}.", types);
}

// A table of the keys of a map, then those of the maps in it; `of`: see takers().
void add_tables(const std::string& path, const Json& map, std::string& text, const std::string& of = {}) {
  std::string rows, below;
  for (const auto& [name, key] : map["properties"].items()) {
    const std::string whole = path.empty() ? name : fmt::format("{}.{}", path, name);
    const Json& inner = key.contains("properties") ? key : key.contains("items") ? key["items"] : key;
    if (inner.contains("properties") && name != "effects") add_tables(whole, inner, below, takers(map, name));
    if (key.contains("properties")) continue;
    rows += fmt::format(
        "| `{}` | {} | {} | {} |\n", name, cell(values(key)),
        key.contains("default") ? fmt::format("`{}`", cell(key["default"].dump())) : std::string(),
        cell(key.value("description", "") + takers(map, name)));
  }
  if (!rows.empty()) {
    const std::string words = map.value("description", "") + of;
    text += path.empty() ? std::string("\n## At the top\n\n") : fmt::format("\n## {}\n\n{}\n\n", path, words);
    text += "| key | values | default | what it is |\n|---|---|---|---|\n" + rows;
  }
  text += below;
}

}  // namespace

int run_schema(bool document) {
  const std::string schema = scree::scenario_schema();
  if (!document) {
    fmt::print("{}", schema);
    return 0;
  }
  std::string text = kHead;
  add_tables("", Json::parse(schema), text);
  fmt::print("{}", text);
  return 0;
}
