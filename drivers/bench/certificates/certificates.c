/* certificates.c: what certificates are worth, on random pencils whose structure is known.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "planted.h"
#include <math.h>
#include <time.h>

/* Dense pencils for each sparse one, and the seeds that --quick takes. */
enum { DENSE_MORE = 200, SEEDS = 500, QUICK = 10 };

typedef struct tally {
  long count, singular, cancels, verdict[3], start[3];
  sunrealtype off; /* the largest error of an x(0+) over its estimate */
} tally;

static void note(steif_report *r, const char *kind, long seed, const planted *p,
                 const planted_outcome *out)
{
  if (out->structure == PLANTED_RIGHT && out->start != PLANTED_WRONG) return;
  steif_report_row(r, "others");
  steif_report_text(r, "others.kind", kind);
  steif_report_whole(r, "others.seed", seed);
  steif_report_text(r, "others.verdict",
                    out->structure == PLANTED_OPEN    ? "not certified"
                    : out->structure == PLANTED_WRONG ? "wrong"
                                                      : "x(0+) wrong");
  steif_report_whole(r, "others.n", p->n);
  steif_report_whole(r, "others.index", p->singular ? -1 : p->index);
  steif_report_whole(r, "others.finite", p->singular ? -1 : p->finite);
  steif_report_text(r, "others.message", out->message);
}

static int judge(struct call *call, enum planted_kind kind, long seed, tally *t,
                 steif_report *r)
{
  static planted p;
  planted_outcome out;
  STEIF_TRY(planted_new(call->ctx, kind, seed, &p));
  STEIF_TRY(planted_judge(call->ctx, kind, &p, &out));
  t->count++;
  t->singular += p.singular;
  t->cancels += !p.singular && out.cancels;
  t->verdict[out.structure]++;
  if (out.structure == PLANTED_RIGHT && !p.singular) t->start[out.start]++;
  t->off = fmax(t->off, out.off);
  note(r, planted_name(kind), seed, &p, &out);
  return STEIF_OK;
}

static void row(steif_report *r, enum planted_kind kind, const tally *t, double cpu_s)
{
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.kind", planted_name(kind));
  steif_report_whole(r, "rows.pencils", t->count);
  steif_report_whole(r, "rows.singular", t->singular);
  steif_report_whole(r, "rows.cancel", t->cancels);
  steif_report_whole(r, "rows.right", t->verdict[PLANTED_RIGHT]);
  steif_report_whole(r, "rows.wrong", t->verdict[PLANTED_WRONG]);
  steif_report_whole(r, "rows.not_certified", t->verdict[PLANTED_OPEN]);
  steif_report_whole(r, "rows.starts_right", t->start[PLANTED_RIGHT]);
  steif_report_whole(r, "rows.starts_wrong", t->start[PLANTED_WRONG]);
  steif_report_whole(r, "rows.starts_not_certified", t->start[PLANTED_OPEN]);
  steif_report_real(r, "rows.error_over_estimate", t->off);
  steif_report_real(r, "rows.cpu_s", cpu_s);
}

static int campaign(struct call *call, enum planted_kind kind, long seeds, steif_report *r,
                    bool *wrong)
{
  const long count = kind == PLANTED_DENSE ? DENSE_MORE * seeds : seeds;
  const clock_t from = clock();
  tally t = {0};
  for (long seed = 1; seed <= count && !interrupted(); seed++) {
    if (seed % 100 == 1) progress(call, "%s %ld of %ld", planted_name(kind), seed, count);
    if (judge(call, kind, seed, &t, r)) return fail(call);
  }
  *wrong = *wrong || t.verdict[PLANTED_WRONG] || t.start[PLANTED_WRONG];
  row(r, kind, &t, (double)(clock() - from) / CLOCKS_PER_SEC);
  if (!interrupted()) rows_come(call, r); /* the last one may be cut */
  return EXIT_OK;
}

int bench_certificates(struct call *call)
{
  const long seeds = whole_or(call, "--seeds", given(call, "--quick") ? QUICK : SEEDS);
  bool wrong = false;
  steif_report *r = steif_report_new(call->ctx);
  int code = r ? EXIT_OK : fail(call);
  for (int kind = 0; !code && !interrupted() && kind < PLANTED_KINDS; kind++)
    code = campaign(call, (enum planted_kind)kind, seeds, r, &wrong);
  if (!code) code = bench_present(call, &r);
  steif_report_free(&r);
  return code ? code : wrong ? EXIT_FAILED : EXIT_OK;
}
