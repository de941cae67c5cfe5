// What a run computes, as data: one entry per column of a result. CSV headers, comparison groups,
// plots, report and regression are all derived from this table.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bentaxis/results/quantities.h"

namespace bentaxis {

/// One scalar result: which component of what, on which body, by which body, at which point, in
/// which frame and unit.
struct Channel {
  std::string name;      ///< column name: reaction, piston, axis and frame, unit ("Rs_1_x2_N")
  std::string quantity;  ///< "Rs"
  std::string meaning;   ///< in words
  std::string equation;  ///< of Roccatello & Nervegna (2009)
  int piston = 0;        ///< 1..N, or 0 where it belongs to no piston
  std::string axis;      ///< "x2"
  std::string frame;     ///< "S2"
  std::string on_body, by_body, point;
  std::string unit;       ///< "N", "Nm", "mm", "bar"
  double unit_in_si = 1;  ///< SI value of one unit
  std::string group;      ///< channels that share one peak: the components of one vector
  ChannelKind kind = ChannelKind::reaction;
  /// Whether a pump that moves by itself has it. Not so: the tooth force Rcs without a gear, the
  /// torque Tb on the block from outside.
  bool of_pump = true;
};

/// Whether a channel has values at given states of motion alone: the torque on the block from
/// outside, which is 0 in all other runs.
bool is_of_given_motion(const Channel& channel);

/// Where each quantity of a pump with N pistons and a kind of transfer stands in a row of results,
/// and its description. Pistons count from 0 here; axes are 0, 1, 2 for x, y, z. Cheap to make and
/// to copy.
class ChannelLayout {
 public:
  explicit ChannelLayout(int pistons, TransferKind transfer = TransferKind::gear);
  explicit ChannelLayout(const PumpParameters& pump)
      : ChannelLayout(pump.geometry.pistons, pump.transfer.kind) {}

  int pistons() const { return n_; }
  TransferKind transfer() const { return transfer_; }
  /// Whether a row has a quantity.
  bool has(Quantity quantity) const {
    return (kQuantities[static_cast<std::size_t>(quantity)].transfers &
            transfers::bit(transfer_)) != 0;
  }
  /// Column of the torque about z2 by which gear or joint carry the block round; size() where
  /// neither does.
  std::size_t carrying() const {
    if (has(Quantity::Tcs)) return Tcs();
    return has(Quantity::TcsJoint) ? TcsJoint(2) : size();
  }
  std::size_t size() const { return channels_->size(); }
  /// Number of leading channels that are unknowns of the equilibrium, of any transfer: 5 N + 12.
  std::size_t reactions() const { return static_cast<std::size_t>(kReactionsEnd.column(n_, 0, 0)); }
  const std::vector<Channel>& channels() const { return *channels_; }

  // Column of every quantity: Rs(k, axis), zB(k), Rb1(axis), Td(), ..; the piston where it repeats,
  // then the axis where it has several. Only of those that has().
#define BENTAXIS_COLUMN(identifier, ...)           \
  template <class... Where>                        \
  std::size_t identifier(Where... where) const {   \
    return column<Quantity::identifier>(where...); \
  }
  BENTAXIS_QUANTITIES(BENTAXIS_COLUMN)
#undef BENTAXIS_COLUMN

 private:
  template <Quantity quantity, class... Where>
  std::size_t column(Where... where) const {
    constexpr QuantityPlace kHere = kPlace<quantity>;
    constexpr int kPistons = kHere.repeated ? 1 : 0;
    static_assert(sizeof...(where) == kPistons + (kHere.components > 1 ? 1 : 0),
                  "the piston where the quantity repeats, the axis where it has several");
    const int list[] = {static_cast<int>(where)..., 0, 0};
    const QuantityPlace place = kPlaces<quantity>[static_cast<std::size_t>(transfer_)];
    return static_cast<std::size_t>(place.column(n_, kHere.repeated ? list[0] : 0, list[kPistons]));
  }

  int n_;
  TransferKind transfer_;
  std::shared_ptr<const std::vector<Channel>> channels_;  // one list per number and transfer
};

}  // namespace bentaxis
