#include "sim/scene/scenario_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace scree {

namespace fs = std::filesystem;

namespace {

const std::string_view kWords[] = {"true", "false", "null", "~", "yes", "no", "on", "off"};

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row.back();
}

}  // namespace

std::string found(const YamlNode& node) {
  switch (node.kind) {
    case YamlKind::null:
      return "nothing";
    case YamlKind::sequence:
      return "a list";
    case YamlKind::map:
      return "a map";
    case YamlKind::scalar:
      break;
  }
  return shown(node.text) + (node.quoted ? " in quotes" : "");
}

Parsed parse_number(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure == std::errc::result_out_of_range && stop == end) {
    // Too small for a double is zero; too large is no number.
    const auto exponent = text.find_first_of("eE");
    if (exponent == text.npos || text.substr(exponent + 1, 1) != "-") return Parsed::not_finite;
    value = 0;
    return Parsed::yes;
  }
  if (failure != std::errc() || stop != end) {
    std::string lower(text);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool special = lower == ".inf" || lower == "-.inf" || lower == ".nan";
    return special ? Parsed::not_finite : Parsed::no;
  }
  return std::isfinite(value) ? Parsed::yes : Parsed::not_finite;
}

bool is_plain_text(const YamlNode& node) {
  if (node.kind != YamlKind::scalar) return false;
  double ignored = 0;
  if (node.quoted) return true;
  return std::find(std::begin(kWords), std::end(kWords), node.text) == std::end(kWords) &&
         parse_number(node.text, ignored) == Parsed::no;
}

std::string join(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

fs::path clean_path(const fs::path& path) {
  std::error_code none;
  const fs::path whole = fs::absolute(path, none);
  return (none ? path : whole).lexically_normal();
}

std::string range_text(const Range& range, std::string_view unit) {
  return fmt::format("{}{} to {}{}{}{}", range.low_open ? "more than " : "", range.low,
                     range.high_open ? "less than " : "", range.high, unit.empty() ? "" : " ", unit);
}

std::string suggestion(std::string_view word, const std::vector<std::string>& allowed) {
  if (word.empty() || word.size() > 64) return "";
  // A wrong or missing unit first: the part before the unit is the same.
  const auto stem = [](std::string_view name) {
    for (const std::string_view unit :
         {"_kg_m3", "_deg_per_s", "_m_per_s", "_km_h", "_ft_s", "_pa", "_kpa", "_mpa",
          "_gpa",   "_deg",       "_rad",     "_mm",   "_cm",   "_km", "_ft",  "_in",
          "_kg",    "_lb",        "_ms",      "_min",  "_t",    "_m",  "_s",   "_g"})
      if (name.size() > unit.size() && name.ends_with(unit)) return name.substr(0, name.size() - unit.size());
    return name;
  };
  const std::string* best = nullptr;
  std::size_t least = word.size() / 3 + 2;
  for (const std::string& name : allowed) {
    const std::size_t distance = stem(name) == stem(word) ? 0 : edit_distance(word, name);
    if (distance < least) {
      least = distance;
      best = &name;
    }
  }
  return best != nullptr ? fmt::format(" (did you mean '{}'?)", *best) : "";
}

}  // namespace scree
