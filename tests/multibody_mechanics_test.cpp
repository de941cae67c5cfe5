// Simbody's equations of motion under the loads of the oil: against its own inverse direction, a
// stored trajectory, the balance of power, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/results/max_abs.h"
#include "support.h"

namespace bentaxis::test {
namespace {

namespace odeint = boost::numeric::odeint;

Case stored_case(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" / name /
                   "case.toml");
}

// A pump with generic data, some drive, and a state of its motion.
struct RandomMotion {
  explicit RandomMotion(RandomPump& random) : the_case(stored_case("motor_driven")) {
    PumpParameters& pump = the_case.pump;
    do pump = random.pump();
    while (pump.geometry.pistons > 9);
    pump.gear.flanks = random.in(0, 1) < 0.5 ? Flanks::one : Flanks::two;
    compliant = random.in(0, 1) < 0.6;
    pump.gear.contact = compliant ? ToothContact::compliant : ToothContact::rigid;
    pump.gear.compliance.reset();
    if (compliant) pump.gear.flanks = Flanks::two;
    if (compliant)
      pump.gear.compliance = ToothCompliance{random.in(2e7, 4e8), random.in(1, 1.6),
                                             random.in(0, 10), random.in(0, 4e-5)};
    the_case.operation.speed_rpm = random.in(-2500, 2500);
    DriveSpec& drive = *the_case.drive;
    const double kind = random.in(0, 3);
    if (kind < 1) {
      drive.kind = DriveKind::speed;
      drive.torque = 0;
    } else {
      drive.kind = kind < 2 ? DriveKind::torque : DriveKind::motor;
      drive.torque = random.in(-600, 600);
      drive.start_speed = random.in(-200, 200);
    }
    if (drive.kind != DriveKind::motor) drive.motor.reset();
    if (random.in(0, 1) < 0.5) {
      // Over time, s, or a motor's speed, rad/s.
      const double unit = drive.kind == DriveKind::motor ? 500 : 1;
      for (const double at : {-0.1, 0.1, 0.25, 0.4, 0.7}) {
        drive.curve.time.push_back(at * unit);
        drive.curve.value.push_back(random.in(-200, 200));
      }
    }
    assumptions = random.assumptions(pump);
    for (int k = 0; k < pump.geometry.pistons; ++k)
      loads.chamber_pressure.push_back(random.in(0, 4e7));
    loads.ports = {random.in(-1e5, 1e6), random.in(0, 4e7)};
    time = random.in(0, 0.5);
    if (drive.kind != DriveKind::speed) {
      y[kTurn] = random.in(-4, 7);
      y[kTurnRate] = random.in(-200, 200);
    }
    if (compliant) {
      const double approach = random.in(-5e-6, 1e-5);
      const int flank = random.in(0, 1) < 0.5 ? 1 : -1;
      y[kLag] = flank * (pump.gear.compliance->backlash / 2 + approach) / arm();
      y[kLagRate] = random.in(-5, 5);
    }
    if (drive.kind == DriveKind::motor) {
      y[kTwist] = random.in(-0.1, 0.1);
      y[kTwistRate] = random.in(-20, 20);
    }
  }

  double arm() const {
    return the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle);
  }
  // What the pressures can do to a shaft, Nm.
  double torque() const {
    const Geometry& g = the_case.pump.geometry;
    double force = 0;
    for (const double p : loads.chamber_pressure)
      force += p * kPi / 4 * std::pow(g.bore_diameter, 2);
    return force * g.joint_circle_radius;
  }
  // The law of Hunt and Crossley, towards +psi, N; and whether a flank leaves too fast to push.
  double tooth_force(bool* released = nullptr) const {
    const ToothCompliance& teeth = *the_case.pump.gear.compliance;
    double force = 0;
    for (const int flank : {1, -1}) {
      const double x = flank * arm() * y[kLag] - teeth.backlash / 2;
      if (x <= 0) continue;
      const double share = 1 + teeth.dissipation * flank * arm() * y[kLagRate];
      if (share < 0 && released != nullptr) *released = true;
      force += flank * teeth.stiffness * 1e-6 * std::pow(x / 1e-6, teeth.exponent) *
               std::max(0.0, share);
    }
    return force;
  }

  Case the_case;
  bool compliant = false;
  Assumptions assumptions;
  OilLoads loads;
  double time = 0;
  MotionVector y{};
};

// The inverse direction: what drives and meshes must do at these accelerations is what they do.
TEST(MultibodyMechanics, AccelerationsAreThoseAtWhichDriveAndTeethFollowTheirLaws) {
  RandomPump random(151);
  int flanks[3] = {0, 0, 0}, kinds[3] = {0, 0, 0}, backwards = 0, released = 0;
  for (int n = 0; n < 150; ++n) {
    const RandomMotion motion(random);
    const Case& the_case = motion.the_case;
    const DriveSpec& drive = *the_case.drive;
    const auto mechanics = multibody::mechanics(the_case, motion.assumptions);
    const MotionVector& y = motion.y;
    MotionVector dy;
    mechanics->rates(motion.time, y, motion.loads, dy);

    Instant now;
    now.shaft = mechanics->shaft(motion.time, y);
    now.block = mechanics->block(motion.time, y);
    const bool given = drive.kind == DriveKind::speed;
    const bool curved = !drive.curve.time.empty();
    now.shaft.acceleration = dy[kTurnRate];
    if (given && curved) now.shaft.acceleration = TimeSignal(drive.curve).slope(motion.time);
    now.block.acceleration = now.shaft.acceleration - dy[kLagRate];
    now.chamber_pressure = motion.loads.chamber_pressure;
    now.ports = motion.loads.ports;
    multibody::Model model(the_case.pump, motion.assumptions, 1);
    std::vector<double> values(model.layout().size());
    model.evaluate(now, values);
    const double td = values[model.layout().Td()];
    const double tooth = (now.shaft.speed < 0 ? -1 : 1) * values[model.layout().Rcs()];

    ++kinds[static_cast<std::size_t>(drive.kind)];
    backwards += now.shaft.speed < 0;
    const double scale = motion.torque();
    SCOPED_TRACE(n);
    if (motion.compliant) {
      bool fast = false;
      const double force = motion.tooth_force(&fast);
      released += fast;
      ++flanks[force > 0 ? 2 : force < 0 ? 0 : 1];
      EXPECT_NEAR(tooth, force, scaled(1e-10) * scale / motion.arm());
      EXPECT_NEAR(dy[kImpulse], std::abs(force), scaled(1e-10) * scale / motion.arm());
      EXPECT_EQ(dy[kLag], y[kLagRate]);
    }
    double power = td * now.shaft.speed;
    if (drive.kind == DriveKind::torque) {
      const double torque = curved ? TimeSignal(drive.curve).value(motion.time) : drive.torque;
      EXPECT_NEAR(td, torque, scaled(1e-10) * scale);
    }
    if (drive.kind == DriveKind::motor) {
      const MotorData& motor = *drive.motor;
      EXPECT_NEAR(td, motor.coupling_stiffness * y[kTwist] + motor.coupling_damping * y[kTwistRate],
                  scaled(1e-10) * scale);
      const double rotor_speed = now.shaft.speed + y[kTwistRate];
      const double torque =
          curved ? TimeSignal(drive.curve).value(rotor_speed)
                 : drive.torque - motor.torque_slope *
                                      (rotor_speed - rad_per_second(the_case.operation.speed_rpm));
      EXPECT_NEAR(motor.rotor_inertia * (dy[kTurnRate] + dy[kTwistRate]), torque - td,
                  scaled(1e-10) * scale);
      power = torque * rotor_speed;
    }
    EXPECT_NEAR(dy[kWorkOfDrive], power, scaled(1e-10) * scale * 300);
    EXPECT_EQ(mechanics->shaft_is_free(), !given);
    EXPECT_EQ(dy[kTurn], given ? 0 : y[kTurnRate]);
  }
  for (const int count : flanks) EXPECT_GT(count, 5);
  for (const int count : kinds) EXPECT_GT(count, 30);
  EXPECT_GT(backwards, 30);
  EXPECT_GT(released, 3);
}

// Along the motion that the rates give.
double rate_along(const RandomMotion& motion, const MotionVector& dy,
                  const std::function<double(double time, const MotionVector& y)>& value) {
  constexpr double kStep = 1e-7;  // s
  const auto at = [&](double step) {
    MotionVector y = motion.y;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += step * dy[i];
    return value(motion.time + step, y);
  };
  return (8 * (at(kStep) - at(-kStep)) - (at(2 * kStep) - at(-2 * kStep))) / (12 * kStep);
}

// Four-point differences over 1e-7 s: rounding of some hundred joules leaves 1e-6 W of megawatts.
TEST(MultibodyMechanics, WorkIsTheEnergyGained) {
  RandomPump random(152);
  double largest = 0;
  for (int n = 0; n < 60; ++n) {
    const RandomMotion motion(random);
    const auto mechanics = multibody::mechanics(motion.the_case, motion.assumptions);
    MotionVector dy;
    mechanics->rates(motion.time, motion.y, motion.loads, dy);
    const double gained = rate_along(motion, dy, [&](double time, const MotionVector& y) {
      return mechanics->kinetic_energy(time, y) + mechanics->potential_energy(y);
    });
    const double scale = motion.torque() * 300;
    EXPECT_NEAR(dy[kWorkOfLoads] + dy[kWorkOfDrive], gained, scaled(1e-8) * scale) << n;
    update_max_abs(largest, gained / scale);
  }
  EXPECT_GT(largest, 0.01);
}

// What the pressures do to the pistons is what the chambers' volumes take from the oil.
TEST(MultibodyMechanics, PressurePowerIsThatOfTheVolumes) {
  RandomPump random(153);
  for (int n = 0; n < 40; ++n) {
    const RandomMotion motion(random);
    const auto mechanics = multibody::mechanics(motion.the_case, motion.assumptions);
    const ChannelLayout& at = mechanics->layout();
    const double area = kPi / 4 * std::pow(motion.the_case.pump.geometry.bore_diameter, 2);
    MotionVector dy;
    mechanics->rates(motion.time, motion.y, motion.loads, dy);
    std::vector<double> state, row;
    MotionChecks checks{};
    const double power = -rate_along(motion, dy, [&](double time, const MotionVector& y) {
      mechanics->row(time, y, motion.loads, state, row, checks);
      double product = 0;
      for (int k = 0; k < at.pistons(); ++k)
        product += motion.loads.chamber_pressure[k] * area * row[at.zB(k)];
      return product;
    });
    EXPECT_NEAR(mechanics->pressure_power(motion.time, motion.y, motion.loads), power,
                scaled(1e-8) * motion.torque() * 300)
        << n;
  }
}

TEST(MultibodyMechanics, RowsAreThoseOfTheInverseDirection) {
  RandomPump random(154);
  for (int n = 0; n < 30; ++n) {
    const RandomMotion motion(random);
    const auto mechanics = multibody::mechanics(motion.the_case, motion.assumptions);
    MotionVector dy;
    std::vector<double> state, row;
    MotionChecks checks{};
    mechanics->row(motion.time, motion.y, motion.loads, state, row, checks);
    mechanics->rates(motion.time, motion.y, motion.loads, dy);
    ASSERT_EQ(state.size(), trajectory_columns(*motion.the_case.drive).size());
    Instant now;
    now.shaft = mechanics->shaft(motion.time, motion.y);
    now.block = mechanics->block(motion.time, motion.y);
    EXPECT_DOUBLE_EQ(radians(state[1]), now.shaft.angle);
    EXPECT_DOUBLE_EQ(radians(state[2]), now.block.angle);
    EXPECT_DOUBLE_EQ(rad_per_second(state[3]), now.shaft.speed);
    EXPECT_DOUBLE_EQ(rad_per_second(state[4]), now.block.speed);
    const DriveSpec& drive = *motion.the_case.drive;
    now.shaft.acceleration = dy[kTurnRate];
    if (drive.kind == DriveKind::speed && !drive.curve.time.empty())
      now.shaft.acceleration = TimeSignal(drive.curve).slope(motion.time);
    now.block.acceleration = now.shaft.acceleration - dy[kLagRate];
    now.chamber_pressure = motion.loads.chamber_pressure;
    now.ports = motion.loads.ports;
    multibody::Model model(motion.the_case.pump, motion.assumptions, 1);
    std::vector<double> values(model.layout().size());
    model.evaluate(now, values);
    const ChannelLayout& at = model.layout();
    const double force = motion.torque() / motion.the_case.pump.geometry.joint_circle_radius;
    for (std::size_t c = 0; c < at.reactions(); ++c)
      EXPECT_NEAR(row[c], values[c], scaled(1e-9) * force) << n << " " << at.channels()[c].name;
    EXPECT_NEAR(checks.power_balance, 0, scaled(1e-10) * motion.torque() * 300);
    if (motion.compliant)
      EXPECT_NEAR(checks.tooth_law, motion.tooth_force(), scaled(1e-10) * force);
    else
      EXPECT_FALSE(is_computed(checks.tooth_law));
  }
}

// Nothing depends on what was asked before, and only pressures may change between two calls.
TEST(MultibodyMechanics, RemembersNothing) {
  RandomPump random(155);
  for (int n = 0; n < 20; ++n) {
    const RandomMotion motion(random);
    const auto mechanics = multibody::mechanics(motion.the_case, motion.assumptions);
    const auto fresh = multibody::mechanics(motion.the_case, motion.assumptions);
    MotionVector first, again, dy;
    mechanics->rates(motion.time, motion.y, motion.loads, first);
    OilLoads others = motion.loads;
    for (double& p : others.chamber_pressure) p *= 0.5;
    mechanics->rates(motion.time, motion.y, others, dy);
    MotionVector fresh_dy;
    fresh->rates(motion.time, motion.y, others, fresh_dy);
    EXPECT_EQ(dy, fresh_dy);
    MotionVector y = motion.y;
    y[kTwist] += 0.01;
    y[kLag] = -y[kLag];
    mechanics->rates(motion.time, y, motion.loads, dy);
    fresh->rates(motion.time, y, motion.loads, fresh_dy);
    EXPECT_EQ(dy, fresh_dy);
    std::vector<double> state, row;
    MotionChecks checks{};
    mechanics->row(motion.time, motion.y, others, state, row, checks);
    mechanics->kinetic_energy(motion.time + 0.1, y);
    mechanics->pressure_power(motion.time, motion.y, others);
    mechanics->rates(motion.time, motion.y, motion.loads, again);
    EXPECT_EQ(first, again);
    // One that is asked for the first time. What is not computed is no number, and equals nothing.
    const auto asked_first = [&] {
      return multibody::mechanics(motion.the_case, motion.assumptions);
    };
    asked_first()->rates(motion.time, y, motion.loads, fresh_dy);
    EXPECT_EQ(dy, fresh_dy);
    const auto row_of = [&](Mechanics& asked) {
      asked.row(motion.time, y, others, state, row, checks);
      std::replace_if(
          row.begin(), row.end(), [](double v) { return !is_computed(v); }, -1.0);
      return row;
    };
    EXPECT_EQ(row_of(*mechanics), row_of(*asked_first()));
    EXPECT_EQ(mechanics->kinetic_energy(motion.time + 0.1, y),
              asked_first()->kinetic_energy(motion.time + 0.1, y));
    EXPECT_EQ(mechanics->pressure_power(motion.time, motion.y, others),
              asked_first()->pressure_power(motion.time, motion.y, others));
    EXPECT_EQ(mechanics->scales(), asked_first()->scales());
  }
}

// Forces whose squares are no numbers are refused, with no trace of the flank that carried them.
TEST(MultibodyMechanics, FailedRowsAreForgotten) {
  RandomPump random(157);
  int rigid = 0;
  for (int n = 0; n < 60; ++n) {
    const RandomMotion motion(random);
    if (motion.compliant) continue;
    ++rigid;
    const auto mechanics = multibody::mechanics(motion.the_case, motion.assumptions);
    OilLoads strange = motion.loads;
    for (double& p : strange.chamber_pressure) p *= 1e290;
    std::vector<double> state, row;
    MotionChecks checks{};
    EXPECT_THROW(mechanics->row(motion.time, motion.y, strange, state, row, checks),
                 ComputationError);
    const auto fresh = multibody::mechanics(motion.the_case, motion.assumptions);
    MotionVector dy, fresh_dy;
    mechanics->rates(motion.time, motion.y, motion.loads, dy);
    fresh->rates(motion.time, motion.y, motion.loads, fresh_dy);
    EXPECT_EQ(dy, fresh_dy);
    EXPECT_EQ(mechanics->kinetic_energy(motion.time, motion.y),
              fresh->kinetic_energy(motion.time, motion.y));
    EXPECT_EQ(mechanics->pressure_power(motion.time, motion.y, motion.loads),
              fresh->pressure_power(motion.time, motion.y, motion.loads));
    mechanics->row(motion.time, motion.y, motion.loads, state, row, checks);
    std::vector<double> fresh_row;
    fresh->row(motion.time, motion.y, motion.loads, state, fresh_row, checks);
    for (std::size_t c = 0; c < row.size(); ++c)
      EXPECT_TRUE(row[c] == fresh_row[c] || (!is_computed(row[c]) && !is_computed(fresh_row[c])));
  }
  EXPECT_GT(rigid, 5);
}

TEST(MultibodyMechanics, StartsAsTheDriveSays) {
  Case the_case = stored_case("motor_driven");
  const double omega = rad_per_second(1500);
  const auto turning = multibody::mechanics(the_case, the_case.multibody);
  EXPECT_DOUBLE_EQ(turning->shaft(0, turning->start()).speed, omega);
  EXPECT_EQ(turning->shaft(0, turning->start()).angle, 0);
  EXPECT_DOUBLE_EQ(turning->start()[kTwist], 292.5 / 5000);
  EXPECT_DOUBLE_EQ(turning->potential_energy(turning->start()),
                   5000 * std::pow(292.5 / 5000, 2) / 2);
  the_case.drive->start_speed = 0;
  const auto resting = multibody::mechanics(the_case, the_case.multibody);
  EXPECT_EQ(resting->start(), MotionVector{});
  EXPECT_EQ(resting->kinetic_energy(0, resting->start()), 0);
  OilLoads loads{std::vector<double>(5, 0.0), {}};
  MotionVector dy;
  resting->rates(0, resting->start(), loads, dy);  // at rest, and finite
  for (const double rate : dy) EXPECT_TRUE(std::isfinite(rate));
  EXPECT_GT(dy[kTwistRate], 0);  // the motor starts
}

// One part of each scale changes accelerations or angles by something one would notice, not by
// everything: sizes of a pump of 280 Nm at 1500 rpm with teeth of 100 N/um.
TEST(MultibodyMechanics, ScalesAreThoseOfThePump) {
  const Case the_case = stored_case("motor_driven");
  const MotionVector scale = multibody::mechanics(the_case, the_case.multibody)->scales();
  EXPECT_NEAR(std::log10(scale[kTurnRate] / 15.7), 0, 0.5);
  EXPECT_NEAR(std::log10(scale[kWorkOfLoads] / 300), 0, 0.5);
  EXPECT_GT(scale[kLag] * 0.05, 1e-8);  // of some tens of newtons to kilonewtons
  EXPECT_LT(scale[kLag] * 0.05, 1e-5);
  EXPECT_NEAR(std::log10(scale[kTwist] / 0.06), 0, 0.5);
  for (const double size : scale) EXPECT_GT(size, 0);
  const Case rigid = stored_case("constant_torque");
  for (const double size : multibody::mechanics(rigid, rigid.multibody)->scales())
    EXPECT_GT(size, 0);
}

// Integrated by any method, with pressures over the block's angle: a torque on rigid teeth, and a
// motor whose teeth meet twice in the first milliseconds, on which this method does not land.
TEST(MultibodyMechanics, StoredTrajectoriesAreReached) {
  struct Stored {
    std::string name;
    std::size_t rows;
    double allowed;  // of a group's peak
  };
  for (const Stored& stored :
       {Stored{"constant_torque", 6, 1e-8}, Stored{"motor_driven", 4, 1e-6}}) {
    const Case the_case = stored_case(stored.name);
    const NumericTable reference =
        read_numeric_csv(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" /
                         stored.name / "reference.csv");
    const PressureTrace trace(the_case.pressure);
    const auto mechanics = multibody::mechanics(the_case, the_case.multibody);
    const int pistons = the_case.pump.geometry.pistons;
    const MotionVector scale = mechanics->scales();
    const auto loads_at = [&](double time, const MotionVector& y) {
      OilLoads loads;
      const double psi_deg = mechanics->block(time, y).angle / kRadPerDegree;
      for (int k = 1; k <= pistons; ++k)
        loads.chamber_pressure.push_back(trace(piston_angle_deg(psi_deg, k, pistons)));
      loads.ports = the_case.pressure.ports;
      return loads;
    };
    // In units of the scales.
    const auto system = [&](const MotionVector& z, MotionVector& dz, double time) {
      MotionVector y;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = z[i] * scale[i];
      mechanics->rates(time, y, loads_at(time, y), dz);
      for (std::size_t i = 0; i < y.size(); ++i) dz[i] /= scale[i];
    };
    MotionVector z = mechanics->start();
    for (std::size_t i = 0; i < z.size(); ++i) z[i] /= scale[i];
    const auto stepper =
        odeint::make_controlled(1e-10, 1e-10, odeint::runge_kutta_dopri5<MotionVector>());
    const double energy = mechanics->kinetic_energy(0, mechanics->start()) +
                          mechanics->potential_energy(mechanics->start());
    std::map<std::string, double> off, peak;
    for (std::size_t row = 0; row < stored.rows; ++row) {
      const double time = reference.rows[row][0];
      if (row > 0)
        odeint::integrate_adaptive(stepper, system, z, reference.rows[row - 1][0], time, 1e-6);
      MotionVector y;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = z[i] * scale[i];
      std::vector<double> state, values;
      MotionChecks checks{};
      mechanics->row(time, y, loads_at(time, y), state, values, checks);
      const std::vector<std::string> names = trajectory_columns(*the_case.drive);
      const std::vector<Channel>& channels = mechanics->layout().channels();
      for (std::size_t c = 1; c < reference.header.size(); ++c) {
        const std::string& column = reference.header[c];
        const auto known = std::find(names.begin(), names.end(), column);
        if (known != names.end()) {
          const double have = state[static_cast<std::size_t>(known - names.begin())];
          update_max_abs(off[column], have - reference.rows[row][c]);
          update_max_abs(peak[column], 1500.0);
          continue;
        }
        const auto channel = std::find_if(channels.begin(), channels.end(),
                                          [&](const Channel& x) { return x.name == column; });
        ASSERT_NE(channel, channels.end()) << column;
        const double have = values[static_cast<std::size_t>(channel - channels.begin())];
        update_max_abs(off[channel->group], have - reference.rows[row][c]);
      }
      EXPECT_NEAR(checks.power_balance, 0, scaled(1e-6));  // of 45 kW
      // Of some hundred joules.
      EXPECT_NEAR(y[kWorkOfLoads] + y[kWorkOfDrive] + energy,
                  mechanics->kinetic_energy(time, y) + mechanics->potential_energy(y),
                  scaled(1e-6));
    }
    for (const auto& row : reference.rows)
      for (std::size_t c = 1; c < reference.header.size(); ++c)
        for (const Channel& channel : mechanics->layout().channels())
          if (channel.name == reference.header[c]) update_max_abs(peak[channel.group], row[c]);
    EXPECT_GE(off.size(), 12U);
    for (const auto& [group, difference] : off)
      EXPECT_LE(difference / peak[group], scaled(stored.allowed)) << stored.name << " " << group;
  }
}

// Two models that share nothing but the pump's description and the loads.
TEST(MechanicsOfBothModels, AgreeAtRandomStates) {
  RandomPump random(156);
  for (int n = 0; n < 150; ++n) {
    const RandomMotion motion(random);
    const MotionVector& y = motion.y;
    const auto a = analytic::mechanics(motion.the_case, motion.assumptions);
    const auto b = multibody::mechanics(motion.the_case, motion.assumptions);
    SCOPED_TRACE(n);
    MotionVector by_a, by_b;
    a->rates(motion.time, y, motion.loads, by_a);
    b->rates(motion.time, y, motion.loads, by_b);
    // Accelerations by what the pressures would give the block alone.
    const double torque = motion.torque();
    const double acceleration = torque / motion.the_case.pump.block.axial_inertia;
    for (const std::size_t i : {kTurnRate, kLagRate, kTwistRate})
      EXPECT_NEAR(by_a[i], by_b[i], scaled(1e-10) * acceleration) << i;
    for (const std::size_t i : {kTurn, kLag, kTwist}) EXPECT_EQ(by_a[i], by_b[i]) << i;
    for (const std::size_t i : {kWorkOfLoads, kWorkOfDrive})
      EXPECT_NEAR(by_a[i], by_b[i], scaled(1e-10) * torque * 300) << i;
    EXPECT_NEAR(by_a[kImpulse], by_b[kImpulse], scaled(1e-10) * torque / motion.arm());

    EXPECT_EQ(a->start(), b->start());
    for (const auto body : {&Mechanics::shaft, &Mechanics::block}) {
      EXPECT_EQ(((*a).*body)(motion.time, y).angle, ((*b).*body)(motion.time, y).angle);
      EXPECT_EQ(((*a).*body)(motion.time, y).speed, ((*b).*body)(motion.time, y).speed);
    }
    EXPECT_EQ(a->breakpoints(), b->breakpoints());
    EXPECT_EQ(a->compliant(), b->compliant());
    EXPECT_EQ(a->has_motor(), b->has_motor());
    EXPECT_EQ(a->shaft_is_free(), b->shaft_is_free());
    if (motion.compliant)
      for (const int flank : {1, -1}) {
        EXPECT_NEAR(a->approach(0, y, flank), b->approach(0, y, flank), 1e-18);
        EXPECT_NEAR(a->approach_rate(0, y, flank), b->approach_rate(0, y, flank), 1e-14);
      }
    EXPECT_NEAR(a->pressure_power(motion.time, y, motion.loads),
                b->pressure_power(motion.time, y, motion.loads), scaled(1e-12) * torque * 300);
    EXPECT_NEAR(a->potential_energy(y), b->potential_energy(y), 1e-12 * a->potential_energy(y));
    // Of pistons that spin the energy of the spin, which stays, is or is not counted.
    MotionVector still = y;
    still[kTurnRate] = still[kLagRate] = still[kTwistRate] = 0;
    const auto gained = [&](Mechanics& m) {
      return m.kinetic_energy(motion.time, y) - m.kinetic_energy(motion.time, still);
    };
    EXPECT_NEAR(gained(*a), gained(*b), scaled(1e-11) * (1 + a->kinetic_energy(motion.time, y)));
    // Two integrations that measure errors alike take like steps.
    const MotionVector scales_a = a->scales();
    const MotionVector scales_b = b->scales();
    for (std::size_t i = 0; i < kMotionStates; ++i) {
      if (by_a[i] == 0) continue;  // not a state of this case
      EXPECT_NEAR(std::log10(scales_a[i] / scales_b[i]), 0, 1.5) << i;
    }

    std::vector<double> state_a, state_b, row_a, row_b;
    MotionChecks checks_a{}, checks_b{};
    a->row(motion.time, y, motion.loads, state_a, row_a, checks_a);
    b->row(motion.time, y, motion.loads, state_b, row_b, checks_b);
    EXPECT_EQ(state_a, state_b);
    const ChannelLayout& at = a->layout();
    const double force = torque / motion.the_case.pump.geometry.joint_circle_radius;
    for (std::size_t c = 0; c < at.size(); ++c) {
      EXPECT_EQ(is_computed(row_a[c]), is_computed(row_b[c])) << at.channels()[c].name;
      if (c >= at.reactions()) continue;
      EXPECT_NEAR(row_a[c], row_b[c], scaled(1e-9) * force) << at.channels()[c].name;
    }
    EXPECT_EQ(is_computed(checks_a.tooth_law), is_computed(checks_b.tooth_law));
    if (motion.compliant) {
      EXPECT_NEAR(checks_a.tooth_law, checks_b.tooth_law, scaled(1e-10) * force);
    }
    EXPECT_NEAR(checks_a.power_balance, 0, scaled(1e-10) * torque * 300);
    EXPECT_EQ(checks_a.ring_power, checks_b.ring_power);
  }
}

// At rest, at dead centres, shaft and block turning against each other, flanks that just meet.
TEST(MechanicsOfBothModels, AgreeWhereSpeedsVanish) {
  int compared = 0;
  for (const char* name : {"constant_torque", "motor_driven", "rattle"})
    for (const double shaft_speed : {0.0, -20.0, 20.0})
      for (const double lag_rate : {0.0, 40.0})
        for (const double turn : {0.0, kPi, 0.3}) {
          Case the_case = stored_case(name);
          const bool compliant = the_case.pump.gear.contact == ToothContact::compliant;
          if (lag_rate != 0 && !compliant) continue;
          if (compliant) the_case.pump.gear.compliance->backlash = 0;
          the_case.operation.speed_rpm = shaft_speed / rad_per_second(1);
          if (the_case.drive->kind != DriveKind::speed) the_case.drive->start_speed = shaft_speed;
          OilLoads loads{{3e7, 2e7, 0, 1e6, 2.5e7}, {1e5, 3e7}};
          const auto a = analytic::mechanics(the_case, the_case.analytic);
          const auto b = multibody::mechanics(the_case, the_case.multibody);
          MotionVector y = b->start(), by_a, by_b;
          EXPECT_EQ(a->start(), y);
          if (b->shaft_is_free()) y[kTurn] = turn;
          y[kLagRate] = lag_rate;
          a->rates(0, y, loads, by_a);
          b->rates(0, y, loads, by_b);
          SCOPED_TRACE(std::string(name) + " " + std::to_string(shaft_speed));
          for (const std::size_t i : {kTurnRate, kLagRate, kTwistRate})
            EXPECT_NEAR(by_a[i], by_b[i], scaled(1e-10) * 1e6) << i;
          EXPECT_NEAR(by_a[kWorkOfLoads], by_b[kWorkOfLoads], scaled(1e-10) * 1e5);
          EXPECT_NEAR(by_a[kWorkOfDrive], by_b[kWorkOfDrive], scaled(1e-10) * 1e5);
          std::vector<double> state_a, state_b, row_a, row_b;
          MotionChecks checks_a{}, checks_b{};
          a->row(0, y, loads, state_a, row_a, checks_a);
          b->row(0, y, loads, state_b, row_b, checks_b);
          EXPECT_EQ(state_a, state_b);
          const ChannelLayout& at = a->layout();
          for (std::size_t c = 0; c < at.size(); ++c) {
            // At rest the closed form takes the balance with a virtual turn.
            if (c == at.power_residual() && shaft_speed == 0) continue;
            EXPECT_EQ(is_computed(row_a[c]), is_computed(row_b[c])) << at.channels()[c].name;
            if (c >= at.reactions()) continue;
            EXPECT_NEAR(row_a[c], row_b[c], scaled(1e-10) * 5e4) << at.channels()[c].name;
          }
          ++compared;
        }
  EXPECT_EQ(compared, 45);
}

// The same cases as a simulation by Simbody refuses, in the same words.
TEST(MultibodyMechanics, RefusesWhatSimulateRefuses) {
  const auto message = [](const std::function<void()>& job) -> std::string {
    try {
      job();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<std::function<void(Case&)>> faults = {
      [](Case& c) { c.drive.reset(); },
      [](Case& c) { c.multibody.gear = BlockDrive::imposed; },
      [](Case& c) { c.pump.shaft.axial_inertia = 0; },
      [](Case& c) { c.pump.block.axial_inertia = 0; },
      [](Case& c) { c.pump.piston.contact = 0.04; },
      [](Case& c) { c.pump.piston.joint_mass_fraction = 1; },
      [](Case& c) { c.pump.friction.regularization = 0; },
      [](Case& c) { c.pump.geometry.pistons = 0; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    Case the_case = stored_case("constant_torque");
    const PressureTrace trace(the_case.pressure);
    faults[i](the_case);
    const std::string here = message([&] { multibody::mechanics(the_case, the_case.multibody); });
    EXPECT_FALSE(here.empty()) << i;
    EXPECT_EQ(here, message([&] { multibody::simulate(the_case, the_case.multibody, trace); }));
  }
  // Friction that jumps as the block goes its own way: simulate() lands on every jump.
  Case jumping = stored_case("rattle");
  jumping.pump.friction.regularization = 0;
  EXPECT_THAT(message([&] { multibody::mechanics(jumping, jumping.multibody); }),
              testing::HasSubstr("regularization_m_per_s = 0"));
  Case smooth = jumping;
  smooth.pump.friction.piston_coulomb = 0;
  EXPECT_NO_THROW(multibody::mechanics(smooth, smooth.multibody));
  jumping.pump.gear.contact = ToothContact::rigid;
  EXPECT_NO_THROW(multibody::mechanics(jumping, jumping.multibody));

  const Case fine = stored_case("constant_torque");
  const auto mechanics = multibody::mechanics(fine, fine.multibody);
  MotionVector dy;
  EXPECT_THAT(message([&] {
                mechanics->rates(0, {}, {{1e5}, {}}, dy);
              }),
              testing::HasSubstr("1 chamber pressures for 5 pistons"));
}

TEST(MechanicsOfBothModels, SayNothingOfTeethThatAreNotModelled) {
  const Case the_case = stored_case("rattle");
  TeethAction action;
  const auto closed = analytic::mechanics(the_case, the_case.analytic);
  EXPECT_FALSE(closed->teeth(0, closed->start(), action));
  const auto multi = multibody::mechanics(the_case, the_case.multibody);
  EXPECT_FALSE(multi->teeth(0, multi->start(), action));
}

TEST(MultibodyMechanics, SaysWherePistonsCannotBePlaced) {
  Case the_case = stored_case("rattle");
  the_case.pump.geometry.piston_length = 0.03;
  const auto mechanics = multibody::mechanics(the_case, the_case.multibody);
  OilLoads loads{std::vector<double>(5, 1e5), {}};
  MotionVector y = {}, dy;
  y[kLag] = 2.5;
  try {
    mechanics->rates(0, y, loads, dy);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("multibody model: no assembly found"));
  }
  // And goes on elsewhere.
  const auto fresh = multibody::mechanics(the_case, the_case.multibody);
  MotionVector expected;
  mechanics->rates(0.01, {}, loads, dy);
  fresh->rates(0.01, {}, loads, expected);
  EXPECT_EQ(dy, expected);
}

}  // namespace
}  // namespace bentaxis::test
