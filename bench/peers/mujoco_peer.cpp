// The pump in MuJoCo (Todorov, Erez, Tassa 2012): see README.md for model and settings.
#include <fmt/format.h>
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "pump_case.h"

namespace bentaxis::peers {
namespace {

PumpCase* pump = nullptr;

// From B to A, unit length, in the frame that turns with the block; with derivatives with respect
// to theta.
struct Direction {
  Vector value, first, second;
};
Direction direction(double theta, int k) {
  const auto state = pump->piston(theta, k);
  const double length = pump->the_case.pump.geometry.piston_length;
  const Eigen::Matrix3d back = Eigen::AngleAxisd(-theta, Vector::UnitZ()).toRotationMatrix();
  const Vector z = Vector::UnitZ();
  const Vector d = -state.axis.value / length;
  const Vector d1 = -state.axis.first / length;
  const Vector d2 = -state.axis.second / length;
  return {back * d, back * (d1 - z.cross(d)), back * (d2 - 2 * z.cross(d1) + z.cross(z.cross(d)))};
}

// Two hinges turn (0, 0, -1) to (-sin b, sin a cos b, -cos a cos b).
struct Hinges {
  double a, b, a1, b1, a2, b2;
};
Hinges hinges(const Direction& d) {
  Hinges h{};
  const double w = -d.value.z(), w1 = -d.first.z(), w2 = -d.second.z();
  const double y = d.value.y(), y1 = d.first.y(), y2 = d.second.y();
  const double c2 = y * y + w * w;
  h.a = std::atan2(y, w);
  h.b = std::asin(-d.value.x());
  const double cosine = std::cos(h.b);
  h.a1 = (y1 * w - y * w1) / c2;
  h.b1 = -d.first.x() / cosine;
  h.a2 = (y2 * w - y * w2) / c2 - 2 * h.a1 * (y * y1 + w * w1) / c2;
  h.b2 = (-d.second.x() + h.b1 * h.b1 * std::sin(h.b)) / cosine;
  return h;
}

// How piston k stands in the block at theta = 0, where all joints are at 0.
Eigen::Matrix3d at_start(int k) {
  const Hinges h = hinges(direction(0, k));
  return (Eigen::AngleAxisd(h.a, Vector::UnitX()) * Eigen::AngleAxisd(h.b, Vector::UnitY()))
      .toRotationMatrix();
}
Hinges hinges_from_start(double theta, int k) {
  const Eigen::Matrix3d back = at_start(k).transpose();
  const Direction d = direction(theta, k);
  return hinges({back * d.value, back * d.first, back * d.second});
}

mjModel* load(int steps, double time_constant_steps) {
  const PumpParameters& p = pump->the_case.pump;
  const Geometry& g = p.geometry;
  const double dt = 2 * kPi / pump->omega / steps;
  const double chi = p.piston.joint_mass_fraction;
  const double transverse = chi * (1 - chi) * p.piston.mass * g.piston_length * g.piston_length;
  std::string bodies, connects;
  for (int k = 0; k < g.pistons; ++k) {
    const auto state = pump->piston(0, k);
    const Vector ring = state.ring();
    const Hinges h = hinges(direction(0, k));
    bodies += fmt::format(
        R"(<body name="p{0}" pos="{1:.17g} {2:.17g} {3:.17g}" euler="{4:.17g} {5:.17g} 0">
             <inertial pos="0 0 {6:.17g}" mass="{7:.17g}" diaginertia="{8:.17g} {8:.17g} 1e-12"/>
             <joint type="slide" axis="{9:.17g} {10:.17g} {11:.17g}"/>
             <joint type="hinge" axis="1 0 0"/><joint type="hinge" axis="0 1 0"/></body>)",
        k, ring.x(), ring.y(), ring.z(), h.a, h.b, -chi * g.piston_length, p.piston.mass,
        transverse, at_start(k)(2, 0), at_start(k)(2, 1), at_start(k)(2, 2));
    connects += fmt::format(R"(<connect body1="p{}" body2="shaft" anchor="0 0 {:.17g}"/>)", k,
                            -g.piston_length);
  }
  const std::string xml = fmt::format(
      R"(<mujoco><compiler angle="radian" boundmass="0" boundinertia="0" inertiafromgeom="false"/>
        <option timestep="{0:.17g}" integrator="RK4" solver="Newton" tolerance="1e-14" iterations="2"
          gravity="0 {1:.17g} 0"><flag contact="disable" refsafe="disable"/></option>
        <default><equality solref="{2:.17g} 1" solimp="0.9999 0.9999 0.001 0.5 2"/></default>
        <worldbody>
          <body name="shaft"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
            <joint type="hinge" axis="0 0 1" armature="1e9"/></body>
          <body name="block" pos="0 0 {3:.17g}" euler="{4:.17g} 0 0">
            <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
            <joint type="hinge" axis="0 0 1" armature="1e9"/>{5}</body>
        </worldbody><equality>{6}</equality></mujoco>)",
      dt, -p.gravity, time_constant_steps * dt, g.axis_offset, -g.tilt, bodies, connects);
  char name[] = "/tmp/bentaxis_mujoco_XXXXXX";
  const int file = mkstemp(name);
  if (file < 0) throw std::runtime_error("cannot write a temporary file");
  close(file);
  std::ofstream(name) << xml;
  char why[1000] = "";
  mjModel* model = mj_loadXML(name, nullptr, why, sizeof why);
  std::remove(name);
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo: ") + why);
  return model;
}

constexpr int kBlock = 1, kFirst = 2;  // joints: shaft, block, three per piston

void set_motion(mjData* d, double theta, bool with_accelerations) {
  const double w = pump->omega;
  d->qpos[0] = d->qpos[kBlock] = theta;
  d->qvel[0] = d->qvel[kBlock] = w;
  for (int k = 0; k < pump->pistons(); ++k) {
    const auto state = pump->piston(theta, k);
    const Hinges h = hinges_from_start(theta, k);
    const int j = kFirst + 3 * k;
    d->qpos[j] = state.ring().z() - pump->piston(0, k).ring().z();
    d->qvel[j] = (state.joint.first.z() + state.axis.first.z()) * w;
    d->qpos[j + 1] = h.a;
    d->qpos[j + 2] = h.b;
    d->qvel[j + 1] = h.a1 * w;
    d->qvel[j + 2] = h.b1 * w;
    if (!with_accelerations) continue;
    d->qacc[0] = d->qacc[kBlock] = 0;
    d->qacc[j] = (state.joint.second.z() + state.axis.second.z()) * w * w;
    d->qacc[j + 1] = h.a2 * w * w;
    d->qacc[j + 2] = h.b2 * w * w;
  }
}

// Pressure and friction at every evaluation, also within a step.
void loads(const mjModel*, mjData* d) {
  for (int k = 0; k < pump->pistons(); ++k) {
    const int j = kFirst + 3 * k;
    d->qfrc_passive[j] += pump->axial(d->qpos[0], k, d->qvel[j]);
  }
}

// Components in S2 of a vector in S1.
Vector to_s2(const double* v) { return pump->kinematics.to_s2({v[0], v[1], v[2]}); }

// A turn with fixed steps; results at the samples.
double integrate(int steps, double time_constant_steps) {
  mjModel* model = load(steps, time_constant_steps);
  mjData* data = mj_makeData(model);
  // At first the soft joints carry no load: a fifth of a turn, not timed, lets them settle.
  const int settling = steps / 5;
  set_motion(data, -2 * kPi * settling / steps, false);
  for (int step = 0; step < settling; ++step) mj_step(model, data);
  const int every = steps / PumpCase::kSamples;
  std::vector<Vector> found;
  const Stopwatch stopwatch;
  for (int step = 0; step < steps; ++step) {
    if (step % every == 0) {
      mj_forward(model, data);  // the forces belong to the present state, not to the last stage
      for (int k = 0; k < pump->pistons(); ++k) found.push_back(to_s2(data->efc_force + 3 * k));
    }
    mj_step(model, data);
  }
  const double seconds = stopwatch.seconds();
  pump->forget();
  for (std::size_t i = 0; i < found.size(); ++i)
    pump->judge(static_cast<int>(i) / pump->pistons(), static_cast<int>(i) % pump->pistons(),
                found[i]);
  mj_deleteData(data);
  mj_deleteModel(model);
  return seconds;
}

// Inverse dynamics of the tree without the joints at A: what the joints of a piston lack is Rs.
double inverse() {
  mjModel* model = load(3600, 2);
  model->opt.disableflags |= mjDSBL_EQUALITY;
  mjData* data = mj_makeData(model);
  std::vector<Vector> found(static_cast<std::size_t>(PumpCase::kSamples) * pump->pistons());
  const Stopwatch stopwatch;
  for (int sample = 0; sample < PumpCase::kSamples; ++sample) {
    set_motion(data, 2 * kPi * sample / PumpCase::kSamples, true);
    mj_inverse(model, data);
    for (int k = 0; k < pump->pistons(); ++k) {
      const int j = kFirst + 3 * k;
      const double* slide = data->xaxis + 3 * j;
      Eigen::Matrix3d m;
      Vector right;
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(data->xmat +
                                                                                    9 * (3 + k));
      const Vector arm = rotation * Vector(0, 0, -pump->the_case.pump.geometry.piston_length);
      for (int i = 0; i < 3; ++i) right[i] = data->qfrc_inverse[j + i];
      m.row(0) = Eigen::Map<const Vector>(slide).transpose();
      for (int i = 1; i < 3; ++i) {
        const Eigen::Map<const Vector> axis(data->xaxis + 3 * (j + i));
        m.row(i) = axis.cross(arm).transpose();  // axis . (arm x f)
      }
      const Vector f = m.partialPivLu().solve(right);
      found[static_cast<std::size_t>(sample) * pump->pistons() + k] = to_s2(f.data());
    }
  }
  const double seconds = stopwatch.seconds();
  pump->forget();
  for (std::size_t i = 0; i < found.size(); ++i)
    pump->judge(static_cast<int>(i) / pump->pistons(), static_cast<int>(i) % pump->pistons(),
                found[i]);
  mj_deleteData(data);
  mj_deleteModel(model);
  return seconds;
}

}  // namespace
}  // namespace bentaxis::peers

int main() {
  using namespace bentaxis::peers;
  PumpCase the_pump;
  pump = &the_pump;
  mjcb_passive = loads;
  Rows rows;
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) best = std::min(best, inverse());
  rows.add("MuJoCo", "inverse dynamics", "mj_inverse on the tree", best, the_pump.error(),
           PumpCase::kSamples);
  for (const int steps : kStepsPerTurn) {
    const Tuned best_run = tuned(the_pump, {1.0, 2.0, 3.0}, [&](double time_constant) {
      return integrate(steps, time_constant);
    });
    rows.add("MuJoCo", "integrated",
             fmt::format("RK4, {} steps, time constant {} steps", steps, best_run.setting),
             best_run.seconds, best_run.error, PumpCase::kSamples);
  }
  rows.print();
  return 0;
}
