// [oil]: viscosity.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kOil = part_of_hydraulics<&HydraulicData::oil>();

std::string viscosity_refusal(const Case& c) {
  const OilData* oil = find(c, &HydraulicData::oil);
  return oil == nullptr || oil->viscosity_100 < oil->viscosity_40
             ? ""
             : "must be below viscosity_40C_cSt: oil thins as it warms";
}

}  // namespace

Table oil_table() {
  return {
      .name = "oil",
      .meaning = "viscosity, for gaps and for laminar friction in lines",
      .part = &kOil,
      .in_fmu = InFmu::tunable,
      .parameters = {number("temperature_C", "T", FIELD(c.hydraulics->oil->temperature), {"C"},
                            {-50, 200}, {60.0}, "of the oil, everywhere"),
                     number("viscosity_40C_cSt", "nu_40", FIELD(c.hydraulics->oil->viscosity_40),
                            kCentistokes, {1, 1e5}, {46.0},
                            "kinematic, at 40 deg C and atmospheric pressure",
                            {.practice = "ISO VG 46: 46"}),
                     number("viscosity_100C_cSt", "nu_100", FIELD(c.hydraulics->oil->viscosity_100),
                            kCentistokes, {1, 1e5}, {6.8}, "the same at 100 deg C",
                            {.range_words = "[1, 1e+05], below that at 40 deg C",
                             .practice = "ISO VG 46, viscosity index 100: 6.8"}),
                     number("pressure_viscosity_per_GPa", "alpha_mu",
                            FIELD(c.hydraulics->oil->pressure_viscosity), kPerGigapascal, {0, 100},
                            {20.0}, "viscosity increases as exp(alpha_mu p)",
                            {.practice = "mineral oil: 15..25"})},
      .rules = {after("viscosity_100C_cSt", viscosity_refusal)}};
}

}  // namespace bentaxis::tables
