#include "bentaxis/pump/periodic_cubic.h"

#include <algorithm>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {

double value_at(const PeriodicCubic::Piece& piece, double to_deg, double angle_deg) {
  const double h = to_deg - piece.from_deg;
  const double t = (angle_deg - piece.from_deg) / h;
  const double rise = piece.end_value - piece.value;
  const double first = piece.slope * h - rise;
  const double last = rise - piece.end_slope * h;
  return piece.value + t * (rise + (1 - t) * (first * (1 - t) + last * t));
}

PeriodicCubic::PeriodicCubic(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty() || pieces_.front().from_deg != 0)
    throw InputError("the first piece of a periodic curve must start at 0 deg");
  for (std::size_t i = 1; i < pieces_.size(); ++i)
    if (!(pieces_[i].from_deg > pieces_[i - 1].from_deg))
      throw InputError("breakpoints of a periodic curve must increase");
  if (!(pieces_.back().from_deg < 360))
    throw InputError("the last piece of a periodic curve must start below 360 deg");
}

double PeriodicCubic::operator()(double angle_deg) const {
  const double at = wrap_degrees(angle_deg);
  const auto next =
      std::upper_bound(pieces_.begin() + 1, pieces_.end(), at,
                       [](double angle, const Piece& piece) { return angle < piece.from_deg; });
  return value_at(*(next - 1), next == pieces_.end() ? 360 : next->from_deg, at);
}

}  // namespace bentaxis
