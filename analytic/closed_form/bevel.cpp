#include "closed_form/bevel.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic::closed_form {
namespace {

double dot(const Vec3<double>& a, const Vec3<double>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Azimuth from a point of a tangent great circle to where it touches the base circle, by its arc.
double azimuth(const Bevel& bevel, double arc) {
  return std::atan2(std::sin(arc), std::cos(arc) * bevel.sin_base);
}

// Azimuth from where an involute leaves its base circle, by the arc of the tangent.
double involute(const Bevel& bevel, double arc) {
  return arc / bevel.sin_base - azimuth(bevel, arc);
}

// Depth under the pitch plane, rad, to which the plane flank of a crown gear may cut without
// undercut: there the point of contact stands still on the flank that is cut.
double cutting_depth(double pressure_angle, double pitch_cone) {
  const double slide = std::sin(pressure_angle) * std::tan(pitch_cone);  // q (1 - q^2), q = sin arc
  const double largest = 2 / (3 * std::sqrt(3.0));
  if (!(std::abs(slide) < largest)) return kPi / 2;
  const double q = 2 / std::sqrt(3.0) * std::sin(std::asin(slide / largest) / 3);
  return std::asin(std::sin(pressure_angle) * q / std::sqrt(1 - q * q));
}

[[noreturn]] void refuse(const char* key, double millimetres, const std::string& why) {
  throw InputError(std::string("[gear] ") + key + " = " + number_text(millimetres) + ": " + why);
}

}  // namespace

double Bevel::cone(double arc) const { return std::acos(cos_base * std::cos(arc)); }

Corner Bevel::corner(double past) const {
  const double s = std::sin(past);
  const double c = std::cos(past);
  const auto value = [](const Harmonic& h, double cosine, double sine) {
    return h[0] + h[1] * cosine + h[2] * sine;
  };
  Corner corner;
  const double cosine = std::min(1.0, value(along_, c, s) / cos_base);
  const double sine = std::sqrt(1 - cosine * cosine);
  corner.arc = std::acos(cosine);
  // The turn is the edge's azimuth and that from there to the base circle, less the same at O4.
  const double x = value(towards_, c, s);
  const double y = value(across_, c, s);
  const double re = x * cosine * sin_base - y * sine;
  const double im = x * sine + y * cosine * sin_base;
  const double size = std::sqrt(re * re + im * im);
  corner.turn_cosine = re / size;
  corner.turn_sine = im / size;
  const double turn = std::atan2(im, re);
  corner.gap = sin_base * (past - turn) - (roll - corner.arc - at.path_end);
  corner.lever = value(lever_, corner.turn_cosine, corner.turn_sine);
  return corner;
}

Vec3<double> Bevel::turned(const Vec3<double>& v, const Corner& c) const {
  return c.turn_cosine * v + c.turn_sine * cross(block_axis, v) +
         (1 - c.turn_cosine) * dot(block_axis, v) * block_axis;
}

Bevel bevel(const PumpParameters& pump) {
  const Gear& gear = pump.gear;
  const ToothData& teeth = *gear.teeth;
  Bevel b;
  BevelGeometry& at = b.at;
  const double half_tilt = pump.geometry.tilt / 2;
  const double sin_pitch = std::cos(half_tilt);
  const double cos_pitch = std::sin(half_tilt);
  const double sin_p = std::sin(gear.pressure_angle);
  const double cos_p = std::cos(gear.pressure_angle);
  at.pitch_cone = kPi / 2 - half_tilt;
  at.distance = gear.pitch_diameter / 2 / sin_pitch;
  b.sin_base = sin_pitch * cos_p;
  b.cos_base = std::sqrt(cos_pitch * cos_pitch + sin_pitch * sin_p * (sin_pitch * sin_p));
  at.base_cone = std::atan2(b.sin_base, b.cos_base);
  at.tip_cone = at.pitch_cone + std::atan(teeth.addendum / at.distance);
  at.root_cone = at.pitch_cone - std::atan(teeth.dedendum / at.distance);
  constexpr long double kTurn = 2 * 3.141592653589793238462643383279502884L;
  const long double pitch = kTurn / teeth.count;
  b.pitch = static_cast<double>(pitch);
  b.pitch_rest = static_cast<double>(pitch - b.pitch);
  at.base_pitch = b.pitch * b.sin_base;
  b.roll = std::atan2(sin_p * sin_pitch, cos_pitch);
  b.tip_roll = std::acos(std::clamp(std::cos(at.tip_cone) / b.cos_base, -1.0, 1.0));
  at.path_end = b.tip_roll - b.roll;
  at.path_begin = -at.path_end;
  at.contact_ratio = 2 * at.path_end / at.base_pitch;

  b.u0 = {0, sin_pitch, -cos_pitch};
  b.n0 = {-cos_p, sin_p * cos_pitch, sin_p * sin_pitch};
  b.m0 = {sin_p, cos_pitch * cos_p, sin_pitch * cos_p};
  b.block_axis = {cos_pitch, sin_p * sin_pitch, b.sin_base};
  const Vec3<double> shaft_axis = {-cos_pitch, sin_p * sin_pitch, b.sin_base};  // z1

  // The shaft's edge turns about z1, from the end of the path on.
  const Vec3<double> edge = {std::cos(at.path_end), std::sin(at.path_end), 0};
  const Vec3<double> fixed = dot(shaft_axis, edge) * shaft_axis;
  const Vec3<double> cosine = edge - fixed;
  const Vec3<double> sine = cross(shaft_axis, edge);
  const auto along = [&](const Vec3<double>& axis) {
    return Bevel::Harmonic{dot(axis, fixed), dot(axis, cosine), dot(axis, sine)};
  };
  const Vec3<double> outward = (1 / sin_pitch) * (Vec3<double>{1, 0, 0} - cos_pitch * b.block_axis);
  const Vec3<double> sideways = cross(b.block_axis, outward);
  const double back = azimuth(b, b.roll);
  b.along_ = along(b.block_axis);
  b.towards_ = along(std::cos(back) * outward + std::sin(back) * sideways);
  b.across_ = along(std::cos(back) * sideways - std::sin(back) * outward);
  const Vec3<double> normal = {0, 0, 1};
  const Vec3<double> kept = b.sin_base * b.block_axis;
  b.lever_ = {dot(shaft_axis, kept), dot(shaft_axis, normal - kept),
              dot(shaft_axis, cross(b.block_axis, normal))};
  // Pairs are looked at from 5/4 of a pitch before O4 on.
  const double past = 1.25 * b.pitch - at.path_end / b.sin_base;
  at.reach = past > 0 ? at.distance * b.corner(past).gap : 0;
  return b;
}

void require_mesh(const Gear& gear, const Bevel& bevel) {
  const ToothData& teeth = *gear.teeth;
  const BevelGeometry& at = bevel.at;
  // The addendum whose tip has this arc from the base circle, mm.
  const auto addendum = [&](double arc) {
    return at.distance * std::tan(bevel.cone(arc) - at.pitch_cone) * 1e3;
  };
  const double h = teeth.addendum * 1e3;
  if (!(teeth.dedendum > teeth.addendum))
    refuse("dedendum_mm", teeth.dedendum * 1e3,
           "no clearance: must be > addendum_mm = " + number_text(h));
  if (!(at.distance > teeth.face_width / 2))
    refuse("face_width_mm", teeth.face_width * 1e3,
           "reaches the intersection of the axes: must be < " + number_text(2 * at.distance * 1e3) +
               ", twice the distance of O4 from there");
  if (!(at.tip_cone < kPi - at.base_cone) || bevel.tip_roll > 2 * bevel.roll)
    refuse("addendum_mm", h,
           "tip interference: the tips reach past the start of the path of contact on the base "
           "cone of the mate: must be <= " +
               rounded_down_text(addendum(std::min(2 * bevel.roll, kPi))));
  const double depth = cutting_depth(gear.pressure_angle, at.pitch_cone);
  if (at.tip_cone - at.pitch_cone > depth)
    refuse("addendum_mm", h,
           "undercut: a crown gear flank that reaches as deep as the tips removes part of the "
           "working flanks: must be <= " +
               rounded_down_text(at.distance * std::tan(depth) * 1e3));
  if (!(bevel.pitch / 4 + involute(bevel, bevel.roll) > involute(bevel, bevel.tip_roll)))
    refuse("addendum_mm", h, "pointed tips: both flanks of a tooth meet below its tip");
  const auto ratio = [&](double least) { return addendum(bevel.roll + least * at.base_pitch / 2); };
  if (!(at.contact_ratio >= 1))
    refuse("addendum_mm", h,
           "contact ratio " + rounded_text(at.contact_ratio) + ": must be >= 1, which needs " +
               rounded_up_text(ratio(1)));
  if (!(at.contact_ratio <= kLargestContactRatio))
    refuse("addendum_mm", h,
           "contact ratio " + rounded_text(at.contact_ratio) +
               ": must be <= " + rounded_text(kLargestContactRatio) + ", which needs at most " +
               rounded_down_text(ratio(kLargestContactRatio)));
}

}  // namespace bentaxis::analytic::closed_form
