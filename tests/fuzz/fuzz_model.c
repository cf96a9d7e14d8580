/* fuzz_model.c: any text as a model. What is accepted must have f, a Jacobian and events that can be asked
 * at the start, and take a few steps or say why not; what is not must have a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then
 *   ./fuzz_model -max_total_time=60 ../tests/fuzz/corpus/fuzz_model ../examples/models
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Numbers of many digits, powers and products may make loops and arrays that are right but long. */
static int is_long(const char *text)
{
  int digits = 0;
  const int ranges = strchr(text, ':') != NULL;
  for (const char *c = text; *c; c++) {
    digits = *c >= '0' && *c <= '9' ? digits + 1 : 0;
    const int exponent = (*c == 'e' || *c == 'E') && c > text && c[-1] >= '0' && c[-1] <= '9';
    if (ranges && (digits > 3 || exponent)) return 1;
  }
  return 0;
}

/* w . (F_y v + F_y' v' + F_p q) by both products, as far as they have values; and the model in C. */
static void products(steif_context *ctx, const steif_problem *p)
{
  const int count = p->parameters ? p->parameters->count : 0;
  N_Vector v[7] = {N_VNew_Serial(p->n, steif_sundials(ctx))};
  double *q = calloc((size_t)count + 1, sizeof *q),
         *by_p = calloc((size_t)count + 1, sizeof *by_p);
  for (int i = 1; i < 7; i++) v[i] = N_VClone(v[0]);
  for (int i = 0; i < p->n; i++) {
    NV_Ith_S(v[0], i) = p->y0[i];
    NV_Ith_S(v[1], i) = NV_Ith_S(v[2], i) = sin(i + 1.0);
    NV_Ith_S(v[3], i) = cos(i + 1.0);
  }
  for (int k = 0; k < count; k++) q[k] = 1.0 / (k + 2);
  const int forwards = steif_model_tangent(ctx, p, p->t0, v[0], v[1], v[2], v[3], q, v[4]);
  const int back = steif_model_adjoint(ctx, p, p->t0, v[0], v[1], v[2], v[5], v[6], by_p);
  if (!forwards && !back) {
    double one = N_VDotProd(v[2], v[4]), other = 0, size = 1;
    for (int i = 0; i < p->n; i++) {
      const double parts[] = {NV_Ith_S(v[5], i) * NV_Ith_S(v[2], i),
                              NV_Ith_S(v[6], i) * NV_Ith_S(v[3], i),
                              NV_Ith_S(v[2], i) * NV_Ith_S(v[4], i)};
      other += parts[0] + parts[1];
      for (int k = 0; k < 3; k++) size += fabs(parts[k]);
    }
    for (int k = 0; k < count; k++) other += by_p[k] * q[k], size += fabs(by_p[k] * q[k]);
    if (isfinite(size) && size < 1e100 && fabs(one - other) > 1e-6 * size) abort();
  }
  if (!steif_model_c(ctx, p) && !strcmp(steif_message(ctx), "ok")) abort();
  for (int i = 0; i < 7; i++) N_VDestroy(v[i]);
  free(q), free(by_p);
}

static void run(steif_context *ctx, const steif_problem *p)
{
  steif_options o = steif_defaults();
  steif_model_facts facts;
  o.max_steps = 5;
  o.rtol = 1e-3;
  if (steif_model_describe(ctx, p, &facts) || facts.n != p->n) abort();
  if (p->n > 200) return;
  steif_solver *s = steif_solver_new(ctx, p, "radau:s=3", &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code < 0 && !strcmp(steif_message(ctx), "ok")) abort();
  steif_solver_free(&s);
  products(ctx, p);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[2048];
  steif_problem p;
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  if (is_long(text)) return 0;
  steif_context *ctx = steif_context_new(NULL);
  if (!steif_model_parse(ctx, text, "m.steif", NULL, &p))
    run(ctx, &p);
  else if (!strcmp(steif_message(ctx), "ok"))
    abort();
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return 0;
}
