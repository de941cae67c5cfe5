// Problems of the problem set with Simbody: simbody_problems NAME FOLDER OUT.csv, or --version
//
// FOLDER is problems/NAME. Positions are found by Simbody's projection, reactions are those of
// mobilizers and constraints. No formula of a problem is here but its geometry and its loads.
// Simbody's forces of constraints have the opposite sign of applied forces; those of mobilizers are
// on the outer body at its frame M, in the ground's axes, with mobility forces (a drive) included.
#include <SimTKsimbody.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "problem_program.h"

namespace {

using namespace SimTK;
using problems::Data;
using problems::Rows;

// A mobility that turns with constant speed from 0: its angle is speed x time.
class Turning : public Motion::Custom::Implementation {
 public:
  explicit Turning(double speed) : speed_(speed) {}
  Motion::Custom::Implementation* clone() const override { return new Turning(*this); }
  Motion::Level getLevel(const State&) const override { return Motion::Position; }
  void calcPrescribedPosition(const State& s, int, Real* q) const override {
    q[0] = speed_ * s.getTime();
  }
  void calcPrescribedPositionDot(const State&, int, Real* q) const override { q[0] = speed_; }
  void calcPrescribedPositionDotDot(const State&, int, Real* q) const override { q[0] = 0; }

 private:
  double speed_;
};

struct Mechanism {
  MultibodySystem system;
  SimbodyMatterSubsystem matter{system};
  GeneralForceSubsystem forces{system};

  void move(State& state, double time) {
    state.setTime(time);
    system.realize(state, Stage::Time);
    system.prescribeQ(state);
    system.realize(state, Stage::Position);
    ProjectOptions options;
    options.setRequiredAccuracy(1e-13);
    options.setOption(ProjectOptions::ForceProjection);
    ProjectResults results;
    Vector none;
    system.projectQ(state, none, options, results);
    system.prescribeU(state);
    system.realize(state, Stage::Velocity);
    system.projectU(state, none, options, results);
    system.realize(state, Stage::Velocity);
  }
  void accelerate(State& state) { system.realize(state, Stage::Acceleration); }

  SpatialVec joint(const State& state, const MobilizedBody& body) {
    return body.findMobilizerReactionOnBodyAtMInGround(state);
  }
  SpatialVec applied(const State& state, const Constraint& constraint, const MobilizedBody& body) {
    const Vector_<SpatialVec> all = constraint.getConstrainedBodyForcesAsVector(state);
    for (ConstrainedBodyIndex i(0); i < constraint.getNumConstrainedBodies(); ++i)
      if (constraint.getMobilizedBodyFromConstrainedBody(i).isSameMobilizedBody(body)) {
        const Rotation& R = constraint.getAncestorMobilizedBody().getBodyRotation(state);
        return {-(R * all[i][0]), -(R * all[i][1])};
      }
    throw std::logic_error("the constraint does not act on the body");
  }
};

// About the z axis of both frames, whose x axis is that of `direction` made perpendicular to it.
Rotation axis_frame(const Vec3& axis, const Vec3& direction) {
  return Rotation(UnitVec3(axis), ZAxis, direction, XAxis);
}

MassProperties about_origin(double mass, const Vec3& centre, const Inertia& central) {
  return {mass, centre, central.shiftFromMassCenter(centre, mass)};
}

Rows pendulum(const Data& d, const std::vector<double>& grid) {
  Mechanism m;
  Force::UniformGravity gravity(m.forces, m.matter, Vec3(0, -d("gravity"), 0));
  const Body::Rigid body(about_origin(
      d("mass"), Vec3(d("centre_x"), 0, d("centre_z")),
      Inertia(d("inertia_x"), d("inertia_y"), d("axial_inertia"), 0, d("product_xz"), 0)));
  // theta = 0 is x1 along -y0.
  MobilizedBody::Pin pin(m.matter.Ground(), Transform(axis_frame(Vec3(0, 0, 1), Vec3(0, -1, 0))),
                         body, Transform());
  State state = m.system.realizeTopology();
  const auto energy = [&](double angle, double speed) {
    pin.setAngle(state, angle);
    pin.setRate(state, speed);
    m.system.realize(state, Stage::Velocity);
    return m.system.calcEnergy(state);
  };
  const double total = energy(0, d("speed_at_bottom"));
  Rows rows;
  for (const double theta : grid) {
    const double rest = energy(theta, 0), unit = energy(theta, 1);
    const double speed = std::sqrt((total - rest) / (unit - rest));
    energy(theta, speed);
    m.accelerate(state);
    const SpatialVec reaction = m.joint(state, pin);
    rows.push_back({speed, reaction[1][0], reaction[1][1], reaction[0][0], reaction[0][1]});
  }
  return rows;
}

Rows spherical(const Data& d, const std::vector<double>& grid, bool joint) {
  Mechanism m;
  const double A = joint ? Pi / 2 : d("input_arc"), B = joint ? Pi / 2 : d("coupler_arc"),
               C = joint ? Pi / 2 : d("output_arc");
  const double tilt = d("tilt");
  const Vec3 x2(1, 0, 0), z2(0, std::sin(tilt), std::cos(tilt)), z(0, 0, 1), y(0, 1, 0);
  const Vec3 a(0, std::sin(A), std::cos(A)), b_out(0, std::sin(C), std::cos(C));
  MobilizedBody::Pin shaft(m.matter.Ground(), Transform(),
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(1))), Transform());
  Motion::Custom drive(shaft, new Turning(d("speed")));
  // The coupler's own axes: x along a, z along a x b.
  const Vec3 b_coupler(std::cos(B), std::sin(B), 0), across = z % b_coupler;
  const Body::Rigid link(MassProperties(
      1, Vec3(0),
      Inertia(d("coupler_inertia", 0), d("coupler_inertia", 1), d("coupler_inertia", 2))));
  MobilizedBody::Pin coupler(shaft, Transform(axis_frame(a, Vec3(1, 0, 0))), link,
                             Transform(axis_frame(Vec3(1, 0, 0), Vec3(0, 0, 1))));
  MobilizedBody::Pin output(
      m.matter.Ground(), Transform(axis_frame(z2, x2)),
      Body::Rigid(MassProperties(1, Vec3(0), Inertia(1, 1, d("output_inertia")))), Transform());
  Constraint::ConstantAngle one(output, UnitVec3(b_out), coupler, UnitVec3(across), Pi / 2);
  Constraint::ConstantAngle two(output, UnitVec3(b_out), coupler, UnitVec3(z), Pi / 2);
  Force::MobilityConstantForce load(m.forces, output, MobilizerUIndex(0), -d("load_torque"));
  Force::MobilityLinearDamper damper(m.forces, output, MobilizerUIndex(0), d("load_damping"));
  State state = m.system.realizeTopology();
  Rows rows;
  for (const double theta : grid) {
    const double psi = joint ? theta + Pi / 2 : d("assembly_psi");
    output.setAngle(state, psi);
    // Roughly: the coupler's normal across a and where b is about to be.
    const Rotation turn(theta, ZAxis);
    const Rotation out = axis_frame(z2, x2) * Rotation(psi, ZAxis);
    const Vec3 normal = ~turn * ((turn * a) % (out * b_out));
    const Rotation own = axis_frame(a, Vec3(1, 0, 0));
    const Vec3 in_F = ~own * normal;
    coupler.setAngle(state, std::atan2(in_F[1], in_F[0]));
    m.move(state, theta / d("speed"));
    m.accelerate(state);
    const Vec3 Ma = m.joint(state, coupler)[0];
    const Vec3 Mb = m.applied(state, one, coupler)[0] + m.applied(state, two, coupler)[0];
    std::vector<double> row;
    if (!joint) {
      const double angle = output.getAngle(state) - d("assembly_psi");
      row.push_back((angle - 2 * Pi * std::round(angle / (2 * Pi)) + d("assembly_psi")) * 180 / Pi);
    }
    row.push_back(output.getRate(state));
    for (const Vec3& couple : {Ma, Mb})
      for (int i = 0; i < 3; ++i) row.push_back(couple[i]);
    row.push_back(m.joint(state, shaft)[0][2]);
    rows.push_back(row);
  }
  return rows;
}

Rows piston(const Data& d, const std::vector<double>& grid) {
  Mechanism m;
  Force::UniformGravity gravity(m.forces, m.matter, Vec3(0, -d("gravity"), 0));
  Force::DiscreteForces loads(m.forces, m.matter);
  const double tilt = d("tilt"), b1 = d("piston_length");
  const Vec3 z2(0, std::sin(tilt), std::cos(tilt)), O2(0, 0, d("axis_offset"));
  const Rotation S2 = axis_frame(z2, Vec3(1, 0, 0));
  const Body::Rigid any(MassProperties(1, Vec3(0), Inertia(1)));
  MobilizedBody::Pin shaft(m.matter.Ground(), Transform(), any, Transform());
  MobilizedBody::Pin block(m.matter.Ground(), Transform(S2, O2), any, Transform());
  Motion::Custom drive(shaft, new Turning(d("speed"))), same(block, new Turning(d("speed")));
  // The piston's origin is A, its z axis points to B.
  const Body::Rigid rod(
      about_origin(d("mass"), Vec3(0, 0, d("centre_of_mass")),
                   Inertia(d("transverse_inertia"), d("transverse_inertia"), d("axial_inertia"))));
  MobilizedBody::Ball body(shaft, Transform(Vec3(0, d("joint_circle_radius"), 0)), rod,
                           Transform());
  Constraint::PointOnLine ring(block, UnitVec3(0, 0, 1), Vec3(0, d("bore_circle_radius"), 0), body,
                               Vec3(0, 0, b1));
  State state = m.system.realizeTopology();
  Rows rows;
  for (const double theta : grid) {
    const Rotation turn(theta, ZAxis);
    body.setQToFitRotation(state, ~turn * S2);
    m.move(state, theta / d("speed"));
    // Of all motions that the constraints allow, the one with this spin.
    const Vec3 e = body.getBodyRotation(state) * Vec3(0, 0, 1);
    const Vec3 spin = (d("spin") - dot(body.getBodyAngularVelocity(state), e)) * e;
    const Vec3 u = body.getOneU(state, 0) * Vec3(1, 0, 0) + body.getOneU(state, 1) * Vec3(0, 1, 0) +
                   body.getOneU(state, 2) * Vec3(0, 0, 1);
    const Vec3 changed = u + ~shaft.getBodyRotation(state) * spin;
    for (int i = 0; i < 3; ++i) body.setOneU(state, i, changed[i]);
    m.system.realize(state, Stage::Velocity);
    const Vec3 at_B(0, 0, b1);
    const double v = dot(body.findStationVelocityInGround(state, at_B), z2);
    const double area = Pi / 4 * square(d("bore_diameter"));
    const double pressure = d("pressure_mean") - d("pressure_amplitude") * std::sin(theta);
    const Vec3 force = -(area * pressure + d("viscous_friction") * v) * z2;
    const Vec3 arm = body.getBodyRotation(state) * at_B;
    loads.setOneBodyForce(state, body, SpatialVec(arm % force, force));
    m.accelerate(state);
    const Vec3 Rs = ~S2 * m.joint(state, body)[1];
    const Vec3 Rc = ~S2 * m.applied(state, ring, body)[1];
    rows.push_back({Rs[0], Rs[1], Rs[2], Rc[0], Rc[1]});
  }
  return rows;
}

Rows one_sided_wall(const Data& d, const std::vector<double>& grid) {
  Mechanism m;
  Force::UniformGravity gravity(m.forces, m.matter, Vec3(0, -d("gravity"), 0));
  Force::DiscreteForces loads(m.forces, m.matter);
  // The crank is balanced: without weight.
  MobilizedBody::Pin crank(m.matter.Ground(), Transform(),
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(1))), Transform());
  Motion::Custom drive(crank, new Turning(d("speed")));
  const Vec3 centre(d("rod_centre"), 0, 0), own(d("crosshead_centre_x"), 0, 0);
  const Body::Rigid rod(about_origin(d("rod_mass"), centre, Inertia(1, 1, d("rod_inertia"))));
  const Body::Rigid head(about_origin(d("crosshead_mass"), own, Inertia(1, 1, 1)));
  MobilizedBody::Pin link(crank, Transform(Vec3(d("crank_radius"), 0, 0)), rod, Transform());
  MobilizedBody::Pin crosshead(link, Transform(Vec3(d("rod_length"), 0, 0)), head, Transform());
  Constraint::PointInPlane front(m.matter.Ground(), UnitVec3(0, 1, 0), 0, crosshead,
                                 Vec3(d("front_pads_x"), 0, 0));
  Constraint::PointInPlane rear(m.matter.Ground(), UnitVec3(0, 1, 0), 0, crosshead,
                                Vec3(d("rear_pads_x"), 0, 0));
  State state = m.system.realizeTopology();
  Rows rows;
  for (const double theta : grid) {
    const double slope = -std::asin(d("crank_radius") * std::sin(theta) / d("rod_length"));
    link.setAngle(state, slope - theta);
    crosshead.setAngle(state, -slope);
    m.move(state, theta / d("speed"));
    const Vec3 gas(-(d("gas_force") + d("gas_amplitude") * std::sin(theta)), 0, 0);
    loads.setOneBodyForce(state, crosshead, SpatialVec(Vec3(0, d("gas_offset"), 0) % gas, gas));
    m.accelerate(state);
    std::vector<double> row;
    for (const Constraint* station :
         {static_cast<const Constraint*>(&front), static_cast<const Constraint*>(&rear)}) {
      const double push = m.applied(state, *station, crosshead)[1][1];
      row.push_back(std::max(push, 0.0));
      row.push_back(std::max(-push, 0.0));
    }
    row.push_back(m.joint(state, crank)[0][2]);
    rows.push_back(row);
  }
  return rows;
}

const std::map<std::string, problems::Solver> kSolvers = {
    {"pendulum", pendulum},
    {"spherical_four_bar",
     [](const Data& data, const std::vector<double>& grid) {
       return spherical(data, grid, false);
     }},
    {"universal_joint",
     [](const Data& data, const std::vector<double>& grid) { return spherical(data, grid, true); }},
    {"piston", piston},
    {"one_sided_wall", one_sided_wall}};

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--version") {
    int major = 0, minor = 0, build = 0;
    SimTK_version_simbody(&major, &minor, &build);
    std::printf("Simbody %d.%d.%d\n", major, minor, build);
    return 0;
  }
  if (argc != 4) {
    std::fputs("usage: simbody_problems NAME FOLDER OUT.csv\n", stderr);
    return 2;
  }
  try {
    return problems::solve(kSolvers, argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simbody_problems: %s\n", error.what());
    return 3;
  }
}
