/* circle.h: (s E + F)^{-1} b around the circle |s| = R, equilibrated and refined.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CIRCLE_H
#define STF_CIRCLE_H

#include "contour_thresholds.h"
#include "linear_system.h"
#include "lu.h"
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>

struct steif_team;

/* E and F scaled: rows and columns multiplied by powers of two that bring the largest entries
 * of size |E| + |F| near one, so that scaling rounds nothing. */
typedef struct stf_scaled {
  steif_context *ctx;
  stf_pool *pool;
  sunindextype n;
  SUNMatrix givenE, givenF;         /* as given, borrowed */
  SUNMatrix E, A;                   /* scaled, A = -F: the pencil s E - A = s E + F */
  sunrealtype *row, *column, *most; /* scales of rows and columns; scratch, 2 n */
  sunrealtype size;                 /* that of the scales; 0: none yet */
  sunrealtype log_scale;            /* log det(scaled) - log det(given) */
  sunrealtype norm[2];              /* largest column sums of |E| and |F|, scaled */
  N_Vector like;
  steif_pencil *pencil;
} stf_scaled;

int stf_scaled_open(steif_context *ctx, SUNMatrix E, SUNMatrix F, stf_scaled *s);
void stf_scaled_close(stf_scaled *s);
/* Equilibrate size |E| + |F|, unless scales of a size near are there, and hand the values to
 * the pencil. */
int stf_scaled_set(stf_scaled *s, sunrealtype size);
/* Whether it holds these matrices, entry for entry; they are the given ones from now on. */
bool stf_scaled_adopt(stf_scaled *s, SUNMatrix E, SUNMatrix F);
/* b <- M^{-1} b in scaled coordinates, M = s E + F as factored in slot k; for complex s all
 * vectors are interleaved, 2 n. */
void stf_scaled_direct(stf_scaled *s, int k, sunrealtype *b);
/* One step of refinement of M x = b where it is needed, or anyway: r comes as b and is
 * overwritten. False: none was made, as the backward error of x is STF_STEADY or less. */
bool stf_scaled_refine(stf_scaled *s, int k, bool anyway, sunrealtype *x, sunrealtype *r);

/* The quadrature with `points` nodes R e^{2 pi i (j + 1/2) / points}, of which half are
 * factored, the data being real: a batch of them at a time on each thread. */
typedef struct stf_circle {
  struct stf_kept kept_by; /* a structure, maybe */
  stf_scaled scaled;
  int points, refinements, threads, batches, room, count;
  bool complete; /* the factors of all nodes are there */
  bool
    careful; /* growth of pivots is checked and solves are refined; else residuals alone decide */
  stf_sequence *sequence; /* pivots, of the first node or the last that needed its own */
  sunrealtype filled;     /* the size of the scales whose values it has */
  long long pivots;       /* how often they were sought; where they are from: */
  int from_visit;
  sunrealtype from_radius, from_at; /* of the circle; of the scales */
  stf_multishift *batch;
  sunrealtype *sum;    /* count x n by rows: R^i times the coefficient of s^i, i = -1, 0, ... */
  sunrealtype *square; /* squared norms of the sums */
  sunrealtype radius;
  sunrealtype log_det;           /* mean of log |det(s E + F)| over the circle */
  const struct steif_team *team; /* that shares the batches; NULL: none */
  long long team_number, passes; /* passes that others took part in */
  int known, answer; /* to processes 1 .. known; the code of the last that answered */
} stf_circle;

/* Largest index that may be looked for. */
enum { STF_INDEX_MOST = 64 };

/* For coefficients -1, 0 .. room - 2, all of them counted, two at least. Defaults of the analysis are
 * filled in. */
int stf_circle_open(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, int room, stf_circle **circle);
void stf_circle_close(steif_context *ctx, stf_circle **circle);
/* Of the structure that circles have found; NULL: none. */
static inline stf_circle *stf_circle_kept(const steif_structure *structure)
{
  return (stf_circle *)structure->kept;
}
/* Whether an open circle serves these matrices, this analysis and so many coefficients, which
 * are counted from now on. */
bool stf_circle_adopt(stf_circle *circle, SUNMatrix E, SUNMatrix F,
                      const steif_analysis *analysis, int room);
/* Factor around the circle of radius R; right-hand sides g in scaled coordinates, NULL:
 * determinant only. */
int stf_circle_run(stf_circle *circle, sunrealtype R, const stf_polynomial *g);
/* Before the first run: memory for the factors of all nodes at once. */
int stf_circle_widen(stf_circle *circle);
/* Other right-hand sides on the circle of the last run, by the factors where they are kept. */
int stf_circle_again(stf_circle *circle, const stf_polynomial *g);

/* The analysis with its defaults. */
steif_analysis stf_analysis_filled(const steif_analysis *analysis);
/* The radius to use: given, found, or a guess from the largest entries. */
sunrealtype stf_radius(SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                       const steif_structure *structure);
/* max |M_ij|, 0 for an empty matrix. */
sunrealtype stf_largest(SUNMatrix M);

#endif
