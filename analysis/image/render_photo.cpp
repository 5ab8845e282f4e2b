#include "analysis/image/render_photo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "analysis/image/grain_shape.h"
#include "analysis/image/picture_file.h"
#include "analysis/pile/segregation.h"
#include "sim/material/random.h"

namespace scree {
namespace {

constexpr int kGround = -1;  // and below it the balls of the ground

// Smooth noise in space with mean 0 and deviation about 1, periodic; one lattice for all grains.
class Texture {
 public:
  explicit Texture(std::uint64_t seed) : lattice_(kSide * kSide * kSide) {
    Random random(seed, 4, RandomPurpose::picture);
    for (float& value : lattice_) value = static_cast<float>(random.uniform(-1, 1) * 3.0);
  }
  // Two octaves.
  float at(const Vec3& p) const { return 0.8f * octave(p) + 0.6f * octave(2.9 * p); }

 private:
  static constexpr int kSide = 32;
  float value(int x, int y, int z) const {
    return lattice_[((z & (kSide - 1)) * kSide + (y & (kSide - 1))) * kSide + (x & (kSide - 1))];
  }
  float octave(const Vec3& p) const {
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y())),
              z = static_cast<int>(std::floor(p.z()));
    const auto smooth = [](double t) { return static_cast<float>(t * t * (3 - 2 * t)); };
    const float u = smooth(p.x() - x), v = smooth(p.y() - y), w = smooth(p.z() - z);
    const auto along_x = [&](int b, int c) {
      return value(x, y + b, z + c) * (1 - u) + value(x + 1, y + b, z + c) * u;
    };
    const auto along_y = [&](int c) { return along_x(0, c) * (1 - v) + along_x(1, c) * v; };
    return along_y(0) * (1 - w) + along_y(1) * w;
  }
  std::vector<float> lattice_;
};

// The highest surface above each pixel, in pixels, and whose it is.
struct Buffers {
  cv::Mat1f height;
  cv::Mat1i owner;  // index of a grain; kGround; kGround - 1 - index of a ball of the ground
  float highest = 0;
};

void draw_sphere(Buffers& buffers, const Grain& grain, int owner, double m_per_px) {
  const double r = grain.diameter / 2 / m_per_px;
  const Vec3 at = grain.position / m_per_px;
  const int top = std::max(static_cast<int>(std::ceil(at.y() - r - 0.5)), 0);
  const int bottom = std::min(static_cast<int>(std::floor(at.y() + r - 0.5)), buffers.height.rows - 1);
  for (int y = top; y <= bottom; ++y) {
    const double dy = y + 0.5 - at.y();
    const double half = std::sqrt(std::max(r * r - dy * dy, 0.0));
    const int left = std::max(static_cast<int>(std::ceil(at.x() - half - 0.5)), 0);
    const int right = std::min(static_cast<int>(std::floor(at.x() + half - 0.5)), buffers.height.cols - 1);
    for (int x = left; x <= right; ++x) {
      const double dx = x + 0.5 - at.x();
      const auto z = static_cast<float>(at.z() + std::sqrt(std::max(r * r - dx * dx - dy * dy, 0.0)));
      if (z <= buffers.height(y, x)) continue;
      buffers.height(y, x) = z;
      buffers.owner(y, x) = owner;
      buffers.highest = std::max(buffers.highest, z);
    }
  }
}

Buffers draw_scene(const RockScene& scene, double m_per_px, int width, int height) {
  Buffers buffers{cv::Mat1f(height, width, 0.f), cv::Mat1i(height, width, kGround)};
  for (std::size_t i = 0; i < scene.ground.size(); ++i)
    draw_sphere(buffers, scene.ground[i], kGround - 1 - static_cast<int>(i), m_per_px);
  for (std::size_t i = 0; i < scene.grains.size(); ++i)
    draw_sphere(buffers, scene.grains[i], static_cast<int>(i), m_per_px);
  return buffers;
}

// Whether the sun reaches a pixel of the height buffer. Steps of a pixel, from clear of the pixel's own.
bool lit(const Buffers& buffers, int x, int y, const Vec3& sun) {
  const double flat = std::hypot(sun.x(), sun.y());
  if (flat < 1e-9) return true;
  const double step_x = sun.x() / flat, step_y = sun.y() / flat, climb = sun.z() / flat;
  const float from = buffers.height(y, x) + 0.5f;
  for (int k = 2;; ++k) {
    const auto z = static_cast<float>(from + k * climb);
    const int px = static_cast<int>(std::floor(x + 0.5 + k * step_x)),
              py = static_cast<int>(std::floor(y + 0.5 + k * step_y));
    if (z > buffers.highest || px < 0 || py < 0 || px >= buffers.height.cols || py >= buffers.height.rows)
      return true;
    if (buffers.height(py, px) > z) return false;
  }
}

Vec3 towards_sun(const PhotoSettings& settings) {
  const double azimuth = settings.sun_azimuth_deg * std::numbers::pi / 180,
               elevation = settings.sun_elevation_deg * std::numbers::pi / 180;
  return {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

// Light that leaves each pixel, 1 for white in full sun.
cv::Mat1f shade(const Buffers& buffers, const RockScene& scene, const PhotoSettings& settings) {
  const Texture texture(settings.seed);
  const Vec3 sun = towards_sun(settings);
  // Brightness of each grain, and where in the lattice it lies.
  std::vector<double> albedo;
  std::vector<Vec3> offset;
  for (const Grain& grain : scene.grains) {
    Random random(settings.seed, static_cast<std::uint64_t>(grain.id) + 16, RandomPurpose::picture);
    albedo.push_back(settings.rock_albedo * random.uniform(0.8, 1.2));
    offset.emplace_back(random.uniform(0, 32), random.uniform(0, 32), random.uniform(0, 32));
  }
  cv::Mat1f light(buffers.height.size());
  for (int y = 0; y < light.rows; ++y)
    for (int x = 0; x < light.cols; ++x) {
      const int owner = buffers.owner(y, x);
      const Vec3 at = Vec3(x + 0.5, y + 0.5, buffers.height(y, x)) * settings.m_per_px;
      Vec3 normal(0, 0, 1), in_texture = at / 0.2;
      double base = settings.ground_albedo;
      if (owner != kGround) {
        const bool rock = owner >= 0;
        const Grain& grain = rock ? scene.grains[owner] : scene.ground[kGround - 1 - owner];
        normal = (at - grain.position).normalized();
        if (rock) {
          base = albedo[owner];
          in_texture = offset[owner] + (at - grain.position) / (0.35 * grain.diameter);
        }
      }
      const double facing = normal.dot(sun);
      const double direct = facing > 0 && lit(buffers, x, y, sun) ? facing : 0;
      // Light from the sky comes from all of it: what faces sideways sees half.
      const double sky = settings.ambient * (0.5 + 0.5 * normal.z());
      light(y, x) = static_cast<float>(base * (1 + settings.texture * texture.at(in_texture)) *
                                       (sky + (1 - settings.ambient) * direct));
    }
  return light;
}

// A flat disc that faces the camera, in the corner at the top right; pixels of it belong to nobody.
void place_target(Buffers& buffers, cv::Mat3f& light, const PhotoSettings& settings) {
  const double r = settings.target_diameter / 2 / settings.m_per_px;
  const double cx = light.cols - 1.3 * r, cy = 1.3 * r;
  for (int y = 0; y < light.rows && y <= cy + r; ++y)
    for (int x = std::max(static_cast<int>(cx - r) - 1, 0); x < light.cols; ++x) {
      if (std::hypot(x + 0.5 - cx, y + 0.5 - cy) > r) continue;
      light(y, x) = cv::Vec3f(0.55f, 0.04f, 0.6f);
      buffers.owner(y, x) = kGround;
    }
}

cv::Mat expose(const cv::Mat3f& light, const PhotoSettings& settings) {
  cv::Mat3f sharp = light;
  if (settings.blur_px > 0) cv::GaussianBlur(light, sharp, {}, settings.blur_px);
  cv::Mat3b picture(light.size());
  for (int y = 0; y < light.rows; ++y) {
    Random random(settings.seed, (std::uint64_t{1} << 40) + y, RandomPurpose::picture);
    for (int x = 0; x < light.cols; ++x) {
      // The sum of twelve has variance 1; the sensor's noise is the same in all colours here.
      double noise = -6;
      if (settings.noise > 0)
        for (int k = 0; k < 3; ++k) {
          const std::uint64_t bits = random.bits();
          for (int part = 0; part < 4; ++part)
            noise += static_cast<double>((bits >> (16 * part)) & 0xffff) / 65536;
        }
      for (int c = 0; c < 3; ++c) {
        const double value = std::pow(std::clamp<double>(sharp(y, x)[c], 0, 1), 1 / 2.2);
        picture(y, x)[c] = cv::saturate_cast<uchar>(255 * (value + settings.noise * noise));
      }
    }
  }
  return picture;
}

PhotoTruth truth_of(const Buffers& buffers, const RockScene& scene, double m_per_px) {
  std::vector<cv::Rect> seen(scene.grains.size());
  for (int y = 0; y < buffers.owner.rows; ++y)
    for (int x = 0; x < buffers.owner.cols; ++x)
      if (const int owner = buffers.owner(y, x); owner >= 0) seen[owner] |= cv::Rect(x, y, 1, 1);
  PhotoTruth truth;
  truth.m_per_px = m_per_px;
  std::vector<double> diameters, masses;
  for (std::size_t i = 0; i < scene.grains.size(); ++i) {
    const Grain& grain = scene.grains[i];
    diameters.push_back(grain.diameter);
    masses.push_back(grain.mass);
    if (seen[i].empty()) continue;
    const GrainShape shape = shape_of(buffers.owner(seen[i]) == static_cast<int>(i));
    const double area = shape.area * m_per_px * m_per_px;
    const double outline = std::numbers::pi / 4 * grain.diameter * grain.diameter;
    truth.grains.push_back({grain.id, seen[i].x + shape.x, seen[i].y + shape.y, grain.diameter, grain.mass,
                            area, std::min(area / outline, 1.0), shape.major * m_per_px,
                            shape.minor * m_per_px});
  }
  if (!diameters.empty()) truth.scene_d50 = PassingCurve(diameters, masses).diameter(0.5);
  return truth;
}

}  // namespace

Photo render_photo(const RockScene& scene, const PhotoSettings& settings) {
  const double columns = std::round(scene.width / settings.m_per_px),
               rows = std::round(scene.height / settings.m_per_px);
  if (!(columns >= 1 && rows >= 1 && columns * rows <= static_cast<double>(kLargestPicture)))
    throw std::invalid_argument(fmt::format(
        "a picture of {:.0f} x {:.0f} pixels: at least one and at most {} megapixels; take another m_per_px",
        columns, rows, kLargestPicture / 1'000'000));
  Buffers buffers = draw_scene(scene, settings.m_per_px, static_cast<int>(columns), static_cast<int>(rows));
  const cv::Mat1f grey = shade(buffers, scene, settings);
  // Rock is a little warmer than grey.
  cv::Mat3f light(grey.size());
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      light(y, x) = cv::Vec3f(0.9f * grey(y, x), 0.98f * grey(y, x), 1.05f * grey(y, x));
  if (settings.target_diameter > 0) place_target(buffers, light, settings);
  return {expose(light, settings), truth_of(buffers, scene, settings.m_per_px)};
}

}  // namespace scree
