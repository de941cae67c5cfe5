#include "bentaxis/study/transfer_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"
#include "same_peak.h"

namespace bentaxis::study {
namespace {

// A piston carries more than another where its wall force exceeds that one's by this share:
// opposite pistons of an even number may share to round-off.
constexpr double kSameForce = 1e-6;
constexpr std::size_t kNamedSectors = 4;
constexpr int kPlayAngles = 720;

double within_half_turn(double deg) { return std::remainder(deg, 360); }

std::string range_text(const TransferSummary::Range& range, const char* unit) {
  const auto shown = [](double value) { return std::abs(value) < 1e-6 ? 0.0 : value; };
  return fmt::format("{:.4g} to {:.4g} {}", shown(range.low), shown(range.high), unit);
}

}  // namespace

void TransferSummary::Range::add(double value, double theta_deg) {
  if (!is_computed(value)) return;
  if (!is_computed(low) || value < low) {
    low = value;
    low_deg = theta_deg;
  }
  if (!is_computed(high) || value > high) {
    high = value;
    high_deg = theta_deg;
  }
}

std::size_t TransferSummary::place(const std::vector<Channel>& channels, std::size_t column) const {
  const std::string& name = ChannelLayout(pump_).channels()[column].name;
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Channel& c) { return c.name == name; });
  return static_cast<std::size_t>(found - channels.begin());
}

TransferSummary::TransferSummary(const PumpParameters& pump, const std::vector<Channel>& channels)
    : pump_(pump),
      missing_(channels.size()),
      lag_column_(missing_),
      psi_column_(missing_),
      speed_column_(missing_),
      couple_columns_{missing_, missing_, missing_},
      force_columns_{missing_, missing_, missing_} {
  const ChannelLayout at(pump);
  if (pump.transfer.kind == TransferKind::gear) return;
  if (at.has(Quantity::lag)) lag_column_ = place(channels, at.lag());
  if (at.has(Quantity::psi)) psi_column_ = place(channels, at.psi());
  if (at.has(Quantity::psi_speed)) speed_column_ = place(channels, at.psi_speed());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (at.has(Quantity::TcsJoint)) couple_columns_[axis] = place(channels, at.TcsJoint(axis));
    if (at.has(Quantity::Fcs)) force_columns_[axis] = place(channels, at.Fcs(axis));
  }
  for (int k = 0; k < at.pistons(); ++k) {
    z_columns_.push_back(place(channels, at.zB(k)));
    if (at.has(Quantity::Rw))
      wall_columns_.push_back({place(channels, at.Rw(k, 0)), place(channels, at.Rw(k, 1))});
  }
  const auto absent = [&](std::size_t column) { return column == missing_; };
  if (std::any_of(z_columns_.begin(), z_columns_.end(), absent)) z_columns_.clear();
  if (std::any_of(wall_columns_.begin(), wall_columns_.end(),
                  [&](const auto& pair) { return absent(pair[0]) || absent(pair[1]); }))
    wall_columns_.clear();
  for (auto* columns : {&couple_columns_, &force_columns_})
    if (std::any_of(columns->begin(), columns->end(), absent)) columns->fill(missing_);
}

TransferSummary::TransferSummary(const PumpParameters& pump, const ResultTable& table)
    : TransferSummary(pump, table.channels) {
  table.for_each_row([this](double theta_deg, const double* values) { add(theta_deg, values); });
}

// The vertex of a parabola through three rows where the middle one is an extreme.
void TransferSummary::DeadCentres::add(const Row& before, const Row& here, const Row& after) {
  for (std::size_t k = 0; k < here.z.size(); ++k) {
    const double rise = here.z[k] - before.z[k], fall = after.z[k] - here.z[k];
    if (rise * fall > 0 || rise == fall) continue;
    const bool is_inner = rise > 0 || (rise == 0 && fall < 0);
    // Angles of this bore around the middle one.
    const double back = within_half_turn(before.psi_deg[k] - here.psi_deg[k]);
    const double ahead = within_half_turn(after.psi_deg[k] - here.psi_deg[k]);
    if (back == 0 || ahead == 0 || back == ahead) continue;
    const double slope_back = -rise / back, slope_ahead = fall / ahead;
    const double bend = (slope_ahead - slope_back) / (ahead - back);
    const double vertex = here.psi_deg[k] - (slope_back - bend * back) / (2 * bend);
    if (is_inner)
      inner.add(within_half_turn(vertex), here.theta_deg);
    else
      outer.add(180 + within_half_turn(vertex - 180), here.theta_deg);
  }
}

void TransferSummary::add(double theta_deg, const double* values) {
  if (pump_.transfer.kind == TransferKind::gear) return;
  Row now;
  now.theta_deg = theta_deg;
  const double psi = psi_column_ == missing_   ? theta_deg
                     : lag_column_ == missing_ ? values[psi_column_]
                                               : theta_deg - values[lag_column_];
  if (psi_column_ != missing_) lag_.add(within_half_turn(theta_deg - psi), theta_deg);
  if (speed_column_ != missing_) {
    speed_.add(values[speed_column_], theta_deg);
    speed_sum_ += values[speed_column_];
  }
  const auto larger = [&](Peak& peak, double value) {
    if (is_computed(value) && !(value <= peak.value * (1 + kSamePeak)))
      peak = {value, theta_deg, 0};
  };
  if (couple_columns_[0] != missing_) {
    const double x = values[couple_columns_[0]], y = values[couple_columns_[1]],
                 z = values[couple_columns_[2]];
    const double s = std::sin(pump_.geometry.tilt), c = std::cos(pump_.geometry.tilt);
    larger(couple_on_block_, std::hypot(x, y));
    larger(couple_on_shaft_, std::hypot(x, c * y + s * z));  // z1 is (0, -s, c) in S2
  }
  if (force_columns_[0] != missing_)
    larger(side_force_, std::hypot(values[force_columns_[0]], values[force_columns_[1]],
                                   values[force_columns_[2]]));
  for (std::size_t k = 0; k < z_columns_.size(); ++k) {
    const double phase = 360.0 * static_cast<double>(k) / pump_.geometry.pistons;
    now.psi_deg.push_back(psi - phase);
    now.z.push_back(values[z_columns_[k]]);
  }
  if (!wall_columns_.empty()) {
    int walls = 0;
    double largest = 0;
    const auto force = [&](int k) {
      const auto& columns = wall_columns_[static_cast<std::size_t>(k)];
      return std::hypot(values[columns[0]], values[columns[1]]);
    };
    if (last_carrier_ >= 0) {
      largest = force(last_carrier_) * (1 + kSameForce);
      if (largest > 0) now.carrier = last_carrier_;
    }
    for (int k = 0; k < static_cast<int>(wall_columns_.size()); ++k) {
      const double here = force(k);
      if (here > 0) ++walls;
      if (here > 0 && !(here <= wall_.value * (1 + kSameForce))) wall_ = {here, theta_deg, k + 1};
      if (here > largest) {
        largest = here * (1 + kSameForce);
        now.carrier = k;
      }
    }
    most_walls_ = std::max(most_walls_, walls);
    if (walls == 0) ++loose_rows_;
    if (now.carrier >= 0) {
      if (last_carrier_ >= 0 && now.carrier != last_carrier_) ++hand_overs_;
      if (first_carrier_ < 0) first_carrier_ = now.carrier;
      last_carrier_ = now.carrier;
    }
    if (now.carrier == 0) {
      if (here_.carrier != 0 || rows_ == 0) sectors_.push_back({theta_deg, theta_deg});
      sectors_.back().to_deg = theta_deg;
    }
  }
  if (rows_ == 0) first_ = now;
  if (rows_ == 1) second_ = now;
  if (rows_ >= 2) centres_.add(before_, here_, now);
  before_ = std::move(here_);
  here_ = std::move(now);
  ++rows_;
}

bool TransferSummary::is_whole_turn() const {
  if (rows_ < 3) return false;
  const double step = second_.theta_deg - first_.theta_deg;
  return std::abs(first_.theta_deg + 360 - here_.theta_deg - step) < 1e-6 * std::abs(step);
}

TransferSummary::DeadCentres TransferSummary::dead_centres() const {
  DeadCentres all = centres_;
  if (is_whole_turn()) {
    all.add(before_, here_, first_);
    all.add(here_, first_, second_);
  }
  return all;
}

TransferSummary::Range TransferSummary::inner_dead_centre() const { return dead_centres().inner; }
TransferSummary::Range TransferSummary::outer_dead_centre() const { return dead_centres().outer; }

std::size_t TransferSummary::hand_overs() const {
  return hand_overs_ + (is_whole_turn() && first_carrier_ != last_carrier_ ? 1 : 0);
}

std::vector<TransferSummary::Sector> TransferSummary::sectors_of_first() const {
  std::vector<Sector> sectors = sectors_;
  if (sectors.size() > 1 && is_whole_turn() && first_.carrier == 0 && here_.carrier == 0) {
    sectors.back().to_deg = sectors.front().to_deg + 360;
    sectors.erase(sectors.begin());
  }
  return sectors;
}

double TransferSummary::speed_ripple() const {
  if (rows_ == 0 || speed_column_ == missing_ || speed_sum_ == 0) return not_computed();
  return 100 * (speed_.high - speed_.low) / std::abs(speed_sum_ / static_cast<double>(rows_));
}

std::vector<std::string> TransferSummary::answers() const {
  std::vector<std::string> sentences;
  if (pump_.transfer.kind == TransferKind::gear || rows_ == 0) return sentences;
  if (is_computed(speed_ripple()))
    sentences.push_back(
        fmt::format("Block: speed {}, ripple {:.3g} % of the mean; it is {} behind the shaft.",
                    range_text(speed_, "rpm"), speed_ripple(), range_text(lag_, "deg")));
  if (is_computed(couple_on_block_.value))
    sentences.push_back(fmt::format(
        "Side couple of the joint: up to {:.4g} Nm on the block at {:.4g} deg, {:.4g} Nm on the "
        "shaft at {:.4g} deg.",
        couple_on_block_.value, couple_on_block_.theta_deg, couple_on_shaft_.value,
        couple_on_shaft_.theta_deg));
  if (is_computed(side_force_.value))
    sentences.push_back(
        fmt::format("Side force of the joint on block and shaft: up to {:.4g} N at {:.4g} deg.",
                    side_force_.value, side_force_.theta_deg));
  if (pump_.transfer.kind == TransferKind::pistons) {
    if (is_computed(lag_.low))
      sentences.push_back(fmt::format(
          "Block: {} behind the shaft{}.", range_text(lag_, "deg"),
          loose_rows_ == 0 ? ""
                           : fmt::format("; no wall pushes in {} of {} rows", loose_rows_, rows_)));
    if (is_computed(wall_.value)) {
      std::vector<std::string> named;
      const std::vector<Sector> sectors = sectors_of_first();
      for (std::size_t i = 0; i < std::min(kNamedSectors, sectors.size()); ++i)
        named.push_back(fmt::format("{:.4g} to {:.4g}", sectors[i].from_deg, sectors[i].to_deg));
      sentences.push_back(fmt::format(
          "Walls: largest force {:.4g} N at {:.4g} deg (piston {}); {} per turn, at "
          "most {} at a time{}.",
          wall_.value, wall_.theta_deg, wall_.piston, counted(hand_overs(), "hand-over"),
          counted(most_walls_, "piston"),
          named.empty() ? ""
                        : fmt::format("; piston 1 carries most at {}{} deg", fmt::join(named, ", "),
                                      sectors.size() > kNamedSectors ? ", .." : "")));
    }
  }
  const Range inner = inner_dead_centre(), outer = outer_dead_centre();
  if (is_computed(inner.low) && is_computed(outer.low))
    sentences.push_back(
        fmt::format("Dead centres of the pistons, by the angle psi_k of the bore: {} and {}.",
                    range_text(inner, "deg"), range_text(outer, "deg")));
  return sentences;
}

std::string free_play_answer(const PumpParameters& pump) {
  if (pump.transfer.kind != TransferKind::pistons) return "";
  const analytic::Model model(pump, Assumptions());
  TransferSummary::Range play;
  for (int i = 0; i < kPlayAngles; ++i) {
    const double theta_deg = 360.0 * i / kPlayAngles;
    const analytic::FreePlay here = model.free_play(radians(theta_deg));
    if (!here.exists) return "";
    play.add((here.high - here.low) / kRadPerDegree, theta_deg);
  }
  return fmt::format("Free play of the block: {}.", range_text(play, "deg"));
}

}  // namespace bentaxis::study
