#include "analysis/report/energy_table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "analysis/report/report_text.h"

namespace scree {

std::string energy_table(const RunResult& result) {
  EnergyTerms mean;
  double n = 0;
  for (const SeedResult& seed : result.seeds) {
    if (!seed.energy) continue;
    ++n;
    mean.put_in += seed.energy->put_in;
    mean.error += seed.energy->error;
    if (mean.terms.empty())
      mean.terms = seed.energy->terms;
    else
      for (std::size_t k = 0; k < mean.terms.size(); ++k) mean.terms[k].joule += seed.energy->terms[k].joule;
  }
  if (n == 0) return "";
  const double put_in = mean.put_in / n;
  const auto [unit, joules] = put_in >= 1e5   ? std::pair("MJ", 1e6)
                              : put_in >= 100 ? std::pair("kJ", 1e3)
                                              : std::pair("J", 1.0);
  std::string rows;
  const auto row = [&, joules = joules](const char* side, const std::string& words, double sum) {
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td>{}</td><td>{}</td></tr>\n", side, words,
        number_text(sum / n / joules), put_in > 0 ? decimals_text(100 * sum / n / put_in, 2) : "–");
  };
  for (const EnergyTerm& term : mean.terms) {
    if (term.joule == 0) continue;
    row(term.side == EnergyTerm::Side::put_in ? "put in"
        : term.side == EnergyTerm::Side::held ? "still there"
                                              : "taken out",
        term.words, term.joule);
  }
  row("error", "put in, and neither there nor taken out", mean.error);
  return fmt::format(
             "<h2>Energy</h2>\n<p>Every term is summed by itself while the run goes on{}; none is what the "
             "others leave over.</p>\n"
             "<div class=\"wide\"><table><thead><tr><th class=\"word\"></th><th "
             "class=\"word\">Energy</th><th>{}</th><th>% of what was put in</th></tr></thead><tbody>\n",
             n > 1 ? ", here the mean over seeds" : "", unit) +
         rows + "</tbody></table></div>\n";
}

}  // namespace scree
