#include <fmt/format.h>

#include <algorithm>

#include "analysis/cases/study.h"
#include "analysis/report/profile_chart.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

std::string ranking(const std::vector<StudyOption>& options, const StudyCriterion& criterion,
                    const std::string& currency) {
  std::string rows;
  for (const StudyRank& rank : rank_options(options, criterion)) {
    const StudyOption& option = options[rank.option];
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"word\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        rank.rank ? std::to_string(*rank.rank) : "not ranked", html_escaped(option.name),
        value_cell("", rank.value, ""), rank.p < 1 ? decimals_text(rank.p, 2) : "–",
        number_text(option.tonnes_per_load), option.cost_per_t ? number_text(*option.cost_per_t) : "–");
  }
  return fmt::format(
      "<div class=\"wide\"><table><thead><tr><th>Rank</th><th class=\"word\">Option</th><th>{}</th><th>p "
      "against the "
      "best of its rank</th><th>t a load</th><th>{} a t</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
      html_escaped(criterion.words), html_escaped(currency.empty() ? "cost" : currency), rows);
}

std::string other_criteria(const std::vector<StudyOption>& options, const StudyCriterion& ranked) {
  std::string head, rows;
  std::vector<std::vector<StudyRank>> all;
  for (const StudyCriterion& each : study_criteria()) {
    if (std::string_view(each.name) == ranked.name) continue;
    head += fmt::format("<th>{}</th>", html_escaped(each.words));
    all.push_back(rank_options(options, each));
  }
  for (std::size_t k = 0; k < options.size(); ++k) {
    rows += fmt::format("<tr><td class=\"word\">{}</td>", html_escaped(options[k].name));
    for (const auto& ranks : all) {
      const auto found =
          std::find_if(ranks.begin(), ranks.end(), [&](const StudyRank& rank) { return rank.option == k; });
      rows +=
          found == ranks.end()
              ? "<td>–</td>"
              : fmt::format("<td>{} <small>{}</small></td>", value_cell("", found->value, ""),
                            found->rank ? fmt::format("rank {}", *found->rank) : std::string("not ranked"));
    }
    rows += "</tr>\n";
  }
  return fmt::format(
      "<h2>By other criteria</h2>\n<div class=\"wide\"><table><thead><tr><th "
      "class=\"word\">Option</th>{}</tr></thead>"
      "<tbody>\n{}</tbody></table></div>\n",
      head, rows);
}

Picture draw_profiles(const std::vector<StudyOption>& options, const std::filesystem::path& folder) {
  ProfileChart chart{"Segregation along the slope",
                     "place along the slope x/L (0 crest, 1 toe)",
                     "segregation degree χ",
                     true,
                     {}};
  for (std::size_t k = 0; k < options.size(); ++k) {
    ChartSeries series{options[k].name, ChartSeries::Kind::ours, static_cast<int>(k), {}, options[k].name};
    int sections = 0;
    for (const Outputs& seed : options[k].runs.seeds)
      if (const auto found = seed.find("sections"); found != seed.end())
        sections = static_cast<int>(found->second);
    for (int s = 1; s <= sections; ++s) {
      const MeanStd both = spread_of(options[k].runs.seeds, fmt::format("chi_S{}", s));
      if (both.n > 0) series.points.push_back({(2.0 * s - 1) / (2.0 * sections), both.mean, both.std});
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  const auto file = folder / "chi.svg";
  draw(chart, file);
  return {"Segregation along the slope", file, "Mean and standard deviation of the seeds of each option."};
}

}  // namespace

std::vector<std::string> write_study(const std::string& title, const std::string& currency,
                                     const std::vector<StudyOption>& options, const StudyCriterion& criterion,
                                     const std::vector<std::string>& warnings,
                                     const std::filesystem::path& folder) {
  const std::filesystem::path pictures = folder / "pictures";
  std::filesystem::create_directories(pictures);
  PageFigures shown;
  std::string body =
      fmt::format("<p class=\"lead\">{}</p>\n", html_escaped(study_answer(options, criterion)));
  body +=
      "<h2>Ranking</h2>\n<p>Options of one rank are a tie: their difference to the best of it is "
      "within the scatter of seeds (Welch's t test, p of 0.05 and more).</p>\n<ul>\n";
  for (const std::string& line : study_in_words(options, criterion))
    body += fmt::format("<li>{}</li>\n", html_escaped(line));
  for (const std::string& warning : warnings)
    body += fmt::format("<li>Warning: {}</li>\n", html_escaped(warning));
  body += "</ul>\n" + ranking(options, criterion, currency) + other_criteria(options, criterion);
  if (std::any_of(options.begin(), options.end(),
                  [](const StudyOption& each) { return !each.runs.seeds.empty(); }))
    body += "<h2>Chart</h2>\n" + shown.figure([&] { return draw_profiles(options, pictures); });
  write_text_file(folder / "report.html",
                  html_page(title, fmt::format("ranked by {}", criterion.words), body));
  return shown.missing();
}

}  // namespace scree
