#include "bentaxis/study/case_sections.h"

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/plausibility.h"
#include "document_parts.h"

namespace bentaxis::study {

report::CaseSection case_section(const Case& the_case) {
  return {the_case.file.filename().string(), the_case.entries};
}

namespace {

// What carries the block round, as far as both models take it from one source.
std::vector<report::CommonInput> transfer_inputs(const Case& the_case, bool motion) {
  std::vector<report::CommonInput> inputs;
  switch (the_case.pump.transfer.kind) {
    case TransferKind::gear:
      inputs.push_back(
          {"line of action of the teeth (22)",
           the_case.pump.gear.contact == ToothContact::teeth
               ? "of each pair at its contact point; the arm (d/2) cos alpha_p, over which Rcs is "
                 "stated"
           : the_case.pump.gear.flanks == Flanks::two
               ? "one for each flank, whose separating part pushes the gears apart; written once "
                 "in each model"
               : "as printed, turned by the sense of rotation; written once in each model",
           the_case.pump.gear.flanks == Flanks::two
               ? "high-precision instants and the frame of O4; what one line of action would "
                 "change is among the limits of validity"
               : "high-precision curves and the frame of O4 check the algebra; that real teeth "
                 "have another line of action in reverse rotation and on the other flank is among "
                 "the limits of validity"});
      break;
    case TransferKind::constant_velocity:
      inputs.push_back(
          {"constant-velocity joint",
           "ideal: no friction, no play. The analytic model has its couple in closed form. The "
           "multibody model has one equation of the rotations of shaft and block, and Simbody "
           "finds the couple",
           "high-precision curves; the couple does no work; free bodies of shaft and block"});
      break;
    case TransferKind::cardan:
      inputs.push_back(
          {"universal joint",
           "ideal: no friction, no play, no mass of the cross; both take the arms' phase from the "
           "case. The analytic model has angle and couple in closed form. The multibody model "
           "keeps the arms at right angles, and Simbody finds motion and couple. Given states are "
           "compared with one law for both",
           "high-precision curves; a cross between two forks (universal mobilizer of Simbody); the "
           "couple does no work; free bodies of shaft and block"});
      break;
    case TransferKind::double_cardan:
      inputs.push_back(
          {"double universal joint",
           "ideal: no friction, no play, no mass of crosses and of the shaft between them, which "
           "slides freely; both take distance of the crosses and phase from the case. The analytic "
           "model has couple and force in closed form. The multibody model keeps the arms of both "
           "forks in one plane with the crosses' centres, and Simbody finds motion, couple and "
           "force",
           "balance of the shaft between the crosses; two crosses with a slider between them "
           "(universal mobilizers of Simbody); couple and force do no work; free bodies of shaft "
           "and block"});
      break;
    case TransferKind::pistons:
      inputs.push_back(
          {"law of the contact of piston and bore",
           "N = k x0 (x/x0)^e (1 + c x') at the point D of the piston's axis, without friction; "
           "written once in each model, which finds approach and rate on its own (closed form; "
           "spheres in cylinders)",
           "high-precision curves; hand-overs from the geometry alone; free bodies; rigid walls "
           "are its limit in proportion to 1/k"});
      if (!motion)
        inputs.push_back(
            {"which lag counts at constant speed",
             "the rules of docs/transfer.md, and that the lag's rate and the block's inertia are "
             "neglected; each model finds free play and root from its own torques",
             "high-precision curves; moments made for each rule; simulate, which neglects "
             "neither"});
      break;
  }
  return inputs;
}

}  // namespace

std::vector<report::CommonInput> common_inputs(const Case& the_case, bool motion,
                                               bool oil_follows) {
  const std::string once = motion ? ", asked by each model at its own block angle"
                                  : ", evaluated once per sample and given to both models";
  std::string trace = "ideal trace" + once;
  if (the_case.pressure.kind == PressureKind::curve)
    trace = "periodic cubic spline through " + the_case.pressure.file.filename().string() + once;
  if (the_case.pressure.kind == PressureKind::hydraulic)
    trace = (the_case.pressure.points == 0
                 ? "hydraulic model, the computed curve"
                 : fmt::format("hydraulic model, periodic cubic spline through {} points",
                               the_case.pressure.points)) +
            once + (motion ? "; that of the constant speed of [operation]" : "");
  const report::CommonInput pressure =
      oil_follows
          ? report::CommonInput{"oil and its integration",
                                "one set of equations of the oil and one integrator, run with each "
                                "model's own motion",
                                "balances of energy and mass; work of pressures and of pistons, "
                                "one found by the model and one by the oil; the periodic state of "
                                "constant speed, found by another method; another tolerance"}
          : report::CommonInput{
                "chamber pressure", trace,
                "high-precision curves (computed with their own trace); mean torque "
                "of a frictionless pump = displacement x pressure / 2 pi"};
  std::vector<report::CommonInput> inputs = {
      pressure,
      {"geometry, masses, loads of the case file", "read and converted to SI once",
       "high-precision curves, which read the case file with another parser"},
      {"law of the port-plate film", "full pressure between r2 and r3, linear to 0 at r1 and r4",
       "high-precision curves; the integral itself is taken twice (closed form, quadrature)"},
      {"law of piston friction",
       the_case.pump.friction.regularization > 0 ? "Fc tanh(v/v_reg) + cv v" : "Fc sign(v) + cv v",
       "high-precision curves; power balance; written once in each model"},
      {"law of shaft friction (38)", "Td (1 - Ct) + Cs omega", "power balance of each model"},
      {"rigid bodies, points A and B on the piston's axis, joints without clearance", "assumed",
       "not in this program: a rig or an elastic model"},
      {"frames, signs and the names of the reactions", "docs/theory.md",
       "free-body diagrams written in the tests; signs printed in the paper"}};
  const auto of_transfer = transfer_inputs(the_case, motion);
  inputs.insert(inputs.begin() + 4, of_transfer.begin(), of_transfer.end());
  if (the_case.pump.gear.contact == ToothContact::teeth) {
    inputs.push_back(
        {"flexibility of a slice of teeth",
         "bending, shear, compression, foundation and flattening of the equivalent spur "
         "tooth: one function for both models",
         "mesh stiffness of a published spur pair and of ISO 6336 (docs/external_benchmarks.md); "
         "1/E in the tests"});
    inputs.push_back(
        {"shape of the teeth and definition of their approach (docs/teeth.md)",
         "spherical involutes in closed form; curves on the sphere and Newton's method "
         "in the multibody model",
         "each other; octoids, of which only the ratio of 1 is the same"});
  }
  if (!motion) {
    const TransferKind kind = the_case.pump.transfer.kind;
    inputs.push_back({the_case.pump.transfer.is_uneven_joint()
                          ? "constant speed of the shaft"
                          : "constant speed, equal for shaft and block (1:1)",
                      the_case.pump.gear.contact == ToothContact::teeth
                          ? "omega given; no torsion; constant lag of the teeth"
                      : kind == TransferKind::pistons ? "omega given; no torsion; frozen lag"
                      : kind == TransferKind::gear
                          ? "omega given; no torsion, no play in the gear"
                          : "omega given; no torsion, no play in the joint",
                      "not in this program: a rig. Torque-driven run: the free shaft under the "
                      "analytic torque keeps its speed"});
    return inputs;
  }
  const DriveSpec& drive = *the_case.drive;
  inputs.push_back({"what turns the shaft",
                    drive.kind == DriveKind::speed    ? "its speed is given"
                    : drive.kind == DriveKind::torque ? "its torque is given"
                                                      : "torque of rotor and coupling; written "
                                                        "once in each model",
                    "stored trajectories of a third integration; work balance of each model"});
  if (!drive.curve.time.empty())
    inputs.push_back(
        {drive.kind == DriveKind::motor ? "the motor's torque over its speed" : "curve over time",
         "one monotone cubic through " + drive.curve.file.filename().string() + " for both models",
         "its values, slopes and integral in the tests"});
  if (the_case.pump.transfer.kind == TransferKind::gear)
    inputs.push_back(
        the_case.pump.gear.contact == ToothContact::compliant
            ? report::
                  CommonInput{"contact law of the teeth",
                              "F = k x0 (x/x0)^e (1 + c x'), from one line of action per flank; "
                              "written once in each model",
                              "stored trajectories; rigid teeth are its limit in proportion to "
                              "1/k"}
        : the_case.pump.gear.contact == ToothContact::teeth
            ? report::CommonInput{"integration of the motion",
                                  "one integrator, run with each model's own accelerations",
                                  "another tolerance; work balance of each model"}
            : report::CommonInput{"rigid teeth", "psi = theta (1:1), no play",
                                  "not in this program: a rig; compliant teeth"});
  inputs.push_back({"instants of events between steps",
                    "one bisection, of the events that each model finds in its own steps",
                    "stored trajectories; roots of known functions in the tests"});
  return inputs;
}

std::vector<report::ValidityRow> validity_section(
    const std::vector<analytic::ValidityLimit>& limits) {
  return report::each_of(limits, [](const analytic::ValidityLimit& limit) {
    return report::ValidityRow{limit.limit,      limit.unit,           limit.consequence,
                               limit.applicable, limit.violated_share, limit.worst,
                               limit.theta_deg};
  });
}

std::vector<report::DerivedQuantity> derived_section(const Case& the_case) {
  const Geometry& g = the_case.pump.geometry;
  const Gear& gear = the_case.pump.gear;
  const analytic::DerivedQuantities derived = analytic::derived_quantities(the_case.pump);
  const TransferKind kind = the_case.pump.transfer.kind;
  const bool own_strokes = the_case.pump.transfer.is_uneven_joint();
  const char* const tilt = kind == TransferKind::pistons
                               ? "AB against z2, the block at the end of its free play"
                               : "AB against z2";
  std::vector<report::DerivedQuantity> rows = {
      {"displacement", "V", derived.displacement * 1e6, "cm3/rev",
       own_strokes ? "A times the sum of all strokes" : "N A stroke"},
      {"stroke", "", derived.stroke * 1e3, "mm",
       own_strokes ? "max zB - min zB over the turn, mean of the pistons"
                   : "max zB - min zB over the turn"},
      {"piston area", "A", derived.piston_area * 1e6, "mm2", "pi Dpi^2 / 4"},
      {"smallest piston tilt", "", derived.smallest_tilt / kRadPerDegree, "deg", tilt},
      {"largest piston tilt", "", derived.largest_tilt / kRadPerDegree, "deg", tilt},
      {"ideal flow", "", derived.displacement * std::abs(the_case.operation.speed_rpm) * 1e3,
       "l/min", "V n"},
      {"ideal torque", "", ideal_torque(derived.displacement, the_case.pressure.ports), "Nm",
       "V (delivery - suction) / 2 pi"}};
  if (kind == TransferKind::gear) {
    rows.push_back({"gear torque arm", "(d/2) cos ap",
                    gear.pitch_diameter / 2 * std::cos(gear.pressure_angle) * 1e3, "mm",
                    "(19), (22)"});
    rows.push_back(
        {"pitch cone", "delta", 90 - g.tilt / kRadPerDegree / 2, "deg", "90 deg - alpha/2"});
  }
  return rows;
}

}  // namespace bentaxis::study
