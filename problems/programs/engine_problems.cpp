// Problems of the problem set with the engines of `bentaxis compare --engine`:
//   engine_problems ENGINE NAME FOLDER OUT.csv     or ENGINE --version
//
// FOLDER is problems/NAME. A problem is written down as data (bentaxis/engines/mechanism.h):
// bodies, joints, loads and what can be carried where. Newton's method closes the loops. The
// engine's module computes the inverse dynamics and finds the reactions. No formula of a problem is
// here but its geometry and its loads.
#include <algorithm>
#include <cmath>

#include "bentaxis/engines/mechanism.h"
#include "bentaxis/engines/run.h"
#include "problem_program.h"
#include "tree_motion.h"

namespace {

using namespace bentaxis::engines;
using problems::Data;
using problems::kPi;
using problems::Rows;

std::string engine;

// What has to hold of the bodies: of their places (level 0), of the first (1) and of the second
// derivative (2).
using Condition = std::function<Eigen::VectorXd(int level)>;

// A mechanism while it is written down.
class Writer {
 public:
  int add(const Body& body) {
    all_.bodies.push_back(body);
    first_.push_back(static_cast<int>(coordinates_.size()));
    coordinates_.resize(coordinates_.size() + body.freedoms.size());
    frames_.resize(all_.bodies.size());
    return static_cast<int>(all_.bodies.size()) - 1;
  }
  Coordinate& at(int body, int freedom = 0) { return coordinates_[first_[body] + freedom]; }
  const FrameMotion& frame(int body) const { return frames_[body]; }
  void gravity(double g) { all_.gravity = {0, -g, 0}; }
  void length(double typical) { all_.length = typical; }

  // A point of one body at a point of another, in all directions or in some.
  Condition together(int on, const Vector& point_on, int by, const Vector& point_by) {
    return [=, this](int level) -> Eigen::VectorXd {
      const auto moved = [&](int body, const Vector& point) -> Vector {
        if (body < 0) return level == 0 ? point : Vector(Vector::Zero());
        const FrameMotion& f = frames_[body];
        return level == 0   ? f.point(point)
               : level == 1 ? f.velocity_of(point)
                            : f.acceleration_of(point);
      };
      return moved(on, point_on) - moved(by, point_by);
    };
  }
  // The angular velocity of a body along its own z.
  Condition spins(int body, double speed) {
    return [=, this](int level) {
      const FrameMotion& f = frames_[body];
      const Vector axis = f.axes.col(2);
      const double value = level == 0   ? 0
                           : level == 1 ? f.turning.dot(axis) - speed
                                        : f.turning_rate.dot(axis);
      return Eigen::VectorXd(Eigen::VectorXd::Constant(1, value));
    };
  }

  void move() {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const Body& body = all_.bodies[i];
      frames_[i] = moved(body.parent < 0 ? FrameMotion{} : frames_[body.parent], body,
                         &coordinates_[first_[i]]);
    }
  }

  // Finds coordinates, their rates and accelerations for which conditions hold. Positions from
  // where the coordinates are.
  void close(const std::vector<Coordinate*>& unknown, const std::vector<Condition>& conditions) {
    const auto all = [&](int level) {
      move();
      std::vector<double> values;
      for (const Condition& condition : conditions)
        for (const double value : condition(level)) values.push_back(value);
      return Eigen::VectorXd(
          Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<long>(values.size())));
    };
    const auto count = static_cast<long>(unknown.size());
    // Rates are linear in the rates of coordinates.
    const auto jacobian = [&] {
      const auto rates = coordinates_;
      for (Coordinate& c : coordinates_) c.velocity = 0;
      const Eigen::VectorXd at_rest = all(1);
      Eigen::MatrixXd columns(at_rest.size(), count);
      for (long i = 0; i < count; ++i) {
        unknown[i]->velocity = 1;
        columns.col(i) = all(1) - at_rest;
        unknown[i]->velocity = 0;
      }
      for (std::size_t i = 0; i < rates.size(); ++i) coordinates_[i].velocity = rates[i].velocity;
      return columns;
    };
    Eigen::VectorXd missing = all(0);
    for (int tried = 0; missing.norm() > 1e-16; ++tried) {
      if (tried == 200) throw std::runtime_error("the loop does not close");
      const Eigen::VectorXd step = jacobian().colPivHouseholderQr().solve(missing);
      const auto before = coordinates_;
      double share = 1;
      Eigen::VectorXd now;
      for (; share > 1e-3; share /= 2) {
        for (long i = 0; i < count; ++i) unknown[i]->position -= share * step[i];
        now = all(0);
        if (now.norm() < missing.norm()) break;
        for (std::size_t i = 0; i < before.size(); ++i)
          coordinates_[i].position = before[i].position;
      }
      if (!(now.norm() < missing.norm())) break;  // round-off is all that is left
      missing = now;
    }
    if (!(missing.norm() < 1e-13)) throw std::runtime_error("the loop does not close");
    const auto solver = Eigen::MatrixXd(jacobian()).colPivHouseholderQr();
    for (Coordinate* c : unknown) c->velocity = c->acceleration = 0;
    const Eigen::VectorXd rates = solver.solve(all(1));
    for (long i = 0; i < count; ++i) unknown[i]->velocity = -rates[i];
    const Eigen::VectorXd accelerations = solver.solve(all(2));
    for (long i = 0; i < count; ++i) unknown[i]->acceleration = -accelerations[i];
    move();
  }

  // Once, before the first state: an unknown force; what a joint can carry. @return its place
  int action(int on, int by) {
    all_.actions.push_back({"", on, by});
    return static_cast<int>(all_.actions.size()) - 1;
  }
  std::vector<int> actions(int count, int on, int by) {
    std::vector<int> places;
    for (int i = 0; i < count; ++i) places.push_back(action(on, by));
    return places;
  }
  std::vector<int> supports(int count, int body) {
    std::vector<int> places;
    for (int i = 0; i < count; ++i) {
      all_.supports.push_back({"", body});
      places.push_back(-static_cast<int>(all_.supports.size()));
    }
    return places;
  }

  // Of a state, in the order of the places.
  void load(int body, const Wrench& wrench) { loads_[body] += wrench; }
  void unit(const Wrench& wrench, bool is_action) {
    (is_action ? now_.actions : now_.supports).push_back(wrench);
  }
  void act(const Wrench& wrench) { unit(wrench, true); }
  void carry(const Wrench& wrench) { unit(wrench, false); }
  void begin_state() {
    now_ = {};
    loads_.assign(all_.bodies.size(), Wrench::Zero());
  }
  void end_state() {
    now_.loads = loads_;
    for (const Coordinate& c : coordinates_) {
      now_.position.push_back(c.position);
      now_.velocity.push_back(c.velocity);
      now_.acceleration.push_back(c.acceleration);
    }
    all_.states.push_back(now_);
  }

  // The engine's sizes of all forces.
  void solve() {
    const Answer answer = run_engine(engine, all_, [](double) {});
    if (!answer.failure.empty()) throw std::runtime_error(answer.failure);
    if (!(answer.residual < 1e-9))
      throw std::runtime_error("joints carry what they cannot: the motion is wrong");
    sizes_ = answer.values;
  }
  double size(std::size_t state, int place) const {
    const std::size_t width = all_.actions.size() + all_.supports.size();
    const std::size_t column =
        place >= 0 ? place : all_.actions.size() + static_cast<std::size_t>(-place - 1);
    return sizes_[state * width + column];
  }
  // The sum of some of them.
  Wrench sum(std::size_t state, const std::vector<int>& places) const {
    Wrench total = Wrench::Zero();
    for (const int place : places)
      total += size(state, place) * (place >= 0 ? all_.states[state].actions[place]
                                                : all_.states[state].supports[-place - 1]);
    return total;
  }

 private:
  Mechanism all_;
  std::vector<int> first_;
  std::vector<Coordinate> coordinates_;
  std::vector<FrameMotion> frames_;
  State now_;
  std::vector<Wrench> loads_;
  std::vector<double> sizes_;
};

const Vector kX = Vector::UnitX(), kY = Vector::UnitY(), kZ = Vector::UnitZ();

Eigen::Matrix3d tilted(double tilt) { return Eigen::AngleAxisd(-tilt, kX).toRotationMatrix(); }

Body turning(const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity(),
             const Vector& place = Vector::Zero()) {
  Body body;
  body.axes = axes;
  body.place = place;
  body.freedoms = {{}};
  body.mass = 1;
  body.inertia = Vector::Ones();
  return body;
}

Rows pendulum(const Data& d, const std::vector<double>& grid) {
  Writer w;
  w.gravity(d("gravity"));
  const double centre = d("centre_x");
  w.length(centre);
  // Axes of the body are those of its inertia.
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  inertia.diagonal() = Vector(d("inertia_x"), d("inertia_y"), d("axial_inertia"));
  inertia(0, 2) = inertia(2, 0) = d("product_xz");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
  Eigen::Matrix3d own = principal.eigenvectors();
  if (own.determinant() < 0) own.col(0) *= -1;
  Eigen::Matrix3d at_bottom;  // x1 along -y0
  at_bottom << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  Body body;
  body.axes = at_bottom * own;
  body.freedoms = {{true, own.transpose() * kZ}};
  body.mass = d("mass");
  body.centre = own.transpose() * Vector(centre, 0, d("centre_z"));
  body.inertia = principal.eigenvalues();
  w.add(body);
  const std::vector<int> force = w.supports(3, 0), moment = w.supports(2, 0);
  const double axial = d("axial_inertia") + d("mass") * centre * centre;
  const double weight = d("mass") * d("gravity") * centre / axial;
  std::vector<double> speeds;
  for (const double theta : grid) {
    const double start = d("speed_at_bottom");
    speeds.push_back(std::sqrt(start * start - 2 * weight * (1 - std::cos(theta))));
    w.at(0) = {theta, speeds.back(), -weight * std::sin(theta)};
    w.begin_state();
    for (const Vector& axis : {kX, kY, kZ}) w.carry(force_at(Vector::Zero(), axis));
    for (const Vector& axis : {kX, kY}) w.carry(couple(axis));
    w.end_state();
  }
  w.solve();
  Rows rows;
  for (std::size_t i = 0; i < grid.size(); ++i)
    rows.push_back({speeds[i], w.size(i, force[0]), w.size(i, force[1]), w.size(i, moment[0]),
                    w.size(i, moment[1])});
  return rows;
}

Rows spherical(const Data& d, const std::vector<double>& grid, bool joint) {
  const double right = kPi / 2;
  const double A = joint ? right : d("input_arc"), B = joint ? right : d("coupler_arc"),
               C = joint ? right : d("output_arc");
  Writer w;
  const Eigen::Matrix3d S2 = tilted(d("tilt"));
  const Vector a(0, std::sin(A), std::cos(A)), b_out(0, std::sin(C), std::cos(C));
  const Vector b_coupler(std::cos(B), std::sin(B), 0);
  const int input = w.add(turning());
  Body link;
  link.parent = input;
  link.axes << a, kX.cross(a), kX;
  link.freedoms = {{true, kX}};
  link.mass = 1;
  link.inertia = Vector(d("coupler_inertia", 0), d("coupler_inertia", 1), d("coupler_inertia", 2));
  const int coupler = w.add(link);
  Body end = turning(S2);
  end.inertia.z() = d("output_inertia");
  const int output = w.add(end);
  const std::vector<int> joint_b = w.actions(2, coupler, output);
  const int drive = w.action(input, -1);
  w.supports(5, input);
  w.supports(3, coupler);
  const std::vector<int> joint_a = w.supports(2, coupler);
  w.supports(5, output);
  const Condition one_axis = w.together(coupler, b_coupler, output, b_out);
  std::vector<double> psi, rate;
  const double start = joint ? right : d("assembly_psi");
  // Where the joint's normal is about to be.
  const Vector normal = a.cross(S2 * Eigen::AngleAxisd(start, kZ) * b_out);
  w.at(coupler).position = std::atan2(-normal.dot(kX.cross(a)), normal.dot(kX));
  w.at(output).position = start;
  for (const double theta : grid) {
    w.at(input) = {theta, d("speed"), 0};
    w.close({&w.at(coupler), &w.at(output)}, {one_axis});
    psi.push_back(w.at(output).position);
    rate.push_back(w.at(output).velocity);
    w.begin_state();
    const Eigen::Matrix3d& own = w.frame(coupler).axes;
    const Vector b = own * b_coupler;
    w.act(couple(own.col(2)));
    w.act(couple(b.cross(own.col(2))));
    w.act(couple(kZ));
    const auto hold = [&](int body) {
      for (const Vector& axis : {kX, kY, kZ}) w.carry(force_at(Vector::Zero(), axis));
      for (int i = body == coupler ? 1 : 0; i < (body == coupler ? 3 : 2); ++i)
        w.carry(couple(w.frame(body).axes.col(i)));
    };
    hold(input);
    hold(coupler);
    hold(output);
    w.load(output, -(d("load_torque") + d("load_damping") * rate.back()) * couple(S2.col(2)));
    w.end_state();
  }
  w.solve();
  Rows rows;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::vector<double> row;
    if (!joint) {
      const double angle = psi[i] - start;
      row.push_back((angle - 2 * kPi * std::round(angle / (2 * kPi)) + start) * 180 / kPi);
    }
    row.push_back(rate[i]);
    for (const std::vector<int>& couples : {joint_a, joint_b})
      for (int k = 0; k < 3; ++k) row.push_back(w.sum(i, couples)[3 + k]);
    row.push_back(w.size(i, drive));
    rows.push_back(row);
  }
  return rows;
}

// One piston, or two opposed ones on a shaft with its bearings.
Rows pistons(const Data& d, const std::vector<double>& grid, bool pair) {
  Writer w;
  w.gravity(d("gravity"));
  w.length(d("joint_circle_radius"));
  const Eigen::Matrix3d S2 = tilted(d("tilt"));
  const Vector O2(0, 0, d("axis_offset"));
  const double length = d("piston_length"), area = kPi / 4 * std::pow(d("bore_diameter"), 2);
  Body turns = turning();
  if (pair) {
    turns.mass = d("shaft_mass");
    turns.centre.z() = d("shaft_centre_z");
  } else {
    turns.mass = 0;
  }
  const int shaft = w.add(turns);
  Body holds = turning(S2, O2);
  holds.mass = 0;
  const int block = w.add(holds);
  struct Piston {
    int body;
    double phase;
    Vector on_shaft;
    std::vector<int> Rs, Rc;
  };
  std::vector<Piston> all;
  for (int k = 0; k < (pair ? 2 : 1); ++k) {
    const double side = k == 0 ? 1 : -1;
    Body rod;  // from B, z towards B from A
    rod.parent = block;
    rod.place.y() = side * d("bore_circle_radius");
    rod.freedoms = {{false, kZ}, {true, kX}, {true, kY}};
    rod.mass = d("mass");
    if (pair) {
      const double chi = d("joint_mass_fraction");
      const double transverse = chi * (1 - chi) * rod.mass * length * length;
      rod.centre.z() = -chi * length;
      rod.inertia = {transverse, transverse, 0};
    } else {
      rod.freedoms.push_back({true, kZ});
      rod.centre.z() = d("centre_of_mass") - length;
      rod.inertia = {d("transverse_inertia"), d("transverse_inertia"), d("axial_inertia")};
    }
    const int body = w.add(rod);
    all.push_back({body, k * kPi, Vector(0, side * d("joint_circle_radius"), 0), {}, {}});
  }
  for (Piston& piston : all) piston.Rs = w.actions(3, piston.body, shaft);
  const int drive = w.action(shaft, -1);
  w.action(block, -1);  // holds the speed of the block
  for (Piston& piston : all) piston.Rc = w.supports(2, piston.body);
  const std::vector<int> bearings = w.supports(5, shaft);
  w.supports(5, block);
  for (const double theta : grid) {
    w.at(shaft) = w.at(block) = {theta, d("speed"), 0};
    w.begin_state();
    w.move();
    for (const Piston& piston : all) {
      const Vector joint(0, 0, -length);
      std::vector<Coordinate*> unknown;
      std::vector<Condition> conditions = {w.together(piston.body, joint, shaft, piston.on_shaft)};
      for (int i = 0; i < (pair ? 3 : 4); ++i) {
        unknown.push_back(&w.at(piston.body, i));
        *unknown.back() = {};
      }
      // From a piston along its bore Newton's method finds B above A.
      unknown[0]->position = length + (w.frame(shaft).point(piston.on_shaft) - O2).dot(S2.col(2));
      if (!pair) conditions.push_back(w.spins(piston.body, d("spin")));
      w.close(unknown, conditions);
      const FrameMotion& f = w.frame(piston.body);
      const double pressure =
          d("pressure_mean") - d("pressure_amplitude") * std::sin(theta + piston.phase);
      w.load(piston.body, -(area * pressure + d("viscous_friction") * f.velocity.dot(S2.col(2))) *
                              force_at(f.origin, S2.col(2)));
      for (int i = 0; i < 3; ++i) w.act(force_at(f.point(joint), S2.col(i)));
      for (int i = 0; i < 2; ++i) w.carry(force_at(f.origin, S2.col(i)));
    }
    w.act(couple(kZ));
    w.act(couple(S2.col(2)));
    const Vector C1(0, 0, pair ? d("tapered_z") : 0), C2(0, 0, pair ? d("cylindrical_z") : -0.1);
    for (const Vector& axis : {kX, kY, kZ}) w.carry(force_at(C1, axis));
    for (const Vector& axis : {kX, kY}) w.carry(force_at(C2, axis));
    for (int i = 0; i < 3; ++i) w.carry(force_at(O2, S2.col(i)));
    for (int i = 0; i < 2; ++i) w.carry(couple(S2.col(i)));
    w.end_state();
  }
  w.solve();
  Rows rows;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::vector<double> row;
    if (pair) {
      for (const int place : bearings) row.push_back(w.size(i, place));
      row.push_back(w.size(i, drive));
    } else {
      for (const int place : all[0].Rs) row.push_back(w.size(i, place));
      for (const int place : all[0].Rc) row.push_back(w.size(i, place));
    }
    rows.push_back(row);
  }
  return rows;
}

Rows gear_pair(const Data& d, const std::vector<double>& grid) {
  Writer w;
  w.gravity(d("gravity"));
  w.length(d("cone_distance"));
  const double shafts = d("shaft_angle"), ratio = d("teeth_input") / d("teeth_output");
  const Eigen::Matrix3d S2 = tilted(shafts);
  const Vector pitch =
      Vector(0, ratio * std::sin(shafts), 1 + ratio * std::cos(shafts)).normalized();
  const Vector k =
      -std::cos(d("pressure_angle")) * kX - std::sin(d("pressure_angle")) * kX.cross(pitch);
  Body one = turning(), two = turning(S2);
  one.mass = d("input_mass");
  one.centre.z() = d("input_centre_z");
  one.inertia.z() = d("input_inertia");
  two.mass = d("output_mass");
  two.centre.z() = d("output_centre_z");
  two.inertia.z() = d("output_inertia");
  const int input = w.add(one), output = w.add(two);
  const int tooth = w.action(output, input), drive = w.action(input, -1);
  const std::vector<int> first = w.supports(5, input), second = w.supports(5, output);
  for (const double theta : grid) {
    const double speed = d("speed") * (1 + d("speed_ripple") * std::cos(theta));
    const double acceleration = -d("speed_ripple") * d("speed") * std::sin(theta) * speed;
    w.at(input) = {theta, speed, acceleration};
    w.at(output) = {-ratio * theta, -ratio * speed, -ratio * acceleration};
    w.begin_state();
    w.act(force_at(d("cone_distance") * pitch, k));
    w.act(couple(kZ));
    for (const auto& [axes, places] :
         {std::pair<Eigen::Matrix3d, std::string>(Eigen::Matrix3d::Identity(), "input_bearing_z"),
          std::pair<Eigen::Matrix3d, std::string>(S2, "output_bearing_z")})
      for (std::size_t bearing = 0; bearing < 2; ++bearing)
        for (int i = 0; i < (bearing == 0 ? 3 : 2); ++i)
          w.carry(force_at(d(places, bearing) * axes.col(2), axes.col(i)));
    w.load(output,
           d("load_torque") * (1 + d("load_ripple") * std::sin(2 * theta)) * couple(S2.col(2)));
    w.end_state();
  }
  w.solve();
  Rows rows;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::vector<double> row = {w.size(i, tooth)};
    for (const std::vector<int>& places : {first, second})
      for (const int place : places) row.push_back(w.size(i, place));
    row.push_back(w.size(i, drive));
    rows.push_back(row);
  }
  return rows;
}

Rows one_sided_wall(const Data& d, const std::vector<double>& grid) {
  Writer w;
  w.gravity(d("gravity"));
  w.length(d("crank_radius"));
  Body wheel = turning();
  wheel.mass = 0;  // it is balanced: without weight
  const int crank = w.add(wheel);
  Body link = turning();
  link.parent = crank;
  link.place.x() = d("crank_radius");
  link.mass = d("rod_mass");
  link.centre.x() = d("rod_centre");
  link.inertia.z() = d("rod_inertia");
  const int rod = w.add(link);
  Body head = turning();
  head.parent = rod;
  head.place.x() = d("rod_length");
  head.mass = d("crosshead_mass");
  head.centre.x() = d("crosshead_centre_x");
  const int crosshead = w.add(head);
  const int front = w.action(crosshead, -1), rear = w.action(crosshead, -1);
  const int drive = w.action(crank, -1);
  for (const int body : {crank, rod, crosshead}) w.supports(5, body);
  // Two points of the crosshead stay on the line y = 0.
  const Vector pads[] = {Vector(d("front_pads_x"), 0, 0), Vector(d("rear_pads_x"), 0, 0)};
  std::vector<Condition> guided;
  for (const Vector& pad : pads)
    guided.emplace_back([&w, crosshead, on_line = w.together(crosshead, pad, -1, {0, 0, 0})](
                            int level) -> Eigen::VectorXd { return on_line(level).segment<1>(1); });
  for (const double theta : grid) {
    const double slope = -std::asin(d("crank_radius") * std::sin(theta) / d("rod_length"));
    w.at(crank) = {theta, d("speed"), 0};
    w.at(rod) = {slope - theta, 0, 0};
    w.at(crosshead) = {-slope, 0, 0};
    w.close({&w.at(rod), &w.at(crosshead)}, guided);
    w.begin_state();
    for (const Vector& pad : pads) w.act(force_at(w.frame(crosshead).point(pad), kY));
    w.act(couple(kZ));
    for (const int body : {crank, rod, crosshead}) {
      for (const Vector& axis : {kX, kY, kZ}) w.carry(force_at(w.frame(body).origin, axis));
      for (const Vector& axis : {kX, kY}) w.carry(couple(axis));
    }
    const Vector gas(-(d("gas_force") + d("gas_amplitude") * std::sin(theta)), 0, 0);
    w.load(crosshead, force_at(w.frame(crosshead).point({0, d("gas_offset"), 0}), gas));
    w.end_state();
  }
  w.solve();
  Rows rows;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::vector<double> row;
    for (const int place : {front, rear}) {  // that pad carries which can push
      row.push_back(std::max(w.size(i, place), 0.0));
      row.push_back(std::max(-w.size(i, place), 0.0));
    }
    row.push_back(w.size(i, drive));
    rows.push_back(row);
  }
  return rows;
}

const std::map<std::string, problems::Solver> kSolvers = {
    {"pendulum", pendulum},
    {"spherical_four_bar",
     [](const Data& d, const std::vector<double>& grid) { return spherical(d, grid, false); }},
    {"universal_joint",
     [](const Data& d, const std::vector<double>& grid) { return spherical(d, grid, true); }},
    {"piston",
     [](const Data& d, const std::vector<double>& grid) { return pistons(d, grid, false); }},
    {"piston_pair",
     [](const Data& d, const std::vector<double>& grid) { return pistons(d, grid, true); }},
    {"gear_pair", gear_pair},
    {"one_sided_wall", one_sided_wall}};

// "MuJoCo 2.2.2" of what the engine says of itself at a body that hangs.
std::string version() {
  Mechanism one;
  one.bodies = {turning()};
  one.supports.assign(5, {"", 0});
  State state;
  state.position = state.velocity = state.acceleration = {0};
  state.loads = {Wrench::Zero()};
  for (int i = 0; i < 5; ++i) state.supports.emplace_back(Wrench::Unit(i));
  one.states = {state};
  const Answer answer = run_engine(engine, one, [](double) {});
  if (!answer.failure.empty()) throw std::runtime_error(answer.failure);
  return answer.text.substr(0, answer.text.find(','));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 1) engine = argv[1];
    if (argc == 3 && std::string(argv[2]) == "--version") {
      std::printf("%s\n", version().c_str());
      return 0;
    }
    if (argc == 5) return problems::solve(kSolvers, argv[2], argv[3], argv[4]);
    std::fputs("usage: engine_problems ENGINE NAME FOLDER OUT.csv\n", stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "engine_problems: %s\n", error.what());
    return 3;
  }
}
