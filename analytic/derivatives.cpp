#include "bentaxis/analytic/derivatives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/validate.h"
#include "closed_form/dual.h"
#include "closed_form/reactions.h"
#include "prepared.h"
#include "turning.h"

namespace bentaxis::analytic {
namespace {

using closed_form::Dual;
using closed_form::kDirections;
using Raw = closed_form::RawPump<double>;
constexpr std::size_t kNumbers = sizeof(Raw) / sizeof(double);

std::array<double, kNumbers> numbers_of(const PumpParameters& pump) {
  const Raw raw = closed_form::raw(pump);
  std::array<double, kNumbers> numbers;
  static_assert(sizeof numbers == sizeof raw);
  std::memcpy(numbers.data(), &raw, sizeof raw);
  return numbers;
}

// A pump's numbers with up to kDirections derivatives.
closed_form::RawPump<Dual> with_rates(const PumpParameters& pump,
                                      std::span<const PumpParameters> directions) {
  const auto numbers = numbers_of(pump);
  std::array<Dual, kNumbers> all;
  for (std::size_t i = 0; i < kNumbers; ++i) all[i] = numbers[i];
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const auto rates = numbers_of(directions[d]);
    for (std::size_t i = 0; i < kNumbers; ++i) all[i].rate[d] = rates[i];
  }
  closed_form::RawPump<Dual> result;
  static_assert(sizeof result == sizeof all);
  std::memcpy(&result, all.data(), sizeof result);
  return result;
}

}  // namespace

PumpParameters no_rates(const PumpParameters& pump) {
  PumpParameters rates = pump;
  for (const PumpInput& input : continuous_inputs(rates)) *input.value = 0;
  return rates;
}

PumpParameters rate_of(const PumpParameters& pump, const std::string& input) {
  PumpParameters rates = no_rates(pump);
  for (const PumpInput& each : continuous_inputs(rates))
    if (each.name == input) {
      *each.value = 1;
      return rates;
    }
  throw InputError("derivative with respect to " + input + ": this pump has no such parameter");
}

struct DerivativeModel::Prepared {
  PreparedPump pump;
  std::vector<closed_form::Pump<Dual>> numbers;  // for kDirections each
};

DerivativeModel::DerivativeModel(const PumpParameters& pump, const Assumptions& assumptions,
                                 std::span<const PumpParameters> directions)
    : layout_(validate(pump)), directions_(directions.size()) {
  if (pump.gear.contact == ToothContact::teeth)
    throw InputError("derivatives: [gear] contact = \"teeth\": must be \"rigid\" or \"compliant\"");
  if (pump.transfer.kind == TransferKind::pistons)
    throw InputError(
        "derivatives: [transfer] kind = \"pistons\": must be of another kind: the lag of the block "
        "is a root");
  Prepared prepared{prepare(pump, assumptions), {}};
  std::size_t first = 0;
  do {
    const std::size_t count = std::min<std::size_t>(kDirections, directions.size() - first);
    const closed_form::FrictionLaw law =
        prepare_numbers(with_rates(pump, directions.subspan(first, count)), pump, assumptions,
                        prepared.numbers.emplace_back());
    prepared.pump.friction.smooth |= law.smooth;  // also where friction is varied from 0
    prepared.pump.friction.dry |= law.dry;
    first += kDirections;
  } while (first < directions.size());
  prepared_ = std::make_unique<const Prepared>(std::move(prepared));
}
DerivativeModel::~DerivativeModel() = default;
DerivativeModel::DerivativeModel(DerivativeModel&&) noexcept = default;

void DerivativeModel::reactions(const Instant& instant, std::span<const Instant> rates,
                                std::span<double> values, std::span<double> derivatives) const {
  const std::size_t reactions = layout_.reactions();
  if (values.size() < reactions || derivatives.size() < reactions * directions_)
    throw InputError("derivatives: space for " + std::to_string(derivatives.size()) +
                     " of them, needed are " + std::to_string(reactions * directions_));
  if (!prepared_->pump.has_tooth_force()) {
    values[layout_.Rcs()] = not_computed();
    for (std::size_t d = 0; d < directions_; ++d)
      derivatives[d * reactions + layout_.Rcs()] = not_computed();
  }
  differentiate(prepared_->pump.common(), instant, rates,
                [&](std::size_t c, double value, std::span<const double> along, std::size_t first) {
                  values[c] = value;
                  for (std::size_t d = 0; d < along.size(); ++d)
                    derivatives[(first + d) * reactions + c] = along[d];
                });
}

void DerivativeModel::joint_couple(const Instant& instant, std::span<const Instant> rates,
                                   std::span<double> values, std::span<double> derivatives) const {
  if (!layout_.has(Quantity::TcsJoint))
    throw InputError("derivatives: [transfer] kind = \"" + to_string(layout_.transfer()) +
                     "\": must be a joint, which has a couple");
  vector_from(layout_.TcsJoint(0), instant, rates, values, derivatives);
}

void DerivativeModel::joint_force(const Instant& instant, std::span<const Instant> rates,
                                  std::span<double> values, std::span<double> derivatives) const {
  if (!layout_.has(Quantity::Fcs))
    throw InputError("derivatives: [transfer] kind = \"" + to_string(layout_.transfer()) +
                     "\": must be \"double_cardan\", whose joint has a force");
  vector_from(layout_.Fcs(0), instant, rates, values, derivatives);
}

void DerivativeModel::vector_from(std::size_t column, const Instant& instant,
                                  std::span<const Instant> rates, std::span<double> values,
                                  std::span<double> derivatives) const {
  if (values.size() < 3 || derivatives.size() < 3 * directions_)
    throw InputError("derivatives: space for " + std::to_string(derivatives.size()) +
                     " of them, needed are " + std::to_string(3 * directions_));
  differentiate(prepared_->pump.common(layout_), instant, rates,
                [&](std::size_t c, double value, std::span<const double> along, std::size_t first) {
                  if (c < column || c > column + 2) return;
                  values[c - column] = value;
                  for (std::size_t d = 0; d < along.size(); ++d)
                    derivatives[(first + d) * 3 + c - column] = along[d];
                });
}

template <class Put>
void DerivativeModel::differentiate(const closed_form::Common& common, const Instant& instant,
                                    std::span<const Instant> rates, const Put& put) const {
  const TransferKind transfer = prepared_->pump.transfer;
  if (transfer == TransferKind::gear) require_locked(instant, "derivatives");
  const auto n = static_cast<std::size_t>(layout_.pistons());
  const auto fits = [&](const Instant& rate) {
    return rate.chamber_pressure.empty() || rate.chamber_pressure.size() == n;
  };
  if (instant.chamber_pressure.size() != n || rates.size() != directions_ ||
      !std::all_of(rates.begin(), rates.end(), fits))
    throw InputError("derivatives: " + std::to_string(rates.size()) + " rates for " +
                     std::to_string(directions_) + " directions, or not one pressure for each of " +
                     std::to_string(n) + " pistons");
  for (std::size_t chunk = 0; chunk < prepared_->numbers.size(); ++chunk) {
    const std::size_t first = chunk * kDirections;
    const std::size_t count = std::min<std::size_t>(kDirections, directions_ - first);
    const auto number = [&](const auto& get) {
      Dual x = get(instant);
      for (std::size_t d = 0; d < count; ++d) x.rate[d] = get(rates[first + d]);
      return x;
    };
    const Dual theta = number([](const Instant& i) { return i.shaft.angle; });
    const closed_form::State<Dual> shaft = {
        sin(theta),
        cos(theta),
        number([](const Instant& i) { return i.shaft.speed; }),
        number([](const Instant& i) { return i.shaft.acceleration; }),
        number([](const Instant& i) { return i.ports.suction; }),
        number([](const Instant& i) { return i.ports.delivery; })};
    const auto pressure = [&](int k) {
      return number([k](const Instant& i) {
        return i.chamber_pressure.empty() ? 0 : i.chamber_pressure[static_cast<std::size_t>(k)];
      });
    };
    with_shaft_state<Dual>(transfer, [&](auto& turning) {
      static_cast<closed_form::State<Dual>&>(turning) = shaft;
      closed_form::turn_block(prepared_->numbers[chunk].joint, turning);
      closed_form::reactions<Dual>(common, prepared_->numbers[chunk], turning, true, pressure,
                                   [&](int index, const Dual& value) {
                                     put(static_cast<std::size_t>(index), value.value,
                                         std::span<const double>(&value.rate[0], count), first);
                                   });
    });
  }
}

}  // namespace bentaxis::analytic
