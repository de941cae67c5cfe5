// [drive]: what turns the shaft in a simulation.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const When kMotor{"drive", "kind", {"motor"}};
const When kGivenTorque{"drive", "kind", {"torque", "motor"}};

const Part kDrive = part_at([](auto& c) { return &c.drive; });
const Part kMotorData =
    part_at([](auto& c) { return c.drive ? &c.drive->motor : nullptr; }, kMotor);
// A single key without which something else is meant.
const Part kStartSpeed = part_at([](auto& c) { return c.drive ? &c.drive->start_speed : nullptr; });

std::string curve_refusal(const Case& c) {
  const DriveSpec& drive = *c.drive;
  if (drive.curve.time.empty()) return "";
  return drive.curve.time.size() >= 4 && drive.curve.time.size() == drive.curve.value.size()
             ? ""
             : "must have at least 4 points";
}

}  // namespace

Table drive_table() {
  return {
      .name = "drive",
      .meaning =
          "what turns the shaft in `bentaxis simulate`, and for how long; other commands "
          "leave it aside",
      .part = &kDrive,
      .parameters =
          {{.key = "kind",
            .field = FIELD(c.drive->kind),
            .words = {"speed", "torque", "motor"},
            .fallback = {std::string("speed")},
            .meaning = "the shaft's speed is given; a torque turns it; or a rotor turns it through "
                       "a coupling, Td = K (phi - theta) + D (phi' - theta')"},
           {.key = "file",
            .field =
                curve_at(PLACE(c.drive->curve.file), {.drive = [](Case& c) { return &*c.drive; }}),
            .fallback = {std::string()},
            .meaning =
                "CSV `time_s,speed_rpm` or `time_s,torque_Nm`, path relative to the case "
                "file, at least 4 points from a time <= 0 on: the speed or the torque over time "
                "instead; of a motor `speed_rpm,torque_Nm`, its torque over its speed; empty: "
                "none"},
           {.key = "torque_Nm",
            .field = FIELD(c.drive->torque),
            .symbol = "Td, T0",
            .unit = {"Nm"},
            .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                           if (c.drive->curve.time.empty()) return std::nullopt;
                           return 0.0;
                         },
                         .words = "required, but beside a `file`"},
            .meaning =
                "of the drive, or of a motor at the speed of `[operation]`; unused beside a `file`",
            .active = kGivenTorque},
           {.key = "torque_slope_Nm_s_per_rad",
            .field = FIELD(c.drive->motor->torque_slope),
            .symbol = "s",
            .unit = {"Nm s/rad"},
            .fallback = {0.0},
            .meaning = "the motor's torque is T0 - s (phi' - omega), beside a `file` it is unused",
            .part = &kMotorData},
           {.key = "rotor_inertia_kg_m2",
            .field = FIELD(c.drive->motor->rotor_inertia),
            .symbol = "J_m",
            .unit = {"kg m2"},
            .range = kPositive,
            .meaning = "of the rotor, at the angle phi",
            .part = &kMotorData},
           {.key = "coupling_stiffness_Nm_per_rad",
            .field = FIELD(c.drive->motor->coupling_stiffness),
            .symbol = "K",
            .unit = {"Nm/rad"},
            .range = kPositive,
            .meaning = "of the coupling",
            .part = &kMotorData},
           {.key = "coupling_damping_Nm_s_per_rad",
            .field = FIELD(c.drive->motor->coupling_damping),
            .symbol = "D",
            .unit = {"Nm s/rad"},
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of the coupling",
            .part = &kMotorData},
           {.key = "start_rpm",
            .field = FIELD(c.drive->start_speed),
            .unit = kRotation,
            .fallback = {.words = "`speed_rpm`"},
            .meaning = "speed of every body at the start, not beside a given speed; from 0 the "
                       "coupling is unwound",
            .part = &kStartSpeed},
           {.key = "duration_s",
            .field = FIELD(c.drive->duration),
            .unit = {"s"},
            .range = kPositive,
            .meaning = "simulated time",
            .in_fmu = InFmu::absent},
           {.key = "samples",
            .field = FIELD(c.drive->samples),
            .range = kCount,
            .meaning = "rows at 0, duration/samples, .., duration"}},
      .rules = {{.key = "file", .after = "file", .broken = curve_refusal}}};
}

}  // namespace bentaxis::tables
