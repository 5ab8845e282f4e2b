#pragma once
// How far a model is from the data, where scatter is known from few repeats.
#include <Eigen/Core>
#include <limits>
#include <vector>

namespace scree {

/// Measured values whose covariance is known up to one scale, which is as uncertain as chi-square of so many
/// degrees of freedom; infinite: it is known.
struct ScatterBlock {
  std::vector<Eigen::Index> values;
  double freedom = std::numeric_limits<double>::infinity();
};

/// The blocks of some of the values, by their places among these; those without any are left out.
std::vector<ScatterBlock> blocks_among(const std::vector<ScatterBlock>& blocks,
                                       const std::vector<Eigen::Index>& which);

/// Distance of a model from the data.
struct Gap {
  double chi2 = 0;
  int freedom = 0;  ///< numbers less what was fitted, 1 at least
  double p = 1;     ///< probability of as much by chance
  /// More numbers than parameters were fitted to. Without, `p` is that of one degree of freedom: the rules of
  /// a diagnosis use it, but it is no test of the fit.
  bool is_test = true;
};

/// A difference between data and model over its covariance, split into what each block adds, given those
/// before it: chi-square is their sum. The density is the product of the blocks', normal where the scale is
/// known, else Student's t of several dimensions: a scale that few repeats left open says nothing of values
/// of other blocks.
struct Misfit {
  double chi2 = 0;
  std::vector<double> of_blocks;
  double log_shape = 0;    ///< of the density without the covariance's volume; 0 where nothing differs
  double log_density = 0;  ///< up to a constant of the data
};

/// Every value must be in one block. Throws std::runtime_error if the covariance is not positive definite or
/// the result no number.
Misfit misfit(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance,
              const std::vector<ScatterBlock>& blocks);

/// The gap after so many parameters were fitted, which take their share off the numbers of each block. A
/// block's chi-square over its numbers follows Fisher's F; each is taken as the chi-square of a known scale
/// that is as probable, and p is that of their sum. Of one block it is Fisher's F itself.
Gap gap_of(const Misfit& misfit, const std::vector<ScatterBlock>& blocks, int fitted);

}  // namespace scree
