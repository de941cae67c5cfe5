// Time per shaft angle of each multibody scene and method, all in one run: only their ratios are
// comparable between machines.
#include <benchmark/benchmark.h>

#include "bentaxis/files/case_file.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/case.h"

namespace {

using namespace bentaxis;

// One turn in steps of half a degree, over and over.
void evaluate(benchmark::State& bench, multibody::Scene scene, multibody::Method method,
              PistonInertia inertia) {
  Case the_case = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml");
  the_case.multibody.inertia = inertia;
  if (inertia == PistonInertia::real)
    the_case.pump.piston.real = PistonMass::Real{0.019, 24e-6, 5e-6, 0};
  const Samples samples = sample_case(the_case, PressureTrace(the_case.pressure));
  multibody::Model model(the_case.pump, the_case.multibody, samples.omega, scene, method);
  std::vector<double> values(model.layout().size());
  Instant instant;
  std::size_t row = 0;
  for (auto _ : bench) {
    samples.instant(row, instant);
    if (++row == samples.theta_deg.size()) row = 0;
    if (scene == multibody::Scene::piston)
      model.evaluate_one(instant, values);
    else
      model.evaluate(instant, values);
    benchmark::DoNotOptimize(values.data());
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const PistonInertia inertia : {PistonInertia::lumped, PistonInertia::real})
    for (std::size_t m = 0; m < multibody::method_names().size(); ++m)
      for (std::size_t s = 0; s < multibody::scene_names().size(); ++s)
        benchmark::RegisterBenchmark((multibody::scene_names()[s] + "/" +
                                      multibody::method_names()[m] + "/" + to_string(inertia))
                                         .c_str(),
                                     evaluate, static_cast<multibody::Scene>(s),
                                     static_cast<multibody::Method>(m), inertia)
            ->Unit(benchmark::kMicrosecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
