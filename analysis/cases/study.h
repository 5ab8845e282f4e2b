#pragma once
// Disposal options of one rock held against each other.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results/finished_runs.h"

namespace scree {

/// One way to dispose of the rock, and its finished runs.
struct StudyOption {
  std::string name;
  double tonnes_per_load = 0;
  std::optional<double> cost_per_t;  ///< of equipment, in the study's currency
  FinishedRuns runs;
};

/// What options are held against each other by; smaller is better for all of them.
struct StudyCriterion {
  const char *name, *words;
  /// The number of one seed; none where it does not exist.
  std::optional<double> (*of)(const Outputs& seed);
};

/// chi_range (chi of the lowest section less that of the crest), d50_ratio and ksat_ratio (toe over crest),
/// lateral_chi_std (mean over sections), inside_ksat_contrast, largest_at_toe.
const std::vector<StudyCriterion>& study_criteria();
/// The one of this name; null if there is none.
const StudyCriterion* study_criterion(const std::string& name);

/// An option's place.
struct StudyRank {
  std::size_t option = 0;       ///< its index
  std::optional<int> rank = 1;  ///< options with the same rank are a tie; none: not ranked
  MeanStd value;
  double p = 1;  ///< two-sided, against the best of its rank (Welch); 1 for that one itself
};

/// Options by rising mean of the criterion; those without a value are left out. An option whose difference to
/// the best of the present rank is within the scatter of seeds (p >= 0.05) shares its rank. The scatter of
/// one with a single seed is not known: it is not ranked, and stands behind the others.
std::vector<StudyRank> rank_options(const std::vector<StudyOption>& options, const StudyCriterion& criterion);

/// The answer in a sentence: what comes first, and what cannot be told from it.
std::string study_answer(const std::vector<StudyOption>& options, const StudyCriterion& criterion);

/// The ranking in words, a line each.
std::vector<std::string> study_in_words(const std::vector<StudyOption>& options,
                                        const StudyCriterion& criterion);

/// Writes folder/report.html; `warnings`: of the study. Gives gnuplot's words on the pictures that it
/// refused. Throws std::runtime_error when gnuplot is missing or a file cannot be written.
std::vector<std::string> write_study(const std::string& title, const std::string& currency,
                                     const std::vector<StudyOption>& options, const StudyCriterion& criterion,
                                     const std::vector<std::string>& warnings,
                                     const std::filesystem::path& folder);

}  // namespace scree
