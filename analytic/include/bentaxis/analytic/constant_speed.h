// Constant speed where the block does not turn as the shaft does: what a run evaluates at its
// samples. docs/transfer.md.
#pragma once

#include <optional>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/pressure.h"

namespace bentaxis::analytic {

/// @throws InputError where a case whose pistons carry the block has no free play at some angle of
///         the turn
void require_free_play(const Case& the_case);

/// Instants of constant speed with the block where the case's transfer puts it.
class PlacedSamples {
 public:
  PlacedSamples(const Model& model, const Case& the_case) : model_(model) {
    if (!the_case.pump.transfer.is_even()) pressure_.emplace(the_case.pressure);
  }
  /// The instant itself, or a copy that is valid until the next call.
  const Instant& at(const Instant& instant) {
    if (!pressure_) return instant;
    placed_ = instant;
    model_.place_at_constant_speed(placed_, *pressure_, &rules_);
    return placed_;
  }
  const LagRules& rules() const { return rules_; }

 private:
  const Model& model_;
  std::optional<PressureTrace> pressure_;
  Instant placed_;
  LagRules rules_;
};

/// Model::evaluate() of such an instant: the block's balance holds by its lag, and the torque from
/// outside is not one that a given motion needs.
void evaluate_at_constant_speed(const Model& model, const Instant& placed,
                                std::vector<double>& values, TeethAction* teeth = nullptr);

}  // namespace bentaxis::analytic
