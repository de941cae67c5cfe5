#include "port_edges.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis::coupled {

double PortEdges::edge(std::ptrdiff_t index) const {
  const auto count = static_cast<std::ptrdiff_t>(edges_deg_.size());
  const std::ptrdiff_t turns = index / count - (index % count < 0 ? 1 : 0);
  return radians(edges_deg_[static_cast<std::size_t>(index - turns * count)] +
                 360 * static_cast<double>(turns));
}

void PortEdges::set() {
  from_ = edge(edge_ - 1);
  to_ = edge(edge_);
}

void PortEdges::find(const AxisMotion& block) {
  if (none()) return;
  const double degrees = block.angle / kRadPerDegree;
  const double turn = std::floor(degrees / 360);
  edge_ = std::upper_bound(edges_deg_.begin(), edges_deg_.end(), degrees - 360 * turn) -
          edges_deg_.begin() +
          static_cast<std::ptrdiff_t>(turn) * static_cast<std::ptrdiff_t>(edges_deg_.size());
  set();
  // On an edge it enters what lies ahead. Where it stands still, the first step will tell.
  if (std::abs(block.angle - from_) <= kOutside && block.speed < 0) --edge_;
  if (std::abs(block.angle - to_) <= kOutside && block.speed > 0) ++edge_;
  set();
}

void PortEdges::pass(int side) {
  edge_ += side;
  set();
}

}  // namespace bentaxis::coupled
