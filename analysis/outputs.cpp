#include "analysis/outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "analysis/summary.h"

namespace scree {
namespace {

constexpr const char* kCells[] = {"top", "middle", "bottom"};

std::vector<std::string> plain_names(const std::string& experiment) {
  std::vector<std::string> names{"particles", "simulated_seconds", "largest_overlap_ratio", "lost_mass_t",
                                 "at_rest"};
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
  else
    add({"slope_angle_deg", "chi_zero_x_over_l", "share_above_1m_orig", "sections", "dumps"});
  if (experiment == "end_dump" || experiment == "push_dump")
    add({"point1_toe_width_m", "inside_porosity", "inside_mean_abs_chi", "inside_ksat_contrast",
         "layer_coarsening_down", "layer_variance_between", "layer_variance_by_chance", "largest_at_toe",
         "flow_depth_m", "arrival_energy_j_per_kg", "arrival_share_of_drop"});
  return names;
}

bool has_sections(const std::string& experiment) {
  return experiment == "end_dump" || experiment == "push_dump" || experiment == "bucket_dump";
}

bool may_give(const std::string& experiment, const std::string& output) {
  const std::vector<std::string> plain = plain_names(experiment);
  if (std::find(plain.begin(), plain.end(), output) != plain.end()) return true;
  if (!has_sections(experiment)) return false;
  static const std::regex slope("([a-z0-9_]+)_S[1-9][0-9]*(of[1-9][0-9]*)?(_dump[1-9][0-9]*)?");
  static const std::regex cell("([a-z0-9_]+)_(top|middle|bottom)");
  std::smatch parts;
  if (!std::regex_match(output, parts, experiment == "bucket_dump" ? cell : slope)) return false;
  static const std::set<std::string> of_bench{"lateral_chi_std", "lateral_chi_range", "lateral_d50_rel_std",
                                              "flow_speed", "flow_fast"};
  if (of_bench.contains(parts[1]))
    return experiment != "bucket_dump" && !parts[2].matched && !parts[3].matched;
  const auto& fields = section_fields();
  return std::any_of(fields.begin(), fields.end(),
                     [&](const SectionField& field) { return parts[1] == field.name; });
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
      const Section& ring = seed.heap->rings.sections[k];
      add("chi_" + ring.name, ring.chi);
      add("d50_rel_" + ring.name, ring.d50_rel);
      add("mass_share_" + ring.name, seed.heap->mass_share[k]);
      add(fmt::format("profile_{:.0f}", 100 * kProfilePlaces[k]), seed.heap->profile[k]);
    }
    add("spread_95", seed.heap->spread_95);
  }
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
    add("arrival_energy_j_per_kg", seed.flow->arrival().mean_energy);
    add("arrival_share_of_drop", seed.flow->arrival().share_of_drop);
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

std::optional<std::string> output_name_for(const ReferenceValue& reference, const Outputs& outputs) {
  const std::string name = output_name(reference.quantity);
  const auto if_there = [&](const std::string& key) {
    return outputs.contains(key) ? std::optional(key) : std::nullopt;
  };
  const int own = whole_number(outputs, "sections"), dumps = whole_number(outputs, "dumps");
  const int count = section_count(reference);
  if (reference.section == "whole") return if_there(name);
  if (reference.quantity == "toe_width") return own == count ? if_there(name) : std::nullopt;
  std::string section = reference.section;
  for (int i = 0; i < 3; ++i)
    if (section == kCells[i]) {
      if (const auto cell = if_there(fmt::format("{}_{}", name, section))) return cell;
      section = fmt::format("S{}", i + 1);
    }
  const auto after = [&](int dump) {
    return if_there(fmt::format("{}_{}{}", name, section, suffix(count, own, dump, dumps)));
  };
  if (reference.dumps > 0 && reference.dumps != dumps)
    if (const auto then = after(reference.dumps)) return then;
  return after(dumps);
}

std::optional<double> output_for(const ReferenceValue& reference, const Outputs& outputs) {
  const auto name = output_name_for(reference, outputs);
  return name ? std::optional(outputs.at(*name)) : std::nullopt;
}

std::string why_not_given(const std::string& experiment, const std::string& output) {
  if (may_give(experiment, output)) return {};
  std::vector<std::string> names = plain_names(experiment);
  if (has_sections(experiment))
    for (const SectionField& field : section_fields())
      names.push_back(fmt::format("{}_{}", field.name, experiment == "bucket_dump" ? "top" : "S1"));
  return fmt::format("a scenario of type {} does not give it; it gives {}{}", experiment,
                     fmt::join(names, ", "),
                     experiment == "bucket_dump" ? "; middle and bottom alike"
                     : has_sections(experiment)  ? "; S2, S3 and so on alike, S1of3, S1_dump2"
                                                 : "");
}

}  // namespace scree
