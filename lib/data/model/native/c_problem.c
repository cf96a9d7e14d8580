/* c_problem.c: a model as a steif_problem in C.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "native.h"
#include "reactions.h"
#include <stdio.h>

/* ---- data ------------------------------------------------------------------------------------- */

static void reals(stf_writer *w, const char *head, long count, const double *x)
{
  stf_write(w, "%s[%ld] = {", head, count > 0 ? count : 1);
  for (long i = 0; i < count; i++) {
    stf_write_number(w, x[i]);
    stf_write(w, i % 8 == 7 ? ",\n  " : ", ");
  }
  stf_write(w, count > 0 ? "};\n" : "0};\n");
}

static void wholes(stf_writer *w, const char *head, long count, const int *x)
{
  stf_write(w, "%s[%ld] = {", head, count);
  for (long i = 0; i < count; i++) stf_write(w, i % 16 == 15 ? "%d,\n  " : "%d, ", x[i]);
  stf_write(w, "};\n");
}

static void indices(stf_writer *w, const char *head, sunindextype count, const sunindextype *x)
{
  stf_write(w, "static const sunindextype %s[%lld] = {", head,
            count > 0 ? (long long)count : 1);
  for (sunindextype i = 0; i < count; i++)
    stf_write(w, i % 16 == 15 ? "%lld,\n  " : "%lld, ", (long long)x[i]);
  stf_write(w, count > 0 ? "};\n" : "0};\n");
}

static void strings(stf_writer *w, const char *head, long count, const char *const *text)
{
  stf_write(w, "static const char *const %s[%ld] = {", head, count);
  for (long i = 0; i < count; i++) {
    stf_write_string(w, text[i]);
    stf_write(w, i % 8 == 7 ? ",\n  " : ", ");
  }
  stf_write(w, "};\n");
}

static void data(stf_writer *w, const stf_model *m, const steif_problem *p)
{
  reals(w, "static double parameter", m->parameters, m->p);
  if (m->given.count) {
    strings(w, "parameter_names", m->given.count, m->given.name);
    stf_write(
      w,
      "static const steif_parameters parameters = {.count = %d, .value = parameter, .name = "
      "parameter_names};\n",
      m->given.count);
  }
  reals(w, "static const double start", m->n, p->y0);
  if (p->yp0) reals(w, "static const double start_slope", m->n, p->yp0);
  strings(w, "unknowns", m->n, m->unknown);
  stf_write(w, "static const steif_names names = {.unknown = unknowns};\n");
  if (p->index) wholes(w, "static const int component_index", m->n, p->index);
  if (p->constraint) wholes(w, "static const int constraints", m->n, p->constraint);
  if (p->break_count) reals(w, "static const double breaks", p->break_count, p->breaks);
}

/* ---- callbacks -------------------------------------------------------------------------------- */

static bool has_events(const stf_model *m) { return m->switches || m->timers || m->discretes; }

static void calls(stf_writer *w, const char *name, const stf_quantity *q, const char *y,
                  const char *yp, const char *memory, const char *to, long long size)
{
  if (!q->assigns) stf_write(w, "  for (long i = 0; i < %lld; i++) %s[i] = 0;\n", size, to);
  for (size_t i = 0; i < q->tapes.count; i++)
    stf_write(w, "  %s_%zu(t, %s, %s, parameter, %s, %s);\n", name, i, y, yp, memory, to);
}

/* A frozen branch that has no value is taken by its relation at this point. */
static void calls_again(stf_writer *w, const stf_model *m, const char *name,
                        const stf_quantity *q, const char *y, const char *yp, const char *to,
                        long long size)
{
  calls(w, name, q, y, yp, has_events(m) ? "run.memory" : "0", to, size);
  if (!m->switches || *y == '0') return;
  stf_write(w, "  if (!all_finite(%s, %lld)) {\n  take_literally(t, %s);\n", to, size, y);
  calls(w, name, q, y, yp, "literal", to, size);
  stf_write(w, "  }\n");
}

static const char head_of_values[] = "  (void)user;\n  double *out = N_VGetArrayPointer(to);\n";

static void values(stf_writer *w, const stf_model *m)
{
  const long long n = m->n;
  const char *y = "N_VGetArrayPointer(y)", *yp = "N_VGetArrayPointer(yp)";
  if (m->form == STEIF_IMPLICIT)
    stf_write(
      w, "static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector to, void *user)\n{\n");
  else if (m->form == STEIF_DESCRIPTOR)
    stf_write(w, "static int g(sunrealtype t, int derivative, N_Vector to, void *user)\n{\n"
                 "  if (derivative) return 1;\n");
  else
    stf_write(w, "static int f(sunrealtype t, N_Vector y, N_Vector to, void *user)\n{\n");
  stf_write_text(w, head_of_values);
  calls_again(w, m, "f", &m->f, m->form == STEIF_DESCRIPTOR ? "0" : y,
              m->form == STEIF_IMPLICIT ? yp : "0", "out", n);
  stf_write(w,
            "  for (long i = 0; i < %lld; i++)\n    if (!isfinite(out[i])) return 1;\n  return "
            "0;\n}\n\n",
            n);
}

/* Into a sparse matrix, or through a list of entries into a dense one. */
static void entries(stf_writer *w, const stf_model *m, const stf_matrix *M, const char *name,
                    bool sparse, const char *y, const char *yp)
{
  const long long count = M->entries > 0 ? (long long)M->entries : 1;
  stf_write(w, sparse ? "  double *a = SUNSparseMatrix_Data(M);\n" : "  double a[%lld];\n",
            count);
  calls_again(w, m, name, &M->quantity, y, yp, "a", M->entries);
  if (sparse)
    stf_write(w,
              "  memcpy(SUNSparseMatrix_IndexPointers(M), %s_column, sizeof %s_column);\n"
              "  memcpy(SUNSparseMatrix_IndexValues(M), %s_row, sizeof %s_row);\n",
              name, name, name, name);
  else
    stf_write(w,
              "  for (long j = 0; j < %lld; j++)\n"
              "    for (sunindextype k = %s_column[j]; k < %s_column[j + 1]; k++)\n"
              "      SM_ELEMENT_D(M, %s_row[k], j) = a[k];\n",
              (long long)m->n, name, name, name);
  stf_write(w, "  return 0;\n}\n\n");
}

static void matrix(stf_writer *w, const stf_model *m, const steif_problem *p,
                   const stf_matrix *M, const char *name)
{
  char column[20], row[20];
  const bool of_f = m->form == STEIF_ODE || m->form == STEIF_MASS;
  const bool jac = of_f && name[0] == 'A', yp = m->form == STEIF_IMPLICIT;
  snprintf(column, sizeof column, "%s_column", name);
  snprintf(row, sizeof row, "%s_row", name);
  indices(w, column, (sunindextype)m->n + 1, M->column);
  indices(w, row, M->entries, M->row);
  if (jac)
    stf_write(
      w, "static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix M, void *user,\n"
         "               N_Vector v1, N_Vector v2, N_Vector v3)\n{\n"
         "  (void)fy, (void)user, (void)v1, (void)v2, (void)v3;\n");
  else
    stf_write(
      w,
      "static int fill_%s(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)\n"
      "{\n  (void)y, (void)yp, (void)user;\n",
      name);
  entries(w, m, M, name, p->storage == STEIF_SPARSE, "N_VGetArrayPointer(y)",
          yp ? "N_VGetArrayPointer(yp)" : "0");
}

static void invariants(stf_writer *w, const stf_model *m)
{
  if (!m->invariant_count) return;
  stf_write(
    w, "static int invariant(sunrealtype t, N_Vector y, sunrealtype *value, void *user)\n{\n"
       "  (void)user;\n");
  calls(w, "invariant", &m->invariants, "N_VGetArrayPointer(y)", "0",
        has_events(m) ? "run.memory" : "0", "value", m->invariant_count);
  stf_write(w, "  return 0;\n}\n\n");
}

/* ---- the problem ------------------------------------------------------------------------------ */

static void members(stf_writer *w, const stf_model *m, const steif_problem *p)
{
  const bool of_f = m->form == STEIF_ODE || m->form == STEIF_MASS;
  stf_write(w, "const steif_problem model = {\n  .name = \"model\",\n  .about = ");
  stf_write_string(w, p->about);
  stf_write(w, ",\n  .n = %lld,\n  .names = &names,\n  .t0 = ", (long long)m->n);
  stf_write_number(w, p->t0);
  stf_write(w, ",\n  .t1 = ");
  stf_write_number(w, p->t1);
  stf_write(w, ",\n  .y0 = start,\n");
  if (p->yp0) stf_write(w, "  .yp0 = start_slope,\n");
  if (of_f) stf_write(w, "  .f = f,\n  .jac = jac,\n");
  if (m->form == STEIF_IMPLICIT) stf_write(w, "  .F = F,\n");
  if (m->form == STEIF_DESCRIPTOR) stf_write(w, "  .g = g,\n");
  if (!of_f) stf_write(w, "  .A = fill_A,\n");
  if (m->form != STEIF_ODE) stf_write(w, "  .E = fill_E,\n");
  stf_write(w, "  .storage = %s,\n  .nnz = %lld,\n  .nnz_E = %lld,\n",
            p->storage == STEIF_SPARSE ? "STEIF_SPARSE" : "STEIF_DENSE", (long long)p->nnz,
            (long long)p->nnz_E);
  if (p->index) stf_write(w, "  .index = component_index,\n");
  if (p->constraint) stf_write(w, "  .constraint = constraints,\n");
  stf_write(w, "  .dae_index = %d,\n  .autonomous = %d,\n  .linear = %d,\n", p->dae_index,
            p->autonomous, p->linear);
  if (p->break_count)
    stf_write(w, "  .breaks = breaks,\n  .break_count = %d,\n", p->break_count);
  if (m->invariant_count)
    stf_write(w, "  .invariants = %d,\n  .invariant = invariant,\n", (int)m->invariant_count);
  if (p->events)
    stf_write(
      w,
      "  .events = %d,\n  .event = event,\n  .event_list = event_list,\n  .handle_event = "
      "handle,\n  .begin = begin,\n  .save = save,\n  .restore = restore,\n",
      p->events);
  if (p->event_slope) stf_write(w, "  .event_slope = event_slope,\n");
  stf_write_text(w, "  .event_spacing = ");
  stf_write_number(w, p->event_spacing);
  stf_write_text(w, ",\n");
  stf_write(w, "  .rtol_scale = ");
  stf_write_number(w, p->rtol_scale);
  stf_write(w, ",\n%s};\n\n", m->given.count ? "  .parameters = &parameters,\n" : "");
}

static void head(stf_writer *w, const stf_model *m, const steif_problem *p)
{
  stf_write(w, "/* ");
  stf_write_plain(w, p->about);
  stf_write(w,
            ": a problem for steif, form %s, %lld unknowns.\n"
            " *\n"
            " *     cc model.c -o model $(pkg-config --cflags --libs steif) -lm\n"
            " *     ./model radau:s=3 1e-8\n"
            " *\n"
            " * Start values are those of the parameters below. Written by 'steif model FILE "
            "--c'. */\n",
            steif_form_name(m->form), (long long)m->n);
  stf_write(w,
            "#include <math.h>\n#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n"
            "#include <nvector/nvector_serial.h>\n#include <sunmatrix/sunmatrix_dense.h>\n"
            "#include <sunmatrix/sunmatrix_sparse.h>\n#include <steif/steif.h>\n\n");
}

/* Every tape that is written, for the functions that they need; the list is the caller's to release. */
static int needed(stf_writer *w, const stf_model *m, stf_vector *copies, stf_vector *list)
{
  const stf_quantity *const own[] = {&m->f,          &m->A.quantity, &m->E.quantity,
                                     &m->invariants, &m->events,     &m->reactions->conditions};
  const size_t actions = m->reactions->list.count;
  STEIF_TRY(stf_vector_resize(w->ctx, copies, actions + 1, sizeof(stf_quantity)));
  STEIF_TRY(stf_vector_resize(w->ctx, list, actions + 6, sizeof(const stf_quantity *)));
  for (size_t i = 0; i < 6; i++) *STF_AT(*list, const stf_quantity *, i) = own[i];
  for (size_t i = 0; i < actions; i++) {
    stf_reaction *r = STF_AT(m->reactions->list, stf_reaction, i);
    stf_quantity *q = STF_AT(*copies, stf_quantity, i);
    *q = (stf_quantity){.tapes = {.data = &r->tape, .count = r->count > 0}};
    *STF_AT(*list, const stf_quantity *, i + 6) = q;
  }
  return STEIF_OK;
}

static void functions(stf_writer *w, const stf_model *m)
{
  stf_vector copies = {0}, list = {0};
  const int code = needed(w, m, &copies, &list);
  if (code)
    w->code = code;
  else
    stf_write_functions(w, m, list.count, list.data);
  stf_vector_free(w->ctx, &copies);
  stf_vector_free(w->ctx, &list);
}

/* Discrete values that nothing changes, under the name that those of events have. */
static void constants(stf_writer *w, const stf_model *m)
{
  stf_write(w, "static const struct { double memory[%d]; } run = {{", (int)m->memories);
  for (int32_t i = 0; i < m->memories; i++) {
    stf_write_number(w, m->memory_start[i]);
    stf_write_text(w, ", ");
  }
  stf_write_text(w, "}};\n");
}

void stf_write_problem(stf_writer *w, const stf_model *m, const steif_problem *p)
{
  const stf_quantity *all[] = {&m->f, &m->A.quantity, &m->E.quantity, &m->invariants};
  static const char *const name[] = {"f", "A", "E", "invariant"};
  head(w, m, p);
  data(w, m, p);
  functions(w, m);
  if (p->events)
    stf_write_event_values(w, m);
  else if (has_events(m))
    constants(w, m);
  for (int i = 0; i < 4; i++)
    stf_write_quantity(
      w, &(stf_dialect){.name = name[i], .standalone = true, .store = "static "}, all[i]);
  values(w, m);
  if (p->events) stf_write_events(w, m);
  matrix(w, m, p, &m->A, "A");
  if (m->form != STEIF_ODE) matrix(w, m, p, &m->E, "E");
  invariants(w, m);
  members(w, m, p);
}
