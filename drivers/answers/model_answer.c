/* model_answer.c: what a model written as text is.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

static void parameters(steif_report *r, const steif_problem *p)
{
  const char *name;
  double value;
  for (size_t i = 0; (name = steif_model_parameter(p, i, &value)); i++) {
    steif_report_row(r, "parameter");
    steif_report_text(r, "parameter.name", name);
    steif_report_real(r, "parameter.value", value);
  }
}

enum { SHOWN = 40 };

static void unknowns(steif_report *r, const steif_problem *p)
{
  static const char *const kind[] = {
    [STEIF_GUESS] = "guess", [STEIF_FIXED] = "fixed", [STEIF_FREE] = "free"};
  for (sunindextype i = 0; i < p->n && i < SHOWN; i++) {
    steif_report_row(r, "unknown");
    steif_report_text(r, "unknown.name", p->names->unknown[i]);
    steif_report_text(r, "unknown.kind", kind[steif_model_attribute(p, i)]);
    steif_report_real(r, "unknown.start", p->y0[i]);
    report_natural(r, "unknown.index", p->index ? p->index[i] : -1);
  }
}

/* Equations, outputs, and what may happen, in the words of the text. */
static void words(steif_report *r, const steif_problem *p)
{
  for (sunindextype i = 0; p->names->equation && i < p->n && i < SHOWN; i++) {
    steif_report_row(r, "equation");
    steif_report_text(r, "equation.name", p->names->equation[i]);
  }
  for (size_t i = 0; i < SHOWN && steif_model_output(p, i); i++) {
    steif_report_row(r, "output");
    steif_report_text(r, "output.name", steif_model_output(p, i));
  }
  for (int i = 0; i < p->events && i < SHOWN; i++) {
    steif_report_row(r, "event");
    steif_report_text(r, "event.name", p->event_list[i].name);
  }
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const struct member members[] = {MEMBER(steif_model_facts, why, A_TEXT),
                                          MEMBER(steif_model_facts, n, A_INDEX),
                                          MEMBER(steif_model_facts, entries, A_INDEX),
                                          MEMBER(steif_model_facts, entries_E, A_INDEX),
                                          MEMBER(steif_model_facts, parameters, A_WHOLE),
                                          MEMBER(steif_model_facts, equations, A_WHOLE),
                                          MEMBER(steif_model_facts, loops, A_WHOLE),
                                          MEMBER(steif_model_facts, relations, A_WHOLE),
                                          MEMBER(steif_model_facts, breaks, A_WHOLE),
                                          MEMBER(steif_model_facts, operations, A_LONG),
                                          MEMBERS_END};
  const struct model_answer *a = result;
  (void)call;
  steif_report_text(r, "model", a->p->name);
  steif_report_text(r, "about", a->p->about);
  steif_report_text(r, "form", steif_form_name(a->facts.form));
  report_members(r, "", members, &a->facts);
  report_natural(r, "index", a->p->dae_index);
  if (steif_model_start(a->p)[0]) steif_report_text(r, "guesses", steif_model_start(a->p));
  steif_report_real(r, "t0", a->p->t0);
  if (a->p->t1 > a->p->t0)
    steif_report_real(r, "t1", a->p->t1);
  else
    steif_report_text(r, "t1", NULL);
  parameters(r, a->p);
  unknowns(r, a->p);
  words(r, a->p);
}

static void fill_good(steif_report *r, const struct call *call, const void *result)
{
  (void)call, (void)result;
  steif_report_text(r, "status", "ok");
  steif_report_text(r, "message", "ok");
}

int model_good(struct call *call)
{
  return call->json ? present_result(call, fill_good, NULL) : EXIT_OK;
}

int model_present(struct call *call, const struct model_answer *a)
{
  return present_result(call, fill, a);
}

static const char main_program[] =
  "#ifndef WITHOUT_MAIN\n"
  "/* Method and tolerance from the command line, the end of the solution in 17 digits. */\n"
  "int main(int argc, char **argv)\n"
  "{\n"
  "  steif_options opt = steif_defaults();\n"
  "  if (argc > 2) opt.rtol = strtod(argv[2], NULL);\n"
  "  steif_context *ctx = steif_context_new(NULL);\n"
  "  steif_solver *s = steif_solver_new(ctx, &model, argc > 1 ? argv[1] : \"auto\", &opt);\n"
  "  const int code = s ? steif_solve_to(s, model.t1) : steif_status(ctx);\n"
  "  for (long i = 0; !code && i < (long)model.n; i++)\n"
  "    printf(\"%s %.17g\\n\", unknowns[i], NV_Ith_S(steif_solution(s), i));\n"
  "  if (code) fprintf(stderr, \"%s\\n\", steif_message(ctx));\n"
  "  steif_solver_free(&s);\n"
  "  steif_context_free(&ctx);\n"
  "  return code != 0;\n"
  "}\n"
  "#endif\n";

int model_print(const char *text)
{
  return fputs(text, stdout) < 0 || fputs(main_program, stdout) < 0 ? EXIT_FAILED : EXIT_OK;
}
