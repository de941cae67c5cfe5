// Which difference of a channel is stated, where what is allowed changes from row to row.
#pragma once

#include "bentaxis/compare/comparison.h"

namespace bentaxis::compare {

/// Whether the first table's own errors are allowed on top of the tolerance (Options::uncertainty).
/// The difference that is stated is then that nearest to its limit, or furthest beyond it, and
/// there may be larger ones within theirs. Without an absolute tolerance.
inline bool is_nearest_to_limit(const ChannelComparison& channel) {
  return channel.compared() && channel.allowed > channel.tolerance * channel.peak;
}

}  // namespace bentaxis::compare
