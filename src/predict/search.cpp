#include "predict/search.hpp"

#include <nlopt.h>

#include <exception>
#include <memory>

#include "bernal/core/error.hpp"

namespace bernal::predict {
namespace {

/// Callback data for NLopt, a C library that no exception may cross.
struct Call {
  const Objective& objective;
  const std::function<bool()>& stopped;
  nlopt_opt search;
  Place best;
  std::exception_ptr thrown = nullptr;
};

double evaluate(unsigned n, const double* x, double*, void* data) {
  Call& call = *static_cast<Call*>(data);
  try {
    if (call.stopped()) {
      nlopt_force_stop(call.search);
      return call.best.value;
    }
    const double value = call.objective({x, n});
    if (value > call.best.value) call.best = {{x, x + n}, value};
    return value;
  } catch (...) {
    call.thrown = std::current_exception();
    nlopt_force_stop(call.search);
    return call.best.value;
  }
}

}  // namespace

Place climb(const Objective& objective, std::vector<double> start, const SearchLimits& limits,
            const std::function<bool()>& stopped) {
  const auto n = static_cast<unsigned>(start.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> search(nlopt_create(NLOPT_LN_NELDERMEAD, n),
                                                                      nlopt_destroy);
  if (!search) throw std::bad_alloc();
  Call call{objective, stopped, search.get(), {start, objective(start)}};
  nlopt_set_max_objective(search.get(), evaluate, &call);
  nlopt_set_lower_bounds1(search.get(), 0);
  nlopt_set_upper_bounds1(search.get(), 1);
  nlopt_set_initial_step1(search.get(), limits.step);
  nlopt_set_ftol_abs(search.get(), limits.gain);
  nlopt_set_maxeval(search.get(), limits.most_evaluations);
  double value = 0;
  const nlopt_result result = nlopt_optimize(search.get(), start.data(), &value);
  if (call.thrown) std::rethrow_exception(call.thrown);
  // A search limited by roundoff has still found a maximum.
  if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED && result != NLOPT_FORCED_STOP)
    throw Error(ErrorCode::bad_argument, "the search for the densest composition cannot start");
  return call.best;
}

}  // namespace bernal::predict
