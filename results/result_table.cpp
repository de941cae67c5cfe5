#include "bentaxis/results/result_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

using Evaluate = std::function<void(const Instant&, std::vector<double>&)>;

// One row in the channels' units, checked.
void evaluate_row(const std::string& name, const std::vector<Channel>& channels,
                  const Evaluate& evaluate, const Instant& instant, double theta_deg,
                  std::vector<double>& row) {
  std::fill(row.begin(), row.end(), not_computed());
  evaluate(instant, row);
  for (std::size_t c = 0; c < row.size(); ++c) {
    if (std::isinf(row[c]) || is_stray_nan(row[c]))
      throw ComputationError(name + " model: " + channels[c].name + " is not finite at " +
                             number_text(theta_deg) + " deg");
    row[c] /= channels[c].unit_in_si;
  }
}

}  // namespace

std::size_t ResultTable::find(const std::string& channel_name) const {
  const auto it = std::find_if(channels.begin(), channels.end(), [&](const Channel& channel) {
    return channel.name == channel_name;
  });
  return static_cast<std::size_t>(it - channels.begin());
}

double ResultTable::peak(const std::string& group) const {
  // Components of one vector share group, frame and piston.
  std::map<std::pair<std::string, int>, std::vector<std::size_t>> vectors;
  for (std::size_t c = 0; c < columns(); ++c)
    if (channels[c].group == group) vectors[{channels[c].frame, channels[c].piston}].push_back(c);
  double peak = 0;
  for (const auto& [key, components] : vectors) {
    for (std::size_t row = 0; row < rows(); ++row) {
      double square = 0;
      for (const auto c : components) {
        const double value = at(row, c);
        if (is_computed(value)) square += value * value;
      }
      peak = std::max(peak, std::sqrt(square));
    }
  }
  return peak;
}

void Samples::instant(std::size_t row, Instant& instant) const {
  instant.turn(radians(std::fmod(theta_deg[row], 360.0)), omega);
  instant.ports = ports;
  const auto first = chamber_pressure.begin() + static_cast<std::ptrdiff_t>(row) * pistons;
  instant.chamber_pressure.assign(first, first + pistons);
}

Sampler::Sampler(const Case& the_case, const PressureTrace& pressure, int revolutions, bool falling)
    : case_(the_case),
      pressure_(pressure),
      rows_(static_cast<long long>(the_case.operation.samples_per_revolution) * revolutions),
      turn_deg_(falling ? -360.0 : 360.0) {}

double Sampler::theta_deg(long long row) const {
  const double theta =
      turn_deg_ * static_cast<double>(row) / case_.operation.samples_per_revolution;
  return theta == 0 ? 0 : theta;
}

void Sampler::instant(long long row, Instant& instant) const {
  const int n = case_.pump.geometry.pistons;
  const double theta = theta_deg(row);
  instant.turn(radians(std::fmod(theta, 360.0)), rad_per_second(case_.operation.speed_rpm));
  instant.ports = case_.pressure.ports;
  instant.chamber_pressure.resize(n);
  for (int k = 1; k <= n; ++k)
    instant.chamber_pressure[k - 1] = pressure_(piston_angle_deg(theta, k, n));
}

Samples sample_case(const Case& the_case, const PressureTrace& pressure, int revolutions,
                    bool falling) {
  const Sampler sampler(the_case, pressure, revolutions, falling);
  Samples samples;
  samples.pistons = the_case.pump.geometry.pistons;
  samples.omega = rad_per_second(the_case.operation.speed_rpm);
  samples.ports = the_case.pressure.ports;
  Instant instant;
  for (long long row = 0; row < sampler.rows(); ++row) {
    sampler.instant(row, instant);
    samples.theta_deg.push_back(sampler.theta_deg(row));
    samples.chamber_pressure.insert(samples.chamber_pressure.end(),
                                    instant.chamber_pressure.begin(),
                                    instant.chamber_pressure.end());
  }
  return samples;
}

ResultTable tabulate(const std::string& name, const ChannelLayout& layout, const Samples& samples,
                     const std::function<void(const Instant&, std::vector<double>&)>& evaluate,
                     const Progress& progress) {
  ResultTable table;
  table.name = name;
  table.channels = layout.channels();
  table.theta_deg = samples.theta_deg;
  table.values.reserve(table.rows() * table.columns());
  Instant instant;
  std::vector<double> row(layout.size());
  for (std::size_t i = 0; i < samples.theta_deg.size(); ++i) {
    samples.instant(i, instant);
    evaluate_row(name, table.channels, evaluate, instant, samples.theta_deg[i], row);
    table.values.insert(table.values.end(), row.begin(), row.end());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(table.rows()));
  }
  return table;
}

void stream_rows(const std::string& name, const ChannelLayout& layout, const Sampler& sampler,
                 const Evaluate& evaluate,
                 const std::function<void(double theta_deg, const std::vector<double>&)>& sink,
                 const Progress& progress) {
  Instant instant;
  std::vector<double> row(layout.size());
  for (long long i = 0; i < sampler.rows(); ++i) {
    sampler.instant(i, instant);
    evaluate_row(name, layout.channels(), evaluate, instant, sampler.theta_deg(i), row);
    sink(sampler.theta_deg(i), row);
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(sampler.rows()));
  }
}

LoadScale load_scale(const Case& the_case, const Samples& samples) {
  const PumpParameters& pump = the_case.pump;
  const double area = kPi / 4 * pump.geometry.bore_diameter * pump.geometry.bore_diameter;
  double pressure = std::max(std::abs(samples.ports.delivery), std::abs(samples.ports.suction));
  for (const double p : samples.chamber_pressure) pressure = std::max(pressure, std::abs(p));
  const double radius =
      std::max(pump.geometry.joint_circle_radius, pump.geometry.bore_circle_radius);
  const double inertia = pump.piston.mass * samples.omega * samples.omega * radius;
  LoadScale scale;
  scale.force =
      std::max({pressure * std::max(area, pump.block.bottom_area), pump.block.spring_force,
                pump.friction.piston_coulomb, inertia,
                pump.gravity * std::max({pump.shaft.mass, pump.block.mass, pump.piston.mass})});
  scale.moment =
      std::max({scale.force * radius, pump.friction.block_viscous * std::abs(samples.omega),
                pump.friction.shaft_viscous * std::abs(samples.omega)});
  return scale;
}

ResultTable select_channels(const ResultTable& table,
                            const std::function<bool(const Channel&)>& wanted) {
  ResultTable selected;
  selected.name = table.name;
  selected.theta_deg = table.theta_deg;
  selected.provenance = table.provenance;
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < table.columns(); ++column)
    if (wanted(table.channels[column])) {
      columns.push_back(column);
      selected.channels.push_back(table.channels[column]);
    }
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const std::size_t column : columns) selected.values.push_back(table.at(row, column));
  return selected;
}

}  // namespace bentaxis
