// The law of a tooth's flexibility in its spur limit, against ISO 6336-1 and a pair from elsewhere.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bentaxis/pump/tooth_flexibility.h"
#include "bentaxis/pump/units.h"
#include "numbers.h"

namespace bentaxis::external {
namespace {

// ---- ISO 6336-1:2019, 9.2, method B: N, mm, um, degrees -----------------------------------------

struct Wheels {
  double module = 0, pressure_angle_deg = 20, helix_deg = 0;
  double teeth[2] = {}, shift[2] = {};
  double rack_dedendum = 1.25;  // h_fP, modules; the addendum is 1
  double distance = 0;          // a, mm; 0: as the shifts want it
};

struct Stiffness {
  double theoretical = 0, single = 0, mesh_alpha = 0, mesh_beta = 0;
};

double contact_ratio(const Wheels& of) {
  const double beta = radians(of.helix_deg);
  const double transverse = std::atan(std::tan(radians(of.pressure_angle_deg)) / std::cos(beta));
  double length = 0, base_sum = 0, distance = 0;
  for (const int i : {0, 1}) {
    const double radius = of.teeth[i] * of.module / std::cos(beta) / 2;
    const double base = radius * std::cos(transverse);
    // Tip diameters are stated to hundredths of a millimetre.
    const double tip = std::round(100 * 2 * (radius + of.module * (1 + of.shift[i]))) / 100 / 2;
    length += std::sqrt(tip * tip - base * base);
    base_sum += base;
    distance += radius;
  }
  if (of.distance > 0) distance = of.distance;
  length -= std::sqrt(distance * distance - base_sum * base_sum);
  return length / (kPi * of.module / std::cos(beta) * std::cos(transverse));
}

Stiffness by_standard(const Wheels& of) {
  const double cosine = std::cos(radians(of.helix_deg));
  // Of the equivalent spur gears, by the helix on the base cylinder.
  const double base_sine =
      std::sin(radians(of.helix_deg)) * std::cos(radians(of.pressure_angle_deg));
  const double straightened = (1 - base_sine * base_sine) * cosine;
  const double z1 = of.teeth[0] / straightened, z2 = of.teeth[1] / straightened;
  const double x1 = of.shift[0], x2 = of.shift[1];
  const double flexibility = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 -
                             0.11654 * x1 / z1 - 0.00193 * x2 - 0.24188 * x2 / z2 +
                             0.00529 * x1 * x1 + 0.00182 * x2 * x2;
  Stiffness c;
  c.theoretical = 1 / flexibility;
  const double correction = 0.8;  // C_M; C_R = 1 of solid wheels
  const double rack =
      (1 + 0.5 * (1.2 - of.rack_dedendum)) * (1 - 0.02 * (20 - of.pressure_angle_deg));
  c.single = c.theoretical * correction * rack * cosine;
  c.mesh_alpha = c.single * (0.75 * contact_ratio(of) + 0.25);
  c.mesh_beta = 0.85 * c.mesh_alpha;
  return c;
}

// ---- the law as spur gears, SI ------------------------------------------------------------------

Gear spur(int teeth, double module, double rim_ratio) {
  Gear gear;
  gear.pitch_diameter = module * teeth;
  gear.pressure_angle = radians(20);
  gear.teeth.emplace();
  gear.teeth->count = teeth;
  gear.teeth->addendum = module;
  gear.teeth->dedendum = 1.25 * module;
  gear.teeth->youngs_modulus = 206e9;
  gear.teeth->poisson_ratio = 0.3;
  gear.teeth->rim_ratio = rim_ratio;
  return gear;
}

/// Two equal spur gears whose rolls on the line of action add up to twice the pressure angle's
/// tangent.
class Mesh {
 public:
  explicit Mesh(const Gear& gear)
      : law_(gear, 0),
        both_(2 * std::tan(gear.pressure_angle)),
        pitch_(2 * kPi / gear.teeth->count) {}

  double first() const { return both_ - law_.profile().tip_roll; }
  double last() const { return law_.profile().tip_roll; }
  double pitch() const { return pitch_; }
  double contact_ratio() const { return (last() - first()) / pitch_; }
  /// Of one pair, per width.
  double pair(double roll) const {
    return 1 / (law_.tooth(height(roll)) + law_.tooth(height(both_ - roll)) + law_.contact());
  }
  /// Of all pairs; 0 to 1 over a base pitch from the start of mesh.
  double mesh(double phase) const {
    double sum = 0;
    for (double roll = first() + phase * pitch_; roll <= last(); roll += pitch_) sum += pair(roll);
    return sum;
  }
  double mean() const {  // the pairs one after another: no jumps
    constexpr int kPlaces = 4000;
    double sum = 0;
    for (int i = 0; i < kPlaces; ++i)
      sum += pair(first() + (last() - first()) * (i + 0.5) / kPlaces);
    return sum / kPlaces * contact_ratio();
  }
  double at_pitch_point() const { return pair(both_ / 2); }
  double height(double roll) const {
    return law_.profile().base_radius * std::hypot(1, roll) - law_.profile().pitch_radius;
  }
  const ToothFlexibility& law() const { return law_; }

 private:
  ToothFlexibility law_;
  double both_, pitch_;
};

/// The same with the conventions of the program that the numbers come from
/// (docs/external_benchmarks.md).
class TheirMesh {
 public:
  TheirMesh(const Mesh& mesh, const Gear& gear) : mesh_(mesh), gear_(gear) {
    start_ = std::atan(mesh.law().profile().start_roll);
    end_ = std::atan(mesh.law().profile().tip_roll);
    step_ = (end_ - start_) / mesh.contact_ratio();
  }
  double mesh(double phase) const {
    const double way = phase * step_;
    double sum = pair(way);
    if (way <= step_ * (mesh_.contact_ratio() - 1)) sum += pair(way + step_);
    return sum;
  }

 private:
  double pair(double way) const {
    return 1 / (tooth(start_ + way) + tooth(end_ - way) + mesh_.law().contact());
  }
  double tooth(double pressure_angle) const {
    const auto& profile = mesh_.law().profile();
    const double roll = std::tan(pressure_angle);
    const auto parts = mesh_.law().parts(mesh_.height(roll));
    const double a = gear_.pressure_angle;
    const double corner = 0.25 / (1 - std::sin(a));
    const double root =
        (kPi / 2 + 2 * std::tan(a) * (1 - corner) + 2 * corner / std::cos(a)) / gear_.teeth->count;
    const auto [l, m, p, q] = ToothFlexibility::foundation_factors(root, gear_.teeth->rim_ratio);
    const double beta = roll - profile.base_angle;
    const double y = profile.base_radius * (roll * std::sin(beta) + std::cos(beta));
    const double arm = (y - profile.root_radius) / (2 * profile.root_radius * root);
    const double foundation = std::pow(std::cos(beta), 2) / gear_.teeth->youngs_modulus *
                              (l * arm * arm + m * arm + p * (1 + q * std::pow(std::tan(beta), 2)));
    return parts.bending + parts.shear + parts.compression + foundation;
  }

  const Mesh& mesh_;
  const Gear& gear_;
  double start_ = 0, end_ = 0, step_ = 0;
};

}  // namespace

Numbers iso_6336() {
  Wheels example;
  example.module = 8;
  example.helix_deg = 15.8;
  example.teeth[0] = 17;
  example.teeth[1] = 103;
  example.shift[0] = 0.145;
  example.rack_dedendum = 1.4;
  example.distance = 500;
  const Stiffness c = by_standard(example);
  Numbers numbers = {{"iso6336.cth", c.theoretical},
                     {"iso6336.c", c.single},
                     {"iso6336.c_gamma_alpha", c.mesh_alpha},
                     {"iso6336.c_gamma_beta", c.mesh_beta}};
  constexpr double kPerMillimetreMicrometre = 1e-9;  // of N/m2
  for (const int teeth : {20, 27, 40, 79, 120}) {
    Wheels wheels;
    wheels.module = 4;
    wheels.teeth[0] = wheels.teeth[1] = teeth;
    const Stiffness standard = by_standard(wheels);
    const Mesh mesh(spur(teeth, 4e-3, 3));
    const std::string spur_pair = "iso6336.law_over_standard." + std::to_string(teeth);
    numbers.push_back(
        {spur_pair + ".c", mesh.at_pitch_point() * kPerMillimetreMicrometre / standard.single});
    numbers.push_back({spur_pair + ".c_gamma_alpha",
                       mesh.mean() * kPerMillimetreMicrometre / standard.mesh_alpha});
  }
  return numbers;
}

Numbers pair_of_62() {
  constexpr double kWidth = 0.02, kModule = 2e-3, kBore = 17.5e-3;
  const Gear gear = spur(62, kModule, (31 - 1.25) * kModule / kBore);
  const Mesh mesh(gear);
  const TheirMesh theirs(mesh, gear);
  constexpr int kPlaces = 1000;
  double mean = 0, most = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double here = theirs.mesh(i / (kPlaces - 1.0));
    mean += here / kPlaces;
    most = std::max(most, here);
  }
  return {{"pair62.contact_ratio", mesh.contact_ratio()},
          {"pair62.hertz", kWidth / mesh.law().contact()},
          {"pair62.start.their_conventions", kWidth * theirs.mesh(0)},
          {"pair62.largest.their_conventions", kWidth * most},
          {"pair62.mean.their_conventions", kWidth * mean},
          {"pair62.start.ours", kWidth * mesh.mesh(0)},
          {"pair62.mean.ours", kWidth * mesh.mean()}};
}

Numbers finite_element_tooth() {
  constexpr double kModule = 4e-3;
  Numbers numbers;
  for (const int teeth : {27, 79}) {
    const ToothFlexibility law(spur(teeth, kModule, 3), 0);
    for (const double height : {-0.5, 0.0, 0.9}) {
      char id[64];
      std::snprintf(id, sizeof id, "tooth.%d.at_%.1f_modules", teeth, height);
      numbers.push_back({id, law.tooth(height * kModule)});
    }
  }
  return numbers;
}

}  // namespace bentaxis::external
