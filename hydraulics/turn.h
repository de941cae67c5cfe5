// One period of the found state, recorded: the N chambers over 360/N degrees are one chamber over
// the turn.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "integrator.h"
#include "network.h"

namespace bentaxis::hydraulics {

/// p_1_bar, p_delivery_bar.
std::vector<Channel> pressure_channels();

/// Pressures, their slopes and the flow that has passed, collected from the steps of an integration
/// over one period.
class TurnRecord {
 public:
  /// @param rows  of the table over the turn
  TurnRecord(const Network& network, double load_size, int rows);

  /// For Integrator::over_period.
  void see(const Integrator::Step& step);

  /// After the last step. Backwards: from here on nodes are those of a turn forwards, the last one
  /// first; period - x is their x, and chamber k stands where forwards chamber k+1 does.
  void finish();

  /// The curve of one chamber over the turn through as few of the collected states as keep the
  /// others within `error` of their own absolute pressure from it, with their slopes; monotone
  /// where the states are. Its `error` is that of the interpolation alone.
  ComputedPressure curve(double error) const;

  /// Pressures (of the chamber as the models get it), flows, volume and openings over the turn.
  ResultTable table(const PressureTrace& chamber) const;

  /// Largest difference, Pa, of the chambers' pressures from those at other states (x, s of the
  /// pressures) of the same period.
  double difference(const std::vector<std::pair<double, std::vector<double>>>& states,
                    const ComputedPressure& curve) const;

  /// What is read off states; the rest of the summary is left as it is.
  void summarize(const Integrals& over_period, Summary& summary) const;

  /// Orders N, 2N, .. of the shaft: amplitudes of the harmonics over the period.
  std::vector<Order> orders(int count) const;

  PressureCurve delivery() const { return {angles_, delivery_}; }

 private:
  // Of the curve of chamber k from node `first` to node `last`.
  void add_pieces(std::size_t first, std::size_t last, int k, double error,
                  std::vector<PeriodicCubic::Piece>& pieces, double& worst) const;
  double s(std::size_t node, int k) const { return s_[node * network_.pressures() + k]; }
  double slope(std::size_t node, int k) const { return slope_[node * network_.pressures() + k]; }
  void add_node(const Integrator::Step& step, double x);
  void add_row(const Integrator::Step& step);
  double delivery_gauge(std::size_t node) const {
    return network_.delivery_gauge(&s_[node * network_.pressures()]);
  }

  const Network& network_;
  double load_size_;
  std::vector<double> x_, s_, slope_, state_;  // of the nodes; s and slope: pressures() each
  std::vector<std::size_t> edges_;             // nodes at which a interval between edges begins
  struct RowPlace {
    double x;
    int row, chamber;
  };
  std::vector<RowPlace> places_;  // of the table's rows in the period, rising in x
  std::size_t next_place_ = 0;
  std::vector<Place> power_places_;
  std::vector<double> load_flow_, load_pressure_;  // of the nodes
  std::vector<double> angles_, delivery_, values_;
  std::vector<double> delivered_, loaded_;  // mass since the start of the period at equal steps
  Network::Flows flows_;
};

}  // namespace bentaxis::hydraulics
