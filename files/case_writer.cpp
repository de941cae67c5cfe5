#include "bentaxis/files/case_writer.h"

#include <cmath>
#include <limits>
#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

using Conversion = double (*)(double);

double same(double value) { return value; }
double from_mpa(double mpa) { return mpa * 1e6; }
double from_percent(double percent) { return percent / 100; }
double from_cm3(double cm3) { return cm3 / 1e6; }
double from_litres(double litres) { return litres / 1e3; }
double from_leakage(double l_per_min_per_bar) { return l_per_min_per_bar / 6e4 / kPascalPerBar; }
double per_rpm(double nm_per_rpm) { return nm_per_rpm / kRadPerSecondPerRpm; }

// The number in the file's unit that is read as `si`.
double in_file_unit(double si, Conversion to_si) {
  const double guess = si / to_si(1);
  if (to_si(guess) == si || !std::isfinite(guess)) return guess;
  const double infinity = std::numeric_limits<double>::infinity();
  double up = guess;
  double down = guess;
  for (int i = 0; i < 4; ++i) {
    up = std::nextafter(up, infinity);
    down = std::nextafter(down, -infinity);
    for (const double near : {up, down})
      if (to_si(near) == si) return near;
  }
  return guess;
}

// A TOML float: an integer would do for the reader, but a float stays one in other hands.
std::string toml_number(double value) {
  std::string text = number_text(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7f) {
      constexpr char kHex[] = "0123456789abcdef";
      out += std::string("\\u00") + kHex[code >> 4U] + kHex[code & 15U];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

class Writer {
 public:
  void table(const std::string& name) { text_ += "\n[" + name + "]\n"; }
  void line(const std::string& key, const std::string& value) {
    text_ += key + " = " + value + "\n";
  }
  void number(const std::string& key, double si, Conversion to_si = same) {
    line(key, toml_number(in_file_unit(si, to_si)));
  }
  void pair(const std::string& key, double first, double second, Conversion to_si = same) {
    line(key, "[" + toml_number(in_file_unit(first, to_si)) + ", " +
                  toml_number(in_file_unit(second, to_si)) + "]");
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void write_hydraulics(Writer& out, const HydraulicData& data) {
  out.table("hydraulics");
  out.number("density_kg_per_m3", data.density);
  out.number("bulk_modulus_MPa", data.bulk_modulus, from_mpa);
  out.number("air_percent", data.air_share, from_percent);
  out.number("air_exponent", data.air_exponent);
  out.number("atmosphere_bar", data.atmosphere, pascals);
  const auto port = [&](const std::string& name, const PlatePort& side) {
    out.pair(name + "_arc_deg", side.arc.from_deg, side.arc.to_deg);
    out.number(name + "_notch_deg", side.notch.length_deg);
    out.number(name + "_notch_area_mm2", side.notch.area, square_metres);
  };
  port("delivery", data.delivery);
  port("suction", data.suction);
  out.number("kidney_width_deg", data.kidney_width_deg);
  out.number("kidney_height_mm", data.kidney_height, metres);
  out.number("kidney_rounding_deg", data.kidney_rounding_deg);
  out.line("notch_law", quoted(data.notch_law == NotchLaw::linear ? "linear" : "quadratic"));
  out.number("discharge_coefficient", data.discharge_coefficient);
  out.number("transition_pressure_bar", data.transition_pressure, pascals);
  out.number("leakage_l_per_min_per_bar", data.leakage, from_leakage);
  out.number("case_bar", data.case_pressure, pascals);
  out.number("dead_volume_cm3", data.dead_volume, from_cm3);
  out.number("delivery_volume_l", data.delivery_volume, from_litres);
  out.number("tolerance", data.tolerance);
}

void write_assumptions(Writer& out, const char* model, const Assumptions& a) {
  out.table(std::string("assumptions.") + model);
  out.line("piston_friction", a.piston_friction ? "true" : "false");
  out.line("inertia", quoted(to_string(a.inertia)));
  out.line("gear", quoted(to_string(a.gear)));
}

}  // namespace

std::string case_text(const Case& the_case) {
  const PumpParameters& p = the_case.pump;
  Writer out;
  out.line("schema", "1");
  out.line("name", quoted(the_case.name));

  out.table("pump");
  out.line("pistons", std::to_string(p.geometry.pistons));
  out.number("tilt_deg", p.geometry.tilt, radians);
  out.number("joint_circle_radius_mm", p.geometry.joint_circle_radius, metres);
  out.number("bore_circle_radius_mm", p.geometry.bore_circle_radius, metres);
  out.number("axis_offset_mm", p.geometry.axis_offset, metres);
  out.number("piston_length_mm", p.geometry.piston_length, metres);
  out.number("bore_diameter_mm", p.geometry.bore_diameter, metres);

  out.table("gear");
  out.number("pitch_diameter_mm", p.gear.pitch_diameter, metres);
  out.number("pressure_angle_deg", p.gear.pressure_angle, radians);

  out.table("bearings");
  out.number("tapered_z_mm", p.bearings.tapered_z, metres);
  out.number("cylindrical_z_mm", p.bearings.cylindrical_z, metres);

  out.table("piston");
  out.line("inertia", quoted(to_string(p.piston.inertia)));
  out.number("mass_kg", p.piston.mass);
  out.number("joint_mass_fraction", p.piston.joint_mass_fraction);
  if (p.piston.real) {
    out.number("centre_of_mass_mm", p.piston.real->centre_of_mass, metres);
    out.number("transverse_inertia_kg_mm2", p.piston.real->transverse_inertia, square_metres);
    out.number("axial_inertia_kg_mm2", p.piston.real->axial_inertia, square_metres);
    out.number("spin_rpm", p.piston.real->spin, rad_per_second);
  }

  out.table("shaft");
  out.number("mass_kg", p.shaft.mass);
  out.number("centre_of_mass_z_mm", p.shaft.centre_of_mass_z, metres);
  out.number("axial_inertia_kg_mm2", p.shaft.axial_inertia, square_metres);

  out.table("block");
  out.number("mass_kg", p.block.mass);
  out.number("centre_of_mass_z_mm", p.block.centre_of_mass_z, metres);
  out.number("pin_z_mm", p.block.pin_z, metres);
  out.number("bottom_area_mm2", p.block.bottom_area, square_metres);
  out.number("spring_force_N", p.block.spring_force);
  out.number("axial_inertia_kg_mm2", p.block.axial_inertia, square_metres);

  out.table("friction");
  out.number("piston_coulomb_N", p.friction.piston_coulomb);
  out.number("piston_viscous_N_s_per_m", p.friction.piston_viscous);
  out.number("regularization_m_per_s", p.friction.regularization);
  out.number("block_viscous_Nm_per_rpm", p.friction.block_viscous, per_rpm);
  out.number("shaft_viscous_Nm_per_rpm", p.friction.shaft_viscous, per_rpm);
  out.number("shaft_torque_factor", p.friction.shaft_torque_factor);

  out.table("operation");
  out.number("speed_rpm", the_case.operation.speed_rpm);
  out.number("gravity_m_per_s2", p.gravity);
  out.line("revolutions", std::to_string(the_case.operation.revolutions));
  out.line("samples_per_revolution", std::to_string(the_case.operation.samples_per_revolution));

  const PressureSpec& pressure = the_case.pressure;
  out.table("pressure");
  const bool curve = pressure.kind == PressureKind::curve;
  const bool hydraulic = pressure.kind == PressureKind::hydraulic;
  out.line("kind", quoted(curve ? "curve" : hydraulic ? "hydraulic" : "ideal"));
  out.number("suction_bar", pressure.ports.suction, pascals);
  out.number("delivery_bar", pressure.ports.delivery, pascals);
  if (curve) {
    out.line("file", quoted(std::filesystem::absolute(pressure.file).string()));
  } else if (hydraulic) {
    out.line("points", std::to_string(pressure.points));
  } else {
    out.number("transition_deg", pressure.transition_deg);
    out.number("delivery_start_deg", pressure.delivery_start_deg);
  }

  if (p.port_plate) {
    const PortPlate& plate = *p.port_plate;
    out.table("port_plate");
    out.pair("inner_land_mm", plate.r1, plate.r2, metres);
    out.pair("outer_land_mm", plate.r3, plate.r4, metres);
    out.pair("delivery_arc_deg", plate.delivery.from_deg, plate.delivery.to_deg);
    out.pair("suction_arc_deg", plate.suction.from_deg, plate.suction.to_deg);
  }
  if (the_case.hydraulics) write_hydraulics(out, *the_case.hydraulics);
  write_assumptions(out, "analytic", the_case.analytic);
  write_assumptions(out, "multibody", the_case.multibody);
  return out.text();
}

}  // namespace bentaxis
