/* test_function.c: families of test functions as expressions in t, and expressions of one's own.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "test_function.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GONE 1e-17     /* of the largest value: where a family ends by itself */
#define ROUNDING 1e-15 /* of the values of an expression in double */
enum { MOST_POWER = 64, MOST_HERMITE = 16 };

struct family {
  struct call *call;
  const steif_spec *spec;
  double t1; /* 0: not given */
  struct test_function *g;
};

/* The parameter `key`, or another value. */
static double parameter(const struct family *m, const char *key, double otherwise)
{
  for (int i = 0; i < m->spec->count; i++)
    if (!strcmp(m->spec->param[i].key, key)) {
      char *end;
      const double value = strtod(m->spec->param[i].value, &end);
      return *end ? NAN : value;
    }
  return otherwise;
}

static int whole(const struct family *m, const char *key, int otherwise, int most)
{
  const double n = parameter(m, key, otherwise);
  return n >= 0 && n <= most && n == floor(n) ? (int)n : -1;
}

static bool power(struct family *m)
{
  const int n = whole(m, "n", 8, MOST_POWER);
  snprintf(m->g->text, sizeof m->g->text, "(1-t/%.15g)^%d", m->t1 > 0 ? m->t1 : 1, n);
  return n >= 1;
}

static bool bump(struct family *m)
{
  const double T = m->t1 > 0 ? m->t1 : 1, c = parameter(m, "c", 0), w = parameter(m, "w", T);
  snprintf(m->g->text, sizeof m->g->text, "exp(-1/(1-((t-(%.15g))/%.15g)^2))", c, w);
  m->g->from = c - w, m->g->to = c + w;
  return isfinite(c) && w > 0 && isfinite(w) && c - w < T && c + w > 0;
}

static bool expcos(struct family *m)
{
  const double a = parameter(m, "a", 1), b = parameter(m, "b", 5);
  snprintf(m->g->text, sizeof m->g->text, "exp(-(%.15g)*t)*cos(%.15g*t)", a, b);
  if (!(m->t1 > 0)) m->t1 = 40 / a;
  return a > 0 && isfinite(a) && isfinite(b);
}

/* H_n(u) = 2 u H_{n-1} - 2 (n-1) H_{n-2}, u = t / scale, as coefficients of u. */
static bool hermite(struct family *m)
{
  const int n = whole(m, "n", 0, MOST_HERMITE);
  const double S = parameter(m, "scale", 0.2);
  double H[3][MOST_HERMITE + 1] = {{1}}, size = 1;
  if (n < 0 || !(S > 0) || !isfinite(S)) return false;
  for (int k = 1; k <= n; k++)
    for (int j = 0; j <= k; j++)
      H[k % 3][j] = (j ? 2 * H[(k + 2) % 3][j - 1] : 0) -
                    (k > 1 && j <= k - 2 ? 2 * (k - 1) * H[(k + 1) % 3][j] : 0);
  size_t used = 0;
  for (int j = 0; j < n && used < sizeof m->g->text; j++)
    used += (size_t)snprintf(m->g->text + used, sizeof m->g->text - used, "(%.15g+t/%.15g*",
                             H[n % 3][j], S);
  for (int j = n; j >= 0 && used < sizeof m->g->text; j--)
    used += (size_t)snprintf(m->g->text + used, sizeof m->g->text - used,
                             j == n ? "(%.15g)" : ")", H[n % 3][j]);
  if (used < sizeof m->g->text)
    used +=
      (size_t)snprintf(m->g->text + used, sizeof m->g->text - used, "*exp(-(t/%.15g)^2/2)", S);
  for (int j = 0; j <= n; j++) size = fmax(size, fabs(H[n % 3][j]));
  double u = 6;
  while (size * pow(u, n) * exp(-u * u / 2) > GONE) u += 0.25;
  u += 1; /* and of derivatives */
  if (!(m->t1 > 0)) m->t1 = u * S;
  return used < sizeof m->g->text;
}

static const struct {
  const char *name, *parameters;
  bool (*write)(struct family *family);
} families[] = {{"power", "n (1 to 64)", power},
                {"bump", "c and w > 0, with 0 or more of [0, t1] in (c-w, c+w)", bump},
                {"expcos", "a > 0 and b", expcos},
                {"hermite", "n (0 to 16) and scale > 0", hermite}};
enum { FAMILIES = sizeof families / sizeof *families };

/* Is it the name of a family, alone or before a colon? */
static int family_of(const char *words)
{
  const size_t length = strcspn(words, ":");
  for (int i = 0; i < FAMILIES; i++)
    if (strlen(families[i].name) == length && !strncmp(words, families[i].name, length))
      return i;
  return -1;
}

static int taylor(long double t, int order, long double *c, void *user)
{
  const struct test_function *g = user;
  for (int j = 0; j <= order; j++) c[j] = 0;
  return t > g->from && t < g->to ? steif_function_taylor(t, order, c, g->f) : 0;
}

/* Smooth on its interval? */
static int check(struct call *call, const struct test_function *g)
{
  double at;
  if (steif_function_breaks(g->f, 0, g->weight.t1, 1, &at) ||
      !steif_function_smooth(g->f, 0, g->weight.t1, &at))
    return bad_usage(call,
                     "the test function %s is not smooth at t = %g: its derivatives are "
                     "values of impulses; take a smooth one",
                     g->text, at);
  return EXIT_OK;
}

int test_function_open(struct call *call, const char *words, double t1, struct test_function *g)
{
  const int which = family_of(words);
  steif_spec spec;
  struct family m = {call, &spec, t1, g};
  *g = (struct test_function){.from = -INFINITY, .to = INFINITY};
  if (which >= 0) {
    if (steif_spec_parse(call->ctx, words, &spec)) return fail(call);
    if (!families[which].write(&m))
      return bad_usage(call, "--g %s: %s takes %s", words, families[which].name,
                       families[which].parameters);
  } else
    snprintf(g->text, sizeof g->text, "%s", words);
  if (strlen(words) >= sizeof g->text)
    return bad_usage(call, "a test function has at most %zu characters", sizeof g->text - 1);
  g->f = steif_function_parse(call->ctx, g->text, 1, NULL);
  if (!g->f) return fail(call);
  g->weight = (steif_weight){taylor, g, m.t1 > 0 ? m.t1 : 1, ROUNDING};
  return check(call, g);
}

void test_function_close(struct test_function *g) { steif_function_free(&g->f); }
