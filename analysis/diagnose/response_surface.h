#pragma once
// What an experiment gives over the parameters of the base model and the amplitudes of effects, learnt from
// simulations whose numbers scatter from seed to seed.
//
// Each output is a sum of terms with Gaussian priors on their coefficients: a polynomial of third order in
// the base parameters; of each effect one of third order in how far along its amplitude is, products of that
// with the base parameters and with the effect's other parameters; and hats along the amplitude, each alone
// and times the base parameters and their squares, because an effect may do most of what it can at the bottom
// of its range and something else further up. What two effects do together is the product of how far along
// they are, that times each of them and each base parameter, and times hats along either. An effect that is
// absent changes nothing. How large the coefficients of the base and of each effect are a priori, and how
// large the scatter is, are those of the largest marginal likelihood. Readings of one pile share nearly all
// of their scatter. Outputs of one run are correlated: the polynomials are those of combinations of the
// outputs whose scatter is not. Source: Rasmussen & Williams, Gaussian Processes for Machine Learning (2006),
// 2.1 and 5.4; Higdon et al., J. Am. Stat. Assoc. 103 (2008), for several outputs.
#include <Eigen/Dense>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/diagnose/forecast.h"
#include "analysis/diagnose/model_space.h"

namespace scree {

/// A simulation and what it gave.
struct DesignRun {
  ModelPoint at;
  Eigen::VectorXd outputs;  ///< finite
  std::string pile = {};    ///< runs of one pile are readings of one simulation; empty: its own
};

/// Mean over many seeds, and how well it is known.
struct SurfacePrediction {
  Eigen::VectorXd mean;        ///< by output
  Eigen::MatrixXd covariance;  ///< of the mean: what is not known of it
};

class ResponseSurface {
 public:
  /// `experiment` chooses the effects that act. Throws std::invalid_argument with fewer runs than base
  /// coefficients. The number of threads changes nothing.
  ResponseSurface(const ModelSpace& space, const std::string& experiment, const std::vector<DesignRun>& runs,
                  int threads = 1);

  SurfacePrediction at(const ModelPoint& point) const;
  /// Covariance of one run about the mean: between seeds.
  const Eigen::MatrixXd& scatter() const { return scatter_; }
  Eigen::Index outputs() const { return scatter_.rows(); }
  /// Root mean square over runs of the difference to what the others predict, over its standard deviation, by
  /// combination of outputs; near 1 if the polynomials are good enough.
  const Eigen::VectorXd& leave_one_out() const { return leave_one_out_; }

  /// How well it foretells runs that it has not learnt from, each of a seed of its own.
  std::vector<Forecast> forecasts(const std::vector<DesignRun>& runs) const;

  /// Fewest runs without effects for so many base parameters.
  static int least_base_runs(std::size_t base_parameters);

 private:
  struct Term {                   // a product
    int group;                    // whose size its prior has: 0: base; effects; their hats; pairs; -1: none
    double prior;                 // standard deviation over the size
    std::vector<int> base_power;  // by base axis
    int effect = -1, power = 0;   // of how far along its amplitude is
    int other = 0;                // a further parameter of the effect, from 1; 0: none
    int hat = 0;                  // not 0: in place of a power, the hat at this knot
    int second = -1;              // the other effect of a product
    int second_power = 0, second_hat = 0;
  };
  void make_terms(const ModelSpace& space, const std::vector<DesignRun>& runs);
  std::vector<Term> terms_of_pair(int effect, int second, int group) const;
  struct PresentEffect {
    const EffectAt* effect = nullptr;  // none: absent
    double along = 0;                  // see CandidateEffect::along
  };
  PresentEffect present(const EffectAt& effect) const;
  // Of a term whose effects are present; the second of a product only.
  static double value_of(const Term& term, const Eigen::VectorXd& base, const PresentEffect& effect,
                         const PresentEffect& second);
  // The terms that do not vanish at a point, and their values.
  struct Values {
    std::vector<Eigen::Index> which;
    std::vector<double> value;
    struct Stretch {  // of terms that follow one another
      Eigen::Index term, at, count;
    };
    std::vector<Stretch> stretches;
  };
  Values values(const ModelPoint& point) const;

  struct Fit {
    Eigen::VectorXd mean;        // of the coefficients
    Eigen::MatrixXd covariance;  // of them
    Eigen::VectorXd size;        // by group, a priori
    double scatter;              // variance
    double freedom;              // piles less coefficients that the data decide
    Eigen::VectorXd residual;    // by run; 0 of further readings
    double leave_one_out;
  };
  struct Group {  // of terms
    std::vector<Eigen::Index> terms;
    Eigen::VectorXd prior;           // of them
    std::vector<Eigen::Index> runs;  // at which they do not vanish
    Eigen::MatrixXd at_runs;         // the terms there, times their priors
  };
  struct Features {
    Eigen::MatrixXd all;  // a row a run, a column a term
    Eigen::VectorXd
        counts;  // 1 of the first reading of a pile, whose scatter is that of a run; 0 of further ones
    std::vector<Group> groups;
  };
  // `whole`: with the coefficients; else how large their sizes and the scatter are, and the residuals.
  Fit fit(const Features& features, const Eigen::VectorXd& y, bool whole) const;
  // How large all that an effect does is a priori: polynomial and hats.
  double size_of(const Eigen::VectorXd& size, int effect) const;
  // Terms of effects that were never simulated together, times their priors; and the covariance, over the
  // scatter.
  struct Product {
    std::pair<int, int> pair;
    std::vector<double> values;
  };
  std::vector<Product> unknown_products(const ModelPoint& point) const;
  double pair_covariance(const std::vector<Product>& first, const std::vector<Product>& second,
                         const Fit& fit) const;

  std::vector<bool> acts_;  // by effect of the space
  std::vector<CandidateEffect> effects_;
  std::vector<std::pair<int, int>> known_pairs_;                    // of effects that were simulated together
  std::map<std::pair<int, int>, std::vector<Term>> unknown_pairs_;  // that were not, and could be
  std::size_t base_axes_ = 0;
  int groups_ = 1;
  std::vector<Term> terms_;  // of the base, of each effect, of pairs
  std::vector<std::size_t> first_of_effect_;
  std::size_t first_of_pairs_ = 0;
  std::vector<std::size_t> first_of_pair_;  // by known pair
  std::vector<Fit> fits_;                   // by combination
  Eigen::VectorXd centre_;                  // of outputs
  Eigen::MatrixXd to_outputs_;              // outputs - centre = to_outputs * combinations
  Eigen::MatrixXd to_combinations_;         // its inverse
  Eigen::MatrixXd scatter_;
  Eigen::VectorXd leave_one_out_;
};

}  // namespace scree
