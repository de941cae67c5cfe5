// Random bits by number: any of them without those before it, the same on every machine.
#pragma once

#include <cstdint>

namespace bentaxis::designs {

/// Bit number `index`, 64 at a time, of the stream `stream`: SplitMix64 (G. L. Steele, D. Lea,
/// C. H. Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014), whose state is a
/// counter.
inline std::uint64_t random_bits(std::uint64_t stream, std::uint64_t index) {
  const auto mix = [](std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  };
  constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
  return mix(mix(stream + kStep) + (index + 1) * kStep);
}

/// The middle of one of the 2^52 equal parts of (0, 1): exact, never 0 or 1.
inline double share_of(std::uint64_t part) { return (static_cast<double>(part) + 0.5) * 0x1p-52; }

/// A number in (0, 1).
inline double random_share(std::uint64_t stream, std::uint64_t index) {
  return share_of(random_bits(stream, index) >> 12);
}

}  // namespace bentaxis::designs
