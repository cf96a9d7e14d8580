// C++: the handles of steif in std::unique_ptr, callbacks as lambdas, a problem object as user data.
//
// Van der Pol's oscillator, y'' = ((1 - y^2) y' - y)/eps, stiff for small eps. A lambda without captures
// converts to the function pointer that the library wants; what it needs to know comes through `user`.
// Known for eps = 1e-6 at t = 2 are the values of the Test Set for IVP Solvers (F. Mazzia, C. Magherini, 2008).
//
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <memory>
#include <nvector/nvector_serial.h>
#include <steif/steif.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
struct release {
  void operator()(steif_context *ctx) const { steif_context_free(&ctx); }
  void operator()(steif_solver *s) const { steif_solver_free(&s); }
};
using context = std::unique_ptr<steif_context, release>;
using solver = std::unique_ptr<steif_solver, release>;

struct oscillator {
  double eps;
  std::vector<double> start{2, 0};

  std::vector<double> at(double t, const std::string &method, double rtol)
  {
    steif_problem p{};
    p.name = "oscillator";
    p.n = static_cast<sunindextype>(start.size());
    p.t1 = t;
    p.y0 = start.data();
    p.user = this;
    p.f = [](sunrealtype, N_Vector y, N_Vector ydot, void *user) {
      const auto *self = static_cast<const oscillator *>(user);
      const sunrealtype *z = N_VGetArrayPointer(y);
      sunrealtype *d = N_VGetArrayPointer(ydot);
      d[0] = z[1];
      d[1] = ((1 - z[0] * z[0]) * z[1] - z[0]) / self->eps;
      return 0;
    };
    steif_options opt = steif_defaults();
    opt.rtol = opt.atol = rtol;
    const context ctx(steif_context_new(nullptr));
    const solver s(steif_solver_new(ctx.get(), &p, method.c_str(), &opt));
    if (!s || steif_solve_to(s.get(), t) != STEIF_OK)
      throw std::runtime_error(steif_message(ctx.get()));
    const sunrealtype *y = N_VGetArrayPointer(steif_solution(s.get()));
    return {y, y + p.n};
  }
};
} // namespace

int main()
{
  const double known[] = {1.706167732170469, -0.8928097010248};
  bool right = true;
  try {
    oscillator o{1e-6};
    for (const char *method : {"auto", "radau:s=5", "bdf", "rodas5p"}) {
      const auto y = o.at(2, method, 1e-9);
      std::printf("%-9s  y = %.10f, y' = %.10f\n", method, y[0], y[1]);
      for (int i = 0; i < 2; i++) right = right && std::fabs(y[i] - known[i]) < 1e-6;
    }
    o.at(2, "radua", 1e-9); // a wrong name: an exception with a sentence
    right = false;
  } catch (const std::runtime_error &reason) {
    std::printf("caught: %s\n", reason.what());
  }
  return right ? 0 : 1;
}
