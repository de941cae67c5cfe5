#include "integrator.h"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "bentaxis/hydraulics/versions.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::hydraulics {
namespace {

// Effort is counted in steps x states, with sensitivities x states again: about a microsecond each.
// A usual operating point takes 1e5, the wildest of our tests that ends 3e6. A delivery line has
// more states, of which each step costs less and more are taken.
constexpr double kMaxEffort = 1.5e7;
// Error per step of sensitivities with a delivery line.
constexpr double kForWaves = 1e-4;
constexpr int kUsualStates = 8;
double most_effort(const Network& network) {
  return kMaxEffort * std::max(1.0, static_cast<double>(network.states()) / kUsualStates);
}
constexpr double kEffortBetweenSigns = 1e4;  // of life
constexpr int kIntegrals = 5;

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

// What the callbacks of CVODES work on.
struct Problem {
  const Network& network;
  double load_size = 0;
  Network::Flows flows;
  const std::vector<Direction>& directions;
  std::vector<double> by_state, by_load, above, below;  // of the sensitivity equations
  double mass_scale = 1;  // kg/degree: of the integrals, for their error control
  double work_scale = 1;
  bool energies = false;                // the integrals wanted are those of power by place
  std::exception_ptr thrown = nullptr;  // by a callback: no exception may pass through C
};

// Negative: CVODES ends the step, and whoever called it throws on.
template <class Function>
int guarded(void* user, const Function& function) {
  auto& problem = *static_cast<Problem*>(user);
  try {
    return function(problem);
  } catch (...) {
    problem.thrown = std::current_exception();
    return -1;
  }
}

int rates(realtype x, N_Vector y, N_Vector dy, void* user) {
  return guarded(user, [&](const Problem& problem) {
    return problem.network.rates(x, data(y), problem.load_size, data(dy)) ? 0 : 1;
  });
}

int jacobian(realtype x, N_Vector y, N_Vector, SUNMatrix matrix, void* user, N_Vector, N_Vector,
             N_Vector) {
  return guarded(user, [&](Problem& problem) {
    problem.network.jacobian(x, data(y), problem.load_size, SUNDenseMatrix_Data(matrix),
                             problem.by_load.data());
    return 0;
  });
}

int sensitivity_rates(Problem& problem, int count, double x, N_Vector y, N_Vector* s,
                      N_Vector* ds) {
  const Network& network = problem.network;
  network.jacobian(x, data(y), problem.load_size, problem.by_state.data(), problem.by_load.data());
  const int size = network.size();
  const int first_direction = count - static_cast<int>(problem.directions.size());
  for (int j = 0; j < count; ++j) {
    double* to = data(ds[j]);
    const double* from = data(s[j]);
    if (j >= first_direction) {
      const Direction& way = problem.directions[j - first_direction];
      if (!way.above->rates(x, data(y), way.above_load, problem.above.data()) ||
          !way.below->rates(x, data(y), way.below_load, problem.below.data()))
        return 1;
      for (int row = 0; row < size; ++row)
        to[row] = (problem.above[row] - problem.below[row]) / way.apart;
    } else {
      for (int row = 0; row < size; ++row)
        to[row] = j < network.states() ? 0 : problem.by_load[row];
    }
    for (int column = 0; column < size; ++column) {
      if (from[column] == 0) continue;
      const double* entries = problem.by_state.data() + column * size;
      for (int row = 0; row < size; ++row) to[row] += entries[row] * from[column];
    }
  }
  return 0;
}

int sensitivity_rates(int count, realtype x, N_Vector y, N_Vector, N_Vector* s, N_Vector* ds,
                      void* user, N_Vector, N_Vector) {
  return guarded(user,
                 [&](Problem& problem) { return sensitivity_rates(problem, count, x, y, s, ds); });
}

int integral_rates(Problem& problem, double x, N_Vector y, N_Vector dq) {
  const Network& network = problem.network;
  network.flows(x, data(y), problem.load_size, problem.flows);
  double* to = data(dq);
  if (problem.energies) {
    const PowerBudget power = network.power(x, data(y), problem.flows);
    const double work = network.seconds_per_degree() / problem.work_scale;
    for (int i = 0; i < network.place_count(); ++i) to[i] = power[static_cast<Place>(i)] * work;
    return 0;
  }
  std::fill(to, to + kIntegrals, 0.0);
  const double mass = network.seconds_per_degree() / problem.mass_scale;
  for (int k = 0; k < network.pistons(); ++k) {
    to[0] += problem.flows.suction[k] * mass;
    to[1] += problem.flows.delivery[k] * mass;
    to[2] += problem.flows.leakage[k] * mass;
  }
  to[3] = problem.flows.load * mass;
  to[4] = problem.flows.power * network.seconds_per_degree() / problem.work_scale;
  return 0;
}

int integral_rates(realtype x, N_Vector y, N_Vector dq, void* user) {
  return guarded(user, [&](Problem& problem) { return integral_rates(problem, x, y, dq); });
}

Integrals in_units(const Problem& problem, const double* q) {
  return {q[0] * problem.mass_scale, q[1] * problem.mass_scale, q[2] * problem.mass_scale,
          q[3] * problem.mass_scale, q[4] * problem.work_scale};
}

void be_silent(int, const char*, const char*, char*, void*) {}

}  // namespace

// Everything CVODES allocates for one integration.
struct Integrator::Implementation {
  SUNContext context = nullptr;
  N_Vector y = nullptr, integrals = nullptr, sampled = nullptr, sampled_integrals = nullptr;
  N_Vector* sensitivity = nullptr;
  int sensitivities = 0;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
  void* memory = nullptr;

  Implementation() {
    if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    if (memory != nullptr) CVodeFree(&memory);
    if (solver != nullptr) SUNLinSolFree(solver);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (sensitivity != nullptr) N_VDestroyVectorArray(sensitivity, sensitivities);
    for (N_Vector v : {y, integrals, sampled, sampled_integrals})
      if (v != nullptr) N_VDestroy(v);
    SUNContext_Free(&context);
  }
};

std::string sundials_version() {
  char text[32] = "";
  return SUNDIALSGetVersion(text, sizeof text) == 0 ? text : "unknown";
}

Integrator::Integrator(const Network& network, std::function<void()> alive)
    : network_(network), alive_(std::move(alive)) {}

void Integrator::follow(std::vector<Direction> directions, double tolerance) {
  directions_ = std::move(directions);
  directions_tolerance_ = tolerance;
}

double Integrator::share_of_effort() const { return effort_ / most_effort(network_); }

std::vector<double> Integrator::over_period(const std::vector<double>& states, double load_size,
                                            double tolerance, std::vector<double>* sensitivity,
                                            Integrals* integrals, const Watch& watch,
                                            PowerBudget* energy) {
  const int size = network_.size();
  Problem problem{network_, load_size, {}, directions_, {}, {}, {}, {}, 1, 1, energy != nullptr};
  problem.by_state.resize(static_cast<std::size_t>(size) * size);
  problem.by_load.resize(size);
  problem.above.resize(size);
  problem.below.resize(size);
  // Integrals are scaled to the mass and the work of one piston's stroke at delivery pressure.
  const double stroke = network_.chamber().swept();
  problem.mass_scale = network_.fluid().state(0).density * stroke;
  problem.work_scale =
      stroke * std::max(network_.delivery_pressure(), network_.fluid().atmosphere());

  double reached = 0;
  const auto fail = [&](const std::string& why) {
    throw IntegrationFailure("hydraulics: the time integration stops at a shaft angle of " +
                             number_text(reached) + " deg: " + why);
  };
  const auto check = [&](int flag) {
    if (flag >= 0) return;
    if (problem.thrown) std::rethrow_exception(problem.thrown);
    if (flag == CV_TOO_MUCH_ACC)
      fail("[hydraulics] tolerance asks for more than double precision gives there");
    fail("the pressures change faster there than steps above round-off can follow");
  };
  Implementation cv;
  cv.y = N_VNew_Serial(size, cv.context);
  cv.sampled = N_VNew_Serial(size, cv.context);
  cv.matrix = SUNDenseMatrix(size, size, cv.context);
  if (cv.y == nullptr || cv.sampled == nullptr || cv.matrix == nullptr) throw std::bad_alloc();
  std::copy(states.begin(), states.end(), data(cv.y));
  if (size > network_.states()) data(cv.y)[size - 1] = 0;
  cv.solver = SUNLinSol_Dense(cv.y, cv.matrix, cv.context);
  cv.memory = CVodeCreate(CV_BDF, cv.context);
  if (cv.memory == nullptr || cv.solver == nullptr) throw std::bad_alloc();
  check(CVodeSetErrHandlerFn(cv.memory, be_silent, nullptr));
  check(CVodeInit(cv.memory, rates, 0, cv.y));
  check(CVodeSStolerances(cv.memory, 0, tolerance));
  check(CVodeSetUserData(cv.memory, &problem));
  check(CVodeSetLinearSolver(cv.memory, cv.solver, cv.matrix));
  check(CVodeSetJacFn(cv.memory, jacobian));
  if (sensitivity != nullptr) {
    cv.sensitivities =
        network_.states() + (network_.load_sought() ? 1 : 0) + static_cast<int>(directions_.size());
    cv.sensitivity = N_VCloneVectorArray(cv.sensitivities, cv.y);
    if (cv.sensitivity == nullptr) throw std::bad_alloc();
    for (int j = 0; j < cv.sensitivities; ++j) {
      N_VConst(0, cv.sensitivity[j]);
      if (j < network_.states()) data(cv.sensitivity[j])[j] = 1;
    }
    check(CVodeSensInit(cv.memory, cv.sensitivities, CV_SIMULTANEOUS, sensitivity_rates,
                        cv.sensitivity));
    // They serve as the Jacobian of a Newton iteration: the states set the steps. But a mode of a
    // delivery line that the states do not excite would be followed in steps far too long.
    const bool waves = network_.has_delivery_line();
    const bool as_result = !directions_.empty();
    const double sensitivity_tolerance = as_result ? directions_tolerance_
                                         : waves   ? std::max(tolerance, kForWaves)
                                                   : tolerance;
    std::vector<double> absolute(cv.sensitivities, sensitivity_tolerance);
    check(CVodeSensSStolerances(cv.memory, sensitivity_tolerance, absolute.data()));
    check(CVodeSetSensErrCon(cv.memory, waves || as_result ? SUNTRUE : SUNFALSE));
  }
  const bool integrate = integrals != nullptr || energy != nullptr;
  if (integrate) {
    const int count = energy != nullptr ? network_.place_count() : kIntegrals;
    cv.integrals = N_VNew_Serial(count, cv.context);
    cv.sampled_integrals = N_VNew_Serial(count, cv.context);
    if (cv.integrals == nullptr || cv.sampled_integrals == nullptr) throw std::bad_alloc();
    N_VConst(0, cv.integrals);
    check(CVodeQuadInit(cv.memory, integral_rates, cv.integrals));
    check(CVodeQuadSStolerances(cv.memory, 0, tolerance));
    check(CVodeSetQuadErrCon(cv.memory, SUNTRUE));
  }

  std::vector<double> sampled_sensitivity;
  const auto copy_sensitivities = [&](std::vector<double>& to) {
    to.clear();
    for (int j = 0; j < cv.sensitivities; ++j)
      to.insert(to.end(), data(cv.sensitivity[j]), data(cv.sensitivity[j]) + size);
  };
  Step taken;
  taken.state = [&](double x) -> const double* {
    check(CVodeGetDky(cv.memory, x, 0, cv.sampled));
    return data(cv.sampled);
  };
  taken.integrals = [&](double x) {
    check(CVodeGetQuadDky(cv.memory, x, 0, cv.sampled_integrals));
    return in_units(problem, data(cv.sampled_integrals));
  };

  taken.sensitivities = [&](double x) -> const std::vector<double>& {
    check(CVodeGetSensDky(cv.memory, x, 0, cv.sensitivity));
    copy_sensitivities(sampled_sensitivity);
    return sampled_sensitivity;
  };

  std::vector<double> stops = network_.edges_deg();
  stops.push_back(network_.period_deg());
  const double effort = size * (sensitivity != nullptr ? size : 1);
  for (const double stop : stops) {
    check(CVodeSetStopTime(cv.memory, stop));
    long steps = 0;
    for (int flag = 0; flag != CV_TSTOP_RETURN; ++steps) {
      taken.from = reached;
      flag = CVode(cv.memory, stop, cv.y, &reached, CV_ONE_STEP);
      check(flag);
      taken.to = reached;
      taken.at_edge = flag == CV_TSTOP_RETURN;
      if (watch) watch(taken);
      effort_ += effort;
      if (effort_ > most_ * most_effort(network_))
        throw ComputationError(
            "hydraulics: no periodic state within " + std::to_string(work_.steps + steps) +
            " steps: the pressures are too stiff (see transition_pressure_bar, dead_volume_cm3, "
            "delivery_volume_l" +
            (network_.has_delivery_line() ? ", bandwidth_Hz of [delivery_line])" : ")"));
      if (alive_ && (since_sign_ += effort) > kEffortBetweenSigns) {
        since_sign_ = 0;
        alive_();
      }
    }
    long evaluations = 0, setups = 0;
    CVodeGetNumRhsEvals(cv.memory, &evaluations);
    CVodeGetNumLinSolvSetups(cv.memory, &setups);
    work_.steps += steps;
    work_.evaluations += evaluations;
    work_.factorizations += setups;
    double at = 0;
    if (integrate) check(CVodeGetQuad(cv.memory, &at, cv.integrals));
    if (sensitivity != nullptr) check(CVodeGetSens(cv.memory, &at, cv.sensitivity));
    if (stop == stops.back()) break;
    // The slopes of the areas jump here: start again at order 1 instead of stepping over it.
    check(CVodeReInit(cv.memory, stop, cv.y));
    if (integrate) check(CVodeQuadReInit(cv.memory, cv.integrals));
    if (sensitivity != nullptr) check(CVodeSensReInit(cv.memory, CV_SIMULTANEOUS, cv.sensitivity));
  }
  if (energy != nullptr)
    for (int i = 0; i < network_.place_count(); ++i)
      (*energy)[static_cast<Place>(i)] = data(cv.integrals)[i] * problem.work_scale;
  else if (integrals != nullptr)
    *integrals = in_units(problem, data(cv.integrals));
  if (sensitivity != nullptr) copy_sensitivities(*sensitivity);
  return {data(cv.y), data(cv.y) + size};
}

}  // namespace bentaxis::hydraulics
