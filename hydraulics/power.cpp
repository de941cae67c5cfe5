#include "bentaxis/hydraulics/power.h"

#include <algorithm>
#include <iterator>

namespace bentaxis::hydraulics {
namespace {

struct Description {
  PowerUse use;
  const char *key, *name;
};

// In the order of Place.
constexpr Description kDescriptions[kPlaces] = {
    {PowerUse::source, "pistons", "pistons on the oil"},
    {PowerUse::source, "tank", "oil taken in, at suction pressure"},
    {PowerUse::delivered, "load", "into the load"},
    {PowerUse::delivered, "drain", "leakage, at case pressure"},
    {PowerUse::loss, "suction_line", "suction line"},
    {PowerUse::loss, "suction_port", "suction port, into the chambers"},
    {PowerUse::loss, "suction_backflow", "suction port, backflow out of the chambers"},
    {PowerUse::loss, "delivery_port", "delivery port, out of the chambers"},
    {PowerUse::loss, "delivery_backflow", "delivery port, backflow into the chambers"},
    {PowerUse::loss, "conductance", "leakage, constant conductance"},
    {PowerUse::loss, "piston_gap", "leakage, piston gap"},
    {PowerUse::loss, "plate_gap", "leakage, port plate gap"},
    {PowerUse::loss, "ring_slot", "leakage, joint of the piston ring"},
    {PowerUse::loss, "delivery_line", "delivery line, friction"},
    {PowerUse::loss, "damped_waves", "delivery line, waves above its bandwidth"},
    {PowerUse::loss, "air", "delayed release and dissolution of air"},
    {PowerUse::approximation, "line_density",
     "lines: different densities inside and at their ends"},
    {PowerUse::loss, "relief_valve", "relief valve parallel to the load"},
    {PowerUse::loss, "accumulator_inlet", "inlet of the accumulator"},
    {PowerUse::loss, "charge_valves", "check valves of the charge supply"},
};

const Description& of(Place place) { return kDescriptions[static_cast<int>(place)]; }

// Losses between the pistons and the ports. The others are of what the ports lead to.
constexpr Place kLossesOfThePump[] = {
    Place::suction_port,      Place::suction_backflow, Place::delivery_port,
    Place::delivery_backflow, Place::conductance,      Place::piston_gap,
    Place::plate_gap,         Place::ring_slot,        Place::air};

double sum_of(const PowerBudget& budget, PowerUse use) {
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i)
    if (kDescriptions[i].use == use) sum += budget[static_cast<Place>(i)];
  return sum;
}

}  // namespace

PowerUse use_of(Place place) { return of(place).use; }
const char* key_of(Place place) { return of(place).key; }
const char* name_of(Place place) { return of(place).name; }

std::optional<Place> place_of(std::string_view key) {
  const auto* const found = std::find_if(std::begin(kDescriptions), std::end(kDescriptions),
                                         [&](const Description& d) { return d.key == key; });
  if (found == std::end(kDescriptions)) return std::nullopt;
  return static_cast<Place>(found - std::begin(kDescriptions));
}

const char* name_of(PowerUse use) {
  constexpr const char* kNames[] = {"source", "delivered", "loss", "approximation"};
  return kNames[static_cast<int>(use)];
}

double left_over(const PowerBudget& budget) {
  return sum_of(budget, PowerUse::source) - sum_of(budget, PowerUse::delivered) - losses(budget) -
         sum_of(budget, PowerUse::approximation);
}

double losses(const PowerBudget& budget) { return sum_of(budget, PowerUse::loss); }

PumpPower pump_power(const PowerBudget& budget) {
  // The chambers hold as much after a period as before it, so that what the pistons do and what the
  // ports carry in leaves again: through the ports, into the case or as a loss.
  PumpPower power;
  power.pistons = budget[Place::pistons];
  power.to_case = budget[Place::drain];
  for (const Place place : kLossesOfThePump) power.dissipated += budget[place];
  power.useful = power.pistons - power.to_case - power.dissipated;
  return power;
}

}  // namespace bentaxis::hydraulics
