#pragma once
// The outcome of a run for other programs: summary.json and sections.csv.
#include <filesystem>
#include <functional>
#include <vector>

#include "analysis/results/results.h"

namespace scree {

/// Writes summary.json in one step (a reader never sees half of it). Totals are over all seeds, `per_seed`
/// lists each; a value that does not exist (an empty section, the deviation of one seed) is null. `sections`
/// is the scenario's own number of sections, `further_sections` the other ones. Throws std::runtime_error
/// when the file cannot be written.
void write_summary(const RunResult& result, const std::filesystem::path& file);

/// Largest error of the seeds' energy balances by size, with its sign, over what was put in; NaN if no seed
/// has one.
double largest_energy_error(const RunResult& result);

/// "closed to 0.02 %", or "open by 3.10 %" where the balance does not hold.
std::string energy_in_words(double relative_error, bool closed);

/// Share of the rock in the first table of sections that lies above the crest's height and so in none of
/// them, over all seeds; 0 without a bench.
double share_in_no_section(const RunResult& result);

/// A seed was ended by the user before its pile was finished: nothing is held against printed values then.
bool unfinished(const RunResult& result);
inline constexpr double kMuchInNoSection = 0.1;  ///< above it sections do not stand for the pile

/// Why the heap of a repose test has no repose angle: "not at rest", "no radius: ..." or "no flank: ...";
/// empty if it has one, and for other experiments.
std::string why_no_repose_angle(const SeedResult& seed);

/// What other programs need of a summary.json.
struct StoredRun {
  std::string title;
  std::vector<std::uint64_t> seeds;
  std::vector<Outputs> outputs;      ///< of each seed
  std::vector<double> wall_seconds;  ///< of each seed, 0 where it is not said
  std::vector<std::string> cases;    ///< reference cases it was compared with
  bool interrupted = false;          ///< before a pile was finished
};

/// Reads the text of a summary.json, or the file. Throws std::runtime_error `what is wrong`, the second with
/// the file's name before it.
StoredRun parse_summary(const std::string& text);
StoredRun read_summary(const std::filesystem::path& file);

/// Writes sections.csv: one row for each seed, table and section; a value that does not exist is empty.
/// Throws std::runtime_error when the file cannot be written.
void write_sections_csv(const RunResult& result, const std::filesystem::path& file);

/// A value of one section for each seed, in the order of the seeds; NaN for a seed without this section.
std::vector<double> over_seeds(const RunResult& result, std::size_t table, std::size_t section,
                               const std::function<double(const Section&)>& value);

/// The table number `table` of the first seed that has it (names and places of the sections); none when no
/// seed has it.
const SectionTable* section_layout(const RunResult& result, std::size_t table);

/// A number of a section under its name in summary.json and sections.csv.
struct SectionField {
  const char* name;
  std::function<double(const Section&)> value;
};
const std::vector<SectionField>& section_fields();

}  // namespace scree
