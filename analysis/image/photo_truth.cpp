#include <fmt/format.h>

#include <algorithm>

#include "analysis/image/render_photo.h"
#include "sim/material/input_text.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr const char* kColumns[] = {"id",          "x_px",          "y_px",        "diameter_m", "mass_kg",
                                    "visible_cm2", "visible_share", "visible_a_m", "visible_b_m"};

// What stands behind "# name = " in a comment line; empty without one.
std::string_view said(const std::string& bytes, const std::string& name) {
  const std::string start = "# " + name + " = ";
  const auto at = bytes.find(start);
  if (at == std::string::npos) return {};
  const auto from = at + start.size();
  return trimmed(std::string_view(bytes).substr(from, bytes.find('\n', from) - from));
}

// A number above 0 that must be there.
double stated(const fs::path& file, const std::string& bytes, const std::string& name) {
  if (const auto value = number_in(said(bytes, name)); value && *value > 0) return *value;
  const std::string start = "# " + name + " = ";
  throw FileError(file, 0, fmt::format("has no line `{}NUMBER`; scree render writes one", start));
}

}  // namespace

std::string truth_csv(const PhotoTruth& truth) {
  std::string text = fmt::format(
      "# What a virtual photograph shows; pixels from the top left corner, of the middle of what is seen.\n"
      "# m_per_px = {:.9g}\n# scene_d50_m = {:.9g}\n{}{}\n",
      truth.m_per_px, truth.scene_d50, truth.region.empty() ? "" : "# region = " + truth.region + "\n",
      fmt::join(kColumns, ","));
  for (const VisibleGrain& grain : truth.grains)
    text += fmt::format("{},{:.2f},{:.2f},{:.6g},{:.6g},{:.6g},{:.4f},{:.6g},{:.6g}\n", grain.id, grain.x,
                        grain.y, grain.diameter, grain.mass, 1e4 * grain.visible_area, grain.visible_share,
                        grain.visible_a, grain.visible_b);
  return text;
}

PhotoTruth read_truth(const fs::path& file) {
  const std::string bytes = read_input_bytes(file);
  DelimitedTable table(file);
  std::size_t column[std::size(kColumns)];
  for (std::size_t i = 0; i < std::size(kColumns); ++i) {
    const auto found = table.column(kColumns[i]);
    if (!found)
      throw FileError(file, table.header_line(),
                      fmt::format("has no column `{}`; needs {}", kColumns[i], fmt::join(kColumns, ", ")));
    column[i] = *found;
  }
  PhotoTruth truth;
  truth.m_per_px = stated(file, bytes, "m_per_px");
  truth.scene_d50 = stated(file, bytes, "scene_d50_m");
  truth.region = said(bytes, "region");
  while (table.next()) {
    double value[std::size(kColumns)];
    for (std::size_t i = 0; i < std::size(kColumns); ++i) {
      const auto number = table.number(column[i]);
      if (!number || *number < 0) table.fail(fmt::format("`{}` must be a number, not below 0", kColumns[i]));
      value[i] = *number;
    }
    for (const int i : {3, 4, 7, 8})
      if (!(value[i] > 0)) table.fail(fmt::format("`{}` must be above 0", kColumns[i]));
    truth.grains.push_back({static_cast<std::int64_t>(value[0]), value[1], value[2], value[3], value[4],
                            1e-4 * value[5], value[6], value[7], value[8]});
  }
  if (truth.grains.empty()) throw FileError(file, 0, "has no grains");
  return truth;
}

}  // namespace scree
