/* sweep_picture.c: what a sweep collects over the values of the last parameter, a curve for each combination of the
 * others; with --points or --at over time, a curve for each member. A panel for each of the first columns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PANELS = SWEEP_PANELS, LABEL = 64, LABELLED = 8 };

struct sweep_picture {
  size_t panels, rows, room;
  long long *member;
  double *x, *y[PANELS];
  struct curves {
    size_t count;
    steif_curve *curve;   /* panel after panel */
    char (*label)[LABEL]; /* of one panel */
  } curves;
};

int sweep_picture_open(struct sweep *s)
{
  const size_t columns = sweep_columns(s);
  if (!s->call->plot) return EXIT_OK;
  if (s->old)
    return bad_usage(s->call,
                     "--plot draws all members: leave --resume out, or draw the file of --csv");
  struct sweep_picture *p = calloc(1, sizeof *p);
  if (!p) return no_memory(s->call, "the picture", "leave --plot out");
  p->panels = columns < PANELS ? columns : PANELS;
  s->picture = p;
  return EXIT_OK;
}

void sweep_picture_close(struct sweep *s)
{
  struct sweep_picture *p = s->picture;
  for (size_t k = 0; p && k < PANELS; k++) free(p->y[k]);
  if (p) free(p->member), free(p->x), free(p->curves.curve), free(p->curves.label);
  free(p);
  s->picture = NULL;
}

/* Room for one more row; what was there before stays valid when memory is short. */
static bool grow(struct sweep_picture *p)
{
  if (p->rows < p->room) return true;
  const size_t room = 2 * p->room + 64;
  long long *member = realloc(p->member, room * sizeof *member);
  if (member) p->member = member;
  double *x = realloc(p->x, room * sizeof *x);
  if (x) p->x = x;
  bool good = member && x;
  for (size_t k = 0; k < p->panels && good; k++) {
    double *y = realloc(p->y[k], room * sizeof *y);
    if (y) p->y[k] = y;
    good = y != NULL;
  }
  if (good) p->room = room;
  return good;
}

int sweep_picture_row(struct sweep *s, long long i, double t, const double *value)
{
  struct sweep_picture *p = s->picture;
  double axis[AXES];
  if (!p) return 0;
  if (!grow(p)) return no_memory(s->call, "the picture", "leave --plot out");
  axes_at(&s->axes, i, axis);
  p->member[p->rows] = i;
  p->x[p->rows] = s->on_the_way ? t : axis[s->axes.count - 1];
  for (size_t k = 0; k < p->panels; k++) p->y[k][p->rows] = value[k];
  p->rows++;
  return 0;
}

/* Do rows a and a + 1 belong to one curve? */
static bool together(const struct sweep *s, size_t a)
{
  const struct sweep_picture *p = s->picture;
  if (s->on_the_way) return p->member[a] == p->member[a + 1];
  const struct axis *last = &s->axes.axis[s->axes.count - 1];
  return s->axes.random || p->member[a] / last->count == p->member[a + 1] / last->count;
}

/* "k=0.3 m=2" of the parameters that belong to a curve. */
static void name_curve(const struct sweep *s, long long member, char *label)
{
  double value[AXES];
  const int count = s->axes.random && !s->on_the_way ? 0 : s->axes.count - !s->on_the_way;
  int used = 0;
  axes_at(&s->axes, member, value);
  label[0] = 0;
  for (int k = 0; k < count && used < LABEL; k++)
    used += snprintf(label + used, (size_t)(LABEL - used), "%s%.20s=%.4g", k ? " " : "",
                     s->axes.name[k], value[k]);
}

static bool find_curves(const struct sweep *s, struct sweep_picture *p)
{
  struct curves *c = &p->curves;
  size_t first = 0;
  for (size_t a = 0; a < p->rows; a++) c->count += a + 1 == p->rows || !together(s, a);
  c->curve = calloc(p->panels * c->count + 1, sizeof *c->curve);
  c->label = calloc(c->count + 1, sizeof *c->label);
  if (!c->curve || !c->label) return false;
  for (size_t a = 0, j = 0; a < p->rows; a++) {
    if (a + 1 < p->rows && together(s, a)) continue;
    if (c->count <= LABELLED) name_curve(s, p->member[a], c->label[j]);
    for (size_t k = 0; k < p->panels; k++)
      c->curve[k * c->count + j] =
        (steif_curve){c->label[j], a + 1 - first, p->x + first, p->y[k] + first,
                      s->axes.random && !s->on_the_way ? 2 : a - first < 50 && !s->on_the_way};
    first = a + 1, j++;
  }
  return true;
}

int sweep_picture_save(struct sweep *s)
{
  struct sweep_picture *p = s->picture;
  char title[160], label[PANELS][COLUMN];
  steif_plot panel[PANELS] = {{0}};
  const struct axis *last = &s->axes.axis[s->axes.count - 1];
  if (!p) return EXIT_OK;
  if (!find_curves(s, p)) return no_memory(s->call, "the picture", "leave --plot out");
  for (size_t k = 0; k < p->panels; k++)
    panel[k] = (steif_plot){.y_label = sweep_column(s, k, label[k]),
                            .log_x = !s->on_the_way && last->log,
                            .count = p->curves.count,
                            .curve = p->curves.curve + k * p->curves.count};
  snprintf(title, sizeof title, "%.70s by %.40s, %lld runs", s->call->word[0], s->call->word[1],
           s->done);
  panel[0].title = title;
  panel[p->panels - 1].x_label = s->on_the_way ? "t" : s->axes.name[s->axes.count - 1];
  return steif_panels_save(s->call->ctx, p->panels, panel, s->call->plot) ? fail(s->call)
                                                                          : EXIT_OK;
}
