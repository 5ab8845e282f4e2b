#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/diagnose/fitted_parameters.h"
#include "analysis/diagnose/words.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kMostPairs = 6;  // in the table of hypotheses, beside those that are named
constexpr std::size_t kMostAlike = 5;  // pairs of effects with what leads
constexpr double kAlike = 0.8;         // cosine from which on other pairs are said, too

// `by`: surfaces or simulations.
Json json_of(const Gap& gap, const char* by) {
  Json json{{"by", by}, {"chi2", gap.chi2}, {"freedom", gap.is_test ? gap.freedom : 0}, {"p", gap.p}};
  if (!gap.is_test) json["p"] = nullptr;  // no more numbers than parameters: no test
  return json;
}

const char* gap_by(const Judgement& j) {
  return j.simulated == Judgement::Simulated::refuted ? "simulations" : "surfaces";
}

Json json_of(const Judgement::Interval& i) {
  return {{"low", i.low}, {"middle", i.middle}, {"high", i.high}};
}

Json json_of(const ModelSpace& space, const Judgement& j) {
  Json json;
  json["name"] = name_of(space, j.hypothesis);
  json["effects"] = Json::array();
  for (const std::size_t e : j.hypothesis.effects) json["effects"].push_back(space.effects[e].name);
  json["unknown"] = j.hypothesis.unknown;
  json["probability"] = j.probability;
  json["log_evidence"] = j.evidence.log_evidence;
  json["prior"] = j.hypothesis.prior;
  json["gap"] = j.hypothesis.unknown ? Json() : json_of(j.gap, gap_by(j));  // of free size: no test
  json["refuted"] = j.simulated == Judgement::Simulated::refuted;
  json["could_not_be_simulated"] = j.simulated == Judgement::Simulated::failed;
  json["signature"] = j.signature;
  for (std::size_t k = 0; k < space.base.size(); ++k)
    json["parameters"][space.base[k].key] = json_of(j.base[k]);
  for (std::size_t k = 0; k < j.hypothesis.effects.size(); ++k) {
    const CandidateEffect& effect = space.effects[j.hypothesis.effects[k]];
    for (std::size_t a = 0; a < effect.axes.size(); ++a)
      json["parameters"][effect.axes[a].key] = json_of(j.effects[k][a]);
  }
  return json;
}

Json json_of(const ModelSpace& space, const std::vector<MeasuredValue>& values, const SimulatedModel& m) {
  Json json;
  json["seeds"] = m.runs;
  json["gap"] = json_of(m.gap, "simulations");
  for (const auto& [key, value] : values_at(space, m.at)) json["parameters"][key] = value;
  for (std::size_t k = 0; k < values.size(); ++k)
    json["numbers"][values[k].label] = {{"mean", m.mean[static_cast<Eigen::Index>(k)]},
                                        {"std", m.std[static_cast<Eigen::Index>(k)]}};
  return json;
}

Json json_of(const HeldOut& held) {
  Json json{{"chi2", held.chi2}, {"count", held.count}, {"gap", held.gap()}};
  for (std::size_t k = 0; k < held.parts.size(); ++k)
    json["parts"][held.parts[k]] = json_of(held.gaps[k], "surfaces");
  return json;
}

const char* word(DiagnosisVerdict::Kind kind) {
  switch (kind) {
    case DiagnosisVerdict::Kind::nothing:
      return "nothing";
    case DiagnosisVerdict::Kind::calibration:
      return "calibration";
    case DiagnosisVerdict::Kind::effect:
      return "effect";
    case DiagnosisVerdict::Kind::group:
      return "group";
    case DiagnosisVerdict::Kind::unknown:
      return "unknown";
  }
  return "";
}

Json json_of(const DiagnosisOrigin& origin) {
  Json json{{"program", origin.program}, {"date", origin.date}, {"command", origin.command}};
  json["model"] = {{"title", origin.title}, {"file", origin.model.string()}};
  for (const DiagnosisOrigin::Data& each : origin.data)
    json["datasets"].push_back(
        {{"title", each.title}, {"source", each.source}, {"file", each.file.string()}});
  return json;
}

Json json_of(const std::vector<FittedParameter>& parameters) {
  Json json;
  for (const FittedParameter& p : parameters) {
    Json& each = json[p.label];
    if (p.has_nominal) each["nominal"] = p.nominal;
    each["range"] = {p.low, p.high};
    each["interval"] = json_of(p.within);
    each["fit"] = p.fit;
    if (p.simulated) each["simulated"] = *p.simulated;
    each["at_end_of_range"] = p.at_end.has_value();
  }
  return json;
}

Json json_of(const DiagnosisOrigin& origin, const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  Json json;
  json["origin"] = json_of(origin);
  json["verdict"] = word(d.verdict.kind);
  json["named"] = Json::array();
  for (const std::size_t k : d.verdict.named)
    json["named"].push_back(name_of(o.space, d.judgements[k].hypothesis));
  json["words"] = diagnosis_in_words(o);
  json["nominal_gap"] = json_of(d.nominal, "surfaces");
  json["calibration"] = json_of(o.space, d.calibration);
  for (const FittedModel& each : fitted_models(o)) json["fitted"][each.name] = json_of(each.parameters);
  for (const Judgement& j : d.judgements) json["hypotheses"].push_back(json_of(o.space, j));
  for (const Disagreement& each : d.numbers)
    json["where"].push_back({{"number", each.where},
                             {"difference", each.difference},
                             {"z", each.z},
                             {"p", each.gap.p},
                             {"significant", each.significant}});
  for (const Disagreement& each : d.parts)
    json["where_parts"].push_back(
        {{"part", each.where}, {"gap", json_of(each.gap, "surfaces")}, {"significant", each.significant}});
  for (std::size_t k = 0; k < d.measured.values.size(); ++k) {
    const MeasuredValue& value = d.measured.values[k];
    const auto at = static_cast<Eigen::Index>(k);
    json["measured"].push_back({{"number", value.label},
                                {"value", value.value},
                                {"stated_uncertainty", value.uncertainty},
                                {"uncertainty", std::sqrt(d.covariance(at, at))}});
  }
  json["nominal"] = json_of(o.space, d.measured.values, o.nominal);
  if (o.calibrated) json["calibrated"] = json_of(o.space, d.measured.values, *o.calibrated);
  if (o.augmented) json["augmented"] = json_of(o.space, d.measured.values, *o.augmented);
  if (o.held_out_calibrated) json["held_out_calibrated"] = json_of(*o.held_out_calibrated);
  if (o.held_out_augmented) json["held_out_augmented"] = json_of(*o.held_out_augmented);
  for (std::size_t a = 0; a < o.space.effects.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (const double c = d.cosine(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
          std::isfinite(c))
        json["cosine"][o.space.effects[a].name][o.space.effects[b].name] = c;
  for (const NextMeasurement& each : o.next)
    json["next"].push_back(
        {{"number", each.label}, {"difference", each.difference}, {"foretold", each.foretold}});
  json["rounds"] = o.rounds;
  json["settled"] = o.settled;
  json["simulations"] = o.simulations;
  json["notes"] = o.notes;
  return json;
}

// Residual of every number, in standard deviations, before and after.
Picture draw_residuals(const DiagnosisOutcome& o, const fs::path& folder) {
  const Diagnosis& d = o.diagnosis;
  const auto n = d.measured.values.size();
  struct Series {
    const char *name, *style;
    const SimulatedModel* model;
  };
  std::vector<Series> series{{"as it is", "pt 7 ps 0.7 lc rgb '#999999'", &o.nominal}};
  if (o.calibrated) series.push_back({"best parameters", "pt 5 ps 0.7 lc rgb '#d95f02'", &*o.calibrated});
  if (o.augmented) series.push_back({"with what was found", "pt 9 ps 0.9 lc rgb '#1b6ca8'", &*o.augmented});
  std::string script = chart_terminal(760, 120 + 22 * static_cast<int>(n)), tics, plots;
  double most = 3;
  for (std::size_t s = 0; s < series.size(); ++s) {
    script += fmt::format("$s{} << EOD\n", s);
    for (std::size_t k = 0; k < n; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      const SimulatedModel& m = *series[s].model;
      const double z = standard_residual(d, m, at);
      most = std::max(most, std::abs(z) * 1.05);
      script += fmt::format("{:.6g} {}\n", z, n - k);
    }
    script += "EOD\n";
    plots += fmt::format("{}$s{} using 1:2 with points {} title {}", s == 0 ? "" : ", ", s, series[s].style,
                         gnuplot_quoted(series[s].name));
  }
  for (std::size_t k = 0; k < n; ++k)
    tics += fmt::format("{}{} {}", k == 0 ? "" : ", ", gnuplot_quoted(d.measured.values[k].label), n - k);
  script += fmt::format(
      "set xrange [{}:{}]\nset yrange [0.3:{}]\nset ytics ({})\nset key top outside horizontal\n"
      "set xlabel 'measured less simulated, in standard deviations'\n"
      "set object 1 rect from -2,graph 0 to 2,graph 1 fc rgb '#eef4ee' fs solid noborder behind\n"
      "set arrow 1 from 0,graph 0 to 0,graph 1 nohead lc rgb '#666666'\nplot {}",
      -most, most, static_cast<double>(n) + 0.7, tics, plots);
  const fs::path file = folder / "residuals.svg";
  run_gnuplot(script, file);
  return {
      "Before and after", file,
      fmt::format("Every measured number against the full simulator: as it is{}{}. Within the band of two "
                  "standard deviations a number agrees.",
                  o.calibrated ? ", with its best parameters" : "",
                  o.augmented ? ", and with what was found" : "")};
}

// Where it comes from.
std::string origin_table(const DiagnosisOrigin& origin) {
  std::string rows;
  const auto row = [&](const char* what, const std::string& value) {
    rows += fmt::format("<tr><td class=\"word\">{}</td><td class=\"word\">{}</td></tr>\n", what,
                        html_escaped(value));
  };
  for (const DiagnosisOrigin::Data& each : origin.data) {
    row("Measurements", each.title);
    row("Their source", each.source.empty() ? "not stated" : each.source);
    row("Dataset", each.file.string());
  }
  row("Model", origin.model.string());
  row("Program", origin.program);
  row("Date", origin.date);
  row("Command", origin.command);
  return fmt::format("<div class=\"wide\"><table><tbody>\n{}</tbody></table></div>\n", rows);
}

std::string parameters_table(const DiagnosisOutcome& o) {
  std::string rows;
  for (const FittedModel& model : fitted_models(o))
    for (const FittedParameter& p : model.parameters)
      rows += fmt::format(
          "<tr{}><td class=\"word\">{}</td><td class=\"word\">{}</td><td>{}</td><td>{} to {}</td><td>{} ({} "
          "to {})</td><td>{}</td><td>{}</td><td class=\"word\">{}</td></tr>\n",
          p.at_end ? " class=\"differs\"" : "", html_escaped(p.label), model.name,
          p.has_nominal ? number_text(p.nominal) : "–", number_text(p.low), number_text(p.high),
          number_text(p.within.middle), number_text(p.within.low), number_text(p.within.high),
          number_text(p.fit), p.simulated ? number_text(*p.simulated) : "–",
          !p.at_end     ? ""
          : p.of_effect ? "at the end of its range"
                        : "at the end of its range: widen it if rock may be so");
  return fmt::format(
      "<h2>Parameters</h2>\n<p>Interval: its middle, in brackets 90 % of the probability. Best fit: most "
      "likely by the fitted surfaces. Simulated: in full, as shown in the picture; with what was found of "
      "the "
      "models tried the nearest to the data. Scenarios hold what was simulated, with what "
      "was found where something was. Nominal of "
      "an effect: where it does nothing.</p>\n<div class=\"wide\"><table><thead><tr><th "
      "class=\"word\">Parameter</th><th class=\"word\">Model</th><th>Nominal</th><th>Range</th>"
      "<th>Interval</th><th>Best fit</th><th>Simulated</th><th class=\"word\"></th></tr></thead><tbody>\n{}"
      "</tbody></table></div>\n",
      rows);
}

// "11.2 on 9" and p in two cells.
std::string gap_cells(const Gap& gap) {
  if (!gap.is_test)
    return fmt::format("<td>{}</td><td>no more numbers than parameters: no test</td>", number_text(gap.chi2));
  return fmt::format("<td>{} on {}</td><td>{}</td>", number_text(gap.chi2), gap.freedom, p_text(gap.p));
}

std::string gaps_table(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  std::string rows;
  const auto row = [&](const char* what, const Gap* by_surfaces, const SimulatedModel* simulated) {
    const std::string none = "<td>–</td><td>–</td>";
    rows += fmt::format("<tr><td class=\"word\">{}</td>{}{}<td>{}</td></tr>\n", what,
                        by_surfaces != nullptr ? gap_cells(*by_surfaces) : none,
                        simulated != nullptr ? gap_cells(simulated->gap) : none,
                        simulated != nullptr ? std::to_string(simulated->runs) : "–");
  };
  const auto by_surfaces = [](const Judgement& j) {
    return j.simulated == Judgement::Simulated::refuted ? nullptr : &j.gap;
  };
  row("as it is", &d.nominal, o.nominal.runs > 0 ? &o.nominal : nullptr);
  row("best parameters", by_surfaces(d.calibration), o.calibrated ? &*o.calibrated : nullptr);
  if (!d.verdict.named.empty())
    row("with what was found", by_surfaces(d.judgements[d.verdict.named.front()]),
        o.augmented ? &*o.augmented : nullptr);
  return fmt::format(
      "<h2>Gap</h2>\n<p>Two measures of it. By the fitted surfaces, which interpolate between simulations: "
      "at "
      "the best fit, with what was fitted taken off the numbers, and what surfaces do not know added to the "
      "uncertainty. By full simulations: their mean over seeds at the values simulated; all numbers count as "
      "free, because these simulations were not fitted. p allows for scatter that is known from few repeats "
      "only (Fisher's "
      "F).</p>\n<div class=\"wide\"><table><thead><tr><th "
      "class=\"word\">Model</th><th>Surfaces: chi-square</th><th>p</th><th>Simulations: chi-square</th>"
      "<th>p</th><th>Seeds</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
      rows);
}

std::string candidates_table(const DiagnosisOutcome& o) {
  const auto& all = o.diagnosis.judgements;
  const auto& named = o.diagnosis.verdict.named;
  std::string rows;
  std::size_t pairs = 0, further = 0;
  double most = 0;  // probability of those that are not shown
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Judgement& j = all[k];
    if (j.hypothesis.effects.size() > 1 && ++pairs > kMostPairs &&
        std::find(named.begin(), named.end(), k) == named.end()) {
      ++further;
      most = std::max(most, j.probability);
      continue;
    }
    const std::string values = values_in_words(o.space, j);
    rows += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td>{}<td class=\"word\">{}</td></tr>\n",
                        html_escaped(name_of(o.space, j.hypothesis)),
                        j.simulated == Judgement::Simulated::refuted  ? "refuted by full simulations"
                        : j.simulated == Judgement::Simulated::failed ? "could not be simulated"
                                                                      : decimals_text(j.probability, 3),
                        j.hypothesis.unknown ? "<td></td><td></td>" : gap_cells(j.gap),
                        html_escaped(values.empty() ? "–" : values));
  }
  const std::string rest =
      further == 0 ? std::string()
                   : fmt::format("<p>And {} further pair{}, {}.</p>\n", further, further == 1 ? "" : "s",
                                 most < 0.001 ? "all below 0.001" : "none above " + decimals_text(most, 3));
  return fmt::format(
      "<h2>What might be missing</h2>\n<p>By falling probability: re-calibration alone, every effect, pairs "
      "of "
      "them where they were tried, and something unknown. Every model is fitted to all numbers, its "
      "parameters "
      "and the effect's together. Chi-square and p are those of the fitted surfaces; of what full "
      "simulations "
      "refuted, theirs. p: probability of a gap this large by chance; a model with p below {} does not "
      "explain "
      "the data. Something unknown has a free size, and so no such test. In brackets 90 % of the "
      "probability.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th class=\"word\">Hypothesis</th><th>Probability</th>"
      "<th>chi-square</th><th>p</th><th "
      "class=\"word\">Values</th></tr></thead><tbody>\n{}</tbody></table></div>\n{}",
      kFitsAbove, rows, rest);
}

std::string where_tables(const Diagnosis& d) {
  std::string parts, numbers;
  for (const Disagreement& each : d.parts)
    parts += fmt::format("<tr{}><td class=\"word\">{}</td><td>{} on {}</td><td>{}</td></tr>\n",
                         each.significant ? " class=\"differs\"" : "", html_escaped(each.where),
                         number_text(each.gap.chi2), each.gap.freedom, p_text(each.gap.p));
  return fmt::format(
      "<h2>Where the nominal model disagrees</h2>\n<p>By the fitted surfaces. Shaded: not by chance, with "
      "{:.0f} % of false alarms "
      "among the "
      "shaded at most to be expected. Where scatter is known from few repeats only, p is that of Student's t "
      "or "
      "Fisher's F and larger than chi-square alone would give.</p>\n<div "
      "class=\"wide\"><table><thead><tr><th class=\"word\">Part</th>"
      "<th>chi-square</th><th>p</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
      100 * kFalseDiscoveries, parts);
}

std::string numbers_table(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  std::string rows;
  // Two columns a model that there is.
  std::vector<std::pair<const char*, const SimulatedModel*>> models{{"As it is", &o.nominal}};
  if (o.calibrated) models.emplace_back("Best parameters", &*o.calibrated);
  if (o.augmented) models.emplace_back("With what was found", &*o.augmented);
  std::string heads;
  for (const auto& each : models) heads += fmt::format("<th>{}</th><th>z</th>", each.first);
  for (std::size_t i = 0; i < d.measured.values.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const MeasuredValue& value = d.measured.values[i];
    rows += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td><td>{}</td><td>{}</td>",
                        html_escaped(value.label), number_text(value.value), number_text(value.uncertainty),
                        number_text(std::sqrt(d.covariance(k, k))));
    for (const auto& each : models)
      rows += fmt::format("<td>{}</td><td>{:+.1f}</td>", number_text(each.second->mean[k]),
                          standard_residual(d, *each.second, k));
    rows += "</tr>\n";
  }
  return fmt::format(
      "<h2>Every number</h2>\n<p>By full simulations. Standard uncertainty: as stated, and as used, drawn "
      "towards "
      "the scatter of the simulation because a deviation between few repeats is itself uncertain. z: "
      "measured "
      "less simulated, over its standard deviation.</p>\n<div "
      "class=\"wide\"><table><thead><tr><th "
      "class=\"word\">Number</th><th>Measured</th><th>stated</th><th>used</th>{}</tr>"
      "</thead><tbody>\n{}</tbody></table></div>\n",
      heads, rows);
}

std::string held_out_table(const DiagnosisOutcome& o) {
  if (!o.held_out_calibrated || !o.held_out_augmented || o.held_out_augmented->count == 0) return {};
  std::string rows;
  const HeldOut &before = *o.held_out_calibrated, &after = *o.held_out_augmented;
  for (std::size_t k = 0; k < before.parts.size(); ++k)
    rows += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        html_escaped(before.parts[k]), before.gaps[k].freedom,
                        number_text(before.gaps[k].chi2), number_text(after.gaps[k].chi2));
  rows += fmt::format("<tr><td class=\"word\">all</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", before.count,
                      number_text(before.chi2), number_text(after.chi2));
  return "<h2>What was not used</h2>\n<p>By the fitted surfaces. Each part is left out in turn, the model "
         "fitted to the rest, and "
         "the part "
         "foretold. A model that is right has a chi-square near the count of numbers.</p>\n<div "
         "class=\"wide\"><table>"
         "<thead><tr><th class=\"word\">Left out</th><th>Numbers</th><th>Re-calibrated alone</th>"
         "<th>With the effect</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string cosine_in_words(double cosine) {
  const double size = std::abs(cosine);
  return fmt::format("{}{}",
                     size > 0.9   ? "nearly "
                     : size > 0.6 ? "much "
                     : size > 0.3 ? "partly "
                                  : "hardly ",
                     cosine > 0 ? "the same way" : "the opposite way");
}

// The effect that is named, or the most probable one of any.
std::vector<std::size_t> leading_effects(const Diagnosis& d) {
  if (!d.verdict.named.empty()) return d.judgements[d.verdict.named.front()].hypothesis.effects;
  for (const Judgement& j : d.judgements)
    if (j.hypothesis.is_effect() && j.simulated == Judgement::Simulated::open) return j.hypothesis.effects;
  return {};
}

std::string alike_table(const DiagnosisOutcome& o) {
  struct Pair {
    std::size_t a, b;
    double cosine;
  };
  std::vector<Pair> pairs, with_leading, others;
  for (std::size_t a = 0; a < o.space.effects.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (const double c = o.diagnosis.cosine(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
          std::isfinite(c))
        pairs.push_back({a, b, c});
  std::sort(pairs.begin(), pairs.end(),
            [](const auto& x, const auto& y) { return std::abs(x.cosine) > std::abs(y.cosine); });
  const std::vector<std::size_t> leading = leading_effects(o.diagnosis);
  for (Pair pair : pairs) {
    const auto leads = [&](std::size_t e) {
      return std::find(leading.begin(), leading.end(), e) != leading.end();
    };
    if (!leads(pair.a)) std::swap(pair.a, pair.b);
    if (leads(pair.a) && with_leading.size() < kMostAlike)
      with_leading.push_back(pair);
    else if (std::abs(pair.cosine) > kAlike)
      others.push_back(pair);
  }
  std::string text;
  const auto list = [&](const std::vector<Pair>& of) {
    text += "<ul>\n";
    for (const Pair& pair : of)
      text += fmt::format("<li>{} and {}: {}, {}</li>\n", html_escaped(o.space.effects[pair.a].name),
                          html_escaped(o.space.effects[pair.b].name), decimals_text(pair.cosine, 2),
                          cosine_in_words(pair.cosine));
    text += "</ul>\n";
  };
  if (!pairs.empty()) {
    text =
        "<h2>What looks alike</h2>\n<p>Cosine between what two effects change in these numbers, counted in "
        "standard uncertainties and after re-calibration. At 1 both change them the same way, at &minus;1 "
        "the "
        "opposite way, at 0 they have nothing in common; its square is the share of the change of one that "
        "some amount of the other gives, too. Effects of a cosine near 1 or &minus;1 are told apart only if "
        "the change is large.</p>\n";
    if (!with_leading.empty()) {
      text += "<p>With what leads:</p>\n";
      list(with_leading);
    }
    if (!others.empty()) {
      text += fmt::format("<p>Others beyond {:g}:</p>\n", kAlike);
      list(others);
    }
  }
  if (!o.next.empty()) {
    text +=
        "<h2>What to measure next</h2>\n<p>Numbers of the same experiments that were not measured; "
        "difference "
        "between what the candidates foretell, in standard deviations with five repeats.</p>\n<ul>\n";
    for (const NextMeasurement& each : o.next)
      text += fmt::format("<li>{}: {}</li>\n", html_escaped(each.label), number_text(each.difference, 2));
    text += "</ul>\n";
  }
  return text;
}

}  // namespace

double standard_residual(const Diagnosis& d, const SimulatedModel& model, Eigen::Index k) {
  const double scatter = model.std[k] * model.std[k] / model.runs;
  return (d.measured.values[static_cast<std::size_t>(k)].value - model.mean[k]) /
         std::sqrt(d.covariance(k, k) + scatter);
}

std::vector<std::pair<std::string, double>> values_at(const ModelSpace& space, const ModelPoint& point) {
  std::vector<std::pair<std::string, double>> values;
  for (std::size_t k = 0; k < space.base.size(); ++k)
    values.emplace_back(space.base[k].key, space.base[k].value(point.base[static_cast<Eigen::Index>(k)]));
  for (const EffectAt& there : point.effects) {
    const CandidateEffect& effect = space.effects[there.effect];
    for (std::size_t k = 0; k < effect.axes.size(); ++k)
      values.emplace_back(effect.axes[k].key, effect.value(k, there.at[static_cast<Eigen::Index>(k)]));
  }
  return values;
}

std::vector<std::string> write_diagnosis(const DiagnosisOrigin& origin, const DiagnosisOutcome& o,
                                         const fs::path& folder) {
  write_text_file(folder / "diagnosis.json", json_of(origin, o).dump(2) + "\n");
  const fs::path pictures = folder / "pictures";
  fs::create_directories(pictures);
  PageFigures shown;
  const std::vector<std::string> words = diagnosis_in_words(o);
  std::string body;
  for (std::size_t k = 0; k < words.size(); ++k)
    body += k == 0 ? fmt::format("<p><strong>{}</strong></p>\n", html_escaped(words[k]))
                   : fmt::format("<p>{}</p>\n", html_escaped(words[k]));
  body += shown.figure([&] { return draw_residuals(o, pictures); }) + gaps_table(o) + parameters_table(o) +
          candidates_table(o) + where_tables(o.diagnosis) + alike_table(o) + held_out_table(o) +
          numbers_table(o);
  if (!o.notes.empty()) {
    body += "<h2>Notes</h2>\n<ul>\n";
    for (const std::string& note : o.notes) body += fmt::format("<li>{}</li>\n", html_escaped(note));
    body += "</ul>\n";
  }
  body += "<h2>Where it comes from</h2>\n" + origin_table(origin);
  std::string measurements;
  for (const DiagnosisOrigin::Data& each : origin.data)
    measurements += (measurements.empty() ? "" : ", ") + each.title;
  write_text_file(
      folder / "report.html",
      html_page(origin.title,
                fmt::format("{}. Measured numbers: {}, effects looked for: {}, simulations: {}", measurements,
                            o.diagnosis.measured.values.size(), o.space.effects.size(), o.simulations),
                body));
  return shown.missing();
}

}  // namespace scree
