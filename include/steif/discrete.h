/* steif/discrete.h: linear systems h' = A h + B u, y = C h + D u on a grid of step dt.
 *
 *   double A[] = {0, -4, 1, -0.5}, B[] = {0, 1};
 *   steif_state_space s = {.n = 2, .m = 1, .A = A, .B = B};
 *   steif_discrete d;
 *   if (steif_c2d(ctx, &s, "foh", 0.1, &d) == STEIF_OK) ... d.form.A, d.form.B, d.B1 ...
 *   steif_discrete_clear(ctx, &d);
 *
 * Schemes, with z = dt A and the phi functions of steif/phi.h; the weights multiply dt B u:
 *
 *   scheme            Ad                     u_k            u_{k+1/2}  u_{k+1}     order
 *   zoh               e^z                    phi_1                                 1
 *   foh               e^z                    phi_1 - phi_2             phi_2       2
 *   exp-trapezoidal   as foh
 *   exp-midpoint      e^z                                   phi_1                  2
 *   averaged          e^z                    phi_1 / 2                 phi_1 / 2   2
 *   quadrature        e^z                    e^z / 2                   1/2         2
 *   impulse           e^z                                              1           1
 *   gbt:alpha=a       K (1 + (1-a) z)        (1-a) K                   a K         1, a = 1/2: 2
 *   forward, bilinear, backward: gbt with a = 0, 1/2, 1;    K = (1 - a z)^{-1}
 *   bilinear:w=W      bilinear with dt replaced by 2 tan(W dt/2)/W: exact at the frequency W
 *   matched           poles and zeros s go to e^{s dt}; one input, one output
 *
 * zoh is exact for inputs constant between samples, foh for continuous piecewise linear ones,
 * also where A is singular: no inverse of A is formed. bilinear and backward keep the equilibria
 * of constant inputs, quadrature does not. With a >= 1/2 and in all exponential schemes stable
 * systems stay stable; forward needs dt < -2 Re l/|l|^2. bilinear maps l -> -infinity to -1:
 * fast modes ring. zoh keeps modulus and phase of imaginary eigenvalues, bilinear the modulus.
 *
 * K. J. Astrom and B. Wittenmark, Computer-Controlled Systems (1997); G. Zhang, X. Chen and
 * T. Chen, J. Franklin Inst. 346 (2009), for gbt. Matrices are dense, by columns, entry (i, j)
 * at i + rows j.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_DISCRETE_H
#define STEIF_DISCRETE_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* n states, m inputs, p outputs; m and p may be 0, their matrices NULL; D NULL counts as 0. */
typedef struct steif_state_space {
  int n, m, p;
  const double *A, *B, *C, *D; /* n x n, n x m, p x n, p x m */
} steif_state_space;

/* The finite part of E x' = A x + B u, y = C x + D u with a regular pencil (descriptor.h), E singular
 * or not:
 *   z' = form.A z + form.B u,   y = form.C z + form.D u + sum_{j=1}^{terms} P_j u^(j),
 * terms = index - 1 (0 for index 0), z a state of its own. From index 2 on outputs may hold
 * derivatives of u: an input held between samples makes impulses of them. */
typedef struct steif_finite_part {
  steif_state_space form; /* ready for steif_c2d unless form.n is 0 */
  int index, terms;
  const double *polynomial; /* P_1, P_2, ... one after another, each p x m */
  void *memory;
} steif_finite_part;

/* E: n x n by columns. s->p = 0: y = x. STEIF_SINGULAR for a singular pencil, STEIF_NOT_CERTIFIED
 * where its index is undecided. steif_finite_part_clear it. */
STEIF_EXPORT int steif_finite_part_find(steif_context *ctx, const steif_state_space *s,
                                        const double *E, steif_finite_part *part);
STEIF_EXPORT void steif_finite_part_clear(steif_context *ctx, steif_finite_part *part);

typedef struct steif_scheme {
  const char *name;
  int order; /* for smooth inputs */
  const char *about;
} steif_scheme;

/* The schemes one after another; NULL past the end. */
STEIF_EXPORT const steif_scheme *steif_scheme_at(size_t i);

typedef struct steif_discrete {
  const char *scheme; /* its name */
  double dt;
  /* x_{k+1} = A x_k + B u_k, y_k = C x_k + D u_k, with the transfer function of the scheme, as
   * control packages write it. foh and impulse have the state x = h - B1 u, gbt and its special
   * cases one similar to that; zoh has x = h. The four schemes exp-trapezoidal, exp-midpoint,
   * averaged and quadrature keep the state h: B is there the sum of the three weights, and
   * C, D are those of the system. */
  steif_state_space form;
  /* h_{k+1} = A h_k + B0 u_k + Bm u(t_k + dt/2) + B1 u_{k+1}, each n x m, y_k = C h_k + D u_k
   * with C and D of the system. matched has a state of its own: B0 = B. */
  const double *B0, *Bm, *B1;
  const double *re, *im; /* n eigenvalues of form.A */
  /* max |Im l| dt/pi over the eigenvalues l of the system: from 1 on its frequencies alias, and
   * no method can recover them from the samples. */
  double alias;
  void *memory;
} steif_discrete;

/* Discretise with step dt > 0. STEIF_UNKNOWN_NAME for a scheme that does not exist,
 * STEIF_SINGULAR where 1 - a z cannot be inverted. steif_discrete_clear it. */
STEIF_EXPORT int steif_c2d(steif_context *ctx, const steif_state_space *s, const char *scheme,
                           double dt, steif_discrete *d);
STEIF_EXPORT void steif_discrete_clear(steif_context *ctx, steif_discrete *d);

/* m values of u(t); 0 is success. */
typedef int (*steif_input_fn)(double t, double *u, void *user);

/* States at t0 + k dt, k = 0 .. steps, in the n x (steps+1) array h; h0 NULL counts as 0. The
 * input is evaluated where a weight is not zero. u NULL: no input. */
STEIF_EXPORT int steif_discrete_run(steif_context *ctx, const steif_discrete *d,
                                    steif_input_fn u, void *user, double t0, const double *h0,
                                    long steps, double *h);

/* H = C (s - A)^{-1} B + D at s = re + i im, p x m complex numbers as pairs. For a discrete
 * system hand over d.form and s = e^{i w dt}. */
STEIF_EXPORT int steif_response(steif_context *ctx, const steif_state_space *s, double re,
                                double im, double *H);

/* The inverse of zoh: A (n x n) and B (n x m) from Ad and Bd, by the principal logarithm, whose
 * eigenvalues have |Im l| dt < pi. Eigenvalues of Ad that are 0 or negative have no real
 * principal logarithm: STEIF_UNSUPPORTED, naming the first of them. */
STEIF_EXPORT int steif_d2c(steif_context *ctx, int n, int m, const double *Ad, const double *Bd,
                           double dt, double *A, double *B);

#ifdef __cplusplus
}
#endif
#endif
