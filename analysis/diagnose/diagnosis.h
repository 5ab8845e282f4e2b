#pragma once
// What measurements say of a model: where it disagrees, whether its parameters can mend that, which effect
// can, and what cannot be told.
#include <Eigen/Dense>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnose/evidence.h"
#include "analysis/diagnose/measurements.h"
#include "analysis/diagnose/model_space.h"

namespace scree {

// The rules by which something is said; docs/diagnose.md states them.
inline constexpr double kNothingAbove = 0.05;  ///< probability of the gap at the nominal parameters, or more
inline constexpr double kFitsAbove = 0.01;     ///< the same of a fitted model: it explains the data
inline constexpr double kSureAbove = 0.9;      ///< probability of a hypothesis that is named alone
inline constexpr double kApartBy = 10;         ///< ratio of probabilities below which two are not told apart
inline constexpr double kFalseDiscoveries = 0.1;  ///< expected share of false alarms in the map

/// Where the nominal model disagrees: one number, or several together.
struct Disagreement {
  std::string where;      ///< label of a number; or "experiment heap", "section S6", "quantity chi"
  double difference = 0;  ///< measured less simulated; a single number only
  double z = 0;           ///< over its standard deviation; a single number only
  Gap gap;
  bool significant =
      false;  ///< with the rate of false discoveries at kFalseDiscoveries (Benjamini-Yekutieli)
};

/// A model that might be true.
struct Hypothesis {
  std::vector<std::size_t> effects;  ///< that are there, by rising index; none: calibration alone
  bool unknown = false;              ///< something that is not in the library
  double prior = 0;

  bool is_effect() const { return !effects.empty() && !unknown; }
};

/// What the data say of a hypothesis.
struct Judgement {
  Hypothesis hypothesis;
  Evidence evidence;  ///< samples: base coordinates, then those of each effect's parameters; unknown: log of
                      ///< its size
  double probability = 0;  ///< of this hypothesis among all
  ModelPoint best;         ///< most likely
  Gap gap;                 ///< there
  /// What full simulations there say: `refuted` if they do not give the data (the gap is theirs then),
  /// `failed` if they fail or give no measurement. Neither is named.
  enum class Simulated { open, refuted, failed } simulated = Simulated::open;
  struct Interval {
    double low, middle, high;
  };
  std::vector<Interval> base;  ///< of each base parameter, in its unit: the shortest of 90 %, and the median
  std::vector<std::vector<Interval>> effects;  ///< of each effect's parameters
  /// Root mean square change by the effects as the surfaces have it, in standard uncertainties, after what
  /// the base parameters make up for.
  double signature = 0;

  /// The fit explains the data (kFitsAbove), and no full simulation of it contradicts it or failed.
  bool explains() const { return simulated == Simulated::open && gap.p > kFitsAbove; }
};

/// How well a hypothesis foretells what it was not fitted to: parts of the data left out in turn.
struct HeldOut {
  std::vector<std::string> parts;  ///< left out: "experiment heap", "section S6"
  std::vector<Gap> gaps;           ///< of each
  double chi2 = 0;                 ///< sum
  int count = 0;                   ///< numbers
  double gap() const { return std::max(0.0, chi2 - count); }
};

/// A number that was not measured and would tell hypotheses apart.
struct NextMeasurement {
  std::string label;
  double difference =
      0;  ///< between what two hypotheses foretell, over the standard deviation of five repeats
  std::vector<double> foretold;  ///< by hypothesis, as asked
};

struct DiagnosisVerdict {
  enum class Kind { nothing, calibration, effect, group, unknown } kind = Kind::nothing;
  std::vector<std::size_t> named;  ///< judgements, most probable first; one of `effect`, several of `group`
};

struct Diagnosis {
  Measurements measured;
  Eigen::MatrixXd covariance;        ///< of the measured values, as used
  std::vector<ScatterBlock> blocks;  ///< how well that is known, see WorkingCovariance
  Gap nominal;
  std::vector<Disagreement> numbers;  ///< by falling |z|
  std::vector<Disagreement> parts;    ///< experiments, sections, quantities
  Judgement calibration;
  std::vector<Judgement> judgements;  ///< calibration, effects, pairs, unknown: by falling probability
  DiagnosisVerdict verdict;
  Eigen::MatrixXd cosine;  ///< between signatures of the space's effects, after compensation; NaN without one
};

/// What simulations gave: of every experiment of the measurements, in the order of its values.
using DesignRuns = std::vector<std::vector<DesignRun>>;

/// The model as learnt from simulations.
class LearntModel {
 public:
  /// `widening`: by experiment; empty: none. Throws std::invalid_argument, see ResponseSurface.
  LearntModel(const ModelSpace& space, const std::vector<std::string>& experiments, const DesignRuns& runs,
              std::vector<Widening> widening = {}, int threads = 1);
  /// Of all values, in their order.
  SurfacePrediction at(const ModelPoint& point) const;
  /// Covariance of one run of each experiment about its mean: between seeds.
  Eigen::MatrixXd scatter() const;
  std::vector<const ResponseSurface*> surfaces() const;

 private:
  std::vector<ResponseSurface> surfaces_;
  std::vector<Widening> widening_;
};

/// Effects of hypotheses that full simulations have contradicted, however well surfaces fit; empty: those of
/// the base model alone.
using Contradicted = std::set<std::vector<std::size_t>>;

/// When two effects at once are tried: where no single one explains the data that is neither contradicted nor
/// less probable than something unknown; or always.
enum class Pairs { where_none_explains, always };

/// Finds, re-calibrates and names. `before`: of the same measurements and model, whose judgements are taken
/// over. The number of threads changes nothing.
Diagnosis diagnose(const ModelSpace& space, const Measurements& measured, const LearntModel& model,
                   const Contradicted& contradicted = {}, Pairs pairs_when = Pairs::where_none_explains,
                   const Diagnosis* before = nullptr, int threads = 1);

/// Where simulations of an experiment were done: those that gave the numbers, and those that failed or did
/// not.
struct SimulatedPoints {
  std::vector<ModelPoint> measured, gave_nothing;
};

/// Points drawn from what the data leave open of a hypothesis, spread wider than it is by a half and evenly
/// along amplitudes: where it is worth learning more. Where the surfaces know little the data may fit, and
/// all such places are open: they are as likely as those where the surfaces know that it fits (the density
/// counts without its covariance's volume), else what was simulated first would draw all that follows to
/// itself. None lies where the nearest simulation of any experiment gave nothing.
std::vector<ModelPoint> where_to_learn(const ModelSpace& space, const Diagnosis& diagnosis,
                                       const LearntModel& model, const Hypothesis& hypothesis, int count,
                                       const std::vector<SimulatedPoints>& simulated);

/// How many of `count` simulations go to which rival of the leading hypothesis: by the roots of the
/// probabilities of all that `among` lists, its own among them. The more even they are, the less is known of
/// which is right.
std::vector<std::pair<const Judgement*, int>> shared_by_rivals(const std::vector<const Judgement*>& among,
                                                               const Judgement& leading, int count);

/// Full simulations at a judgement's best parameters leave `gap` and contradict it, or none could be done
/// (nothing): its probability goes to the others in proportion. Says anew what is named; the order of
/// judgements changes.
void refute(Diagnosis& diagnosis, std::size_t judgement, const std::optional<Gap>& gap);

/// Every experiment left out in turn; with one experiment every section, else every number.
HeldOut held_out(const ModelSpace& space, const Diagnosis& diagnosis, const LearntModel& model,
                 const Hypothesis& hypothesis);

/// Chi-square of the measured values and what full simulations gave: `mean` over `runs` seeds of each
/// experiment, whose scatter is added. All numbers are free even at fitted values, which are those of the
/// surfaces and not of these simulations.
Gap simulated_gap(const Diagnosis& diagnosis, const LearntModel& model, const Eigen::VectorXd& mean,
                  int runs);

/// Root mean square of a change of the measured numbers that simulations gave, about base parameters `base`,
/// in standard uncertainties, as far as other base parameters cannot make up for it (to first order). What
/// the covariance of the change adds to the square is taken off.
double detectability(const LearntModel& model, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& base,
                     const Eigen::VectorXd& change, const Eigen::MatrixXd& covariance_of_change);

}  // namespace scree
