// Evaluates both models at one instant, sweeps over the tilt, compares both on a hydraulic case in
// one call, then both with the engines of others that are installed.
// usage: uses_bentaxis CASE HYDRAULIC_CASE
#include <cmath>
#include <cstdio>
#include <memory>

#include "bentaxis/analytic/model.h"
#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/engines/run.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/engine_comparison.h"

int main(int, char** argv) {
  const bentaxis::Case the_case = bentaxis::read_case(argv[1]);
  const bentaxis::analytic::Model analytic(the_case.pump, the_case.analytic);
  bentaxis::multibody::Model multibody(the_case.pump, the_case.multibody, 1);
  bentaxis::Instant now;
  now.turn(0.5, 157.0);
  now.chamber_pressure.assign(the_case.pump.geometry.pistons, 100e5);
  std::vector<double> a(analytic.layout().size());
  std::vector<double> m(analytic.layout().size());
  analytic.evaluate(now, a);
  multibody.evaluate(now, m);
  const double torque = a[analytic.layout().Td()];
  const double difference = std::abs(m[analytic.layout().Td()] - torque);
  std::printf("Td = %.6f Nm, difference %.1e Nm\n", torque, difference);

  // A sweep of three designs, kept in block files and written with what the library was built with.
  bentaxis::designs::SweepRequest request;
  request.vary = {{"pump.tilt_deg", "20:40:10"}};
  request.outputs = {"mean:Td"};
  const bentaxis::designs::Sweep sweep(the_case, bentaxis::designs::sweep_plan(request, the_case));
  const bentaxis::designs::SweepParts parts("parts", bentaxis::designs::record_of(sweep, "test"));
  parts.begin();
  bentaxis::designs::compute_blocks(sweep, parts, {}, [](double) {});
  bentaxis::OutputFolder folder("out");
  const auto designs = bentaxis::designs::write_sweep(
      sweep, parts, {.csv = true, .hdf5 = bentaxis::designs::has_hdf5()}, folder, 0, [](double) {});
  std::printf("mean torque at 40 deg: %.6f Nm\n", designs.results.at(2));

  const auto result = bentaxis::study::compare_models(bentaxis::read_case(argv[2]), {}, {});
  std::printf("%s\n", result.headline().c_str());

  bentaxis::study::EngineOptions engines;
  engines.names = bentaxis::engines::installed_engines();
  bool agree = true;
  if (!engines.names.empty()) {
    bentaxis::study::ComparisonOptions options;
    options.engines = std::make_shared<bentaxis::study::EngineOptions>(engines);
    const auto beside = bentaxis::study::compare_models(the_case, {}, options);
    for (const std::string& failure : beside.engines->failures())
      std::printf("%s\n", failure.c_str());
    std::printf("%s\n", beside.engines->headline().c_str());
    agree = beside.engines->failures().empty() && beside.engines->agrees();
  }
  return difference < 1e-9 && result.agrees() && result.first.hydraulics && agree ? 0 : 1;
}
