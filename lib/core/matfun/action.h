/* action.h: w = sum_k phi_k(tA) b_k by Krylov spaces and Taylor series.
 *
 * The polynomial methods see one exponential: with W = eta [b_p .. b_1], J the p x p shift and
 * B = [tA W; 0 J], e^B (b_0, e_p/eta) = (w, *). A vector of size n + p is a state.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ACTION_H
#define STF_ACTION_H

#include "matfun.h"
#include "space.h"

/* The largest Krylov space. */
enum { STF_DIMENSION = 200, STF_POLYNOMIAL = 30, STF_RATIONAL = 60 };

typedef struct stf_state {
  N_Vector v;
  double z[STEIF_PHI_MOST];
} stf_state;

/* Norms and symmetries of a matrix. */
typedef struct stf_facts {
  double norm;        /* ||A||_1 */
  double mu, shifted; /* tr(A)/n, ||A - mu I||_1 */
  bool symmetric, skew;
  double root[2][10]; /* ||(A - mu I)^k||_1^{1/k}, without and with shift; 0: not known yet */
} stf_facts;

struct steif_action {
  steif_context *ctx;
  stf_pool *pool;
  SUNMatrix A; /* NULL: an operator */
  stf_space space;
  steif_action_options o;
  double absolute; /* error that is always allowed */
  steif_pencil *pencil;
  bool borrowed; /* the pencil */
  stf_facts facts;
  double gamma; /* of the factors at hand; 0: none */
  int *sign;    /* n, for norm estimates */
  int states, dimension;
  stf_state *basis;                      /* `states` of dimension + 2 */
  double *H, *M, *X, *R, *column, *last; /* dense work of order stf_order(dimension) */
  void *core;

  /* The application at hand. */
  double t, eta, scale, mu; /* scale = sum ||b_k||/k!; mu is subtracted from tA */
  int p, aux;               /* aux = p, or 0 for spaces of A alone */
  N_Vector *b;
  steif_action_report report;
};

/* Order of the dense matrices of a Krylov space, with room for phi_0 .. phi_{p+1} or a
 * correction. */
static inline int stf_order(int dimension) { return dimension + STEIF_PHI_MOST + 3; }

/* For owners of a pencil: its A, of any storage, and its slot 0 are used; E is the identity. All
 * vectors are made at once. */
steif_action *stf_action_open(steif_context *ctx, steif_pencil *pencil, N_Vector like,
                              const steif_action_options *options);
/* The values of A changed, and the pencil knows. */
int stf_action_renew(steif_action *a);
/* Errors up to relative ||w|| + absolute are allowed from now on. */
void stf_action_aim(steif_action *a, double relative, double absolute);

/* augmented.c: at least `count` states of the basis exist. */
int stf_state_grow(steif_action *a, int count);
/* out = (B - mu I) x */
int stf_state_product(steif_action *a, const stf_state *x, stf_state *out);
/* (b_0, e_p/eta), after eta has been set. */
void stf_state_start(steif_action *a, stf_state *x);
double stf_state_norm(const steif_action *a, const stf_state *x);
void stf_state_scale(const steif_action *a, double c, stf_state *x);
void stf_state_add(const steif_action *a, double c, const stf_state *x, stf_state *y);
/* y = sum_{j<count} c_j basis_j; y is not of those. */
void stf_state_combine(const steif_action *a, int count, const double *c, stf_state *y);
/* basis[m] becomes orthonormal to basis[0 .. m-1]; h holds the m coefficients and, behind them,
 * the norm that was left, 0 if nothing of significance was. */
void stf_state_orthogonalise(const steif_action *a, int m, double *h);
double stf_vector_norm(const stf_space *space, N_Vector x);

/* facts.c */
int stf_facts_find(steif_action *a);
/* ||(A - mu I)^k||_1^{1/k}, estimated; k <= 9. */
double stf_facts_root(steif_action *a, bool shift, int k);

/* X = e^M for the order x order matrix in a->M; false if it overflows. */
bool stf_action_expm(steif_action *a, int order);

/* The three methods: w and report, STEIF_OK even when the error stays above the tolerance. */
int stf_action_polynomial(steif_action *a, N_Vector w);
int stf_action_rational(steif_action *a, N_Vector w);
int stf_action_taylor(steif_action *a, N_Vector w);

/* The error that `norm` = ||w|| allows. */
static inline double stf_action_allowed(const steif_action *a, double norm)
{
  return a->o.tolerance * norm + 16 * STF_EPS * a->scale + a->absolute;
}

#endif
