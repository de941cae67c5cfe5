// The gear and its teeth.
#include <fmt/format.h>

#include <cmath>

#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

bool has_teeth(const Facts& f) {
  return f.pump.gear.teeth && f.pump.gear.contact == ToothContact::teeth;
}

}  // namespace

std::vector<Check> gear() {
  return {
      {"gear-inside-bores", "d/2 < Rd + Dpi/2: the teeth would intersect the bores",
       [](const Facts& f) {
         return outside(f, "gear", "pitch_diameter_mm", mm(2 * f.bores_radius), HUGE_VAL,
                        "the teeth would intersect the bores, which reach to this diameter",
                        {kRadius, kCentimetres, kInches, kMetres});
       }},
      {"gear-large", "d/2 > 3 (Rd + Dpi/2)",
       [](const Facts& f) {
         return outside(f, "gear", "pitch_diameter_mm", 0, mm(6 * f.bores_radius),
                        "three times the enclosing diameter of the bores",
                        {kDiameter, kTenth, kMicrometres});
       }},
      {"pressure-angle", "0 < pressure angle < {0:g} deg, or > {1:g} deg", "gear",
       "pressure_angle_deg", [](const Facts& f) { return f.pump.gear.pressure_angle != 0; }},
      {"tooth-module", "module of the teeth, d/Z, below 1 or above 12 mm", has_teeth,
       [](const Facts& f) {
         const int count = f.pump.gear.teeth->count;
         return outside(fmt::format("tooth_number = {}: module", count),
                        mm(f.pump.gear.pitch_diameter) / count, 1, 12, "mm",
                        "synchronising gears have 2 to 8 mm");
       }},
      {"tooth-shape",
       "backlash above a tenth of the module, tip relief or crowning above a fiftieth, run-out "
       "above "
       "a "
       "twentieth, a face wider than half the distance from O2",
       has_teeth,
       [](const Facts& f) {
         const ToothData& teeth = *f.pump.gear.teeth;
         const double module = f.pump.gear.pitch_diameter / teeth.count;
         const double um = 1e6;
         const auto one = [&](const char* key, double value, double share, const char* why) {
           return outside(key, um * std::abs(value), 0, um * share * module, "um", why,
                          {{1e-3, "in um?"}});
         };
         return first_of(
             {one("backlash_um", teeth.backlash, 0.1, "gears of this module have a few hundredths"),
              one("tip_relief_um", teeth.tip_relief, 0.02, "reliefs are deflections, some microns"),
              one("lead_crowning_um", teeth.lead_crowning, 0.02, "crownings are some microns"),
              one("shaft_runout_um", teeth.shaft.runout, 0.05, "run-outs are some hundredths"),
              one("block_runout_um", teeth.block.runout, 0.05, "run-outs are some hundredths"),
              outside(f, "gear", "face_width_mm", 0,
                      mm(f.pump.gear.pitch_diameter) / (4 * std::cos(f.g.tilt / 2)),
                      "half the distance of the teeth from where the axes meet")});
       }},
  };
}

}  // namespace bentaxis::study::checks
