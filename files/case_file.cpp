#include "bentaxis/files/case_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <sstream>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

// A computed number for a message, to six digits.
std::string short_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

class CaseReader {
 public:
  explicit CaseReader(const TomlFile& file) : toml_(file), file_(file.file().string()) {
    result_.file = file.file();
  }

  Case read() {
    TableReader top = toml_.root(&result_.entries);
    top.integer("schema", 1, 1);
    result_.name = top.text("name");
    // Reading in the order of the schema keeps the first error the one nearest to the top.
    read_pump(table(top, "pump"));
    read_gear(table(top, "gear"));
    read_bearings(table(top, "bearings"));
    read_piston(table(top, "piston"));
    read_shaft(table(top, "shaft"));
    read_block(table(top, "block"));
    read_friction(table(top, "friction", false));
    read_operation(table(top, "operation"));
    read_pressure(table(top, "pressure"));
    if (top.has("port_plate")) read_port_plate(table(top, "port_plate"));
    if (result_.pressure.kind == PressureKind::hydraulic || top.has("hydraulics"))
      read_hydraulics(table(top, "hydraulics"));
    read_assumptions(top);
    top.finish();
    return std::move(result_);
  }

 private:
  // A table that may be left out is then read as an empty one: every key takes its default.
  TableReader table(TableReader& parent, const std::string& key, bool required = true) {
    return required ? parent.table(key) : parent.optional_table(key);
  }

  void read_pump(TableReader in) {
    Geometry& g = result_.pump.geometry;
    in.choice("type", {"bent_axis_bevel"}, 0);
    g.pistons = in.integer("pistons", 1, 99);
    g.tilt = radians(in.number("tilt_deg", {0, 90, false, true}));
    g.joint_circle_radius = metres(in.number("joint_circle_radius_mm", kPositive));
    g.bore_circle_radius = metres(in.number("bore_circle_radius_mm", kPositive));
    g.axis_offset = metres(in.number("axis_offset_mm", kAny));
    g.piston_length = metres(in.number("piston_length_mm", kPositive));
    g.bore_diameter = metres(in.number("bore_diameter_mm", kPositive));
    in.finish();
    const AssemblyMargin margin = assembly_margin(g);
    if (!(g.piston_length > margin.longest_distance))
      in.fail("piston_length_mm",
              "must be > " + short_text(margin.longest_distance * 1e3) +
                  ": the pump cannot be assembled at theta = " + short_text(margin.theta_deg) +
                  " deg, where " + short_text((margin.longest_distance - g.piston_length) * 1e3) +
                  " mm are missing (set by joint_circle_radius_mm, bore_circle_radius_mm, "
                  "axis_offset_mm, tilt_deg)");
  }

  void read_gear(TableReader in) {
    result_.pump.gear.pitch_diameter = metres(in.number("pitch_diameter_mm", kPositive));
    result_.pump.gear.pressure_angle = radians(in.number("pressure_angle_deg", {0, 60}));
    in.finish();
  }

  void read_bearings(TableReader in) {
    Bearings& bearings = result_.pump.bearings;
    bearings.tapered_z = metres(in.number("tapered_z_mm", kAny));
    bearings.cylindrical_z = metres(in.number("cylindrical_z_mm", kAny));
    if (bearings.tapered_z == bearings.cylindrical_z)
      in.fail("cylindrical_z_mm", "must differ from tapered_z_mm");
    in.finish();
  }

  void read_piston(TableReader in) {
    PistonMass& piston = result_.pump.piston;
    piston.inertia = static_cast<PistonInertia>(in.choice("inertia", piston_inertia_names()));
    const bool real = piston.inertia != PistonInertia::lumped;
    piston.mass = in.number("mass_kg", kNotNegative);
    piston.joint_mass_fraction = in.number("joint_mass_fraction", {0, 1}, 0.5);
    // Data of the real piston may stand in a lumped case; they are read where they are complete.
    const std::vector<std::string> needed = {"centre_of_mass_mm", "transverse_inertia_kg_mm2",
                                             "axial_inertia_kg_mm2"};
    const auto present = std::count_if(needed.begin(), needed.end(),
                                       [&](const std::string& key) { return in.has(key); });
    const bool complete = present == static_cast<std::ptrdiff_t>(needed.size());
    if (real || complete) {
      PistonMass::Real data;
      data.centre_of_mass = metres(in.number("centre_of_mass_mm", kAny));
      const double transverse = in.number("transverse_inertia_kg_mm2", kNotNegative);
      data.transverse_inertia = square_metres(transverse);
      data.axial_inertia = square_metres(in.number("axial_inertia_kg_mm2", {0, 2 * transverse}));
      data.spin = rad_per_second(in.number("spin_rpm", kAny, 0.0));
      piston.real = data;
    } else {
      for (const auto& key : needed)
        if (in.has(key)) in.number(key, key == needed[0] ? kAny : kNotNegative);
      in.number("spin_rpm", kAny, 0.0);
    }
    in.finish();
    if (const std::string why = piston_inertia_refusal(piston.inertia, result_.pump); !why.empty())
      in.fail("inertia", why);
  }

  void read_shaft(TableReader in) {
    Shaft& shaft = result_.pump.shaft;
    shaft.mass = in.number("mass_kg", kNotNegative);
    shaft.centre_of_mass_z = metres(in.number("centre_of_mass_z_mm", kAny));
    shaft.axial_inertia = square_metres(in.number("axial_inertia_kg_mm2", kNotNegative, 2000.0));
    in.finish();
  }

  void read_block(TableReader in) {
    Block& block = result_.pump.block;
    block.mass = in.number("mass_kg", kNotNegative);
    block.centre_of_mass_z = metres(in.number("centre_of_mass_z_mm", kAny));
    block.pin_z = metres(in.number("pin_z_mm", kAny));
    block.bottom_area = square_metres(in.number("bottom_area_mm2", kNotNegative, 0.0));
    block.spring_force = in.number("spring_force_N", kNotNegative, 0.0);
    block.axial_inertia = square_metres(in.number("axial_inertia_kg_mm2", kNotNegative, 1500.0));
    in.finish();
  }

  void read_friction(TableReader in) {
    Friction& friction = result_.pump.friction;
    friction.piston_coulomb = in.number("piston_coulomb_N", kNotNegative, 0.0);
    friction.piston_viscous = in.number("piston_viscous_N_s_per_m", kNotNegative, 0.0);
    friction.regularization = in.number("regularization_m_per_s", kNotNegative, 0.01);
    friction.block_viscous =
        in.number("block_viscous_Nm_per_rpm", kNotNegative, 0.0) / kRadPerSecondPerRpm;
    friction.shaft_viscous =
        in.number("shaft_viscous_Nm_per_rpm", kNotNegative, 0.0) / kRadPerSecondPerRpm;
    friction.shaft_torque_factor = in.number("shaft_torque_factor", {0, 1, true}, 1.0);
    in.finish();
  }

  void read_operation(TableReader in) {
    constexpr int kMost = std::numeric_limits<int>::max();
    result_.operation.speed_rpm = in.number("speed_rpm", kAny);
    result_.pump.gravity = in.number("gravity_m_per_s2", kAny, 9.80665);
    result_.operation.revolutions = in.integer("revolutions", 1, kMost, 1);
    result_.operation.samples_per_revolution = in.integer("samples_per_revolution", 1, kMost, 720);
    in.finish();
  }

  void read_pressure(TableReader in) {
    PressureSpec& pressure = result_.pressure;
    pressure.kind =
        std::array{PressureKind::ideal, PressureKind::curve,
                   PressureKind::hydraulic}[in.choice("kind", {"ideal", "curve", "hydraulic"})];
    const bool curve = pressure.kind == PressureKind::curve;
    const bool hydraulic = pressure.kind == PressureKind::hydraulic;
    pressure.ports.suction = pascals(in.number("suction_bar", kAny));
    pressure.ports.delivery =
        pascals(in.number("delivery_bar", hydraulic ? NumberRange{0, 10000} : kAny));
    // Keys of the other kinds may be present and are then unused.
    if (hydraulic || in.has("points")) pressure.points = in.integer("points", 16, 100000, 800);
    const bool ideal = pressure.kind == PressureKind::ideal;
    const std::optional<double> unused = ideal ? std::nullopt : std::optional<double>(0.0);
    pressure.transition_deg = in.number("transition_deg", {0, 180}, unused);
    pressure.delivery_start_deg = in.number("delivery_start_deg", kAny, 180.0);
    if (curve) {
      pressure.file = std::filesystem::path(file_).parent_path() / in.text("file");
      if (!std::filesystem::exists(pressure.file))
        in.fail("file", "no such file: " + pressure.file.string());
      if (std::filesystem::is_directory(pressure.file))
        in.fail("file", "is a folder: " + pressure.file.string());
      pressure.curve = read_pressure_curve(pressure.file);
      PressureTrace{pressure};  // refuses a curve that cannot be a periodic spline
    } else if (in.has("file")) {
      in.text("file");
    }
    in.finish();
  }

  void read_port_plate(TableReader in) {
    PortPlate plate;
    const auto [r1, r2] = in.pair("inner_land_mm", kNotNegative);
    const auto [r3, r4] = in.pair("outer_land_mm", kNotNegative);
    if (!(r1 < r2)) in.fail("inner_land_mm", "must be [r1, r2] with 0 <= r1 < r2");
    if (!(r2 < r3 && r3 < r4)) in.fail("outer_land_mm", "must be [r3, r4] with r2 < r3 < r4");
    plate.r1 = metres(r1);
    plate.r2 = metres(r2);
    plate.r3 = metres(r3);
    plate.r4 = metres(r4);
    const auto arc = [&](const std::string& key) {
      const auto [from, to] = in.pair(key, kAny);
      if (!(from < to && to <= from + 360))
        in.fail(key, "must be [from, to] with from < to <= from + 360");
      return PortArc{from, to};
    };
    plate.delivery = arc("delivery_arc_deg");
    plate.suction = arc("suction_arc_deg");
    in.finish();
    result_.pump.port_plate = plate;
  }

  // After [port_plate], whose arcs and lands are the defaults of the ports here.
  void read_hydraulics(TableReader in) {
    HydraulicData data;
    const auto& plate = result_.pump.port_plate;
    data.density = in.number("density_kg_per_m3", {100, 5000}, 850.0);
    data.bulk_modulus = in.number("bulk_modulus_MPa", {10, 1e9}, 1400.0) * 1e6;
    data.air_share = in.number("air_percent", {0, 50, true}, 0.5) / 100;
    data.air_exponent = in.number("air_exponent", {1, 1.67}, 1.4);
    data.atmosphere = pascals(in.number("atmosphere_bar", {0.1, 10}, 1.01325));
    const auto port = [&](const std::string& name, std::optional<PortArc> arc) {
      PlatePort result;
      const std::string key = name + "_arc_deg";
      if (in.has(key) || !arc) {
        const auto [from, to] = in.pair(key, kAny);
        if (!(from < to && to <= from + 360))
          in.fail(key, "must be [from, to] with from < to <= from + 360");
        arc = PortArc{from, to};
      }
      result.arc = *arc;
      result.notch.length_deg = in.number(name + "_notch_deg", {0, 90}, 0.0);
      result.notch.area = square_metres(in.number(name + "_notch_area_mm2", kNotNegative, 0.0));
      return result;
    };
    data.delivery = port("delivery", plate ? std::optional(plate->delivery) : std::nullopt);
    data.suction = port("suction", plate ? std::optional(plate->suction) : std::nullopt);
    data.kidney_width_deg = in.number("kidney_width_deg", {0, 180, true});
    data.kidney_height =
        metres(in.number("kidney_height_mm", kPositive,
                         plate ? std::optional((plate->r3 - plate->r2) * 1e3) : std::nullopt));
    data.kidney_rounding_deg = in.number("kidney_rounding_deg", {0, data.kidney_width_deg},
                                         std::min(5.0, data.kidney_width_deg));
    data.notch_law = in.choice("notch_law", {"quadratic", "linear"}, 0) == 0 ? NotchLaw::quadratic
                                                                             : NotchLaw::linear;
    for (const auto& [name, side] :
         {std::pair{"delivery", &data.delivery}, std::pair{"suction", &data.suction}})
      if (side->arc.to_deg - side->arc.from_deg + side->notch.length_deg + data.kidney_width_deg >
          360)
        in.fail("kidney_width_deg",
                std::string("with the ") + name + " port's arc and notch must not exceed 360 deg");
    data.discharge_coefficient = in.number("discharge_coefficient", {0, 2, true}, 0.67);
    data.transition_pressure = pascals(in.number("transition_pressure_bar", kPositive, 0.1));
    // 1 l/min = 1e-3/60 m3/s
    data.leakage =
        in.number("leakage_l_per_min_per_bar", kNotNegative, 0.002) / 6e4 / kPascalPerBar;
    const NumberRange absolute{-data.atmosphere / kPascalPerBar,
                               std::numeric_limits<double>::infinity(), true};
    data.case_pressure = pascals(in.number("case_bar", absolute, 0.0));
    data.dead_volume = in.number("dead_volume_cm3", kPositive, 3.0) / 1e6;
    data.delivery_volume = in.number("delivery_volume_l", kPositive, 0.5) / 1e3;
    data.tolerance = in.number("tolerance", {1e-12, 1e-4}, 1e-10);
    in.finish();
    if (result_.pressure.kind != PressureKind::hydraulic) return;  // present and unused
    if (!absolute.contains(result_.pressure.ports.suction / kPascalPerBar))
      in.fail("atmosphere_bar",
              "must exceed -suction_bar of [pressure]: no absolute pressure is "
              "below zero");
    result_.hydraulics = data;
  }

  // [assumptions.analytic] and [assumptions.multibody]: what a model leaves out or does otherwise.
  void read_assumptions(TableReader& top) {
    const auto fallback = Assumptions{true, result_.pump.piston.inertia, BlockDrive::mesh};
    result_.analytic = result_.multibody = fallback;
    if (!top.has("assumptions")) return;
    TableReader both = top.table("assumptions");
    for (auto [name, target] :
         {std::pair{"analytic", &result_.analytic}, std::pair{"multibody", &result_.multibody}}) {
      if (!both.has(name)) continue;
      TableReader in = both.table(name);
      target->piston_friction = in.flag("piston_friction", true);
      target->inertia = static_cast<PistonInertia>(
          in.choice("inertia", piston_inertia_names(), static_cast<std::size_t>(fallback.inertia)));
      target->gear =
          in.choice("gear", {"mesh", "imposed"}, 0) == 1 ? BlockDrive::imposed : BlockDrive::mesh;
      if (const std::string why = piston_inertia_refusal(target->inertia, result_.pump);
          !why.empty())
        in.fail("inertia", why);
      in.finish();
    }
    both.finish();
  }

  const TomlFile& toml_;
  std::string file_;
  Case result_;
};

}  // namespace

Case parse_case(const std::string& text, const std::filesystem::path& file) {
  return CaseReader(TomlFile(text, file)).read();
}

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& changes) {
  if (!changes.empty()) throw InputError("--set " + changes.front() + ": not understood yet");
  return CaseReader(TomlFile::read(file, "case file")).read();
}

}  // namespace bentaxis
