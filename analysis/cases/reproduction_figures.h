#pragma once
// Figures of the thesis, drawn again with our seeds beside its printed values.
#include <filesystem>
#include <vector>

#include "analysis/cases/reproduction.h"
#include "analysis/report/pictures.h"

namespace scree {

/// Those figures of which a case has runs, as SVG in the folder.
std::vector<Picture> draw_figures(const std::vector<CaseResult>& cases, const std::filesystem::path& folder);

/// A number of the crest over the velocity of the blade, of all cases of push dumping, one picture a trend.
std::vector<Picture> draw_velocity_trends(const std::vector<CaseResult>& cases,
                                          const std::filesystem::path& folder);

}  // namespace scree
