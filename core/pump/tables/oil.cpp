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
  return {.name = "oil",
          .meaning = "viscosity, for gaps and for laminar friction in lines",
          .part = &kOil,
          .in_fmu = InFmu::tunable,
          .parameters = {{.key = "temperature_C",
                          .field = FIELD(c.hydraulics->oil->temperature),
                          .symbol = "T",
                          .unit = {"C"},
                          .range = {-50, 200},
                          .fallback = {60.0},
                          .meaning = "of the oil, everywhere"},
                         {.key = "viscosity_40C_cSt",
                          .field = FIELD(c.hydraulics->oil->viscosity_40),
                          .symbol = "nu_40",
                          .unit = kCentistokes,
                          .range = {1, 1e5},
                          .fallback = {46.0},
                          .meaning = "kinematic, at 40 deg C and atmospheric pressure",
                          .practice = "ISO VG 46: 46"},
                         {.key = "viscosity_100C_cSt",
                          .field = FIELD(c.hydraulics->oil->viscosity_100),
                          .symbol = "nu_100",
                          .unit = kCentistokes,
                          .range = {1, 1e5},
                          .range_words = "[1, 1e+05], below that at 40 deg C",
                          .fallback = {6.8},
                          .meaning = "the same at 100 deg C",
                          .practice = "ISO VG 46, viscosity index 100: 6.8"},
                         {.key = "pressure_viscosity_per_GPa",
                          .field = FIELD(c.hydraulics->oil->pressure_viscosity),
                          .symbol = "alpha",
                          .unit = kPerGigapascal,
                          .range = {0, 100},
                          .fallback = {20.0},
                          .meaning = "viscosity grows as exp(alpha p)",
                          .practice = "mineral oil: 15..25"}},
          .rules = {{.key = "viscosity_100C_cSt",
                     .after = "viscosity_100C_cSt",
                     .broken = viscosity_refusal}}};
}

}  // namespace bentaxis::tables
