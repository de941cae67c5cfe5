// The list of quantities that a run computes, and where each stands in a row of results: from it
// follow the channels, the columns of ChannelLayout and where the closed form puts its results. A
// new quantity is one entry of BENTAXIS_QUANTITIES and the physics that computes it.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "bentaxis/pump/parameters.h"

namespace bentaxis {

enum class ChannelKind {
  reaction,  ///< one of the unknowns of the equilibrium equations
  derived,   ///< follows from reactions and positions
  input,     ///< given to the model
  check,     ///< must vanish
};

/// How often a quantity stands in a row.
enum class Repeat {
  once,
  per_piston,  ///< N times in a row: of piston 1, 2, .. N
  interleaved  ///< once in the block of every piston; entries that follow each other share one
               ///< block
};

/// Kinds of transfer, as bits by their number in TransferKind.
namespace transfers {
constexpr unsigned bit(TransferKind kind) { return 1U << static_cast<unsigned>(kind); }
enum Set : unsigned {
  gear = bit(TransferKind::gear),
  cardan = bit(TransferKind::cardan),
  pistons = bit(TransferKind::pistons),
  double_cardan = bit(TransferKind::double_cardan),
  joint = bit(TransferKind::cardan) | bit(TransferKind::constant_velocity) |
          bit(TransferKind::double_cardan),
  cardan_or_pistons = bit(TransferKind::cardan) | bit(TransferKind::pistons),
  all = (1U << kTransferKinds) - 1
};
}  // namespace transfers

// clang-format off
// The quantities of a row of results, in their order:
//   identifier, symbol, transfers that have it, repeat, components, unit, kind, group (shares one
//   peak), frame, on body, by body, at point ('#' is the number of the piston), equation, meaning
// A component is a letter of the axis, or '-' for a quantity without one. Reactions that every
// transfer has lead the list.
#define BENTAXIS_QUANTITIES(X) \
  X(Rs, "Rs", all, interleaved, "xyz", "N", reaction, "Rs", "S2", "piston #", "shaft", "A#", \
    "(29)-(33)", "joint force") \
  X(Rc, "Rc", all, interleaved, "xy", "N", reaction, "Rc", "S2", "piston #", "block", "B#", \
    "(30)-(33)", "bore force") \
  X(Fh, "Fh", all, once, "z", "N", reaction, "Fh", "S2", "block", "port-plate film", "(xh, yh)", \
    "(51), (56)", "hydrodynamic force of the port-plate film") \
  X(Th, "Th", all, once, "xy", "Nm", reaction, "Th", "S2", "block", "port-plate film", "about O2", \
    "(52), (57)", "moment of Fh by its offset") \
  X(Rcn, "Rcn", all, once, "xy", "N", reaction, "Rcn", "S2", "block", "pin", "(0, 0, z_pin)", \
    "(54), (56)", "pin force") \
  X(Rcs, "Rcs", all, once, "z", "N", reaction, "Rcs", "S4", "block", "shaft", "O4", "(55), (57)", \
    "gear tooth force") \
  X(Rb1, "Rb1", all, once, "xyz", "N", reaction, "Rb1", "S1", "shaft", "tapered bearing", "C1", \
    "(39), (42)", "tapered bearing force") \
  X(Rb2, "Rb2", all, once, "xy", "N", reaction, "Rb2", "S1", "shaft", "cylindrical bearing", "C2", \
    "(40), (42)", "cylindrical bearing force") \
  X(Td, "Td", all, once, "z", "Nm", reaction, "Td", "S1", "shaft", "prime mover", "about z1", \
    "(41), (43)", "drive torque") \
  X(xh, "xh", all, once, "x", "mm", derived, "xh_yh", "S2", "block", "port-plate film", "from z2", \
    "(53)", "point where Fh acts") \
  X(yh, "yh", all, once, "y", "mm", derived, "xh_yh", "S2", "block", "port-plate film", "from z2", \
    "(53)", "point where Fh acts") \
  X(Tcs, "Tcs", gear, once, "z", "Nm", derived, "Tcs", "S2", "block", "shaft (gear) or imposed drive", \
    "about z2", "(57)", "torque that drives the block") \
  X(TcsJoint, "Tcs", joint, once, "xyz", "Nm", reaction, "Tcs", "S2", "block", "shaft (joint)", \
    "about O2", "", "couple by which a joint drives the block") \
  X(Fcs, "Fcs", double_cardan, once, "xyz", "N", reaction, "Fcs", "S2", "block", "shaft (joint)", \
    "O2", "", "force beside the couple of a double universal joint") \
  X(Rw, "Rw", pistons, per_piston, "xy", "N", reaction, "Rw", "S2", "piston #", "block (bore wall)", \
    "D#", "", "wall force on a tapered piston") \
  X(psi, "psi", cardan_or_pistons, once, "-", "deg", derived, "psi", "", "block", "", "about z2", \
    "", "angle of the block") \
  X(psi_speed, "psi", cardan, once, "-", "rpm", derived, "psi_speed", "", "block", "", "about z2", \
    "", "speed of the block") \
  X(psi_acceleration, "psi", cardan, once, "-", "rad/s2", derived, "psi_acceleration", "", "block", \
    "", "about z2", "", "acceleration of the block") \
  X(lag, "lag", pistons, once, "-", "deg", derived, "lag", "", "block", "", "about z2", "", \
    "angle of the shaft ahead of the block, theta - psi") \
  X(Tb, "Tb", pistons, once, "z", "Nm", reaction, "Tb", "S2", "block", "from outside", "about z2", \
    "", "torque that a given motion of the block needs") \
  X(pressure, "p", all, per_piston, "-", "bar", input, "p", "", "piston #", "oil", "B#", "(24)", \
    "chamber pressure, gauge") \
  X(zB, "zB", all, per_piston, "z", "mm", derived, "zB", "S2", "piston #", "", "B#", "(11)", \
    "position of B on its bore axis") \
  X(Rs3, "Rs", all, per_piston, "xyz", "N", derived, "Rs", "S3", "piston #", "shaft", "A#", \
    "(17), (29)", "joint force along the piston (z3) and across it") \
  X(Tc, "Tc", all, per_piston, "z", "Nm", derived, "Tc", "S2", "block", "piston #", "about z2", \
    "(57)", "share of the pistons' torque on the block") \
  X(power_residual, "power_residual", all, once, "-", "Nm", check, "power_residual", "", "pump", "", \
    "", "", "sum of all power over omega (virtual work per radian)") \
  X(axis_moment, "axis_moment", all, per_piston, "-", "Nm", check, "axis_moment", "", "piston #", "", \
    "centre of mass", "", "moment about the piston's own axis")
// clang-format on

/// A quantity of a row of results, in the order of the row.
enum class Quantity {
#define BENTAXIS_ENUMERATOR(identifier, ...) identifier,
  BENTAXIS_QUANTITIES(BENTAXIS_ENUMERATOR)
#undef BENTAXIS_ENUMERATOR
};

/// One entry of the list above.
struct QuantityEntry {
  std::string_view symbol;
  unsigned transfers;
  Repeat repeat;
  std::string_view components, unit;
  ChannelKind kind;
  std::string_view group, frame, on_body, by_body, point, equation, meaning;
};

inline constexpr QuantityEntry kQuantities[] = {
#define BENTAXIS_ENTRY(identifier, symbol, of, repeat, components, unit, kind, group, frame, on, \
                       by, point, equation, meaning)                                             \
  {symbol, transfers::of, Repeat::repeat, components, unit, ChannelKind::kind, group, frame, on, \
   by,     point,         equation,       meaning},
    BENTAXIS_QUANTITIES(BENTAXIS_ENTRY)
#undef BENTAXIS_ENTRY
};

/// Where a quantity stands in a row; pistons and components count from 0.
struct QuantityPlace {
  int per_piston = 0, single = 0, stride = 0, components = 0;
  bool repeated = false;

  constexpr int column(int pistons, int piston, int component) const {
    return per_piston * pistons + single + stride * piston + component;
  }
};

/// Place of entry `wanted` of kQuantities in a row of a pump with this transfer, which has it; of
/// one beyond the last: the length of the row.
constexpr QuantityPlace quantity_place(std::size_t wanted,
                                       TransferKind transfer = TransferKind::gear) {
  constexpr std::size_t kCount = sizeof(kQuantities) / sizeof(kQuantities[0]);
  QuantityPlace place;
  for (std::size_t first = 0; first < kCount;) {
    // A block: an entry, or those that share the block of a piston.
    std::size_t end = first + 1;
    if ((kQuantities[first].transfers & transfers::bit(transfer)) == 0) {
      if (first == wanted) return place;  // not in this row
      first = end;
      continue;
    }
    if (kQuantities[first].repeat == Repeat::interleaved)
      while (end < kCount && kQuantities[end].repeat == Repeat::interleaved) ++end;
    int length = 0;
    for (std::size_t i = first; i < end; ++i)
      length += static_cast<int>(kQuantities[i].components.size());
    const bool repeated = kQuantities[first].repeat != Repeat::once;
    for (std::size_t i = first; i < end; ++i) {
      place.components = static_cast<int>(kQuantities[i].components.size());
      if (i == wanted) {
        place.stride = repeated ? length : 0;
        place.repeated = repeated;
        return place;
      }
      place.single += place.components;
    }
    if (repeated) {
      place.single -= length;
      place.per_piston += length;
    }
    first = end;
  }
  return place;
}

/// Entries of kQuantities that are reactions: they lead every row.
constexpr std::size_t count_reactions() {
  std::size_t count = 0;
  for (const QuantityEntry& entry : kQuantities) {
    if (entry.kind != ChannelKind::reaction) break;
    ++count;
  }
  return count;
}

/// Place of a quantity in the row of every transfer.
constexpr std::array<QuantityPlace, kTransferKinds> quantity_places(std::size_t wanted) {
  std::array<QuantityPlace, kTransferKinds> places;
  for (std::size_t kind = 0; kind < kTransferKinds; ++kind)
    places[kind] = quantity_place(wanted, static_cast<TransferKind>(kind));
  return places;
}
/// The first transfer that has a quantity.
constexpr TransferKind first_with(std::size_t wanted) {
  std::size_t kind = 0;
  while ((kQuantities[wanted].transfers & transfers::bit(static_cast<TransferKind>(kind))) == 0)
    ++kind;
  return static_cast<TransferKind>(kind);
}

template <Quantity quantity>
inline constexpr std::array<QuantityPlace, kTransferKinds> kPlaces =
    quantity_places(static_cast<std::size_t>(quantity));
template <Quantity quantity>
inline constexpr QuantityPlace kPlace =
    kPlaces<quantity>[static_cast<std::size_t>(first_with(static_cast<std::size_t>(quantity)))];
inline constexpr QuantityPlace kReactionsEnd = quantity_place(count_reactions());

}  // namespace bentaxis
