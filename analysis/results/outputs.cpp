#include "analysis/results/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "analysis/results/summary.h"
#include "sim/material/input_text.h"

namespace scree {
namespace {

constexpr const char* kCells[] = {"top", "middle", "bottom"};

constexpr std::array kOfEveryRun{"particles", "simulated_seconds", "largest_overlap_ratio", "lost_mass_t",
                                 "at_rest"};
constexpr std::array kOfEveryDump{"sections", "dumps", "share_above_1m_orig"};

std::vector<std::string> plain_names(const std::string& experiment) {
  std::vector<std::string> names(kOfEveryRun.begin(), kOfEveryRun.end());
  const auto add = [&](std::initializer_list<const char*> more) {
    names.insert(names.begin(), more.begin(), more.end());
  };
  if (experiment == "repose_lift")
    add({"angle_deg", "height_over_radius_deg", "half_coverage_deg", "height_m", "radius_m", "runaways",
         "chi_ring1", "chi_ring2", "chi_ring3", "d50_rel_ring1", "d50_rel_ring2", "d50_rel_ring3",
         "mass_share_ring1", "mass_share_ring2", "mass_share_ring3", "profile_25", "profile_50", "profile_75",
         "spread_95"});
  else if (experiment == "drop_test")
    add({"rebound_height_m"});
  else {
    names.insert(names.end(), kOfEveryDump.begin(), kOfEveryDump.end());
    add({"slope_angle_deg", "chi_zero_x_over_l"});
  }
  if (experiment == "end_dump" || experiment == "bucket_dump") add({"carried_back_t"});
  if (experiment == "end_dump" || experiment == "push_dump")
    add({"point1_toe_width_m", "inside_porosity", "inside_mean_abs_chi", "inside_ksat_contrast",
         "layer_coarsening_down", "layer_variance_between", "layer_variance_by_chance", "largest_at_toe",
         "flow_depth_m", "arrival_energy_j_per_kg", "arrival_share_of_drop"});
  return names;
}

bool has_sections(const std::string& experiment) {
  return experiment == "end_dump" || experiment == "push_dump" || experiment == "bucket_dump";
}

bool contains(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

enum class Given { yes, no, not_by_this_one };

// not_by_this_one: others of its type give it.
Given given(const OutputScope& scope, const std::string& output) {
  const std::vector<std::string> plain = plain_names(scope.experiment);
  if (std::find(plain.begin(), plain.end(), output) != plain.end()) return Given::yes;
  if (!has_sections(scope.experiment) || output.size() > kLongestName) return Given::no;
  // Numbers of up to four digits: no pile has more sections or loads.
  static const std::regex slope(
      "([a-z0-9_]+)_S([1-9][0-9]{0,3})(?:of([1-9][0-9]{0,3}))?(?:_dump([1-9][0-9]{0,3}))?");
  static const std::regex cell("([a-z0-9_]+)_(top|middle|bottom)");
  const bool cells = scope.experiment == "bucket_dump";
  std::smatch parts;
  if (!std::regex_match(output, parts, cells ? cell : slope)) return Given::no;
  static const std::set<std::string> of_bench{"lateral_chi_std", "lateral_chi_range", "lateral_d50_rel_std",
                                              "flow_speed", "flow_fast"};
  const auto& fields = section_fields();
  const bool of_section = std::any_of(fields.begin(), fields.end(),
                                      [&](const SectionField& field) { return parts[1] == field.name; });
  if (cells) return of_section ? Given::yes : Given::no;
  const bool plain_section = !parts[3].matched && !parts[4].matched;
  if (!of_section && !(of_bench.contains(parts[1]) && plain_section)) return Given::no;
  const int count = parts[3].matched ? std::stoi(parts[3]) : scope.sections;
  if (std::stoi(parts[2]) > count) return Given::not_by_this_one;
  if (parts[3].matched && !contains(scope.further_sections, count)) return Given::not_by_this_one;
  return parts[4].matched && !contains(scope.after_dumps, std::stoi(parts[4])) ? Given::not_by_this_one
                                                                               : Given::yes;
}

// Where chi changes sign along the slope, from the crest; linear between the middles of sections.
double chi_zero(const SectionTable& table) {
  const auto& s = table.sections;
  for (std::size_t i = 1; i < s.size(); ++i)
    if (s[i - 1].chi < 0 && s[i].chi >= 0)
      return s[i - 1].x_over_l +
             (s[i].x_over_l - s[i - 1].x_over_l) * s[i - 1].chi / (s[i - 1].chi - s[i].chi);
  return std::numeric_limits<double>::quiet_NaN();
}

// What follows the name of a section: of6 unless the table is the scenario's own, _dump3 unless it is the
// finished pile.
std::string suffix(int count, int own, int dump, int dumps) {
  return (count == own ? std::string() : fmt::format("of{}", count)) +
         (dump == dumps ? std::string() : fmt::format("_dump{}", dump));
}

int whole_number(const Outputs& outputs, const char* name) {
  const auto found = outputs.find(name);
  return found == outputs.end() ? 0 : static_cast<int>(found->second);
}

std::string output_name(const std::string& quantity) {
  if (quantity == "angle" || quantity == "slope_angle") return quantity + "_deg";
  if (quantity == "rebound_height") return quantity + "_m";
  if (quantity == "xl_chi_zero") return "chi_zero_x_over_l";
  if (quantity == "toe_width") return "point1_toe_width_m";
  static const std::regex diameter("d[0-9]+");
  return std::regex_match(quantity, diameter) ? quantity + "_m" : quantity;
}

// A name as outputs are written: chi_S1 for Chi_s1.
std::string in_our_case(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::regex_replace(name, std::regex("_s([0-9])"), "_S$1");
}

}  // namespace

Outputs outputs_of(const SeedResult& seed) {
  Outputs outputs;
  const auto add = [&](const std::string& name, double value) {
    if (std::isfinite(value)) outputs[name] = value;
  };
  add("particles", static_cast<double>(seed.particles));
  add("simulated_seconds", seed.simulated_seconds);
  add("largest_overlap_ratio", seed.largest_overlap_ratio);
  add("lost_mass_t", seed.lost_mass / 1000);
  add("at_rest", seed.at_rest ? 1 : 0);
  if (seed.repose) {
    add("angle_deg", seed.repose->angle);
    add("height_over_radius_deg", seed.repose->height_over_radius);
    add("half_coverage_deg", seed.repose->half_coverage);
    add("height_m", seed.repose->height);
    add("radius_m", seed.repose->radius);
    add("runaways", seed.repose->runaways);
  }
  if (seed.heap) {
    for (std::size_t k = 0; k < kHeapRings; ++k) {
      const std::string ring = fmt::format("ring{}", k + 1);
      add("chi_" + ring, of_ring(*seed.heap, k, [](const Section& s) { return s.chi; }));
      add("d50_rel_" + ring, of_ring(*seed.heap, k, [](const Section& s) { return s.d50_rel; }));
      add("mass_share_" + ring, seed.heap->mass_share[k]);
      add(fmt::format("profile_{:.0f}", 100 * kProfilePlaces[k]), seed.heap->profile[k]);
    }
    add("spread_95", seed.heap->spread_95);
  }
  if (seed.carried_back) add("carried_back_t", *seed.carried_back / 1000);
  if (seed.slope_angle) add("slope_angle_deg", *seed.slope_angle);
  if (seed.rebound_height) add("rebound_height_m", *seed.rebound_height);
  if (seed.sections.empty()) return outputs;
  const SectionTable& first = seed.sections.front();
  const int own = static_cast<int>(first.sections.size());
  add("sections", own);
  add("dumps", first.dumps);
  add("share_above_1m_orig", first.original_above_1m);
  add("chi_zero_x_over_l", chi_zero(first));
  for (const SectionTable& table : seed.sections) {
    const std::string after = suffix(static_cast<int>(table.sections.size()), own, table.dumps, first.dumps);
    for (const Section& section : table.sections)
      for (const SectionField& field : section_fields())
        add(fmt::format("{}_{}{}", field.name, section.name, after), field.value(section));
  }
  if (seed.inside) {
    add("inside_porosity", seed.inside->mean_porosity);
    add("inside_mean_abs_chi", seed.inside->mean_abs_chi);
    add("inside_ksat_contrast", seed.inside->ksat_grading_contrast);
  }
  if (seed.layers) {
    add("layer_coarsening_down", seed.layers->mean_coarsening_down);
    add("layer_variance_between", seed.layers->variance_between);
    add("layer_variance_by_chance", seed.layers->variance_by_chance);
  }
  if (seed.largest_at_toe) add("largest_at_toe", *seed.largest_at_toe);
  if (seed.flow) {
    const std::vector<double> speeds = seed.flow->mean_speed();
    for (std::size_t k = 0; k < speeds.size(); ++k) {
      add(fmt::format("flow_speed_S{}", k + 1), speeds[k]);
      add(fmt::format("flow_fast_S{}", k + 1), seed.flow->highest_fast()[k]);
    }
    add("flow_depth_m", seed.flow->largest_depth());
    const auto arrival = seed.flow->arrival();
    add("arrival_energy_j_per_kg", arrival.mean_energy);
    add("arrival_share_of_drop", arrival.share_of_drop);
  }
  if (seed.lateral) {
    add("point1_toe_width_m", seed.lateral->point1_toe_width);
    for (const LateralSection& section : seed.lateral->sections) {
      add("lateral_chi_std_" + section.name, section.chi_std);
      add("lateral_chi_range_" + section.name, section.chi_range);
      add("lateral_d50_rel_std_" + section.name, section.d50_rel_std);
    }
  }
  return outputs;
}

std::vector<Outputs> outputs_of(const std::vector<SeedResult>& seeds) {
  std::vector<Outputs> all;
  for (const SeedResult& seed : seeds) all.push_back(outputs_of(seed));
  return all;
}

PileValue pile_value(const ReferenceValue& reference) {
  return {reference.quantity, reference.section, section_count(reference), reference.dumps};
}

std::optional<std::string> output_name_for(const PileValue& value, const Outputs& outputs) {
  const std::string name = output_name(value.quantity);
  const auto if_there = [&](const std::string& key) {
    return outputs.contains(key) ? std::optional(key) : std::nullopt;
  };
  const int own = whole_number(outputs, "sections"), dumps = whole_number(outputs, "dumps");
  if (value.section == "whole") return if_there(name);
  if (value.quantity == "toe_width") return own == value.sections ? if_there(name) : std::nullopt;
  std::string section = value.section;
  for (int i = 0; i < 3; ++i)
    if (section == kCells[i]) {
      if (const auto cell = if_there(fmt::format("{}_{}", name, section))) return cell;
      section = fmt::format("S{}", i + 1);
    }
  const auto after = [&](int dump) {
    return if_there(fmt::format("{}_{}{}", name, section, suffix(value.sections, own, dump, dumps)));
  };
  if (value.dumps > 0 && value.dumps != dumps)
    if (const auto then = after(value.dumps)) return then;
  return after(dumps);
}

std::optional<double> output_for(const PileValue& value, const Outputs& outputs) {
  const auto name = output_name_for(value, outputs);
  return name ? std::optional(outputs.at(*name)) : std::nullopt;
}

bool finished_pile_instead(const PileValue& value, const Outputs& outputs) {
  const int dumps = whole_number(outputs, "dumps");
  if (value.dumps == 0 || dumps == 0 || value.dumps == dumps) return false;
  const auto name = output_name_for(value, outputs);
  return name && !name->ends_with(fmt::format("_dump{}", value.dumps));
}

bool is_of_the_run(const std::string& output) {
  const auto in = [&](const auto& names) {
    return std::find(names.begin(), names.end(), output) != names.end();
  };
  return in(kOfEveryRun) || in(kOfEveryDump);
}

std::string why_not_given(const OutputScope& scope, const std::string& output) {
  if (scope.measured && is_of_the_run(output))
    return "says something of a run, and is not measured on a pile";
  const Given answer = given(scope, output);
  if (answer == Given::yes) return {};
  if (answer == Given::not_by_this_one)
    return fmt::format(
        "this scenario cuts the slope into {} sections, without 'of' (output.sections){}{}", scope.sections,
        scope.further_sections.empty()
            ? ", no others (output.further_sections)"
            : fmt::format(" and {} (output.further_sections)", fmt::join(scope.further_sections, ", ")),
        scope.after_dumps.empty() ? ", and keeps no pile before the last load (output.after_dumps)"
                                  : fmt::format(", and keeps the pile after loads {} (output.after_dumps) "
                                                "and the finished one, without '_dump'",
                                                fmt::join(scope.after_dumps, ", ")));
  if (const std::string other = in_our_case(output); other != output && given(scope, other) == Given::yes)
    return fmt::format("did you mean '{}'?", other);
  std::vector<std::string> names = plain_names(scope.experiment);
  if (scope.measured) std::erase_if(names, is_of_the_run);
  if (has_sections(scope.experiment))
    for (const SectionField& field : section_fields())
      names.push_back(fmt::format("{}_{}", field.name, scope.experiment == "bucket_dump" ? "top" : "S1"));
  return fmt::format("a scenario of type {} does not give it; it gives {}{}", scope.experiment,
                     fmt::join(names, ", "),
                     scope.experiment == "bucket_dump" ? "; middle and bottom alike"
                     : has_sections(scope.experiment)  ? "; S2, S3 and so on alike, S1of3, S1_dump2"
                                                       : "");
}

}  // namespace scree
