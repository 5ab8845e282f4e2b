#include "analysis/results/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/results/outputs.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

// Keys in the order in which they are written.
using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <typename T>
Json number(const std::optional<T>& value) {
  return value ? number(static_cast<double>(*value)) : Json(nullptr);
}

/// {per_seed, mean, std}
Json spread(const std::vector<double>& values) {
  const MeanStd both = mean_std(values);
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return {{"per_seed", list},
          {"mean", both.n > 0 ? number(both.mean) : Json(nullptr)},
          {"std", both.n > 1 ? number(both.std) : Json(nullptr)}};
}

template <typename Value>
auto total(const std::vector<SeedResult>& seeds, Value SeedResult::*field) {
  Value sum{};
  for (const SeedResult& seed : seeds) sum += seed.*field;
  return sum;
}

template <typename Value>
std::vector<double> each(const RunResult& result, Value value) {
  std::vector<double> out;
  for (const SeedResult& seed : result.seeds) out.push_back(value(seed));
  return out;
}

/// Passing curves of one table: shares at the sieves, of the rock as dumped and of each section.
Json passing_curves(const SectionTable& table) {
  Json sections = Json::array();
  for (const Section& section : table.sections) sections.push_back(section.passing);
  return {{"n", table.sections.size()},
          {"dumps", table.dumps},
          {"mass_outside_t", number(table.mass_outside / 1000)},
          {"sieves_m", table.sieves},
          {"original_passing", table.original_passing},
          {"section_passing", sections}};
}

Json outputs(const SeedResult& seed) {
  Json list = Json::object();
  for (const auto& [name, value] : outputs_of(seed)) list[name] = value;
  return list;
}

/// Terms in joules, by what they are.
Json energy(const EnergyTerms& energy) {
  Json put_in = Json::object(), held = Json::object(), taken_out = Json::object();
  for (const EnergyTerm& term : energy.terms) {
    Json& side = term.side == EnergyTerm::Side::put_in ? put_in
                 : term.side == EnergyTerm::Side::held ? held
                                                       : taken_out;
    side[term.name + "_j"] = number(term.joule);
  }
  return {{"put_in", put_in},
          {"still_there", held},
          {"taken_out", taken_out},
          {"put_in_j", number(energy.put_in)},
          {"error_j", number(energy.error)},
          {"error_over_put_in", number(energy.relative_error)}};
}

const char* verdict_of_watch(const std::vector<std::string>& failures) {
  return failures.empty() ? "passed" : "FAILED";
}

Json seed_facts(const SeedResult& seed) {
  Json tables = Json::array();
  for (const SectionTable& table : seed.sections) tables.push_back(passing_curves(table));
  return {{"tables", tables},
          {"seed", seed.seed},
          {"watch", verdict_of_watch(seed.failures)},
          {"energy", seed.energy ? energy(*seed.energy) : Json(nullptr)},
          {"outputs", outputs(seed)},
          {"particles", seed.particles},
          {"fixed_balls", seed.fixed.size()},
          {"mass_t", number(seed.mass / 1000)},
          {"wall_seconds", number(seed.wall_seconds)},
          {"simulated_seconds", number(seed.simulated_seconds)},
          {"squeezed_into_walls", seed.squeezed_into_walls},
          {"crowded_contacts", seed.crowded_contacts},
          {"steps", seed.steps},
          {"particle_steps", number(seed.particle_steps)},
          {"time_step_min_s", number(seed.time_step_min)},
          {"time_step_max_s", number(seed.time_step_max)},
          {"largest_overlap_ratio", number(seed.largest_overlap_ratio)},
          {"lost_particles", seed.lost_particles},
          {"lost_mass_t", number(seed.lost_mass / 1000)},
          {"carried_back_t", seed.carried_back ? number(*seed.carried_back / 1000) : Json()},
          {"at_rest", seed.at_rest},
          {"interrupted", seed.interrupted}};
}

Json section_list(const RunResult& result, std::size_t table) {
  Json list = Json::array();
  const SectionTable* layout = section_layout(result, table);
  if (!layout) return list;
  for (std::size_t i = 0; i < layout->sections.size(); ++i) {
    Json section = {{"name", layout->sections[i].name}, {"x_over_l", number(layout->sections[i].x_over_l)}};
    for (const SectionField& field : section_fields())
      section[field.name] = spread(over_seeds(result, table, i, field.value));
    list.push_back(section);
  }
  return list;
}

std::size_t table_count(const RunResult& result) {
  std::size_t count = 0;
  for (const SeedResult& seed : result.seeds) count = std::max(count, seed.sections.size());
  return count;
}

Json repose(const RunResult& result) {
  const auto reading = [&](double ReposeAngle::*field) {
    return spread(each(result, [&](const SeedResult& seed) {
      return seed.repose ? (*seed.repose).*field : std::numeric_limits<double>::quiet_NaN();
    }));
  };
  return {{"angle_deg", reading(&ReposeAngle::angle)},
          {"height_over_radius_deg", reading(&ReposeAngle::height_over_radius)},
          {"half_coverage_deg", reading(&ReposeAngle::half_coverage)},
          {"height_m", reading(&ReposeAngle::height)},
          {"radius_m", reading(&ReposeAngle::radius)},
          {"runaways", reading(&ReposeAngle::runaways)}};
}

Json heap(const RunResult& result) {
  const auto reading = [&](auto value) {
    return spread(each(result, [&](const SeedResult& seed) {
      return seed.heap ? value(*seed.heap) : std::numeric_limits<double>::quiet_NaN();
    }));
  };
  Json rings = Json::array(), profile = Json::array();
  for (std::size_t k = 0; k < kHeapRings; ++k) {
    Json ring = {{"name", fmt::format("ring{}", k + 1)},
                 {"mass_share", reading([k](const HeapShape& h) { return h.mass_share[k]; })}};
    for (const SectionField& field : section_fields())
      ring[field.name] = reading([&](const HeapShape& h) { return of_ring(h, k, field.value); });
    rings.push_back(ring);
    profile.push_back({{"r_over_radius", kProfilePlaces[k]},
                       {"height_share", reading([k](const HeapShape& h) { return h.profile[k]; })}});
  }
  return {{"rings", rings},
          {"profile", profile},
          {"spread_95", reading([](const HeapShape& h) { return h.spread_95; })}};
}

Json comparison(const Comparison& row) {
  const ReferenceValue& reference = row.reference;
  return {{"quantity", reference.quantity},
          {"section", reference.section},
          {"kind", reference.kind},
          {"case", reference.case_name},
          {"reference", number(reference.value)},
          {"reference_std", number(reference.std)},
          {"relation", reference.relation},
          {"simulated", number(row.simulated)},
          {"simulated_std", number(row.simulated_std)},
          {"z", number(row.z)},
          {"unit", reference.unit},
          {"source", reference.source}};
}

}  // namespace

const std::vector<SectionField>& section_fields() {
  static const std::vector<SectionField> fields{
      {"mass_t", [](const Section& s) { return s.mass / 1000; }},
      {"grains", [](const Section& s) { return static_cast<double>(s.grains); }},
      {"chi", [](const Section& s) { return s.chi; }},
      {"d10_m", [](const Section& s) { return s.d10; }},
      {"d15_m", [](const Section& s) { return s.d15; }},
      {"d50_m", [](const Section& s) { return s.d50; }},
      {"d60_m", [](const Section& s) { return s.d60; }},
      {"d80_m", [](const Section& s) { return s.d80; }},
      {"d90_m", [](const Section& s) { return s.d90; }},
      {"d95_m", [](const Section& s) { return s.d95; }},
      {"share_above_1m", [](const Section& s) { return s.share_above_1m; }},
      {"ksat_rel", [](const Section& s) { return s.ksat_rel; }},
      {"d10_rel", [](const Section& s) { return s.d10_rel; }},
      {"d50_rel", [](const Section& s) { return s.d50_rel; }},
      {"d80_rel", [](const Section& s) { return s.d80_rel; }},
      {"d90_rel", [](const Section& s) { return s.d90_rel; }},
      {"d95_rel", [](const Section& s) { return s.d95_rel; }},
  };
  return fields;
}

const SectionTable* section_layout(const RunResult& result, std::size_t table) {
  for (const SeedResult& seed : result.seeds)
    if (table < seed.sections.size()) return &seed.sections[table];
  return nullptr;
}

std::vector<double> over_seeds(const RunResult& result, std::size_t table, std::size_t section,
                               const std::function<double(const Section&)>& value) {
  return each(result, [&](const SeedResult& seed) {
    if (table >= seed.sections.size() || section >= seed.sections[table].sections.size())
      return std::numeric_limits<double>::quiet_NaN();
    return value(seed.sections[table].sections[section]);
  });
}

void write_summary(const RunResult& result, const std::filesystem::path& file) {
  const std::vector<SeedResult>& seeds = result.seeds;
  double overlap = 0;
  bool at_rest = !seeds.empty();
  Json numbers = Json::array(), facts = Json::array(), rows = Json::array(), further = Json::array();
  for (const SeedResult& seed : seeds) {
    overlap = std::max(overlap, seed.largest_overlap_ratio);
    at_rest = at_rest && seed.at_rest;
    numbers.push_back(seed.seed);
    facts.push_back(seed_facts(seed));
  }
  for (const Comparison& row : result.comparison) rows.push_back(comparison(row));
  for (std::size_t table = 1; table < table_count(result); ++table)
    further.push_back({{"n", section_layout(result, table)->sections.size()},
                       {"dumps", section_layout(result, table)->dumps},
                       {"sections", section_list(result, table)}});

  Json out = {{"watch", verdict_of_watch(result.failures)},
              {"failures", result.failures},
              {"title", result.title},
              {"scenario", result.scenario},
              {"engine", result.engine},
              {"version", result.version},
              {"seeds", numbers},
              {"particles", total(seeds, &SeedResult::particles)},
              {"wall_seconds", number(result.wall_seconds)},
              {"simulated_seconds", number(total(seeds, &SeedResult::simulated_seconds))},
              {"steps", total(seeds, &SeedResult::steps)},
              {"particle_steps", number(total(seeds, &SeedResult::particle_steps))},
              {"largest_overlap_ratio", number(overlap)},
              {"lost_particles", total(seeds, &SeedResult::lost_particles)},
              {"lost_mass_t", number(total(seeds, &SeedResult::lost_mass) / 1000)},
              {"energy_error_over_put_in", number(largest_energy_error(result))},
              {"at_rest", at_rest},
              {"interrupted", unfinished(result)},
              {"per_seed", facts},
              {"sections", section_list(result, 0)},
              {"further_sections", further}};
  if (std::any_of(seeds.begin(), seeds.end(), [](const SeedResult& seed) { return seed.repose.has_value(); }))
    out["repose"] = repose(result);
  if (std::any_of(seeds.begin(), seeds.end(), [](const SeedResult& seed) { return seed.heap.has_value(); }))
    out["heap"] = heap(result);
  if (std::any_of(seeds.begin(), seeds.end(),
                  [](const SeedResult& seed) { return seed.slope_angle.has_value(); }))
    out["slope_angle"] = spread(each(result, [](const SeedResult& seed) {
      return seed.slope_angle.value_or(std::numeric_limits<double>::quiet_NaN());
    }));
  if (std::any_of(seeds.begin(), seeds.end(),
                  [](const SeedResult& seed) { return seed.rebound_height.has_value(); }))
    out["rebound_height_m"] = spread(each(result, [](const SeedResult& seed) {
      return seed.rebound_height.value_or(std::numeric_limits<double>::quiet_NaN());
    }));
  out["comparison"] = rows;
  out["notes"] = result.notes;
  // Text from a scenario may hold bytes that are no UTF-8; they are replaced rather than refused.
  write_text_file(file, out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void write_sections_csv(const RunResult& result, const std::filesystem::path& file) {
  std::string text = "seed,sections,dumps,section,x_over_l";
  for (const SectionField& field : section_fields()) text += fmt::format(",{}", field.name);
  text += '\n';
  for (const SeedResult& seed : result.seeds) {
    for (const SectionTable& table : seed.sections) {
      for (const Section& section : table.sections) {
        text += fmt::format("{},{},{},{},{:.6g}", seed.seed, table.sections.size(), table.dumps, section.name,
                            section.x_over_l);
        for (const SectionField& field : section_fields()) {
          const double value = field.value(section);
          text += std::isfinite(value) ? fmt::format(",{:.6g}", value) : ",";
        }
        text += '\n';
      }
    }
  }
  write_text_file(file, text);
}

double largest_energy_error(const RunResult& result) {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (const SeedResult& seed : result.seeds) {
    if (!seed.energy) continue;
    const double error = seed.energy->relative_error;
    if (!std::isfinite(error)) return error;
    if (!(std::abs(error) <= std::abs(largest))) largest = error;
  }
  return largest;
}

std::string energy_in_words(double relative_error, bool closed) {
  return std::isfinite(relative_error)
             ? fmt::format("{} {:.2f} %", closed ? "closed to" : "open by", 100 * std::abs(relative_error))
             : "not a number";
}

bool unfinished(const RunResult& result) {
  return std::any_of(result.seeds.begin(), result.seeds.end(),
                     [](const SeedResult& seed) { return seed.interrupted; });
}

double share_in_no_section(const RunResult& result) {
  double outside = 0, all = 0;
  for (const SeedResult& seed : result.seeds) {
    if (seed.sections.empty() || !(result.bench_height > 0)) continue;
    outside += seed.sections.front().mass_outside;
    all += seed.sections.front().mass_outside;
    for (const Section& section : seed.sections.front().sections) all += section.mass;
  }
  return all > 0 ? outside / all : 0;
}

std::string why_no_repose_angle(const SeedResult& seed) {
  if (!seed.repose || std::isfinite(seed.repose->angle)) return "";
  if (!seed.at_rest) return "not at rest";
  if (!std::isfinite(seed.repose->radius))
    return "no radius: the middle of the heap lies in a gap between its grains";
  return "no flank: the mean surface about the heap's axis does not fall from 80 % to 20 % of its height "
         "over "
         "two rings or more";
}

}  // namespace scree
