#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/scene/scenario_keys.h"

namespace scree {
namespace {

using Json = nlohmann::ordered_json;

/// 300 rather than 300.0, as it is written in a file.
Json plain(double x) {
  if (std::abs(x) < 1e15 && x == std::floor(x)) return static_cast<std::int64_t>(x);
  return x;
}

Json ranged(std::string_view type, const Range& range) {
  Json out = {{"type", type}};
  if (std::isfinite(range.low)) out[range.low_open ? "exclusiveMinimum" : "minimum"] = plain(range.low);
  if (std::isfinite(range.high)) out[range.high_open ? "exclusiveMaximum" : "maximum"] = plain(range.high);
  return out;
}

Json list_of(Json item, Count count) {
  return {{"type", "array"}, {"items", std::move(item)}, {"minItems", count.least}, {"maxItems", count.most}};
}

Json schema(const Fields& fields);

struct TargetSchema {
  bool required;  ///< a required key has no default

  Json with_default(Json out, Json value) const {
    if (!required) out["default"] = std::move(value);
    return out;
  }
  static Json with_unit(Json out, std::string_view unit) {
    if (!unit.empty()) out["unit"] = unit;
    return out;
  }

  Json operator()(const Number& t) const {
    return with_default(with_unit(ranged("number", t.range), t.unit), plain(*t.value / t.factor));
  }
  Json operator()(const NumberOr& t) const {
    return {{"anyOf", Json::array({ranged("number", t.range), Json{{"const", t.word}}})},
            {"default", t.word}};
  }
  Json operator()(const Integer& t) const { return with_default(ranged("integer", t.range), *t.value); }
  Json operator()(const Boolean& t) const { return with_default({{"type", "boolean"}}, *t.value); }
  Json operator()(const Text& t) const {
    return with_default({{"type", "string"}, {"minLength", t.length.least}, {"maxLength", t.length.most}},
                        *t.value);
  }
  Json operator()(const Choice& t) const {
    return with_default({{"enum", t.names}}, t.names[static_cast<std::size_t>(t.get())]);
  }
  Json operator()(const MeshFile& t) const {
    return with_default({{"type", "string"}, {"minLength", 1}}, t.standard);
  }
  Json operator()(const GradingFile&) const { return {{"type", "string"}, {"minLength", 1}}; }
  Json operator()(const Vector& t) const {
    const Vec3& v = *t.value;
    return with_default(with_unit(list_of(ranged("number", t.range), {3, 3}), t.unit),
                        Json::array({plain(v.x()), plain(v.y()), plain(v.z())}));
  }
  Json operator()(const Numbers& t) const {
    Json standard = Json::array();
    for (const double x : *t.value) standard.push_back(plain(x));
    return with_default(with_unit(list_of(ranged("number", t.range), t.count), t.unit), std::move(standard));
  }
  Json operator()(const Integers& t) const {
    return with_default(list_of(ranged("integer", t.range), t.count), *t.value);
  }
  Json operator()(const Seeds& t) const {
    Json out = list_of({{"type", "integer"}, {"minimum", 0}, {"maximum", kLargestSeed}}, t.count);
    out["uniqueItems"] = true;
    return with_default(std::move(out), *t.value);
  }
  Json operator()(const Texts& t) const {
    return with_default(list_of({{"type", "string"}}, t.count), *t.value);
  }
  Json operator()(const Group& t) const { return schema(t.fields()); }
  Json operator()(const GroupList& t) const {
    t.resize(1);
    Json item = schema(t.fields(0));
    Json names = Json::array();
    for (const Field& field : t.fields(0))
      if (field.required) names.push_back(field.name);
    item["required"] = std::move(names);
    t.resize(0);
    return list_of(std::move(item), t.count);
  }
  Json operator()(const Optionals& t) const {
    t.select(std::vector<bool>(t.names.size(), true));
    Json properties = Json::object();
    for (std::size_t k = 0; k < t.names.size(); ++k) {
      Json& group = properties[std::string(t.names[k])];
      group = schema(t.fields(k));
      group["description"] = t.docs[k];
    }
    t.select(std::vector<bool>(t.names.size(), false));
    return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  }
  /// The keys of all types; those of the others are forbidden once the type is given. `extends` may give it.
  Json operator()(const OneOf& t) const {
    Json all = {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
    Json& properties = all["properties"];
    properties["type"] = {{"enum", t.names}, {"description", t.doc}};
    std::vector<Json> own;
    for (int i = 0; i < static_cast<int>(t.names.size()); ++i) {
      t.select(i);
      own.push_back(schema(t.fields())["properties"]);
      properties.update(own.back());
    }
    t.select(0);
    for (std::size_t i = 0; i < own.size(); ++i) {
      Json others = Json::object();
      for (const auto& [name, value] : properties.items())
        if (name != "type" && !own[i].contains(name)) others[name] = false;
      all["allOf"].push_back(
          {{"if", {{"properties", {{"type", {{"const", t.names[i]}}}}}, {"required", Json::array({"type"})}}},
           {"then", {{"properties", std::move(others)}}}});
    }
    return all;
  }
  Json operator()(const Extends&) const { return {{"type", "string"}, {"minLength", 1}}; }
};

Json schema(const Fields& fields) {
  Json properties = Json::object();
  for (const Field& field : fields) {
    Json& property = properties[std::string(field.name)];
    property = std::visit(TargetSchema{field.required}, field.target);
    std::string doc(field.doc);
    if (property.contains("unit")) doc += fmt::format(" Unit: {}.", property["unit"].get<std::string>());
    property["description"] = std::move(doc);
  }
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

/// Required keys of a map and of the maps in it. A file that extends another need not give them.
Json required_keys(const Fields& fields) {
  Json names = Json::array(), inner = Json::object();
  for (const Field& field : fields) {
    bool needed = field.required;
    if (const auto* group = std::get_if<Group>(&field.target)) {
      Json within = required_keys(group->fields());
      if (within.contains("required")) {
        needed = true;
        inner[std::string(field.name)] = std::move(within);
      }
    } else if (std::holds_alternative<OneOf>(field.target)) {
      inner[std::string(field.name)] = {{"required", Json::array({"type"})}};
    }
    if (needed) names.push_back(field.name);
  }
  Json out = Json::object();
  if (!names.empty()) out["required"] = std::move(names);
  if (!inner.empty()) out["properties"] = std::move(inner);
  return out;
}

}  // namespace

std::string scenario_schema() {
  Scenario standard;
  const Fields fields = scenario_keys(standard);
  Json out = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "scree scenario"},
      {"description", "Simulation of mine waste rock dumped over a bench, or of a repose angle test."}};
  out.update(schema(fields));
  out["if"] = {{"not", {{"required", Json::array({"extends"})}}}};
  out["then"] = required_keys(fields);
  return out.dump(2) + "\n";
}

}  // namespace scree
