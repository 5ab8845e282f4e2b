#include "sim/io/vtk_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace scree {
namespace {

constexpr std::size_t kMostNames = 50;

// What a grain is made of.
constexpr std::array<std::string_view, 5> kMeanings{"diameter", "radius", "mass", "id", "dump"};

}  // namespace

double number_from(const char* bytes, VtkNumber kind, std::endian order) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < kind.size; ++k)
    bits = bits << 8 | static_cast<unsigned char>(bytes[order == std::endian::big ? k : kind.size - 1 - k]);
  if (kind.kind == 'f')
    return kind.size == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                          : std::bit_cast<double>(bits);
  if (kind.kind == 'u') return static_cast<double>(bits);
  const unsigned unused = 64 - 8 * static_cast<unsigned>(kind.size);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

void VtkPoints::fail(const std::string& message) const {
  throw FileError(file_, 0, piece_ > 1 ? fmt::format("piece {}: {}", piece_, message) : message);
}

void VtkPoints::add_piece(const std::vector<double>& positions) {
  end_piece();
  ++piece_;
  start_ = count();
  of_piece_.clear();
  raw_.grains.resize(start_ + positions.size() / 3);
  for (std::size_t k = start_; k < count(); ++k) {
    const double* place = &positions[3 * (k - start_)];
    raw_.grains[k].position = {place[0], place[1], place[2]};
  }
}

// All pieces must have the arrays of the first.
void VtkPoints::end_piece() {
  if (count_of_piece() == 0) return;
  if (first_piece_ == 0) first_piece_ = piece_, of_first_ = of_piece_;
  const auto require = [&](int lacks, const Meanings& less, int has, const Meanings& more) {
    for (const std::string_view meaning : more)
      if (!less.contains(meaning))
        throw FileError(file_, 0,
                        fmt::format("the points of piece {} have no array '{}', those of piece {} have one",
                                    lacks, meaning, has));
  };
  require(piece_, of_piece_, first_piece_, of_first_);
  require(first_piece_, of_first_, piece_, of_piece_);
}

bool VtkPoints::wants(std::string_view name, std::size_t components, std::size_t rows) {
  const std::string_view start = name.substr(0, kLongestName);
  if (names_.size() < kMostNames && std::find(names_.begin(), names_.end(), start) == names_.end())
    names_.emplace_back(start);
  const std::string_view meaning = meaning_of_column(name);
  if (components != 1 || std::find(kMeanings.begin(), kMeanings.end(), meaning) == kMeanings.end())
    return false;
  if (of_piece_.contains(meaning)) fail(fmt::format("two arrays of the points are '{}'", meaning));
  if (rows != count_of_piece())
    fail(fmt::format("array '{}' has {} values for {} points", meaning, rows, count_of_piece()));
  return true;
}

void VtkPoints::add(std::string_view name, const std::vector<double>& values) {
  const std::string_view meaning = meaning_of_column(name);
  const bool has_diameter = of_piece_.contains("diameter"), has_radius = of_piece_.contains("radius");
  for (std::size_t k = start_; k < count(); ++k) {
    Grain& grain = raw_.grains[k];
    const double value = values[k - start_];
    const GrainPlace place{file_, 0, k};
    if (meaning == "diameter")
      grain.diameter =
          diameter_of(value, has_radius ? std::optional(grain.diameter / 2) : std::nullopt, place);
    if (meaning == "radius")
      grain.diameter = diameter_of(has_diameter ? std::optional(grain.diameter) : std::nullopt, value, place);
    if (meaning == "mass") grain.mass = value;
    if (meaning == "id") grain.id = id_of(value, place);
    if (meaning == "dump") grain.dump = dump_of(value, place);
  }
  of_piece_.insert(meaning);
}

RawSnapshot VtkPoints::grains() {
  if (count() == 0) throw FileError(file_, 0, "has no points");
  end_piece();
  if (!of_first_.contains("diameter") && !of_first_.contains("radius"))
    throw FileError(
        file_, 0,
        fmt::format("no radius: an array radius or diameter of the points is needed, found: {:.200}",
                    names_.empty() ? "none" : fmt::format("{}", fmt::join(names_, ", "))));
  raw_.has_mass = of_first_.contains("mass"), raw_.has_id = of_first_.contains("id"),
  raw_.has_dump = of_first_.contains("dump");
  return std::move(raw_);
}

}  // namespace scree
