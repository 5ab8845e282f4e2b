#pragma once
// The report of a run: one HTML page for people who did not run it.
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/report/pictures.h"
#include "analysis/results/results.h"

namespace scree {

/// Writes folder/report.html, which holds its pictures and needs neither network nor script, and the pictures
/// beside it in folder/pictures. Gives gnuplot's words on the pictures that it refused, which stand in their
/// places on the page. Throws std::runtime_error when gnuplot is missing or a file cannot be written.
std::vector<std::string> write_report(const RunResult& result, const std::filesystem::path& folder,
                                      const SceneFacts& scene = {});

}  // namespace scree
