#include "analysis/report/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "analysis/results/summary.h"

namespace scree {
namespace {

/// A value of the first or last section that has rock.
struct End {
  std::string name;
  MeanStd chi, d50;
};

std::optional<End> end_of_slope(const RunResult& result, bool toe) {
  const SectionTable* layout = section_layout(result, 0);
  const std::size_t n = layout ? layout->sections.size() : 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = toe ? n - 1 - k : k;
    const MeanStd chi = mean_std(over_seeds(result, 0, i, [](const Section& s) { return s.chi; }));
    if (chi.n > 0)
      return End{layout->sections[i].name, chi,
                 mean_std(over_seeds(result, 0, i, [](const Section& s) { return s.d50; }))};
  }
  return std::nullopt;
}

std::string segregation_sentence(const RunResult& result) {
  const auto crest = end_of_slope(result, false), toe = end_of_slope(result, true);
  if (!crest || !toe || crest->name == toe->name) return "";
  const double difference = toe->chi.mean - crest->chi.mean;
  // A tenth of a degree of segregation is less than what seeds differ by.
  const char* answer = std::abs(difference) < 0.1 ? "Rock at the toe and at the crest hardly differs in size"
                       : difference > 0           ? "Rock at the toe is coarser than at the crest"
                                                  : "Rock at the toe is finer than at the crest";
  return fmt::format(
      "<strong>{}</strong>: the segregation degree χ goes from {} ({}, crest) to {} ({}, toe), and half of "
      "the mass "
      "is finer than {} m at the crest and {} m at the toe.",
      answer, decimals_text(crest->chi.mean, 2), html_escaped(crest->name), decimals_text(toe->chi.mean, 2),
      html_escaped(toe->name), number_text(crest->d50.mean), number_text(toe->d50.mean));
}

std::string with_std(const MeanStd& both, int decimals) {
  return both.n > 1 ? fmt::format("{}\u00a0±\u00a0{}", decimals_text(both.mean, decimals),
                                  decimals_text(both.std, decimals))
                    : decimals_text(both.mean, decimals);
}

std::string angle_sentences(const RunResult& result) {
  std::vector<double> rebound, repose, slope;
  for (const SeedResult& seed : result.seeds) {
    if (seed.rebound_height) rebound.push_back(*seed.rebound_height);
    if (seed.repose) repose.push_back(seed.repose->angle);
    if (seed.slope_angle) slope.push_back(*seed.slope_angle);
  }
  std::string out;
  if (!rebound.empty())
    out += fmt::format("<strong>The rock rebounds to {} m.</strong> ", with_std(mean_std(rebound), 3));
  const bool at_rest = std::all_of(result.seeds.begin(), result.seeds.end(),
                                   [](const SeedResult& seed) { return seed.at_rest; });
  if (const MeanStd angle = mean_std(repose); angle.n > 0)
    out += fmt::format(
        "<strong>{} {}°.</strong> ",
        at_rest ? "The heap stands at a repose angle of" : "The heap is not at rest yet; its flank stands at",
        with_std(angle, 1));
  else if (!repose.empty())
    out += fmt::format("<strong>No repose angle: {}.</strong> ",
                       html_escaped(why_no_repose_angle(
                           *std::find_if(result.seeds.begin(), result.seeds.end(),
                                         [](const SeedResult& seed) { return seed.repose.has_value(); }))));
  const bool thin = std::any_of(result.seeds.begin(), result.seeds.end(), lies_thin);
  if (mean_std(slope).n > 0)
    out +=
        fmt::format("{} {}°. ",
                    !at_rest ? "The slope is not at rest yet; it stands at"
                    : thin   ? "No slope of the rock's own: it lies thin on the bench face, with a surface of"
                             : "The slope came to rest at",
                    with_std(mean_std(slope), 1));
  return out;
}

std::string comparison_sentence(const RunResult& result) {
  if (unfinished(result)) return "Its pile is not finished and is not compared with printed values.";
  if (result.comparison.empty()) return "This run was not compared with printed values.";
  std::map<Verdict, int> count;
  for (const Comparison& row : result.comparison) ++count[verdict(row)];
  const int agree = count[Verdict::close] + count[Verdict::agrees], known = agree + count[Verdict::differs];
  const int open = count[Verdict::unknown];
  std::string out;
  if (known > 0)
    out = fmt::format("<strong>Of {} printed {}, {} {}</strong> within two standard deviations.", known,
                      known == 1 ? "value" : "values", agree, agree == 1 ? "agrees" : "agree");
  if (open > 0)
    out += fmt::format(" For {} {}{} no standard deviation is known, so agreement cannot be judged.", open,
                       known > 0 ? "more " : "printed ", open == 1 ? "value" : "values");
  return out;
}

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string csv_field(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += c;
    out += c;
  }
  return out + '"';
}

std::string base64(std::string_view bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0U;
    };
    const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
    out += letters[three >> 18];
    out += letters[three >> 12 & 63];
    out += i + 1 < bytes.size() ? letters[three >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? letters[three & 63] : '=';
  }
  return out;
}

std::string decimals_text(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "−" + text : text;
}

int decimals_of(double value, int digits) {
  if (!std::isfinite(value)) return 0;
  const int before = value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return std::clamp(digits - before, 0, 6);
}

std::string number_text(double value, int digits) {
  return decimals_text(value, decimals_of(value, digits));
}

std::string count_text(double value) {
  std::string text = fmt::format("{:.0f}", value);
  for (int at = static_cast<int>(text.size()) - 3; at > (text[0] == '-' ? 1 : 0); at -= 3)
    text.insert(static_cast<std::size_t>(at), "\u202f");
  return text;
}

std::string counted_text(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string duration_text(double seconds) {
  if (seconds < 120) return number_text(seconds) + " s";
  if (seconds < 7200) return number_text(seconds / 60) + " min";
  return number_text(seconds / 3600) + " h";
}

std::string p_text(double p) {
  return p < 0.001 ? "< 0.001" : decimals_text(p, 3);
}

std::string kind_in_words(const std::string& kind) {
  return kind == "pfc3d" ? "PFC3D" : kind;
}

std::string quantity_in_words(const std::string& quantity) {
  static const std::map<std::string, std::string> words{
      {"chi", "segregation degree χ"},
      {"mass_t", "mass"},
      {"xl_chi_zero", "place x/L where χ changes sign"},
      {"toe_width", "width at the toe of the first point's rock"},
      {"lateral_chi_std", "deviation of χ across"},
      {"lateral_chi_range", "largest difference of χ across"},
      {"rebound_height", "rebound height"},
      {"angle", "repose angle"},
      {"slope_angle", "slope angle"},
      {"share_above_1m", "share of all rock above 1 m"},
      {"share_above_1m_orig", "rock above 1 m, as dumped"}};
  if (const auto found = words.find(quantity); found != words.end()) return found->second;
  if (constexpr std::string_view scatter = "_scatter"; quantity.ends_with(scatter))
    return fmt::format("deviation between repeats of {}",
                       quantity_in_words(quantity.substr(0, quantity.size() - scatter.size())));
  if (quantity.size() >= 3 && quantity[0] == 'd' && quantity.find_first_not_of("0123456789", 1) >= 3) {
    const std::string size = fmt::format("D{}", quantity.substr(1, quantity.find('_') - 1));
    if (quantity.ends_with("_rel")) return fmt::format("{0} / {0} as dumped", size);
    if (quantity.find('_') == std::string::npos) return size;
  }
  return quantity;
}

Verdict verdict(const Comparison& comparison) {
  if (!comparison.z || !std::isfinite(*comparison.z)) return Verdict::unknown;
  const double distance = std::abs(*comparison.z);
  return distance < 1 ? Verdict::close : distance < 2 ? Verdict::agrees : Verdict::differs;
}

std::string in_words(Verdict verdict) {
  switch (verdict) {
    case Verdict::close:
      return "agrees closely";
    case Verdict::agrees:
      return "agrees";
    case Verdict::differs:
      return "does not agree";
    case Verdict::unknown:
      break;
  }
  return "not judged";
}

std::string lead_paragraphs(const RunResult& result) {
  const std::string answer = segregation_sentence(result);
  const double outside = share_in_no_section(result);
  std::string out = fmt::format(
      "<p class=\"lead\">{}{}{} {}</p>\n",
      unfinished(result) ? "<strong>This run was ended before it was finished.</strong> " : "",
      outside > kMuchInNoSection
          ? fmt::format("<strong>{} % of the rock lies above the crest's height and belongs to no "
                        "section.</strong> ",
                        decimals_text(100 * outside, 0))
          : "",
      answer, angle_sentences(result));
  const std::size_t seeds = result.seeds.size();
  out += fmt::format("<p>{} The values are {}.</p>\n", comparison_sentence(result),
                     seeds == 1
                         ? std::string("of one seed, so their own scatter is not known")
                         : fmt::format("means over {} seeds, ± one standard deviation between them", seeds));
  return out;
}

}  // namespace scree
