#pragma once
// The one random generator: counter-based, so that a stream depends on nothing but its name.
#include <cmath>
#include <cstdint>
#include <numbers>

namespace scree {

/// What a stream of random numbers is for; streams of different purposes are independent.
enum class RandomPurpose : std::uint64_t {
  diameters = 1,
  positions = 2,
  base_layer = 3,
  measurement = 4,
  design = 5,
  fragments = 6,
  picture = 7
};

/// Counter-based generator (SplitMix64 finaliser over key and counter; Steele, Lea & Flood, OOPSLA 2014).
/// The n-th number of a stream (seed, dump, purpose) is a pure function of the four: nothing else moves it.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t dump, RandomPurpose purpose)
      : key_(mix(mix(mix(seed) ^ dump) ^ static_cast<std::uint64_t>(purpose))) {}

  std::uint64_t bits() { return mix(key_ + 0x9e3779b97f4a7c15ull * ++counter_); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box & Muller, Ann. Math. Stat. 29 (1958) 610).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace scree
