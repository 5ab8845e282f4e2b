#pragma once
// Words and numbers of the report.
#include <string>
#include <string_view>
#include <vector>

#include "analysis/results/results.h"

namespace scree {

/// Text that HTML shows as it stands.
std::string html_escaped(std::string_view text);

/// Text as a field of CSV, in quotation marks (RFC 4180).
std::string csv_field(std::string_view text);

/// Bytes in base64 (RFC 4648), for pictures inside the page.
std::string base64(std::string_view bytes);

/// Three significant digits without exponent and with a true minus sign; a dash for what does not exist.
std::string number_text(double value, int digits = 3);
/// Decimals that show this many significant digits.
int decimals_of(double value, int digits = 3);
/// A fixed number of decimals, else as number_text.
std::string decimals_text(double value, int decimals);
/// 12 345 678 in groups of three.
std::string count_text(double value);
/// "1 number", "9 numbers".
std::string counted_text(std::size_t count, std::string_view what);
/// Seconds as "48 s", "12.5 min" or "3.4 h".
std::string duration_text(double seconds);

/// A probability with three decimals, "< 0.001" below; a dash for what does not exist.
std::string p_text(double p);

/// pfc3d -> "PFC3D", measured -> "measured".
std::string kind_in_words(const std::string& kind);
/// chi -> "segregation degree χ", d50_rel -> "D50 / D50 as dumped"; an unknown name stays.
std::string quantity_in_words(const std::string& quantity);

/// How far a simulated value is from the printed one.
enum class Verdict { close, agrees, differs, unknown };
/// |z| below 1, below 2, above; unknown without a deviation.
Verdict verdict(const Comparison& comparison);
std::string in_words(Verdict verdict);

/// The answer of the run in plain words, as HTML paragraphs.
std::string lead_paragraphs(const RunResult& result);

}  // namespace scree
