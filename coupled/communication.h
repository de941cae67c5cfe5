// A simulation that exchanges values with a partner outside. Internal.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bentaxis/coupled/simulation.h"
#include "bentaxis/results/motion.h"
#include "hybrid_integrator.h"

namespace bentaxis::coupled {

/// Communication points of a simulation. Mechanics and oil are given back as the case has them.
class Communication {
 public:
  /// @throws InputError where its step is not above 0
  Communication(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                const Exchange& exchange, double end);
  ~Communication();
  Communication(const Communication&) = delete;
  Communication& operator=(const Communication&) = delete;

  /// s, of the point that is next; beyond any end after the last.
  double next() const;
  /// Passes it: a integrator that has got there goes on from it under what the partner gives.
  /// @throws InputError where the case does not take that, what the partner throws
  void pass(HybridIntegrator& integrator);

 private:
  void read(double time, const SystemState& state);
  void set_inputs(const Surroundings& outside, HybridIntegrator& integrator,
                  const SystemState& state);

  Mechanics& mechanics_;
  Oil& oil_;
  const Exchange& exchange_;
  double end_;
  long points_ = 0;  // passed
  Surroundings outside_;
  MotionTable row_;
  OilLoads loads_;
  std::vector<double> motion_, reactions_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  std::size_t oil_columns_ = 0;
};

}  // namespace bentaxis::coupled
