#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "sim/scene/scenario_read.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// Shortest text that is read back as the same double.
std::string number_text(double value) {
  return fmt::format("{}", value);
}

/// Shortest text x with factor * x == value: dividing alone may miss `value` by one unit in the last place.
std::string scaled_text(double value, double factor) {
  if (factor == 1) return number_text(value);
  const double guess = value / factor;
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string rounded = fmt::format("{:.{}g}", guess, digits);
    double x = 0;
    std::from_chars(rounded.data(), rounded.data() + rounded.size(), x);
    if (x * factor == value) return number_text(x);
  }
  const double below = std::nextafter(guess, -HUGE_VAL), above = std::nextafter(guess, HUGE_VAL);
  return number_text(below * factor == value ? below : above * factor == value ? above : guess);
}

template <class T, class F>
std::string flow(const T& values, F one) {
  std::string out = "[";
  for (const auto& value : values) out += (out.size() > 1 ? ", " : "") + one(value);
  return out + "]";
}

class Writer {
 public:
  explicit Writer(const fs::path& asset_dir) : asset_dir_(clean_path(asset_dir)) {}

  void fields(const Fields& all, int indent) {
    for (const Field& field : all)
      std::visit([&](const auto& target) { write(target, field.name, indent); }, field.target);
  }

  std::string out;

 private:
  void line(int indent, std::string_view name, const std::string& value) {
    const auto spaces = static_cast<std::size_t>(indent);
    out += first_of_item_ ? std::string(spaces - 2, ' ') + "- " : std::string(spaces, ' ');
    first_of_item_ = false;
    out += fmt::format("{}:{}{}\n", name, value.empty() ? "" : " ", value);
  }

  void write(const Number& t, std::string_view name, int indent) {
    line(indent, name, scaled_text(*t.value, t.factor));
  }
  void write(const NumberOr& t, std::string_view name, int indent) {
    line(indent, name, *t.value ? number_text(**t.value) : std::string(t.word));
  }
  void write(const Integer& t, std::string_view name, int indent) {
    line(indent, name, std::to_string(*t.value));
  }
  void write(const Boolean& t, std::string_view name, int indent) {
    line(indent, name, *t.value ? "true" : "false");
  }
  void write(const Text& t, std::string_view name, int indent) { line(indent, name, yaml_text(*t.value)); }
  void write(const Choice& t, std::string_view name, int indent) {
    line(indent, name, std::string(t.names[static_cast<std::size_t>(t.get())]));
  }
  void write(const MeshFile& t, std::string_view name, int indent) {
    line(indent, name, yaml_text(asset_name(*t.value, asset_dir_).value_or(t.value->string())));
  }
  void write(const GradingFile& t, std::string_view name, int indent) {
    const auto in_gradings = asset_name(*t.value, asset_dir_ / "gradings");
    const bool named =
        in_gradings && in_gradings->find('/') == std::string::npos && in_gradings->ends_with(".csv");
    line(indent, name, yaml_text(named ? t.value->stem().string() : t.value->string()));
  }
  void write(const Vector& t, std::string_view name, int indent) {
    const Vec3& v = *t.value;
    line(indent, name, flow(std::vector<double>{v.x(), v.y(), v.z()}, number_text));
  }
  void write(const Numbers& t, std::string_view name, int indent) {
    line(indent, name, flow(*t.value, number_text));
  }
  void write(const Integers& t, std::string_view name, int indent) {
    line(indent, name, flow(*t.value, [](int i) { return std::to_string(i); }));
  }
  void write(const Seeds& t, std::string_view name, int indent) {
    line(indent, name, flow(*t.value, [](std::uint64_t i) { return std::to_string(i); }));
  }
  void write(const Texts& t, std::string_view name, int indent) {
    line(indent, name, flow(*t.value, yaml_text));
  }
  void write(const Group& t, std::string_view name, int indent) {
    line(indent, name, "");
    fields(t.fields(), indent + 2);
  }
  void write(const GroupList& t, std::string_view name, int indent) {
    line(indent, name, t.size() == 0 ? "[]" : "");
    for (std::size_t i = 0; i < t.size(); ++i) {
      first_of_item_ = true;
      fields(t.fields(i), indent + 4);
    }
  }
  void write(const Optionals& t, std::string_view name, int indent) {
    const std::vector<bool> there = t.there();
    if (std::find(there.begin(), there.end(), true) == there.end()) return;
    line(indent, name, "");
    for (std::size_t k = 0; k < there.size(); ++k) {
      if (!there[k]) continue;
      line(indent + 2, t.names[k], "");
      fields(t.fields(k), indent + 4);
    }
  }
  void write(const OneOf& t, std::string_view name, int indent) {
    line(indent, name, "");
    line(indent + 2, "type", std::string(t.names[static_cast<std::size_t>(t.get())]));
    fields(t.fields(), indent + 2);
  }
  void write(const Extends&, std::string_view, int) {}

  static std::optional<std::string> asset_name(const fs::path& file, const fs::path& folder) {
    const fs::path relative = file.lexically_relative(folder);
    if (relative.empty() || *relative.begin() == "..") return std::nullopt;
    return relative.string();
  }

  fs::path asset_dir_;
  bool first_of_item_ = false;
};

}  // namespace

std::string write_scenario(Scenario scenario, const fs::path& asset_dir) {
  Writer writer(asset_dir);
  writer.fields(scenario_keys(scenario), 0);
  return std::move(writer.out);
}

}  // namespace scree
