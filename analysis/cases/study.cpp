#include "analysis/cases/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/statistics/welch.h"

namespace scree {
namespace {

std::optional<double> number(const Outputs& seed, const std::string& name) {
  const auto found = seed.find(name);
  return found == seed.end() ? std::nullopt : std::optional(found->second);
}

std::string of_toe(const Outputs& seed, const char* field) {
  return fmt::format("{}_S{}", field, static_cast<int>(number(seed, "sections").value_or(0)));
}

std::optional<double> toe_over_crest(const Outputs& seed, const char* field) {
  const auto toe = number(seed, of_toe(seed, field)), crest = number(seed, fmt::format("{}_S1", field));
  return toe && crest && *crest > 0 ? std::optional(*toe / *crest) : std::nullopt;
}

std::optional<double> chi_range(const Outputs& seed) {
  const auto toe = number(seed, of_toe(seed, "chi")), crest = number(seed, "chi_S1");
  return toe && crest ? std::optional(*toe - *crest) : std::nullopt;
}

std::optional<double> lateral(const Outputs& seed) {
  double sum = 0;
  int count = 0;
  for (const auto& [name, value] : seed)
    if (name.starts_with("lateral_chi_std_S")) sum += value, ++count;
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

MeanStd spread(const StudyOption& option, const StudyCriterion& criterion) {
  return spread_of(option.runs.seeds, criterion.of);
}

}  // namespace

const std::vector<StudyCriterion>& study_criteria() {
  static const std::vector<StudyCriterion> criteria{
      {"chi_range", "χ of the toe less χ of the crest", chi_range},
      {"d50_ratio", "D50 of the toe over that of the crest",
       [](const Outputs& seed) { return toe_over_crest(seed, "d50_m"); }},
      {"ksat_ratio", "hydraulic conductivity by grading, toe over crest",
       [](const Outputs& seed) { return toe_over_crest(seed, "ksat_rel"); }},
      {"lateral_chi_std", "deviation of χ across the slope", lateral},
      {"inside_ksat_contrast", "hydraulic conductivity by grading inside, 90th over 10th percentile",
       [](const Outputs& seed) { return number(seed, "inside_ksat_contrast"); }},
      {"largest_at_toe", "share of the coarsest tenth in the lowest sixth",
       [](const Outputs& seed) { return number(seed, "largest_at_toe"); }},
  };
  return criteria;
}

const StudyCriterion* study_criterion(const std::string& name) {
  const auto& all = study_criteria();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const StudyCriterion& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<StudyRank> rank_options(const std::vector<StudyOption>& options,
                                    const StudyCriterion& criterion) {
  std::vector<StudyRank> ranks;
  for (std::size_t k = 0; k < options.size(); ++k) {
    const MeanStd value = spread(options[k], criterion);
    if (value.n > 0) ranks.push_back({k, value.n > 1 ? std::optional(1) : std::nullopt, value, 1});
  }
  std::stable_sort(ranks.begin(), ranks.end(), [](const StudyRank& a, const StudyRank& b) {
    return a.rank.has_value() != b.rank.has_value() ? a.rank.has_value() : a.value.mean < b.value.mean;
  });
  std::size_t best = 0;
  for (std::size_t k = 1; k < ranks.size() && ranks[k].rank; ++k) {
    const Welch test = welch(ranks[k].value, ranks[best].value);
    ranks[k].p = test.p;
    ranks[k].rank = ranks[best].rank;
    if (test.p < kSignificant) {
      ranks[k].rank = static_cast<int>(k) + 1;
      ranks[k].p = 1;
      best = k;
    }
  }
  return ranks;
}

std::string study_answer(const std::vector<StudyOption>& options, const StudyCriterion& criterion) {
  const std::vector<StudyRank> ranks = rank_options(options, criterion);
  std::vector<std::string> first, unranked;
  const StudyRank* next = nullptr;
  for (const StudyRank& rank : ranks) {
    const std::string& name = options[rank.option].name;
    if (!rank.rank)
      unranked.push_back(fmt::format("{} ({:.3g})", name, rank.value.mean));
    else if (*rank.rank == 1)
      first.push_back(name);
    else if (next == nullptr)
      next = &rank;
  }
  if (first.empty())
    return fmt::format("No option is ranked by {} yet: it takes two runs of each.", criterion.words);
  const auto value = [&](const StudyRank& rank) {
    return fmt::format("{:.3g} ± {:.2g}", rank.value.mean, rank.value.std);
  };
  const std::string behind =
      (next == nullptr ? "" : fmt::format("; then {}, {}", options[next->option].name, value(*next))) +
      (unranked.empty() ? "" : fmt::format("; not ranked, with one run: {}", fmt::join(unranked, ", ")));
  if (first.size() == 1 && next == nullptr)
    return fmt::format("Of {} alone {} is known with its scatter: {}{}.", first.front(), criterion.words,
                       value(ranks.front()), behind);
  if (first.size() == 1)
    return fmt::format("{} is best by {}: {}{}.", first.front(), criterion.words, value(ranks.front()),
                       behind);
  return fmt::format(
      "These runs do not tell {} and {} apart by {}: their differences to the smallest mean, {} of {}, are "
      "within the scatter of seeds{}.",
      fmt::join(first.begin(), first.end() - 1, ", "), first.back(), criterion.words, value(ranks.front()),
      first.front(), behind);
}

std::vector<std::string> study_in_words(const std::vector<StudyOption>& options,
                                        const StudyCriterion& criterion) {
  std::vector<std::string> lines;
  for (const StudyOption& option : options)
    if (!option.runs.complete()) lines.push_back(runs_in_words(option.name, option.runs));
  const std::vector<StudyRank> ranks = rank_options(options, criterion);
  for (const StudyRank& rank : ranks) {
    if (!rank.rank) {
      lines.push_back(fmt::format("{}: {:.3g} (not ranked: of one run the scatter is not known)",
                                  options[rank.option].name, rank.value.mean));
      continue;
    }
    const auto sharing = std::count_if(ranks.begin(), ranks.end(),
                                       [&](const StudyRank& other) { return other.rank == rank.rank; });
    lines.push_back(fmt::format("{}. {}: {:.3g} +- {:.2g}{}", *rank.rank, options[rank.option].name,
                                rank.value.mean, rank.value.std, sharing > 1 ? " (tie)" : ""));
  }
  return lines;
}

}  // namespace scree
