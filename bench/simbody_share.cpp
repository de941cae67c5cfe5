// How much of an evaluation of the multibody model is Simbody itself? Its realizations at one angle
// of the default pump, which no model built on it can leave out, beside the whole evaluation.
// Prints a Markdown table (docs/speed.md); ratios within one run count.
#include <SimTKsimbody.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/units.h"
#include "placement/placement.h"
#include "scene_facts.h"

namespace {

using namespace bentaxis;
using multibody::Method;
using multibody::Scene;
using SimTK::Stage;

// Processor time of a call, us: the least of some rounds.
template <class Call>
double microseconds(const Call& call) {
  constexpr int kRounds = 7, kCalls = 2000;
  double least = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    const std::clock_t from = std::clock();
    for (int i = 0; i < kCalls; ++i) call();
    const double seconds = static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
    least = std::min(least, 1e6 * seconds / kCalls);
  }
  return least;
}

void measure(const Case& the_case, Scene scene, Method method) {
  const double speed = rad_per_second(the_case.operation.speed_rpm);
  const AxisMotion turning{0.7, speed, 0};
  Instant instant;
  instant.turn(turning.angle, speed);
  instant.chamber_pressure.assign(static_cast<std::size_t>(the_case.pump.geometry.pistons), 100e5);
  multibody::Model model(the_case.pump, the_case.multibody, speed, scene, method);
  std::vector<double> values(model.layout().size());
  const double all = microseconds([&] {
    if (scene == Scene::piston)
      model.evaluate_one(instant, values);
    else
      model.evaluate(instant, values);
  });

  multibody::PumpSystem pump(multibody::built_pump(the_case.pump, scene), the_case.multibody, speed,
                             multibody::drive_of(scene));
  multibody::Placement(pump).place(turning, turning);
  SimTK::State& state = pump.dynamics();
  const auto simbody = [&](Stage to, bool place) {
    pump.system().realize(state, to);
    return microseconds([&] {
      if (place)
        state.updQ();  // whoever asks for them to write invalidates what follows from them
      else
        state.invalidateAllCacheAtOrAbove(Stage::Acceleration);
      pump.system().realize(state, to);
    });
  };
  const double to_dynamics = simbody(Stage::Dynamics, true);
  const double accelerations =
      method == Method::multipliers ? simbody(Stage::Acceleration, false) : 0;
  std::printf("| %s, %s | %.2f us | %.2f us | %.2f us | %.0f %% |\n",
              multibody::scene_names()[static_cast<std::size_t>(scene)].c_str(),
              multibody::method_names()[static_cast<std::size_t>(method)].c_str(), all, to_dynamics,
              accelerations, 100 * (to_dynamics + accelerations) / all);
}

}  // namespace

int main() {
  try {
    const Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
    std::puts("| scene | an evaluation | positions to loads | accelerations | Simbody's share |");
    std::puts("|---|---|---|---|---|");
    measure(the_case, Scene::full, Method::multipliers);
    measure(the_case, Scene::full, Method::residual);
    measure(the_case, Scene::piston, Method::residual);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "simbody_share: %s\n", e.what());
    return 1;
  }
}
