// Motion and oil as one set of equations. Internal.
#pragma once

#include <array>
#include <vector>

#include "bentaxis/coupled/system_state.h"
#include "bentaxis/numerics/stiff_integrator.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"

namespace bentaxis::coupled {

/// States of motion that move, of those that a simulation may have.
std::vector<std::size_t> moving(const Mechanics& mechanics);
/// Times at which what is given kinks, rising.
std::vector<double> breakpoints_of(const Mechanics& mechanics, const Oil& oil);
/// Some motions of a state, then its oil, each over its scale; and back.
void pack(const SystemState& state, const std::vector<std::size_t>& motions,
          const std::vector<double>& scale, double* y);
void unpack(const double* y, const std::vector<std::size_t>& motions,
            const std::vector<double>& scale, SystemState& state);

class System : public numerics::Equations {
 public:
  /// @param balances  works, impulse and what goes by each place of the oil are integrated too
  System(Mechanics& mechanics, const Oil& oil, bool balances);

  Mechanics& mechanics() const { return mechanics_; }
  const Oil& oil() const { return oil_; }
  long evaluations() const { return evaluations_; }  ///< of the equations of motion

  // The scaled vector that is integrated: states of motion that move, works, then the oil's.
  int motions() const { return motions_; }  ///< the first of it
  const std::vector<std::size_t>& active() const { return active_; }
  const std::vector<double>& scale() const { return scale_; }
  void scaled(const SystemState& state, std::vector<double>& y) const;
  void unscaled(const double* y, SystemState& state) const;

  /// Interval of the block's angle, rad, whose ends are event_functions.
  double from = -1e300, to = 1e300;
  /// Each contact's touch is an event function too, from kContacts on.
  enum EventFunction : std::size_t { kTo, kFrom, kContacts };
  const std::vector<int>& contacts() const { return contacts_; }  ///< of the mechanics

  // Integrals, in units of integral_scale().
  int places() const { return places_; }  ///< energies, the first of them
  int mass_in() const { return places_; }
  int mass_out() const { return places_ + 1; }
  int pressure_work() const { return places_ + 2; }
  double integral_scale(int index) const {
    return index == mass_in() || index == mass_out() ? mass_scale_ : work_scale_;
  }

  int states() const override { return static_cast<int>(scale_.size()); }
  int integrals() const override { return balances_ && oil_.states() > 0 ? places_ + 3 : 0; }
  std::vector<int> event_functions() const override;
  bool rates(double time, const double* y, double* dy) override;
  void jacobian(double time, const double* y, const double* dy, bool again,
                double* by_state) override;
  void integrands(double time, const double* y, double* dq) override;
  void event_values(double time, const double* y, double* values) override;
  bool is_recoverable(const std::exception& error) const override;

  /// The mechanics have changed their law: what is known of their derivatives is of no use.
  void forget() { known_ = false; }

 private:
  void set(double time, const double* y);
  void find_mechanics(double time, const double* y, const double* dy);
  bool moved(const double* y) const;

  Mechanics& mechanics_;
  const Oil& oil_;
  bool balances_;
  int motions_ = 0, places_ = 0;
  std::vector<std::size_t> active_;
  std::vector<int> contacts_;
  std::vector<double> scale_;
  double work_scale_ = 1, mass_scale_ = 1;
  long evaluations_ = 0;

  // At what was asked for last.
  SystemState state_;
  AxisMotion shaft_, block_;
  OilLoads loads_;
  MotionVector motion_rates_{};
  std::vector<double> oil_rates_;

  // Derivatives of the scaled rates of motion and works, column-major, and where they were found.
  bool known_ = false;
  std::vector<double> by_motion_, by_pressure_, known_at_;
  double known_angle_ = 0;
  std::vector<double> other_rates_, by_oil_, by_loads_;
  OilLoads other_loads_;
};

}  // namespace bentaxis::coupled
