/* answers.h: results of analyses as reports, rows and pictures: what a verb has found goes in, an exit
 * code comes out.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef ANSWERS_H
#define ANSWERS_H

#include "curves.h"
#include "integration.h"

/* Rows of the sheet "methods". */
void report_methods(steif_report *r, const struct call *call);

/* Errors with steps h, h/2, ..., and the orders that rounding leaves. */
struct order_answer {
  steif_method_info method;
  steif_report *report;
  size_t count; /* of rows asked for, and of those made */
  size_t made;
  steif_order_row row[HALVINGS];
};
/* Row by row, each with its rounding; all end where the longest steps do. */
int order_measure(struct call *call, const steif_problem *p, struct order_answer *a);

struct problem_answer {
  const steif_problem *problem;
  const char *text; /* equations and sources; NULL: none */
};
/* The problem of the first word of the call, or that there is none. */
int problem_shown(struct call *call);

struct structure_answer {
  const steif_names *names; /* NULL: none */
  steif_structure found;
  bool eigenvalues; /* there are some: */
  steif_eigenvalues values;
  double near[2]; /* S */
};
void report_eigenvalues(steif_report *r, const steif_eigenvalues *e);
int eigenvalues_plot(const struct call *call, const steif_eigenvalues *e, const double near[2]);
int structure_present(const struct call *call, const struct structure_answer *a);

struct model_answer {
  const steif_problem *p;
  steif_model_facts facts;
};
int model_present(struct call *call, const struct model_answer *a);
/* Nothing, or with --json that it is. */
int model_good(struct call *call);
/* A model in C (steif_model_c) with a main that integrates it, on stdout. */
int model_print(const char *text);

struct region_answer {
  steif_region region;
  size_t count;
  double *point, *re, *im; /* the boundary as pairs, and by parts */
};
int region_present(const struct call *call, const struct region_answer *a);

/* |x| after every step: of the method, and exact. */
struct counterexample_answer {
  double h, rate;
  steif_counterexample facts;
  long count;
  double *t, *x, *exact;
};
int counterexample_present(const struct call *call, const struct counterexample_answer *a);

/* S = dy/dp: rows of t, y and the columns of S one after another, `width` numbers each. */
enum { SENSITIVITIES = 64 };
/* --functional: the problem with its integrand as a quadrature. */
struct functional {
  steif_problem problem, model;
  steif_quadrature quadrature;
  N_Vector out;
  bool kinks; /* which its steps do not meet: the error of the quadrature is to be tested */
};
int functional_open(struct call *call, const steif_problem *p, struct functional *f);
void functional_close(struct call *call, struct functional *f);
/* Is it made from a text? Then the same with integrands (model.h), to its end. */
bool is_model(const steif_problem *p);
int integrands_open(struct call *call, const steif_problem *p, int count,
                    const char *const *expression, steif_problem *model);
/* Of other problems: whether it has kinks; what may jump is an error. */
int expression_kinks(struct call *call, const steif_problem *p, const char *expression,
                     bool *kinks);
/* A model with the names of the problem's unknowns and parameters, the slope of whose first unknown is the
 * expression, its branches no events; its parameters as others are now; and its value with these, `out` for the slopes. */
int expression_open(struct call *call, const steif_problem *p, const char *expression,
                    steif_problem *model);
int expression_follow(const steif_parameters *from, const steif_problem *model);
int expression_value(const steif_parameters *from, const steif_problem *model, double t,
                     N_Vector y, N_Vector out, double *value);

struct sensitivity_answer {
  const steif_problem *problem;
  steif_options options;
  int count, active[SENSITIVITIES];
  steif_report *report;
  size_t shown, width;
  double *value;
  double *mesh;              /* of the run, where it is to be checked */
  char used[STEIF_SENTENCE]; /* the method, which auto chooses */
  size_t times, room;
  outcome outcome;
  steif_sensitivity_cost cost;
  bool checked;
  double disagreement;
  double integral, gradient[SENSITIVITIES]; /* of --functional, at the end */
  bool by_event;                            /* an event has ended the run: */
  double t_event, tau[SENSITIVITIES],
    *total;       /* its time, dtau/dp, dy(tau(p); p)/dp by columns */
  double *before; /* y before the event that came last */
  double reach;   /* how far it may move within its step on the mesh of --check */
};
/* --parameters; the run, and what it shows: exit codes after a sentence. */
int sensitivity_choose(struct call *call, struct sensitivity_answer *a);
int sensitivity_measure(struct call *call, struct sensitivity_answer *a);
/* Its parts: what is known at the start, the rows of the point that came last, the rest, of a run that a signal has
 * stopped, too. */
void sensitivity_begin(struct call *call, struct sensitivity_answer *a);
void sensitivity_point(struct call *call, struct sensitivity_answer *a);
int sensitivity_present(struct call *call, const struct sensitivity_answer *a);
const char *sensitivity_name(const struct sensitivity_answer *a, int i, char *room);
double sensitivity_scale(const struct sensitivity_answer *a, int i);
/* A run that has met an event which ends it; its derivatives, NaN with a sentence where it has none; their rows. */
void sensitivity_met(struct call *call, struct sensitivity_answer *a, steif_solver *s);
int sensitivity_event(struct call *call, struct sensitivity_answer *a, steif_solver *s);
void sensitivity_event_rows(steif_report *r, const struct call *call,
                            const struct sensitivity_answer *a);
/* Fits steif_options.on_event. */
int sensitivity_before(steif_solver *s, double t, N_Vector y, const int *fired, void *answer);
/* For --check: one more time; nonzero: no memory. The problem found once more, p moved by d v, or p_k by d where v is NULL: a
 * model makes start and form follow. */
int mesh_add(double **mesh, size_t *times, size_t *room, double t);
int moved_problem(struct call *call, const steif_problem *problem, int k, const double *v,
                  double d, steif_problem *p);
/* The mesh of a run that ends by an event, *mesh[0 .. *times - 1], which is to come to lie inside a step that others
 * follow up to t1; returns how far the event may move within that step, or -1: no memory. */
double event_mesh(double **mesh, size_t *times, double t0, double event, double t1);
/* Differences of runs of a problem with breaks are of runs with steps of their own, and a thousandth of the tolerance:
 * false where it has none, or steps are constant. */
bool tighten(const steif_problem *p, steif_options *o);
/* --check: fits steif_options.observe, and takes the mesh of the run; then the comparison. */
int sensitivity_note(steif_solver *s, double t, N_Vector y, void *answer);
int sensitivity_check(struct call *call, struct sensitivity_answer *a);
void sensitivity_close(struct sensitivity_answer *a);

struct energy_answer {
  const steif_problem *problem;
  double t1;             /* as asked for, or where a signal came */
  size_t which, columns; /* the invariant shown, from 1; of a row: t and every invariant */
  steif_energy energy;
  steif_report *report;
  const struct call *call;
  size_t told; /* rows of the energy that the report has */
};
/* Fits steif_options.observe, with the answer: rows that have come. */
int energy_follow(steif_solver *s, double t, N_Vector y, void *answer);
/* After the code of steif_energy_measure: what a run has seen that a signal has stopped, too. */
int energy_shown(struct call *call, struct energy_answer *a, int code);

struct lyapunov_answer {
  size_t count;
  double t0, t1; /* t1: as asked for */
  double *exponent, *interval, *error;
  steif_separation *separation; /* of neighbours */
  steif_lyapunov_facts facts;
  steif_growth_facts growth;
  bool measured; /* growth, and by steps: */
  size_t steps, room;
  double *t, *norm, *lte; /* NULL: not wanted */
  size_t averages;
  double
    *average; /* t and the exponents so far, 1 + count each; where no solution is followed */
  steif_context *ctx; /* of the rows of --series: */
  const char *series; /* the path; NULL: there is none, or it cannot be written */
  steif_rows *file;
  steif_decay decay;
  bool judged, decided; /* decay is there; and says something, or is not for this problem */
  steif_lyapunov_check *check;
  int checks;
};
/* Room for the steps, where --series or --plot is given, and its end; tell: for steif_growth_measure. */
int series_open(struct call *call, struct lyapunov_answer *a, double steps);
void series_close(struct lyapunov_answer *a);
int series_tell(double t, double norm, double lte, void *answer);
int series_average(double t, int count, const double *mean, void *answer);
/* --series and --plot. */
int series_save(const struct call *call, const struct lyapunov_answer *a);
/* Everything but the room, by the options of the call; then presented. */
int lyapunov_measure(struct call *call, const steif_problem *p, struct lyapunov_answer *a);
int lyapunov_present(const struct call *call, const struct lyapunov_answer *a);

/* The windows of one run, and ln |w| at their ends: count + 1 points. */
struct supervise_run {
  size_t count, room;
  struct supervise_answer *rows; /* whose report gets a row for each window; NULL: none */
  steif_supervised_window *window;
  double *t, *log;
  steif_supervised facts;
  int code;
};
/* Room for so many windows: false where memory is short; close it in any case. */
bool supervise_open(struct supervise_run *run, size_t room);
void supervise_close(struct supervise_run *run);
/* Fits steif_supervision.tell, with a supervise_run as user data. */
int supervise_keep(const steif_supervised_window *window, void *run);
struct supervise_answer {
  const struct call *call;
  steif_report *report;
  size_t n;
  double *y;
  struct supervise_run alone, kept; /* by error control alone, and supervised */
};
/* What is known at the start. */
void supervise_begin(struct supervise_answer *a);
/* Both runs by the options of the call, presented. */
int supervise_both(struct call *call, const steif_problem *p, struct supervise_answer *a);
int supervise_present(struct supervise_answer *a);

struct discrete_answer {
  steif_discrete discrete;
  steif_finite_part part; /* of E x' = A x + B u; memory NULL: there is no E */
};
int discrete_present(const struct call *call, const struct discrete_answer *a);

struct hamiltonian_answer {
  int n;
  steif_hamiltonian found;
};
int hamiltonian_present(const struct call *call, const struct hamiltonian_answer *a);

struct diagnosis_answer {
  const steif_problem *problem;
  steif_diagnosis diagnosis;
  steif_start start; /* y NULL: there is none */
  char beside[640];  /* what x(0+) has to say of it; "": nothing */
};
int diagnosis_present(const struct call *call, const struct diagnosis_answer *a);

#endif
