#pragma once
// The cases of the thesis beside ours: every printed value, every printed difference between cases, figures.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/cases/printed_scatter.h"
#include "analysis/report/profile_chart.h"
#include "analysis/results/finished_runs.h"
#include "analysis/results/outputs.h"
#include "analysis/statistics/ordered_trend.h"

namespace scree {

/// One case and its finished runs.
struct CaseResult {
  std::string name, title;
  FinishedRuns runs;
  double largest_overlap = 0;  ///< over the smaller radius, of all its runs
  double lost_mass = 0;        ///< t, of all its runs
  std::vector<Comparison> comparison;
  std::optional<double> blade_velocity;  ///< m/s, of push dumping
};

/// Whether rock is fine at the crest and coarse at the toe of a case with six sections.
struct SegregationSigns {
  std::string case_name, title;
  MeanStd crest, toe;  ///< chi of S1 and S6
  double p_crest = 0,
         p_toe = 0;     ///< one-sided: of chi(S1) < 0, of chi(S6) > 0 (p_of_sign); NaN with one seed
  int as_expected = 0;  ///< seeds with both signs
  MeanStd zero;         ///< x/L where chi changes sign, of the seeds in which it does once
  std::optional<double> printed_zero;
};
/// Those of the cases that have runs with six sections.
std::vector<SegregationSigns> segregation_signs(const std::vector<CaseResult>& cases);

/// A difference that the thesis prints between two cases: `quantity` of `case_name` less that of `against`.
struct Trend {
  std::string case_name, against;
  std::string quantity, section;  ///< as in ReferenceValue
  double difference = 0;
  bool relative = false;  ///< over the magnitude of the value of `against`
  bool bound = false;     ///< the magnitude is printed to be at most `difference`
  std::string source;
};

/// What seeds can say of a printed difference.
enum class TrendVerdict {
  unknown,     ///< fewer than two seeds of a case, or no scatter
  agrees,      ///< beyond the scatter of seeds, in the printed direction, and of the printed size
  other_size,  ///< beyond the scatter, in the printed direction, of another size
  opposite,    ///< beyond the scatter, in the other direction, and the printed size is excluded
  undecided,   ///< ours and the printed difference can be the same, and one of them can be none
  not_seen,    ///< seeds alone may differ so much, and the printed size is excluded
  within,      ///< of a bound: the whole interval lies within it
  beyond,      ///< of a bound: the whole interval lies beyond it
};

/// How a number of a pile changes with the velocity of the blade, over all seeds of all cases of push
/// dumping.
struct VelocityTrend {
  PileValue value;
  std::string first, last;  ///< cases of the slowest and the fastest blade
  std::size_t runs = 0;
  Slope here;                                      ///< per m/s
  JonckheereTerpstra order;                        ///< groups by velocity
  std::vector<ChartSeries::Point> means, printed;  ///< over velocity in m/s: of seeds, and PFC3D's
  double printed_slope = 0;        ///< least squares over PFC3D's printed means; NaN without two
  PrintedHalf printed_slope_half;  ///< by PFC3D's repeats
  TrendVerdict verdict = TrendVerdict::unknown;  ///< of the printed slope
};
/// Of chi and the D50 ratio at the crest; none unless there are three velocities.
std::vector<VelocityTrend> velocity_trends(const std::vector<CaseResult>& cases);

/// How a report shows a verdict: the class of the cell, and words.
struct TrendLook {
  const char *style, *words;
};
TrendLook look(TrendVerdict verdict);

/// What a difference with its 95 % interval and its p says of a printed one that is no bound, whose 95 %
/// interval is `printed` +- `printed_half`. The printed size is excluded when the two differ by more than the
/// root of the sum of the squares of their intervals' halves.
TrendVerdict judged(double difference, double low, double high, double p, double printed,
                    double printed_half);

/// A printed difference and ours.
struct TrendComparison {
  Trend trend;
  double difference = 0;  ///< ours, of the means over seeds; NaN when unknown
  double low = 0,
         high = 0;      ///< its 95 % interval from the scatter of seeds (Welch; delta method for a ratio)
  PrintedHalf printed;  ///< of the printed difference, by PFC3D's repeats; of a bound none
  double p = 1;         ///< two-sided probability that seeds alone differ so much (Welch's t test)
  TrendVerdict verdict = TrendVerdict::unknown;
};

/// Reads assets/reference/trends.csv (case,against,quantity,section,difference,relative,relation,source).
/// Throws std::runtime_error `file:line: what is wrong`.
std::vector<Trend> read_trends(const std::filesystem::path& file);

/// The trends both of whose cases are there, in their order. Names of cases are compared without regard to
/// upper and lower case.
std::vector<TrendComparison> compare_trends(const std::vector<CaseResult>& cases,
                                            const std::vector<Trend>& trends);

/// What agrees and what does not, a line each.
struct ReproductionWords {
  std::vector<std::string> runs;    ///< what limits the comparison: runs that are missing, other piles
  int judged = 0, agreeing = 0;     ///< printed values and bounds
  std::vector<std::string> counts;  ///< how many printed values and differences agree
  std::vector<std::string> apart;   ///< each printed value that does not
  std::vector<std::string> trends;  ///< signs, and the velocity of the blade
};
ReproductionWords reproduction_in_words(const std::vector<CaseResult>& cases,
                                        const std::vector<TrendComparison>& trends);

/// Writes folder/report.html with its figures, and these in folder/pictures. Gives gnuplot's words on those
/// that it refused. Throws std::runtime_error when gnuplot is missing or a file cannot be written.
std::vector<std::string> write_reproduction(const std::vector<CaseResult>& cases,
                                            const std::vector<TrendComparison>& trends,
                                            const std::filesystem::path& folder);

}  // namespace scree
