#pragma once
// The energy of a run as its summary and report show it.
#include <string>
#include <vector>

namespace scree {

/// One term of the balance.
struct EnergyTerm {
  enum class Side { put_in, held, taken_out };
  std::string name;   ///< in summary.json, without its unit
  std::string words;  ///< in the report
  Side side;
  double joule;
};

/// put in = held + taken out + error
struct EnergyTerms {
  std::vector<EnergyTerm> terms;
  double put_in = 0;          ///< J; terms that gave energy, without those that took
  double error = 0;           ///< J
  double relative_error = 0;  ///< of what was put in
  bool closed = true;         ///< the error is small enough for the run to count
};

}  // namespace scree
