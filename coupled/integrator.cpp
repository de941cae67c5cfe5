#include "integrator.h"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <exception>
#include <new>

namespace bentaxis::coupled {
namespace {

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

void be_silent(int, const char*, const char*, char*, void*) {}

void check(int flag) {
  if (flag >= 0) return;
  if (flag == CV_TOO_MUCH_ACC)
    throw IntegrationFailure("the tolerance asks for more than double precision gives there");
  if (flag == CV_FIRST_RHSFUNC_ERR || flag == CV_REPTD_RHSFUNC_ERR || flag == CV_UNREC_RHSFUNC_ERR)
    throw IntegrationFailure("motion or pressures have no finite rate of change from there on");
  throw IntegrationFailure(
      "motion or pressures change faster there than steps above round-off can follow");
}

}  // namespace

// What CVODES allocates, and what its callbacks work on.
struct Integrator::Implementation {
  Equations& equations;
  std::exception_ptr thrown;  // by the equations; no exception may pass through C
  long failures = 0;          // of Newton's method, when the Jacobian was last asked for

  SUNContext context = nullptr;
  N_Vector y = nullptr, integrals = nullptr, sampled = nullptr, sampled_integrals = nullptr;
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
    for (N_Vector v : {y, integrals, sampled, sampled_integrals})
      if (v != nullptr) N_VDestroy(v);
    SUNContext_Free(&context);
  }

  // Positive: CVODES may try a shorter step.
  template <class Function>
  static int guarded(void* user, Function&& function) {
    auto& cv = *static_cast<Implementation*>(user);
    try {
      return function(cv) ? 0 : 1;
    } catch (const ComputationError&) {
      cv.thrown = std::current_exception();
      return 1;
    } catch (...) {
      cv.thrown = std::current_exception();
      return -1;
    }
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
  static int guard_values(realtype t, N_Vector y, realtype* values, void* user) {
    return guarded(user, [&](Implementation& cv) {
      cv.equations.guard_values(t, data(y), values);
      return true;
    });
  }
};

Integrator::Integrator(Equations& equations, double tolerance)
    : cv_(std::make_unique<Implementation>(equations)) {
  Implementation& cv = *cv_;
  const int size = equations.states();
  const int integrals = equations.integrals();
  cv.y = N_VNew_Serial(size, cv.context);
  cv.sampled = N_VNew_Serial(size, cv.context);
  cv.matrix = SUNDenseMatrix(size, size, cv.context);
  if (cv.y == nullptr || cv.sampled == nullptr || cv.matrix == nullptr) throw std::bad_alloc();
  N_VConst(0, cv.y);
  cv.solver = SUNLinSol_Dense(cv.y, cv.matrix, cv.context);
  cv.memory = CVodeCreate(CV_BDF, cv.context);
  if (cv.memory == nullptr || cv.solver == nullptr) throw std::bad_alloc();
  check(CVodeSetErrHandlerFn(cv.memory, be_silent, nullptr));
  check(CVodeInit(cv.memory, Implementation::rates, 0, cv.y));
  check(CVodeSStolerances(cv.memory, 0, tolerance));
  check(CVodeSetUserData(cv.memory, &cv));
  check(CVodeSetLinearSolver(cv.memory, cv.solver, cv.matrix));
  check(CVodeSetJacFn(cv.memory, Implementation::jacobian));
  if (integrals > 0) {
    cv.integrals = N_VNew_Serial(integrals, cv.context);
    cv.sampled_integrals = N_VNew_Serial(integrals, cv.context);
    if (cv.integrals == nullptr || cv.sampled_integrals == nullptr) throw std::bad_alloc();
    N_VConst(0, cv.integrals);
    check(CVodeQuadInit(cv.memory, Implementation::integrands, cv.integrals));
    check(CVodeQuadSStolerances(cv.memory, 0, tolerance));
    check(CVodeSetQuadErrCon(cv.memory, SUNTRUE));
  }
  std::vector<int> directions = equations.event_functions();
  passed_.resize(directions.size());
  if (!directions.empty()) {
    check(CVodeRootInit(cv.memory, static_cast<int>(directions.size()),
                        Implementation::guard_values));
    check(CVodeSetRootDirection(cv.memory, directions.data()));
    check(CVodeSetNoInactiveRootWarn(cv.memory));
  }
}

Integrator::~Integrator() = default;

void Integrator::start(double time, const std::vector<double>& y,
                       const std::vector<double>& integrals) {
  Implementation& cv = *cv_;
  std::copy(y.begin(), y.end(), data(cv.y));
  check(CVodeReInit(cv.memory, time, cv.y));
  if (cv.integrals != nullptr) {
    std::copy(integrals.begin(), integrals.end(), data(cv.integrals));
    check(CVodeQuadReInit(cv.memory, cv.integrals));
  }
  cv.failures = 0;
  time_ = time;
}

Integrator::Reached Integrator::step(double stop) {
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
  CVodeGetLastStep(cv.memory, &last_step_);
  std::fill(passed_.begin(), passed_.end(), 0);
  if (flag == CV_ROOT_RETURN) {
    CVodeGetRootInfo(cv.memory, passed_.data());
    return Reached::guard;
  }
  return flag == CV_TSTOP_RETURN ? Reached::stop : Reached::step;
}

void Integrator::forget_complaint() { cv_->thrown = nullptr; }

std::string Integrator::complaint() const {
  if (cv_->thrown == nullptr) return {};
  try {
    std::rethrow_exception(cv_->thrown);
  } catch (const std::exception& error) {
    return error.what();
  }
}

void Integrator::state_at(double time, double* y) const {
  check(CVodeGetDky(cv_->memory, time, 0, cv_->sampled));
  std::copy_n(data(cv_->sampled), cv_->equations.states(), y);
}

void Integrator::integrals_at(double time, double* q) const {
  if (cv_->integrals == nullptr) return;
  check(CVodeGetQuadDky(cv_->memory, time, 0, cv_->sampled_integrals));
  std::copy_n(data(cv_->sampled_integrals), cv_->equations.integrals(), q);
}

}  // namespace bentaxis::coupled
