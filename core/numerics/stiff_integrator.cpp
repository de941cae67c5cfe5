#include "bentaxis/numerics/stiff_integrator.h"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <new>

#include "serial_vectors.h"

namespace bentaxis::numerics {
namespace {

using Reason = IntegrationFailure::Reason;

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

void be_silent(int, const char*, const char*, char*, void*) {}

void check(int flag) {
  if (flag >= 0) return;
  if (flag == CV_TOO_MUCH_ACC) throw IntegrationFailure(Reason::tolerance);
  if (flag == CV_FIRST_RHSFUNC_ERR || flag == CV_REPTD_RHSFUNC_ERR || flag == CV_UNREC_RHSFUNC_ERR)
    throw IntegrationFailure(Reason::no_rates);
  throw IntegrationFailure(Reason::step);
}

}  // namespace

std::string text_of(Reason reason, const std::string& states) {
  switch (reason) {
    case Reason::tolerance:
      return "the tolerance is tighter than double precision allows there";
    case Reason::no_rates:
      return "the rates of change of " + states + " are not finite from there on";
    case Reason::step:
      break;
  }
  return states + " change too fast there: the step falls below round-off";
}

IntegrationFailure::IntegrationFailure(Reason reason)
    : std::runtime_error(text_of(reason, "the states")), reason_(reason) {}

std::string sundials_version() {
  char text[32] = "";
  return SUNDIALSGetVersion(text, sizeof text) == 0 ? text : "unknown";
}

// What CVODES allocates, and what its callbacks work on.
struct StiffIntegrator::Implementation {
  Equations& equations;
  std::exception_ptr thrown;     // by the last callback; no exception may pass through C
  std::exception_ptr complaint;  // the last one that a shorter step was to avoid
  long failures = 0;             // of Newton's method, when the Jacobian was last asked for
  double weight = 0;             // of every state's error

  SUNContext context = nullptr;
  N_Vector y = nullptr, integrals = nullptr, sampled = nullptr, sampled_integrals = nullptr;
  N_Vector* sensitivities = nullptr;
  int count = 0;  // of the sensitivities
  std::vector<double> sampled_sensitivities;
  std::vector<const double*> columns;  // for a callback
  std::vector<double*> rates_of_columns;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
  void* memory = nullptr;

  explicit Implementation(Equations& of) : equations(of) {
    if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    if (memory != nullptr) CVodeFree(&memory);
    if (solver != nullptr) SUNLinSolFree(solver);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    if (sensitivities != nullptr) N_VDestroyVectorArray(sensitivities, count);
    for (N_Vector v : {y, integrals, sampled, sampled_integrals})
      if (v != nullptr) N_VDestroy(v);
    SUNContext_Free(&context);
  }

  N_Vector vector(int size) const {
    N_Vector v = N_VNew_Serial(size, context);
    if (v == nullptr) throw std::bad_alloc();
    serial::use_loops(v);
    N_VConst(0, v);
    return v;
  }
  void copy_sensitivities() {
    const int size = equations.states();
    sampled_sensitivities.clear();
    for (int j = 0; j < count; ++j)
      sampled_sensitivities.insert(sampled_sensitivities.end(), data(sensitivities[j]),
                                   data(sensitivities[j]) + size);
  }

  // Positive: CVODES may try a shorter step. Negative: it ends the step, and whoever called it
  // throws on.
  template <class Function>
  static int guarded(void* user, Function&& function) {
    auto& cv = *static_cast<Implementation*>(user);
    try {
      const bool done = function(cv);
      cv.thrown = nullptr;  // what was thrown before has been avoided
      return done ? 0 : 1;
    } catch (const std::exception& error) {
      cv.thrown = std::current_exception();
      if (!cv.equations.is_recoverable(error)) return -1;
      cv.complaint = cv.thrown;
      return 1;
    } catch (...) {
      cv.thrown = std::current_exception();
      return -1;
    }
  }
  // An error counts as it is, whatever the states.
  static int weights(N_Vector, N_Vector all, void* user) {
    N_VConst(static_cast<Implementation*>(user)->weight, all);
    return 0;
  }
  static int rates(realtype t, N_Vector y, N_Vector dy, void* user) {
    return guarded(user,
                   [&](Implementation& cv) { return cv.equations.rates(t, data(y), data(dy)); });
  }
  static int jacobian(realtype t, N_Vector y, N_Vector dy, SUNMatrix by_state, void* user, N_Vector,
                      N_Vector, N_Vector) {
    return guarded(user, [&](Implementation& cv) {
      long now = 0;
      CVodeGetNumNonlinSolvConvFails(cv.memory, &now);
      const bool again = now != cv.failures;
      cv.failures = now;
      cv.equations.jacobian(t, data(y), data(dy), again, SUNDenseMatrix_Data(by_state));
      return true;
    });
  }
  static int integrands(realtype t, N_Vector y, N_Vector dq, void* user) {
    return guarded(user, [&](Implementation& cv) {
      cv.equations.integrands(t, data(y), data(dq));
      return true;
    });
  }
  static int event_values(realtype t, N_Vector y, realtype* values, void* user) {
    return guarded(user, [&](Implementation& cv) {
      cv.equations.event_values(t, data(y), values);
      return true;
    });
  }
  static int sensitivity_rates(int count, realtype t, N_Vector y, N_Vector, N_Vector* s,
                               N_Vector* ds, void* user, N_Vector, N_Vector) {
    return guarded(user, [&](Implementation& cv) {
      for (int j = 0; j < count; ++j) {
        cv.columns[j] = data(s[j]);
        cv.rates_of_columns[j] = data(ds[j]);
      }
      return cv.equations.sensitivity_rates(t, data(y), cv.columns, cv.rates_of_columns);
    });
  }
};

StiffIntegrator::StiffIntegrator(Equations& equations, double tolerance,
                                 const Sensitivities& sensitivities)
    : cv_(std::make_unique<Implementation>(equations)) {
  Implementation& cv = *cv_;
  const int size = equations.states();
  const int integrals = equations.integrals();
  cv.y = cv.vector(size);
  cv.sampled = cv.vector(size);
  cv.matrix = SUNDenseMatrix(size, size, cv.context);
  if (cv.matrix == nullptr) throw std::bad_alloc();
  serial::use_loops(cv.matrix);
  cv.solver = SUNLinSol_Dense(cv.y, cv.matrix, cv.context);
  cv.memory = CVodeCreate(CV_BDF, cv.context);
  if (cv.memory == nullptr || cv.solver == nullptr) throw std::bad_alloc();
  serial::use_loops(cv.solver);
  check(CVodeSetErrHandlerFn(cv.memory, be_silent, nullptr));
  check(CVodeInit(cv.memory, Implementation::rates, 0, cv.y));
  cv.weight = 1 / tolerance;
  check(CVodeWFtolerances(cv.memory, Implementation::weights));
  check(CVodeSetUserData(cv.memory, &cv));
  check(CVodeSetLinearSolver(cv.memory, cv.solver, cv.matrix));
  check(CVodeSetJacFn(cv.memory, Implementation::jacobian));
  if (sensitivities.count > 0) {
    cv.count = sensitivities.count;
    cv.sensitivities = N_VCloneVectorArray(cv.count, cv.y);
    if (cv.sensitivities == nullptr) throw std::bad_alloc();
    for (int j = 0; j < cv.count; ++j) N_VConst(0, cv.sensitivities[j]);
    cv.columns.resize(cv.count);
    cv.rates_of_columns.resize(cv.count);
    check(CVodeSensInit(cv.memory, cv.count, CV_SIMULTANEOUS, Implementation::sensitivity_rates,
                        cv.sensitivities));
    std::vector<double> absolute(cv.count, sensitivities.tolerance);
    check(CVodeSensSStolerances(cv.memory, sensitivities.tolerance, absolute.data()));
    check(CVodeSetSensErrCon(cv.memory, sensitivities.sets_steps ? SUNTRUE : SUNFALSE));
  }
  if (integrals > 0) {
    cv.integrals = cv.vector(integrals);
    cv.sampled_integrals = cv.vector(integrals);
    check(CVodeQuadInit(cv.memory, Implementation::integrands, cv.integrals));
    check(CVodeQuadSStolerances(cv.memory, 0, tolerance));
    check(CVodeSetQuadErrCon(cv.memory, SUNTRUE));
  }
  std::vector<int> directions = equations.event_functions();
  passed_.resize(directions.size());
  if (!directions.empty()) {
    check(CVodeRootInit(cv.memory, static_cast<int>(directions.size()),
                        Implementation::event_values));
    check(CVodeSetRootDirection(cv.memory, directions.data()));
    check(CVodeSetNoInactiveRootWarn(cv.memory));
  }
}

StiffIntegrator::~StiffIntegrator() = default;

void StiffIntegrator::start(double time, const std::vector<double>& y,
                            const std::vector<double>& integrals,
                            const std::vector<double>& sensitivities) {
  Implementation& cv = *cv_;
  const int size = cv.equations.states();
  std::copy(y.begin(), y.end(), data(cv.y));
  check(CVodeReInit(cv.memory, time, cv.y));
  if (cv.integrals != nullptr) {
    std::copy(integrals.begin(), integrals.end(), data(cv.integrals));
    check(CVodeQuadReInit(cv.memory, cv.integrals));
  }
  for (int j = 0; j < cv.count; ++j)
    std::copy_n(sensitivities.begin() + static_cast<std::ptrdiff_t>(j) * size, size,
                data(cv.sensitivities[j]));
  if (cv.count > 0) check(CVodeSensReInit(cv.memory, CV_SIMULTANEOUS, cv.sensitivities));
  cv.failures = 0;
  time_ = time;
}

void StiffIntegrator::restart() {
  Implementation& cv = *cv_;
  double at = 0;
  if (cv.integrals != nullptr) check(CVodeGetQuad(cv.memory, &at, cv.integrals));
  if (cv.count > 0) check(CVodeGetSens(cv.memory, &at, cv.sensitivities));
  check(CVodeReInit(cv.memory, time_, cv.y));
  if (cv.integrals != nullptr) check(CVodeQuadReInit(cv.memory, cv.integrals));
  if (cv.count > 0) check(CVodeSensReInit(cv.memory, CV_SIMULTANEOUS, cv.sensitivities));
  cv.failures = 0;
}

StiffIntegrator::Reached StiffIntegrator::step(double stop) {
  Implementation& cv = *cv_;
  check(CVodeSetStopTime(cv.memory, stop));
  const double from = time_;
  const int flag = CVode(cv.memory, stop, cv.y, &time_, CV_ONE_STEP);
  if (flag < 0) {
    time_ = from;
    if (cv.thrown) std::rethrow_exception(cv.thrown);
    check(flag);
  }
  ++steps_;
  std::fill(passed_.begin(), passed_.end(), 0);
  if (flag == CV_ROOT_RETURN) {
    CVodeGetRootInfo(cv.memory, passed_.data());
    return Reached::event;
  }
  return flag == CV_TSTOP_RETURN ? Reached::stop : Reached::step;
}

void StiffIntegrator::forget_complaint() { cv_->complaint = nullptr; }

std::string StiffIntegrator::complaint() const {
  if (cv_->complaint == nullptr) return {};
  try {
    std::rethrow_exception(cv_->complaint);
  } catch (const std::exception& error) {
    return error.what();
  }
}

long StiffIntegrator::evaluations() const {
  long count = 0;
  CVodeGetNumRhsEvals(cv_->memory, &count);
  return count;
}

const double* StiffIntegrator::state_at(double time) const {
  if (time == time_)
    N_VScale(1, cv_->y, cv_->sampled);
  else
    check(CVodeGetDky(cv_->memory, time, 0, cv_->sampled));
  return data(cv_->sampled);
}

const double* StiffIntegrator::integrals_at(double time) const {
  check(CVodeGetQuadDky(cv_->memory, time, 0, cv_->sampled_integrals));
  return data(cv_->sampled_integrals);
}

const std::vector<double>& StiffIntegrator::sensitivities_at(double time) const {
  check(CVodeGetSensDky(cv_->memory, time, 0, cv_->sensitivities));
  cv_->copy_sensitivities();
  return cv_->sampled_sensitivities;
}

}  // namespace bentaxis::numerics
