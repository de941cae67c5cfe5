#include "bentaxis/pump/result_table.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "bentaxis/pump/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

constexpr std::uint64_t kNotComputedBits = 0x7ff8'0000'0000'be57;

bool is_stray_nan(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return !is_computed(value) && bits != kNotComputedBits;
}

}  // namespace

double not_computed() {
  double value = 0;
  std::memcpy(&value, &kNotComputedBits, sizeof value);
  return value;
}

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
  instant.theta = radians(std::fmod(theta_deg[row], 360.0));
  instant.omega = omega;
  instant.omega_dot = 0;
  instant.ports = ports;
  const auto first = chamber_pressure.begin() + static_cast<std::ptrdiff_t>(row) * pistons;
  instant.chamber_pressure.assign(first, first + pistons);
}

Samples sample_case(const Case& the_case, const PressureTrace& pressure, int revolutions,
                    bool falling) {
  Samples samples;
  samples.pistons = the_case.pump.geometry.pistons;
  samples.omega = rad_per_second(the_case.operation.speed_rpm);
  samples.ports = the_case.pressure.ports;
  const int per_turn = the_case.operation.samples_per_revolution;
  const auto rows = static_cast<long long>(per_turn) * revolutions;
  for (long long i = 0; i < rows; ++i) {
    const double theta = (falling ? -360.0 : 360.0) * static_cast<double>(i) / per_turn;
    samples.theta_deg.push_back(theta == 0 ? 0 : theta);
    for (int k = 1; k <= samples.pistons; ++k)
      samples.chamber_pressure.push_back(pressure(piston_angle_deg(theta, k, samples.pistons)));
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
    std::fill(row.begin(), row.end(), not_computed());
    evaluate(instant, row);
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (std::isinf(row[c]) || is_stray_nan(row[c]))
        throw ComputationError(name + " model: " + table.channels[c].name + " is not finite at " +
                               number_text(samples.theta_deg[i]) + " deg");
      table.values.push_back(row[c] / table.channels[c].unit_in_si);
    }
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(table.rows()));
  }
  return table;
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

std::string to_csv(const ResultTable& table) {
  std::string text = "theta_deg";
  for (const Channel& channel : table.channels) text += "," + channel.name;
  text += "\n";
  for (std::size_t row = 0; row < table.rows(); ++row) {
    append_number(text, table.theta_deg[row]);
    for (std::size_t column = 0; column < table.columns(); ++column) {
      text += ',';
      append_number(text, table.at(row, column));
    }
    text += '\n';
  }
  return text;
}

}  // namespace bentaxis
