// The raw description of a bent-axis pump: the only thing both models are built from.
//
// Everything here is an input in SI units. Nothing is derived: each model works out its own angles,
// points and derivatives, so that a mistake in one of them shows as a difference.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace bentaxis {

/// The most pistons that a pump may have: buffers of fixed size rely on it.
inline constexpr int kMaxPistons = 99;
inline constexpr int kMostPistons [[deprecated("use kMaxPistons")]] = kMaxPistons;

/// Main dimensions. Frames: S1 has its origin O1 where the shaft axis z1 meets the plane of the
/// piston joints, y1 up; S2 has its origin at (0, 0, axis_offset) in S1 and is bent by `tilt`
/// about x towards +y1; z2 is the block axis (Roccatello & Nervegna 2009, Fig. 1, (7)).
struct Geometry {
  int pistons = 0;                 ///< N
  double tilt = 0;                 ///< alpha, rad, between shaft and block axis
  double joint_circle_radius = 0;  ///< R_a, m, of the spherical joints A_k about z1
  double bore_circle_radius = 0;   ///< R_d, m, of the bores about z2
  double axis_offset = 0;          ///< b, m, z1 of the block frame's origin O2
  double piston_length = 0;        ///< b_1, m, from A to B
  double bore_diameter = 0;        ///< D_pi, m
};

/// Which flanks of the teeth carry.
enum class Flanks {
  one,  ///< one line of action for either sign of the force, as the paper prints it
  two,  ///< that which is pushed: the separating part always pushes the gears apart
};

/// What lies between the teeth.
enum class ToothContact {
  rigid,      ///< nothing: in motion the block turns as the shaft does
  compliant,  ///< compliant flanks with backlash
  teeth,      ///< straight bevel teeth: where they are, they touch
};

/// Approach x0, m, at which the force of a compliant flank is stated.
inline constexpr double kToothApproach = 1e-6;

/// The contact law of compliant flanks: F = k x0 (x/x0)^e (1 + c x') while x > 0, never negative,
/// with x the approach along the line of action (Hunt and Crossley 1975).
struct ToothCompliance {
  double stiffness = 0;    ///< k, N/m, at the approach x0
  double exponent = 1;     ///< e
  double dissipation = 0;  ///< c, s/m
  double backlash = 0;     ///< j, m, along the line of action
};

/// What one gear's teeth deviate from perfect ones, m along the line of action at O4. With the
/// pitch angle p = 2 pi / Z, tooth i of the shaft, i = 1..Z, stands at O4 with its middle where
/// theta = (i - 1) p, and tooth i of the block where psi = (i - 1/2) p: at 0 tooth 1 of the shaft
/// is in the middle of a gap of the block.
struct ToothErrors {
  double runout = 0;        ///< both flanks of tooth i lack runout cos((i - 1) p - runout_angle)
  double runout_angle = 0;  ///< rad
  std::vector<double> pitch = {};  ///< tooth i stands so far ahead, towards +theta or +psi; Z
                                   ///< values, or none: 0
};

/// Straight bevel teeth of shaft and block, alike but for their errors. Lengths are those at O4,
/// the middle of the face width; towards O2 all but crowning shrink with the distance from it.
struct ToothData {
  int count = 0;              ///< Z
  double face_width = 0;      ///< w, m, along the pitch cone
  double addendum = 0;        ///< h_a, m, perpendicular to the pitch cone
  double dedendum = 0;        ///< h_f, m
  double backlash = 0;        ///< j, m, along the line of action
  double dissipation = 0;     ///< c, s/m, as of ToothCompliance, per slice
  double tip_relief = 0;      ///< C_a, m, material less at the tip
  double relief_height = 0;   ///< from the tip down to where relief begins, m
  double lead_crowning = 0;   ///< C_b, m, more distance at both ends than in the middle, of a pair
  double youngs_modulus = 0;  ///< E, Pa
  double poisson_ratio = 0;   ///< nu
  double rim_ratio = 0;       ///< root radius over that of the hub's bore
  ToothErrors shaft, block;
  std::filesystem::path error_file = {};  ///< where the pitch errors come from
};

/// Shape of the flanks of perfect teeth: both carry with a ratio of exactly 1.
enum class FlankShape {
  involute,  ///< spherical involutes of base cones
  octoid,    ///< envelopes of a plane flank of a crown gear
};

/// Bevel gear pair with equal tooth counts that carries the block round (19)-(23).
struct Gear {
  double pitch_diameter = 0;  ///< d = m Z, m
  double pressure_angle = 0;  ///< alpha_p, rad
  ToothContact contact = ToothContact::rigid;
  Flanks flanks = Flanks::one;
  std::optional<ToothCompliance> compliance = {};  ///< there where the contact is compliant
  std::optional<ToothData> teeth = {};             ///< there where the contact is that of teeth

  /// Whether the block has a motion of its own in time.
  bool is_compliant() const { return contact != ToothContact::rigid; }
  [[deprecated("use is_compliant")]] bool gives_way() const { return is_compliant(); }
};

/// What carries the block round.
enum class TransferKind {
  gear,               ///< the bevel gear pair, struct Gear
  constant_velocity,  ///< an ideal constant-velocity joint
  cardan,             ///< one universal joint with a massless cross, centre O2
  pistons,            ///< tapered pistons or rods that touch the walls of their bores
  double_cardan,      ///< two universal joints with a sliding shaft between them, about O2
};

/// What the rest of the program asks of a kind of transfer.
struct TransferTraits {
  const char* name;  ///< as in a case file
  const char* what;  ///< in a sentence
  bool joint;        ///< the angle of the shaft prescribes that of the block through a joint
  bool even;         ///< the block turns exactly as the shaft at constant speed, and all pistons
                     ///< move along one path
};
/// In the order of the enumeration.
inline constexpr TransferTraits kTransfers[] = {
    {"gear", "the bevel gear", false, true},
    {"constant_velocity", "constant-velocity joint", true, true},
    {"cardan", "universal joint", true, false},
    {"pistons", "pistons that touch their bores", false, false},
    {"double_cardan", "double universal joint", true, true}};
inline constexpr std::size_t kTransferKinds = std::size(kTransfers);

constexpr const TransferTraits& traits_of(TransferKind kind) {
  return kTransfers[static_cast<std::size_t>(kind)];
}
/// Names as in a case file, in the order of the enumeration.
inline const std::vector<std::string>& transfer_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const TransferTraits& transfer : kTransfers) all.emplace_back(transfer.name);
    return all;
  }();
  return names;
}
inline std::string to_string(TransferKind kind) { return traits_of(kind).name; }

/// How the crosses of universal joints stand. The shaft's fork holds the arm (cos t, sin t, 0) in
/// S1, t = theta - phase. Of one joint the block's fork holds the arm (-sin(psi - phase),
/// cos(psi - phase), 0) in S2; of two joints the arm (cos t, sin t, 0) in S2.
struct CardanJoint {
  double phase = 0;  ///< phi, rad
};

/// Two universal joints in a row: the cross of the shaft's fork has its centre on z1 at the
/// distance `cross_distance` before O2, that of the block's fork on z2 as far behind O2. A shaft
/// without mass, whose two forks are parallel, joins both crosses; its length adapts without
/// friction.
struct DoubleCardanJoint {
  double cross_distance = 0;  ///< d, m
};

/// Contact of a tapered piston with the wall of its bore. At D = A + l_c e the axis of the piston
/// may be `clearance` away from that of the bore, or what its deviation makes of it; with the
/// approach x beyond it the wall pushes with k x0 (x/x0)^e (1 + c_d x'), never negative; x0 is
/// kWallApproach.
struct WallContact {
  double from_joint = 0;                      ///< l_c, m, from A along the piston's axis to D
  double clearance = 0;                       ///< h, m, radial
  double stiffness = 0;                       ///< k, N/m, at the approach x0
  double exponent = 1;                        ///< e
  double dissipation = 0;                     ///< c_d, s/m
  std::filesystem::path deviation_file = {};  ///< where the deviations come from
  std::vector<double> deviation = {};  ///< m, of the clearance of each piston; empty: none has one

  /// Of a piston, counted from 0, m.
  double clearance_of(std::size_t piston) const {
    return deviation.empty() ? clearance : clearance + deviation[piston];
  }
  double smallest_clearance() const {
    return deviation.empty() ? clearance
                             : clearance + *std::min_element(deviation.begin(), deviation.end());
  }
};
inline constexpr double kWallApproach = 1e-6;

/// How the shaft turns the block. Each kind's own data is present when the case file gives it.
struct Transfer {
  TransferKind kind = TransferKind::gear;
  std::optional<CardanJoint> cardan = {};  ///< of kinds cardan and double_cardan
  std::optional<WallContact> wall = {};    ///< of kind pistons
  std::optional<DoubleCardanJoint> double_cardan = {};

  /// Whether the angle of the shaft prescribes that of the block through a joint.
  bool is_joint() const { return traits_of(kind).joint; }
  /// Whether the block turns exactly as the shaft at constant speed: all pistons then move along
  /// one path, and chambers have the pressures of the shaft's angle.
  bool is_even() const { return traits_of(kind).even; }
  /// Whether a joint turns the block at a speed of its own: each piston has a path of its own.
  bool is_uneven_joint() const { return is_joint() && !is_even(); }
  /// Whether its joint has crosses, whose arms stand at a phase.
  bool has_crosses() const {
    return kind == TransferKind::cardan || kind == TransferKind::double_cardan;
  }
  double phase() const { return cardan ? cardan->phase : 0; }
  /// Whether pistons have clearances of their own.
  bool has_own_clearances() const {
    return kind == TransferKind::pistons && wall && !wall->deviation.empty();
  }
  /// Whether the pump repeats itself after an N-th of a turn, but for the numbers of the pistons:
  /// crosses and clearances of their own repeat after a turn.
  bool repeats_every_pitch() const { return !has_crosses() && !has_own_clearances(); }
};

/// Bearing centres on the shaft axis, z1 in m.
struct Bearings {
  double tapered_z = 0;      ///< of C1, takes x, y and z
  double cylindrical_z = 0;  ///< of C2, takes x and y
};

enum class PistonInertia {
  lumped,  ///< two point masses, chi m at A and (1 - chi) m at B (27), (28)
  real,    ///< rigid, axisymmetric, spinning about its own axis at constant rate (appendix)
  dynamically_equivalent,  ///< three point masses at A, at the centre of mass and at B that have
                           ///< the real piston's mass, centre and transverse inertia; no spin
};

/// Names as in a case file, in the order of the enumeration.
inline const std::vector<std::string>& piston_inertia_names() {
  static const std::vector<std::string> names = {"lumped", "real", "dynamically_equivalent"};
  return names;
}

/// Mass properties of one piston. Each kind's own data is present when the case file gives it.
struct PistonMass {
  struct Real {
    double centre_of_mass = 0;      ///< s_G, m, from A towards B
    double transverse_inertia = 0;  ///< I_t, kg m2, about the centre of mass
    double axial_inertia = 0;       ///< I_a, kg m2
    double spin = 0;                ///< w_s, rad/s, absolute, positive along A->B
  };
  PistonInertia inertia = PistonInertia::lumped;
  double mass = 0;                   ///< m_pi, kg
  double joint_mass_fraction = 0.5;  ///< chi, share of the mass at A
  std::optional<double> contact;     ///< s_C, m, from A to where the bore force acts; none: at B
  std::optional<Real> real;
};

/// Axial inertias where a case does not give them, kg m2: of a pump of the size of the BAP 63. At
/// constant speed nothing depends on them; they are there so that a run in which the speed changes
/// has an answer.
inline constexpr double kUsualShaftInertia = 2000e-6;
inline constexpr double kUsualBlockInertia = 1500e-6;

struct Shaft {
  double mass = 0;                            ///< m_s, kg
  double centre_of_mass_z = 0;                ///< z1, m
  double axial_inertia = kUsualShaftInertia;  ///< kg m2, about z1
};

struct Block {
  double mass = 0;                            ///< m_c, kg
  double centre_of_mass_z = 0;                ///< z2, m
  double pin_z = 0;                           ///< z2 of the pin's mean contact point H_cn, m
  double bottom_area = 0;                     ///< A_c per bore, m2
  double spring_force = 0;                    ///< F_m, N, pushes block and shaft apart
  double axial_inertia = kUsualBlockInertia;  ///< kg m2, about z2
};

struct Friction {
  double piston_coulomb = 0;       ///< F_c, N
  double piston_viscous = 0;       ///< c_v, N s/m
  double regularization = 0.01;    ///< v_reg, m/s; 0 gives the sign function
  double block_viscous = 0;        ///< C_c, Nm s/rad
  double shaft_viscous = 0;        ///< C_s, Nm s/rad
  double shaft_torque_factor = 1;  ///< C_t of (38); 1 means no proportional loss
};

/// Arc of a port on the fixed port plate, degrees; the point at angle psi is
/// (-r sin psi, r cos psi) in S2.
struct PortArc {
  double from_deg = 0;
  double to_deg = 0;
};

/// Lands of the port plate: full port pressure between r2 and r3, falling linearly to 0 at r1, r4.
struct PortPlate {
  double r1 = 0, r2 = 0, r3 = 0, r4 = 0;  ///< m
  PortArc delivery, suction;
};

/// Word of a case file for the mechanism. Both are bent-axis pumps with any transfer; the second
/// says that it is a bevel gear.
enum class PumpType { bent_axis, bent_axis_bevel };

/// All of the pump that the mechanical models need.
struct PumpParameters {
  Geometry geometry;
  Gear gear;  ///< unused where the transfer is of another kind
  Bearings bearings;
  PistonMass piston;
  Shaft shaft;
  Block block;
  Friction friction;
  std::optional<PortPlate> port_plate;
  double gravity = 9.80665;  ///< m/s2, along -y1
  Transfer transfer = {};
  PumpType type = PumpType::bent_axis;

  /// Whether the block has a motion of its own in time.
  bool block_moves_freely() const {
    return transfer.kind == TransferKind::pistons ||
           (transfer.kind == TransferKind::gear && gear.is_compliant());
  }
};

/// How the block is driven.
enum class BlockDrive {
  mesh,     ///< the shaft drives it by the tooth force R_cs along z4 at O4
  imposed,  ///< its speed is imposed on its joint, as in the paper's ADAMS run; no R_cs
};

/// What a model takes into account beyond the raw description. Two models may differ here; the
/// comparison then accounts for every difference.
struct Assumptions {
  bool piston_friction = true;
  PistonInertia inertia = PistonInertia::lumped;
  BlockDrive gear = BlockDrive::mesh;
  FlankShape flanks = FlankShape::involute;  ///< of a multibody model's teeth
};

inline bool operator==(const Assumptions& a, const Assumptions& b) {
  return a.piston_friction == b.piston_friction && a.inertia == b.inertia && a.gear == b.gear &&
         a.flanks == b.flanks;
}

inline std::string to_string(PistonInertia inertia) {
  return piston_inertia_names()[static_cast<std::size_t>(inertia)];
}
inline std::string to_string(FlankShape flanks) {
  return flanks == FlankShape::involute ? "involute" : "octoid";
}
inline std::string to_string(BlockDrive gear) {
  return gear == BlockDrive::mesh ? "mesh" : "imposed";
}

/// Why this piston cannot be treated as `inertia` asks, as the end of a message; empty where it
/// can. Real and dynamically equivalent pistons need their data; three point masses with a
/// transverse inertia need the centre of mass strictly between A and B.
std::string piston_inertia_refusal(PistonInertia inertia, const PumpParameters& pump);

/// Why the block of this pump cannot be driven as `drive` asks, as the end of a message; empty
/// where it can: an imposed speed replaces the gear and nothing else.
std::string imposed_refusal(BlockDrive drive, const PumpParameters& pump);

/// Ideal gap between the longest distance from a joint A to the axis of its bore and the piston
/// length that has to span it: where it is not positive the pump cannot be assembled.
struct AssemblyMargin {
  double longest_distance = 0;  ///< m, largest distance of A from its bore axis over a turn
  double theta_deg = 0;         ///< where
};

/// The worst angle for assembly, exactly (the squared distance is a quadratic in cos theta).
AssemblyMargin assembly_margin(const Geometry& geometry);

/// The same of a pump, for every piston: with a universal joint each has a trajectory of its own.
AssemblyMargin assembly_margin(const PumpParameters& pump);

/// psi - theta of a block that a joint drives, rad: 0 unless the joint is a universal joint. Where
/// nothing prescribes the block (compliant teeth, pistons) that of a block without lag.
double block_lead(const PumpParameters& pump, double theta);

/// Distance of a joint A at the angle theta of the shaft from the axis of its bore at the angle psi
/// of the block, m: what a piston's length must exceed. Angles in rad.
double joint_distance(const Geometry& geometry, double theta, double psi);

}  // namespace bentaxis
