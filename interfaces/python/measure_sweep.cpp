// The sweep of scripts/measure_python by the library alone: prints designs and seconds.
#include <cstdio>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/results/stopwatch.h"

int main(int argc, char** argv) {
  using namespace bentaxis;
  if (argc != 2) return 2;
  const Case base = read_case(argv[1]);
  designs::SweepRequest request;
  request.vary = {{"pump.tilt_deg", "20:40:#100"},
                  {"pressure.delivery_bar", "50:400:#100"},
                  {"operation.speed_rpm", "500:2500:#10"}};
  request.outputs = {"max:Rb1_z1", "peak:Rb1", "peak:Rb2", "mean:Td"};
  const Stopwatch watch;
  const designs::SweepResult result =
      designs::compute_in_memory(designs::Sweep(base, designs::sweep_plan(request, base)), 0);
  std::printf("%zu %.6f\n", result.designs, watch.seconds());
  return result.infeasible.empty() ? 0 : 1;
}
