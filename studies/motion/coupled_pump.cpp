#include "coupled_pump.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::study {
namespace {

std::unique_ptr<Oil> oil_of(const PreparedCase& ready, bool follows) {
  const Case& c = ready.the_case;
  if (!follows)
    return coupled::prescribed_oil(c.pump.geometry.pistons, ready.pressure, c.pressure.ports);
  hydraulics::OilStart start;
  if (ready.hydraulics)
    start = hydraulics::starts_periodic(c) ? hydraulics::running(*ready.hydraulics)
                                           : hydraulics::at_rest(*ready.hydraulics);
  return hydraulics::oil_in_time(c, start);
}

}  // namespace

double mass_passed(const Trajectory& run) {
  const OilHistory& oil = *run.oil;
  double mass = std::max(std::abs(oil.mass_in), std::abs(oil.mass_out));
  double circulated = 0;
  for (std::size_t c = 0; c < oil.columns.size(); ++c) {
    if (oil.columns[c].name != "flow_delivery_l_per_min") continue;
    constexpr double kUsualDensity = 850;  // kg/m3: a scale need not be exact
    for (std::size_t row = 1; row < run.lag.size(); ++row)
      circulated += std::abs(oil.value(row, c)) * kLitrePerMinute * kUsualDensity *
                    (run.state(row, StateColumn::time) - run.state(row - 1, StateColumn::time));
  }
  return std::max(mass, circulated);
}

CoupledPump::CoupledPump(const PreparedCase& ready, bool follows)
    : ready_(ready), oil_(oil_of(ready, follows)) {}

std::unique_ptr<Mechanics> CoupledPump::mechanics(Model model) const {
  const Assumptions& assumptions = ready_.assumptions(model);
  return model == Model::analytic ? analytic::mechanics(ready_.the_case, assumptions)
                                  : multibody::mechanics(ready_.the_case, assumptions);
}

Trajectory CoupledPump::simulate(Model model, const coupled::Options& options,
                                 const Progress& progress) const {
  return coupled::simulate(to_string(model), *mechanics(model), *oil_, *ready_.the_case.drive,
                           options, progress);
}

coupled::SteadyMotion CoupledPump::steady(Model model, const coupled::Options& options,
                                          const Progress& progress) const {
  return coupled::steady(to_string(model), *mechanics(model), *oil_, *ready_.the_case.drive,
                         options, progress);
}

}  // namespace bentaxis::study
