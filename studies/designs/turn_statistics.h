// Outputs of many designs by the kernel of the closed form: statistics of reactions over a turn,
// made while the reactions are, without tables. Internal.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/designs/output.h"
#include "bentaxis/designs/variable.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::designs {

/// Outputs as the kernel gives them.
struct TurnOutputs {
  struct Place {
    Statistic statistic = Statistic::mean;
    std::size_t measured = 0;  ///< in `measured`; of geometry: its number in `geometry`
    double unit_in_si = 1;
    bool of_geometry = false;
  };
  std::vector<Place> places;  ///< one per output
  std::vector<analytic::Measured> measured;
  std::vector<Output> geometry;  ///< what follows from the geometry alone
};

/// Whether the kernel can follow from design to design: no channels that come and go, no teeth, no
/// other kind of pressure.
bool stays_in_reach(const Family& family);

/// Nothing where one of them is neither a statistic of a reaction nor one of the geometry.
std::optional<TurnOutputs> turn_outputs(const std::vector<Output>& outputs, const Case& base);

/// The kernel over a turn of one design after the other: for one thread. Angles and pressures are
/// kept from one to the next while what they depend on stays.
class KernelTurn {
 public:
  /// At the samples of each design.
  KernelTurn() = default;
  /// At these angles of a turn, deg, for every design.
  explicit KernelTurn(std::vector<double> theta_deg) : given_deg_(std::move(theta_deg)) {}

  /// Becomes a turn of this design.
  /// @param the_case  valid; every time as many pistons, no teeth, pressure ideal or the same curve
  /// @throws InputError
  void become(const Case& the_case, const Assumptions& assumptions);

  // Of the last design:
  const analytic::BatchModel& model() const { return *model_; }
  analytic::BatchInstants instants() const;

 private:
  void set_samples(std::size_t samples, int pistons);
  double degrees(std::size_t sample) const;
  // Whether each chamber passes the samples where the one before it has been.
  bool shifted(int pistons) const;
  void set_pressure(const PressureSpec& pressure, int pistons);

  std::optional<analytic::BatchModel> model_;
  double speed_rpm_ = 0;
  PortPressures ports_;
  std::vector<double> given_deg_;
  std::vector<double> theta_;  // rad
  // Chamber by chamber where chambers pass the samples at places of their own; else of the first
  // chamber twice, each other one beginning somewhere in its first turn. Shares are of the way from
  // suction to delivery, on which ideal pressures have no influence.
  std::vector<double> shares_, pressures_;
  std::vector<analytic::Varying> chambers_;
  std::optional<PressureSpec> made_for_;  // without a curve
};

/// Evaluates one design after the other: for one thread.
class TurnStatistics {
 public:
  /// @param outputs  must outlive this object
  explicit TurnStatistics(const TurnOutputs& outputs);

  /// @param the_case  valid; as many pistons as the base, no teeth, pressure ideal or a curve
  /// @param results   one per output
  /// @return false where the general way has to say what is wrong: a value is not finite
  /// @throws InputError
  bool find(const Case& the_case, std::span<double> results);

 private:
  const TurnOutputs& outputs_;
  KernelTurn turn_;
  std::vector<analytic::Statistics> statistics_;
};

}  // namespace bentaxis::designs
