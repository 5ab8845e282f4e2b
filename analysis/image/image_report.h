#pragma once
// The page about photographs.
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/image/image_tables.h"

namespace scree {

struct ImageReport {
  std::vector<AnalysedPhoto> photos;
  std::vector<std::filesystem::path> overlays;  ///< of the photos, in their order
  std::vector<TruthCheck> checks;               ///< of the photos, where their truth is known
  std::optional<ImageBias> bias;
  PhotoAnalysisSettings settings;
  std::string version;
};

/// Writes report.html into the folder and the charts it shows, passing-N.svg, chi.svg and bias.svg. Gives
/// gnuplot's words on those that it refused. Throws std::runtime_error when gnuplot is missing or a file
/// cannot be written.
std::vector<std::string> write_image_report(const ImageReport& report, const std::filesystem::path& folder);

}  // namespace scree
