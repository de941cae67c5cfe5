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
          "what drives the shaft in `bentaxis simulate`, and for how long; other commands do not "
          "use it",
      .part = &kDrive,
      .parameters =
          {choice(
               "kind", FIELD(c.drive->kind), {"speed", "torque", "motor"}, "speed",
               "speed: the speed of the shaft is given; torque: a torque acts on it; motor: a "
               "rotor drives it through a coupling, Td = K_c (phi - theta) + D_c (phi' - theta')"),
           text("file",
                curve_at(PLACE(c.drive->curve.file), {.drive = [](Case& c) { return &*c.drive; }}),
                "CSV `time_s,speed_rpm` or `time_s,torque_Nm`, path relative to the case file: the "
                "speed or the torque over time instead. At least 4 points, the first at a time "
                "<= 0. Of a motor `speed_rpm,torque_Nm`: its torque over its speed. Other names, "
                "units (`time [ms]`, `torque [kNm]`) and formats as in docs/import.md. Empty: "
                "none"),
           number(
               "torque_Nm", "T0", FIELD(c.drive->torque), {"Nm"}, kAny,
               {.computed = [](const Case& c) -> std::optional<Value> {
                  if (c.drive->curve.time.empty()) return std::nullopt;
                  return 0.0;
                },
                .words = "required where there is no `file`"},
               "of the drive, or of a motor at the speed of `[operation]`; not used with a `file`",
               {.active = kGivenTorque}),
           number("torque_slope_Nm_s_per_rad", "s_T", FIELD(c.drive->motor->torque_slope),
                  {"Nm s/rad"}, kAny, {0.0},
                  "the motor's torque is T0 - s_T (phi' - omega), not used with a `file`",
                  {.part = &kMotorData}),
           number("rotor_inertia_kg_m2", "J_m", FIELD(c.drive->motor->rotor_inertia), {"kg m2"},
                  kPositive, kRequired, "of the rotor, at the angle phi", {.part = &kMotorData}),
           number("coupling_stiffness_Nm_per_rad", "K_c", FIELD(c.drive->motor->coupling_stiffness),
                  {"Nm/rad"}, kPositive, kRequired, "of the coupling", {.part = &kMotorData}),
           number("coupling_damping_Nm_s_per_rad", "D_c", FIELD(c.drive->motor->coupling_damping),
                  {"Nm s/rad"}, kNotNegative, {0.0}, "of the coupling", {.part = &kMotorData}),
           number("start_rpm", "", FIELD(c.drive->start_speed), kRotation, kAny,
                  {.words = "`speed_rpm`"},
                  "speed of every body at the start, not with a given speed; from 0 the coupling "
                  "is unwound",
                  {.part = &kStartSpeed}),
           number("duration_s", "", FIELD(c.drive->duration), {"s"}, kPositive, kRequired,
                  "simulated time", {.in_fmu = InFmu::absent}),
           number("samples", "", FIELD(c.drive->samples), kNoUnit, kCount, kRequired,
                  "rows at 0, duration/samples, .., duration")},
      .rules = {after("file", curve_refusal)}};
}

}  // namespace bentaxis::tables
