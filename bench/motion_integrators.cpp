// Which method for the motion of shaft, block and rotor? The same pieces of the motor case, their
// ends given, by extrapolation, multistep methods and Runge-Kutta pairs: evaluations of the
// equations of motion, time, and error of the state at the end. Prints a Markdown table
// (docs/motion.md).
#include <arkode/arkode_erkstep.h>
#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "bentaxis/files/case_file.h"
#include "bentaxis/results/stopwatch.h"
#include "simulation/pieces.h"

namespace {

using namespace bentaxis;
using namespace bentaxis::analytic::simulation;

// Rounding of a state's size: no tolerance below it can be met.
constexpr double kRounding = 1e-15;
constexpr long kMaxSteps = 1000000;

// States over their scales.
struct Problem {
  Equations equations;
  State scale;
  std::vector<Piece> pieces;

  explicit Problem(const Case& the_case, const PressureTrace& pressure)
      : equations(the_case, the_case.analytic, pressure), scale(equations.scales()) {
    analytic::SimulationOptions best;
    best.accuracy = 1e-14;
    analytic::simulation::simulate(the_case, the_case.analytic, pressure, best, pieces);
  }
  void rates(double time, const double* y, double* dy) {
    State at, rate;
    for (std::size_t i = 0; i < kMotionStates; ++i) at[i] = y[i] * scale[i];
    equations.rates(time, at, rate);
    for (std::size_t i = 0; i < kMotionStates; ++i) dy[i] = rate[i] / scale[i];
  }
  State start() const {
    State y = pieces.front().state;
    for (std::size_t i = 0; i < kMotionStates; ++i) y[i] /= scale[i];
    return y;
  }
  // Runs a method over the pieces: advance(from, to) takes the state from one time to another.
  void over_pieces(double* y, const std::function<void(double, double)>& advance) {
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      const Piece& piece = pieces[i];
      equations.teeth = piece.teeth;
      equations.from_angle = piece.from_angle;
      equations.to_angle = piece.to_angle;
      if (piece.state[kImpulse] == 0) y[kImpulse] = 0;
      if (pieces[i + 1].time > piece.time) advance(piece.time, pieces[i + 1].time);
    }
  }
  // Largest error of the motion at the end, in units of the scales.
  double error(const double* y) const {
    double worst = 0;
    for (std::size_t i = 0; i < kWorkOfLoads; ++i)
      worst = std::max(worst, std::abs(y[i] - pieces.back().state[i] / scale[i]));
    return worst;
  }
};

int rates_for_sundials(realtype time, N_Vector y, N_Vector dy, void* problem) {
  static_cast<Problem*>(problem)->rates(time, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

void check(int flag) {
  if (flag < 0) throw std::runtime_error("SUNDIALS gives up: " + std::to_string(flag));
}

struct Cost {
  long evaluations = 0;
  double seconds = 0, error = 0;
};
using Method = std::function<void(Problem&, double* y, double tolerance)>;

Cost cost_of(Problem& problem, const Method& method, double tolerance) {
  State y = problem.start();
  const long before = problem.equations.evaluations();
  const Stopwatch watch;
  method(problem, y.data(), tolerance);
  // Three evaluations of the closed form are one of the equations of motion.
  return {(problem.equations.evaluations() - before) / 3, watch.seconds(), problem.error(y.data())};
}

void extrapolation(Problem& problem, double* y, double tolerance) {
  boost::numeric::odeint::bulirsch_stoer<State> method(tolerance, kRounding, 1.0, 0.0);
  const auto system = [&](const State& at, State& rate, double time) {
    problem.rates(time, at.data(), rate.data());
  };
  double next = 1e-5;
  problem.over_pieces(y, [&](double time, double end) {
    while (time < end) {
      State from, slope, to;
      std::copy(y, y + kMotionStates, from.begin());
      system(from, slope, time);
      double step = std::min(next, end - time);
      const double taken = step;
      if (method.try_step(system, from, slope, time, to, step) != boost::numeric::odeint::success) {
        next = std::min(step, taken / 2);
        continue;
      }
      // try_step() has moved the time.
      if (end - time < 1e-16 * end) time = end;
      next = taken < next ? std::max(next, step) : step;
      std::copy(to.begin(), to.end(), y);
    }
  });
}

void multistep(int kind, Problem& problem, double* y, double tolerance) {
  SUNContext context = nullptr;
  check(SUNContext_Create(nullptr, &context));
  const N_Vector state = N_VMake_Serial(kMotionStates, y, context);
  void* const memory = CVodeCreate(kind, context);
  check(CVodeInit(memory, rates_for_sundials, 0, state));
  check(CVodeSStolerances(memory, kRounding, tolerance));
  check(CVodeSetUserData(memory, &problem));
  check(CVodeSetMaxNumSteps(memory, kMaxSteps));
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  SUNNonlinearSolver fixed_point = nullptr;
  if (kind == CV_ADAMS) {
    fixed_point = SUNNonlinSol_FixedPoint(state, 0, context);
    check(CVodeSetNonlinearSolver(memory, fixed_point));
  } else {
    matrix = SUNDenseMatrix(kMotionStates, kMotionStates, context);
    linear = SUNLinSol_Dense(state, matrix, context);
    check(CVodeSetLinearSolver(memory, linear, matrix));
  }
  problem.over_pieces(y, [&](double from, double to) {
    check(CVodeReInit(memory, from, state));
    check(CVodeSetStopTime(memory, to));
    realtype reached = 0;
    check(CVode(memory, to, state, &reached, CV_NORMAL));
  });
  void* freed = memory;
  CVodeFree(&freed);
  if (fixed_point != nullptr) SUNNonlinSolFree(fixed_point);
  if (linear != nullptr) SUNLinSolFree(linear);
  if (matrix != nullptr) SUNMatDestroy(matrix);
  N_VDestroy(state);
  SUNContext_Free(&context);
}

void runge_kutta(ARKODE_ERKTableID table, Problem& problem, double* y, double tolerance) {
  SUNContext context = nullptr;
  check(SUNContext_Create(nullptr, &context));
  const N_Vector state = N_VMake_Serial(kMotionStates, y, context);
  void* const memory = ERKStepCreate(rates_for_sundials, 0, state, context);
  check(ERKStepSStolerances(memory, kRounding, tolerance));
  check(ERKStepSetUserData(memory, &problem));
  check(ERKStepSetMaxNumSteps(memory, kMaxSteps));
  check(ERKStepSetTableNum(memory, table));
  problem.over_pieces(y, [&](double from, double to) {
    check(ERKStepReInit(memory, rates_for_sundials, from, state));
    check(ERKStepSetStopTime(memory, to));
    realtype reached = 0;
    check(ERKStepEvolve(memory, to, state, &reached, ARK_NORMAL));
  });
  void* freed = memory;
  ERKStepFree(&freed);
  N_VDestroy(state);
  SUNContext_Free(&context);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string file =
        argc > 1 ? argv[1] : BENTAXIS_SOURCE_DIR "/reference_data/motion/motor_driven/case.toml";
    const Case the_case = read_case(file);
    const PressureTrace pressure(the_case.pressure);
    Problem problem(the_case, pressure);
    using std::placeholders::_1, std::placeholders::_2, std::placeholders::_3;
    const std::pair<const char*, Method> methods[] = {
        {"Gragg-Bulirsch-Stoer (Boost.Odeint)", extrapolation},
        {"CVODE, Adams (SUNDIALS)", std::bind(multistep, CV_ADAMS, _1, _2, _3)},
        {"CVODE, BDF", std::bind(multistep, CV_BDF, _1, _2, _3)},
        {"ARKODE, Fehlberg 8(7)", std::bind(runge_kutta, ARKODE_FEHLBERG_13_7_8, _1, _2, _3)},
        {"ARKODE, Verner 6(5)", std::bind(runge_kutta, ARKODE_VERNER_8_5_6, _1, _2, _3)}};
    const double tolerances[] = {1e-9, 1e-11, 1e-13};
    fmt::print("| method, tolerance per step | 1e-9 | 1e-11 | 1e-13 |\n|---|---|---|---|\n");
    for (const auto& [name, method] : methods) {
      fmt::print("| {} |", name);
      for (const double tolerance : tolerances) {
        const Cost cost = cost_of(problem, method, tolerance);
        fmt::print(" {}, {:.3f} s: {:.0e} |", cost.evaluations, cost.seconds, cost.error);
      }
      fmt::print("\n");
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "motion_integrators: %s\n", error.what());
    return 3;
  }
}
