#pragma once
// The cases of the thesis beside ours: every printed value, every printed difference between cases, figures.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results.h"

namespace scree {

/// One case and its finished runs.
struct CaseResult {
  std::string name, title;
  std::vector<Outputs> seeds;  ///< of the runs that are done
  int failed = 0, missing = 0;
  double wall_seconds = 0;  ///< of all its runs together
  std::vector<Comparison> comparison;
};

/// A difference that the thesis prints between two cases: `quantity` of `case_name` less that of `against`.
struct Trend {
  std::string case_name, against;
  std::string quantity, section;  ///< as in ReferenceValue
  double difference = 0;
  bool relative = false;  ///< over the magnitude of the value of `against`
  bool bound = false;     ///< the magnitude is printed to be at most `difference`
  std::string source;
};

/// A printed difference and ours.
struct TrendComparison {
  Trend trend;
  double difference = 0;     ///< ours, of the means over seeds
  double low = 0, high = 0;  ///< its 95 % interval from the scatter of seeds (Welch)
  double p = 1;              ///< two-sided probability that seeds alone differ so much (Welch's t test)
};

/// Reads assets/reference/trends.csv (case,against,quantity,section,difference,relative,relation,source).
/// Throws std::runtime_error `file:line: what is wrong`.
std::vector<Trend> read_trends(const std::filesystem::path& file);

/// The trends whose two cases both have at least two seeds with the quantity. Names of cases are compared
/// without regard to upper and lower case.
std::vector<TrendComparison> compare_trends(const std::vector<CaseResult>& cases,
                                            const std::vector<Trend>& trends);

/// What agrees and what does not, a line each.
std::vector<std::string> reproduction_in_words(const std::vector<CaseResult>& cases,
                                               const std::vector<TrendComparison>& trends);

/// Writes folder/report.html with its figures, and these in folder/pictures. Throws std::runtime_error when
/// gnuplot is missing or fails or a file cannot be written.
void write_reproduction(const std::vector<CaseResult>& cases, const std::vector<TrendComparison>& trends,
                        const std::filesystem::path& folder);

}  // namespace scree
