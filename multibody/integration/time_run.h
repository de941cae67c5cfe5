// A pump carried through time, from sample to sample.
#pragma once

#include <SimTKsimbody.h>

#include <functional>
#include <memory>
#include <vector>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/results/channels.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// Integrates the scene over the samples of a case, landing on every sample and on every edge of
/// the pressure, and keeps account of errors and work.
class TimeRun {
 public:
  /// Assembles the pump at theta = 0.
  /// @param samples, pressure  must outlive the run
  TimeRun(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
          const PressureTrace& pressure, const IntegrationOptions& options, Drive drive);

  PumpSystem& system() { return system_; }

  /// Angle (degrees) inside the present segment between edges that belongs to a shaft angle in
  /// (-pi, pi].
  double angle_in_segment(double theta) const;

  /// @throws ComputationError where the integrator gives up or the state is no longer made of
  ///                          numbers
  void run(const Progress& progress, const std::function<void(std::size_t row)>& at_sample);

  /// Reads all channels at the sample just reached, with that sample's pressures.
  /// @throws ComputationError where the multipliers cannot be trusted
  void read(std::size_t row, const ChannelLayout& layout, std::vector<double>& values);

  const IntegrationRecord& record() const { return record_; }

 private:
  void advance_to(double distance);
  void step_to(double distance);
  void enter_segment(double from);
  WorstErrors errors_at(std::size_t row, const SimTK::State& state) const;
  void note(std::size_t row);

  const Samples& samples_;
  const PressureTrace& pressure_;
  PumpSystem system_;
  std::function<void()> alive_ = [] {};  // asked at every step; may throw
  double direction_;
  std::vector<double> edges_;
  std::size_t next_edge_ = 0;
  double low_ = 0, high_ = 0;  // of the present segment, |theta| in degrees
  double start_ = 0;           // s
  double energy_at_start_ = 0;
  std::unique_ptr<SimTK::Integrator> integrator_;
  IntegrationRecord record_;
};

}  // namespace bentaxis::multibody
