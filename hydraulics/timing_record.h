// Collects what Timing says from the steps of an integration over one period.
#pragma once

#include <functional>
#include <vector>

#include "bentaxis/hydraulics/timing.h"
#include "integrator.h"
#include "network.h"

namespace bentaxis::hydraulics {

class TimingRecord {
 public:
  TimingRecord(const Network& network, double load_size)
      : network_(network), load_size_(load_size) {}

  /// For Integrator::over_period.
  void see(const Integrator::Step& step);

  /// @param delivery_mean  Pa gauge
  Timing timing(double delivery_mean) const;

 private:
  // A chamber at one angle of its turn.
  struct Node {
    double theta_deg;  // rising over the turn
    double s;
    double to_delivery, from_suction;  // kg/s
    double air_out;                    // share of the dissolved air, where it takes time
  };
  std::vector<Node> turn() const;

  const Network& network_;
  double load_size_;
  // Every step has as many nodes as its quadrature takes, at equal distances; of each all chambers.
  std::vector<double> x_;
  std::vector<Node> nodes_;
  Network::Flows flows_;
};

/// Where values over rising angles of a turn are below a limit, straight lines between them; the
/// last angle is 360 degrees past the first. One interval over the whole turn: [0, 360].
std::vector<AngleInterval> intervals_below(const std::vector<double>& theta_deg,
                                           const std::vector<double>& values, double limit);

}  // namespace bentaxis::hydraulics
