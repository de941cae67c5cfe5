// What the tests share: where the data are, tolerances, random pumps.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::test {

inline std::filesystem::path reference_folder() {
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "high_precision";
}

/// Names of all high-precision cases.
inline std::vector<std::string> reference_cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(reference_folder()))
    if (entry.is_directory()) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

inline Case reference_case(const std::string& name) {
  return read_case(reference_folder() / name / "case.toml");
}

/// The pump at a constant speed, rad/s, under the case's pressure; the block turns with the shaft.
inline Instant instant_at(const Case& the_case, double theta_deg, double speed) {
  const PressureTrace pressure(the_case.pressure);
  const int pistons = the_case.pump.geometry.pistons;
  Instant instant;
  instant.turn(radians(theta_deg), speed);
  instant.ports = the_case.pressure.ports;
  for (int k = 1; k <= pistons; ++k)
    instant.chamber_pressure.push_back(pressure(piston_angle_deg(theta_deg, k, pistons)));
  return instant;
}

/// One channel's values.
inline std::vector<double> column(const ResultTable& table, const std::string& name) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows(); ++row)
    values.push_back(table.at(row, table.find(name)));
  return values;
}

inline double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// What a job is refused for; "accepted" where it is not.
inline std::string refusal(const std::function<void()>& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// A folder of a test's own, gone with it.
class Scratch {
 public:
  Scratch()
      : path_(std::filesystem::temp_directory_path() /
              ("bentaxis_test_" + std::to_string(getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Scales every tolerance: BENTAXIS_TOLERANCE_SCALE=0 makes all comparisons fail and so print their
/// true residuals.
inline double tolerance_scale() {
  const char* text = std::getenv("BENTAXIS_TOLERANCE_SCALE");
  return text == nullptr ? 1.0 : std::atof(text);
}

inline double scaled(double tolerance) { return tolerance * tolerance_scale(); }

/// Largest difference of two tables over each group's peak in the first, reactions and derived
/// channels alike; and where.
struct Worst {
  double over_peak = 0;
  std::string channel;
};
inline Worst worst_difference(const ResultTable& first, const ResultTable& second,
                              bool reactions_only = false) {
  Worst worst;
  for (std::size_t c = 0; c < first.columns(); ++c) {
    const Channel& channel = first.channels[c];
    if (channel.kind == ChannelKind::check) continue;
    if (reactions_only && channel.kind != ChannelKind::reaction) continue;
    const double peak = first.peak(channel.group);
    for (std::size_t row = 0; row < first.rows(); ++row) {
      const double a = first.at(row, c);
      const double b = second.at(row, c);
      if (is_computed(a) != is_computed(b)) return {1e300, channel.name + " computed by one only"};
      if (!is_computed(a)) continue;
      const double difference = std::abs(a - b) / (peak > 0 ? peak : 1);
      if (difference > worst.over_peak) worst = {difference, channel.name};
    }
  }
  return worst;
}

/// One turn of a case.
inline Samples one_turn(const Case& the_case) {
  return sample_case(the_case, PressureTrace(the_case.pressure));
}

/// A pump with generic, non-aligned data that can be assembled. Seeded: the same for the same seed.
class RandomPump {
 public:
  explicit RandomPump(unsigned seed) : engine_(seed) {}

  PumpParameters pump() {
    for (;;) {
      PumpParameters p;
      Geometry& g = p.geometry;
      g.pistons = std::uniform_int_distribution<int>(1, 11)(engine_);
      g.tilt = in(0, 1.0);
      g.joint_circle_radius = in(0.015, 0.05);
      g.bore_circle_radius = g.joint_circle_radius * in(0.7, 1.1);
      g.axis_offset = in(-0.006, 0.006);
      g.piston_length = in(0.03, 0.09);
      g.bore_diameter = in(0.008, 0.03);
      p.gear.pitch_diameter = in(0.05, 0.15);
      p.gear.pressure_angle = in(0, 0.5);
      p.bearings.tapered_z = in(-0.05, 0.02);
      p.bearings.cylindrical_z = p.bearings.tapered_z - in(0.02, 0.08);
      p.piston.mass = in(0.02, 0.3);
      p.piston.joint_mass_fraction = in(0, 0.95);
      PistonMass::Real real;
      real.centre_of_mass = in(0.2, 0.8) * g.piston_length;
      real.transverse_inertia = in(0.02, 0.12) * p.piston.mass * g.piston_length * g.piston_length;
      real.axial_inertia = in(0.1, 1.9) * real.transverse_inertia;
      real.spin = in(-100, 100);
      p.piston.real = real;
      const double kind = in(0, 1);
      p.piston.inertia = kind < 0.4   ? PistonInertia::real
                         : kind < 0.6 ? PistonInertia::dynamically_equivalent
                                      : PistonInertia::lumped;
      p.shaft = {in(0.5, 4), in(-0.08, 0), in(1e-3, 4e-3)};
      p.block = {in(0.5, 3),  in(0.02, 0.06), in(0.03, 0.08),
                 in(0, 4e-4), in(0, 500),     in(1e-3, 3e-3)};
      p.friction = {in(0, 60), in(0, 30), in(0.005, 0.05), in(0, 0.1), in(0, 0.05), in(0.8, 1)};
      if (in(0, 1) < 0.7) {
        const double r1 = in(0.01, 0.015);
        PortPlate plate{r1, r1 + in(1e-3, 3e-3), r1 + in(5e-3, 8e-3), r1 + in(9e-3, 12e-3), {}, {}};
        plate.delivery = {in(180, 200), in(330, 350)};
        plate.suction = {in(0, 20), in(150, 170)};
        p.port_plate = plate;
      }
      p.gravity = in(-20, 20);
      if (assembly_margin(g).longest_distance < 0.8 * g.piston_length) return p;
    }
  }

  /// An instant for that pump; `with_rate` gives a changing speed too.
  Instant instant(const PumpParameters& p, bool with_rate) {
    Instant i;
    const double angle = in(-4, 7);
    const double speed = in(-300, 300);
    i.turn(angle, speed, with_rate ? in(-2000, 2000) : 0);
    i.ports = {in(-1e5, 1e6), in(0, 4e7)};
    for (int k = 0; k < p.geometry.pistons; ++k) i.chamber_pressure.push_back(in(0, 4e7));
    return i;
  }

  /// That pump with the bore force beside B and a second flank, now and then.
  PumpParameters free(PumpParameters p) {
    if (in(0, 1) < 0.7) p.piston.contact = in(0.5, 1.3) * p.geometry.piston_length;
    if (in(0, 1) < 0.7) p.gear.flanks = Flanks::two;
    return p;
  }

  /// An instant at which the block moves on its own, `lead` rad and less from the shaft.
  Instant free_instant(const PumpParameters& p, double lead) {
    Instant i = instant(p, true);
    i.block = {i.shaft.angle + in(-lead, lead), in(-300, 300), in(-9000, 9000)};
    return i;
  }

  Assumptions assumptions(const PumpParameters& p) {
    return {in(0, 1) < 0.7, p.piston.inertia, BlockDrive::mesh};
  }

  double in(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

 private:
  std::mt19937 engine_;
};

}  // namespace bentaxis::test
