#pragma once

namespace bentaxis::study {

/// What is larger by no more than this share is the same peak, at the next piston or a part of a
/// turn later: the first counts.
inline constexpr double kSamePeak = 1e-9;

}  // namespace bentaxis::study
