#pragma once
// Options that photographs share, real and virtual ones.
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

struct ImageOptions {
  std::vector<std::filesystem::path> photos;
  std::string scale;  ///< "1.2cm/px"; empty: from targets in the picture
  std::string target_diameter = "0.5m";
  int sections = 6;
  std::string region;               ///< "x,y x,y ...", px; empty: the whole picture
  std::string model = "ellipsoid";  ///< sphere, ellipsoid, feret
  double shape_factor = 0;          ///< 0: the thesis's
  std::filesystem::path weighed;    ///< table of weighed fractions; empty: none
  double detection_limit_cm2 = 25;
  double density = 2760;  ///< kg/m3
  double neck = 0.75;
  std::string threshold = "otsu";  ///< otsu, local
  bool no_edges = false;
  std::vector<std::filesystem::path> truth;  ///< one a photo; empty: none
  std::filesystem::path scenario;            ///< that a dataset names; empty: no dataset
  std::optional<double> relative_uncertainty;
  std::filesystem::path out;  ///< empty: a free runs/image
  bool force = false;
};

struct RenderOptions {
  std::filesystem::path out;       ///< picture; its truth lies beside it
  std::string layout = "apart";    ///< apart, touching, overlapping
  std::string grading = "CM0";     ///< file, or name in assets/gradings
  std::filesystem::path snapshot;  ///< of a pile; instead of layout and grading
  std::optional<double> slope;     ///< degrees; none: that of the pile
  std::string pixels = "1600x1200";
  std::string scale = "1.2cm/px";
  std::optional<double> coverage;
  double segregation = 0.5;
  std::string sun = "135,45";  ///< azimuth, elevation, degrees
  double ambient = 0.3, texture = 0.15, blur = 0.8, noise = 0.01;
  std::string target_diameter = "0.5m";
  std::uint64_t seed = 1;
  bool force = false;
};

int run_image(const ImageOptions& options);
int run_render(const RenderOptions& options);

/// Corners of "x,y x,y x,y ...": two are opposite corners of a rectangle.
std::optional<std::vector<cv::Point>> polygon_in(const std::string& option, const std::string& text);
