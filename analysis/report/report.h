#pragma once
// The report of a run: one HTML page for people who did not run it.
#include <filesystem>

#include "analysis/report/pictures.h"
#include "analysis/results/results.h"

namespace scree {

/// Writes folder/report.html, which holds its pictures and needs neither network nor script, and the pictures
/// beside it in folder/pictures. Throws std::runtime_error when gnuplot is missing or fails or a file cannot
/// be written.
void write_report(const RunResult& result, const std::filesystem::path& folder, const SceneFacts& scene = {});

}  // namespace scree
