#include "cli/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <thread>

#include "analysis/results/output_units.h"
#include "sim/material/input_text.h"
#include "sim/scene/scenario.h"

namespace {

constexpr double kLongest = 1e4;  // m, or m/px

std::optional<double> length_of(std::string_view text) {
  const auto unit_at = text.find_first_not_of("0123456789.eE+-");
  if (unit_at == std::string_view::npos) return std::nullopt;
  const auto value = scree::number_in(text.substr(0, unit_at));
  const auto factor = scree::unit_factor(std::string(scree::trimmed(text.substr(unit_at))), "m");
  if (!value || !factor || !(*value > 0) || *value * *factor > kLongest) return std::nullopt;
  return *value * *factor;
}

}  // namespace

int cores_or(int asked) {
  return asked > 0 ? asked : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

std::optional<double> length_in(const std::string& option, const std::string& text) {
  const auto length = length_of(text);
  if (!length)
    fmt::print(stderr, "{} {}: a length above 0 with its unit, like 0.5m, 50cm, 500mm\n", option, text);
  return length;
}

std::optional<double> scale_in(const std::string& option, const std::string& text) {
  const std::string_view given = text;
  const auto slash = given.find("/px");
  const auto length = slash == std::string_view::npos || slash + 3 != given.size()
                          ? std::nullopt
                          : length_of(given.substr(0, slash));
  if (!length) fmt::print(stderr, "{} {}: a length a pixel, like 1.2cm/px or 12mm/px\n", option, text);
  return length;
}

std::optional<std::pair<double, double>> pair_in(const std::string& option, const std::string& text,
                                                 char separator) {
  const std::string_view given = text;
  const auto at = given.find(separator);
  if (at != std::string_view::npos) {
    const auto first = scree::number_in(given.substr(0, at)), second = scree::number_in(given.substr(at + 1));
    if (first && second) return std::pair(*first, *second);
  }
  fmt::print(stderr, "{} {}: two numbers, A{}B\n", option, text, separator);
  return std::nullopt;
}

CLI::Validator within(double low, double high) {
  const auto refuse = [=](const std::string& text) {
    const auto value = scree::number_in(text);
    return value && *value >= low && *value <= high
               ? std::string()
               : fmt::format("Value {} not in range {:g} to {:g}", text, low, high);
  };
  return {refuse, fmt::format("in [{:g} - {:g}]", low, high)};
}

CLI::Validator whole(std::int64_t low, std::int64_t high) {
  const auto refuse = [=](const std::string& text) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range)
      return fmt::format("Value {} not in range {} to {}", text, low, high);
    const bool plain = error == std::errc() && end == text.data() + text.size() && text.front() != '-' &&
                       (text.size() == 1 || text.front() != '0');
    if (plain && value >= low && value <= high) return std::string();
    return plain || value < 0 ? fmt::format("Value {} not in range {} to {}", text, low, high)
                              : fmt::format("Value {} is no whole number", text);
  };
  return {refuse, fmt::format("in [{} - {}]", low, high)};
}

CLI::Validator given() {
  const auto refuse = [](const std::string& text) {
    return text.empty() || text.starts_with("--") ? std::string("needs a value") : std::string();
  };
  return {refuse, ""};
}

bool is_of_kind(const std::filesystem::path& file, scree::FileKind wanted) {
  const std::string why = scree::why_another_kind(file, wanted);
  if (!why.empty()) fmt::print(stderr, "{}\n", why);
  return why.empty();
}

bool nothing_wrong(const std::vector<scree::ScenarioError>& errors,
                   const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
  for (const scree::ScenarioError& error : errors) fmt::print(stderr, "{}\n", error.text());
  return errors.empty();
}

bool given_twice(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    std::error_code none;
    const auto is_same = [&](const std::filesystem::path& other) {
      return std::filesystem::equivalent(file, other, none);
    };
    if (std::count_if(files.begin(), files.end(), is_same) > 1) {
      fmt::print(stderr, "{}: is given twice; every measurement would count twice\n", file.string());
      return true;
    }
  }
  return false;
}
