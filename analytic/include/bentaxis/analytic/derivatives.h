// Reactions with their derivatives, exact to round-off: the closed form evaluated with numbers that
// carry derivatives (forward automatic differentiation).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"

namespace bentaxis::analytic {
namespace closed_form {
struct Common;
}

/// A pump's numbers as rates: all 0, with the parts that `pump` has. For use as a direction, once
/// some of them are set.
PumpParameters no_rates(const PumpParameters& pump);
/// The direction of one of its continuous_inputs() (pump/inputs.h): "geometry.tilt".
/// @throws InputError where there is none of this name
PumpParameters rate_of(const PumpParameters& pump, const std::string& input);

/// Reactions of a pump, differentiated along directions in the space of its parameters and of the
/// instant. Immutable.
class DerivativeModel {
 public:
  /// @param directions  of the parameters: each number is the rate of that of `pump`
  /// @throws InputError as BatchModel
  DerivativeModel(const PumpParameters& pump, const Assumptions& assumptions,
                  std::span<const PumpParameters> directions);
  ~DerivativeModel();
  DerivativeModel(DerivativeModel&&) noexcept;

  const ChannelLayout& layout() const { return layout_; }
  std::size_t directions() const { return directions_; }

  /// Reactions as Model::reactions, of a block that is locked to the shaft or that a joint drives,
  /// and their derivatives.
  /// At a kink (a flank that changes, dry friction at rest) those of one side.
  /// @param rates        one per direction: rates of angle, speed and acceleration of the shaft, of
  ///                     the chamber pressures (none: 0) and of the port pressures
  /// @param values       at least layout().reactions() long; Rcs is not_computed() where the block
  ///                     speed is imposed
  /// @param derivatives  directions() times as long, direction by direction
  /// @throws InputError where a size does not fit or the block is not locked to the shaft
  void reactions(const Instant& instant, std::span<const Instant> rates, std::span<double> values,
                 std::span<double> derivatives) const;

  /// The couple Tcs of a joint, x, y and z in S2, and its derivatives likewise.
  /// @param values       at least 3 long
  /// @param derivatives  directions() times as long
  /// @throws InputError where no joint drives the block, and as reactions()
  void joint_couple(const Instant& instant, std::span<const Instant> rates,
                    std::span<double> values, std::span<double> derivatives) const;
  /// The force Fcs of two universal joints at O2, likewise.
  /// @throws InputError where no such joint drives the block, and as reactions()
  void joint_force(const Instant& instant, std::span<const Instant> rates, std::span<double> values,
                   std::span<double> derivatives) const;

 private:
  void vector_from(std::size_t column, const Instant& instant, std::span<const Instant> rates,
                   std::span<double> values, std::span<double> derivatives) const;
  template <class Put>
  void differentiate(const closed_form::Common& common, const Instant& instant,
                     std::span<const Instant> rates, const Put& put) const;

  struct Prepared;
  ChannelLayout layout_;
  std::size_t directions_;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace bentaxis::analytic
