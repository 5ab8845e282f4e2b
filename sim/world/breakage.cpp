#include "sim/world/breakage.h"

#include <numbers>

#include "sim/material/random.h"

namespace scree {

std::array<Vec3, Breakage::kFragments> fragment_places(std::uint64_t number) {
  // A rotation drawn evenly from all (Shoemake, Graphics Gems III, 1992).
  Random random(number, 0, RandomPurpose::fragments);
  const double a = random.uniform(), b = 2 * std::numbers::pi * random.uniform(),
               c = 2 * std::numbers::pi * random.uniform();
  const Quaternion turn(std::sqrt(a) * std::cos(c), std::sqrt(1 - a) * std::sin(b),
                        std::sqrt(1 - a) * std::cos(b), std::sqrt(a) * std::sin(c));
  const double out = (1 - Breakage::kSizeAtFirst) / std::sqrt(3.0);
  return {turn * Vec3(out, out, out), turn * Vec3(out, -out, -out), turn * Vec3(-out, out, -out),
          turn * Vec3(-out, -out, out)};
}

}  // namespace scree
