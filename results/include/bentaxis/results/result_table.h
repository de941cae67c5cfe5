// A table of results over the shaft angle, whoever computed it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"

namespace bentaxis {

/// How a table came about, as lines for a report: bodies, equations, rank, times.
struct Provenance {
  std::vector<std::pair<std::string, std::string>> facts;
  double seconds = 0;  ///< wall-clock time of the run
};

/// Values by row (shaft angle) and column (channel), in the channel's own unit.
struct ResultTable {
  std::string name;
  std::vector<Channel> channels;
  std::vector<double> theta_deg;
  std::vector<double> values;  ///< row-major, theta_deg.size() x channels.size()
  Provenance provenance;

  std::size_t rows() const { return theta_deg.size(); }
  std::size_t columns() const { return channels.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * columns() + column]; }
  /// Index of a column by name, or columns() where there is none.
  std::size_t find(const std::string& channel_name) const;
  /// Largest magnitude of the vectors of a group over the whole table; 0 where not computed.
  double peak(const std::string& group) const;
};

/// Angles of a run with the chamber pressures there: evaluated once, given to every model.
struct Samples {
  std::vector<double> theta_deg;
  std::vector<double> chamber_pressure;  ///< row-major, one column per piston, Pa gauge
  PortPressures ports;
  double omega = 0;  ///< rad/s
  int pistons = 0;

  /// Copies sample `row` into `instant`. theta is reduced to one turn first, exactly.
  void instant(std::size_t row, Instant& instant) const;
};

/// Angles of a run one at a time, for runs too long to hold.
class Sampler {
 public:
  /// As sample_case. Both arguments must outlive it.
  Sampler(const Case& the_case, const PressureTrace& pressure, int revolutions = 1,
          bool falling = false);
  long long rows() const { return rows_; }
  double theta_deg(long long row) const;
  /// Fills `instant` with sample `row`. theta is reduced to one turn first, exactly.
  void instant(long long row, Instant& instant) const;

 private:
  const Case& case_;
  const PressureTrace& pressure_;
  long long rows_;
  double turn_deg_;  // 360, or -360 where angles fall
};

/// Samples of `revolutions` turns: angles 360 i/s for i = 0 .. s x revolutions - 1; against the
/// direction of rotation (speed < 0) an integrated run takes `falling` angles -360 i/s.
Samples sample_case(const Case& the_case, const PressureTrace& pressure, int revolutions = 1,
                    bool falling = false);

/// Reports a fraction done in [0, 1]; may throw Interrupted to stop the run.
using Progress = std::function<void(double)>;

/// Fills a table: calls `evaluate(instant, row values in SI)` for every sample, checks that every
/// value is finite or marked as not computed, and converts to the channels' units.
/// @throws ComputationError naming model, channel and angle where a value is not finite.
ResultTable tabulate(const std::string& name, const ChannelLayout& layout, const Samples& samples,
                     const std::function<void(const Instant&, std::vector<double>&)>& evaluate,
                     const Progress& progress = {});

/// The same row by row, without a table: `sink` gets each row's angle and its values in the
/// channels' units.
void stream_rows(const std::string& name, const ChannelLayout& layout, const Sampler& sampler,
                 const std::function<void(const Instant&, std::vector<double>&)>& evaluate,
                 const std::function<void(double theta_deg, const std::vector<double>&)>& sink,
                 const Progress& progress = {});

/// Largest applied load of a case, for channels whose peak is zero.
struct LoadScale {
  double force = 0;   ///< N: largest applied force
  double moment = 0;  ///< Nm: the same times the larger circle radius, or a friction torque
};
LoadScale load_scale(const Case& the_case, const Samples& samples);

/// The table with only those of its channels that are wanted.
ResultTable select_channels(const ResultTable& table,
                            const std::function<bool(const Channel&)>& wanted);

}  // namespace bentaxis
