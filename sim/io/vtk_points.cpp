#include "sim/io/vtk_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace scree {
namespace {

constexpr std::size_t kMostNames = 50;

// 0 for what is none: no id or dump has it.
std::int64_t whole(double number) {
  return std::abs(number) <= 1e9 ? static_cast<std::int64_t>(number) : 0;
}

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

void VtkPoints::add_positions(const std::vector<double>& values) {
  positions_.insert(positions_.end(), values.begin(), values.end());
}

std::vector<double>* VtkPoints::array_of(std::string_view name) {
  const std::string_view meaning = meaning_of_column(name);
  if (meaning == "diameter") return &diameter_;
  if (meaning == "radius") return &radius_;
  if (meaning == "mass") return &mass_;
  if (meaning == "id") return &id_;
  if (meaning == "dump") return &dump_;
  return nullptr;
}

bool VtkPoints::wants(std::string_view name, std::size_t components, std::size_t rows) {
  if (names_.size() < kMostNames && std::find(names_.begin(), names_.end(), name) == names_.end())
    names_.emplace_back(name);
  const std::vector<double>* array = array_of(name);
  if (components != 1 || array == nullptr) return false;
  if (array->size() + rows > count())
    throw FileError(file_, 0, fmt::format("two arrays of the points are '{}'", meaning_of_column(name)));
  return true;
}

void VtkPoints::add(std::string_view name, const std::vector<double>& values) {
  std::vector<double>& array = *array_of(name);
  array.insert(array.end(), values.begin(), values.end());
}

RawSnapshot VtkPoints::grains() const {
  if (count() == 0) throw FileError(file_, 0, "has no points");
  if (diameter_.empty() && radius_.empty())
    throw FileError(
        file_, 0,
        fmt::format("no radius: an array radius or diameter of the points is needed, found: {:.200}",
                    names_.empty() ? "none" : fmt::format("{}", fmt::join(names_, ", "))));
  for (const auto* array : {&diameter_, &radius_, &mass_, &id_, &dump_})
    if (!array->empty() && array->size() != count())
      throw FileError(file_, 0,
                      fmt::format("an array has {} values for {} points; is a piece without it?",
                                  array->size(), count()));
  RawSnapshot raw;
  raw.has_mass = !mass_.empty(), raw.has_id = !id_.empty(), raw.has_dump = !dump_.empty();
  raw.grains.reserve(count());
  for (std::size_t k = 0; k < count(); ++k) {
    Grain grain;
    grain.position = {positions_[3 * k], positions_[3 * k + 1], positions_[3 * k + 2]};
    grain.diameter = diameter_.empty() ? 2 * radius_[k] : diameter_[k];
    if (raw.has_mass) grain.mass = mass_[k];
    if (raw.has_id) grain.id = whole(id_[k]);
    if (raw.has_dump) grain.dump = static_cast<int>(whole(dump_[k]));
    raw.grains.push_back(grain);
  }
  return raw;
}

}  // namespace scree
