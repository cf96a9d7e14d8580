"""Parameters of a problem: derivatives of its solution, fits to measurements."""
import ctypes as c
import difflib
import inspect
import os

import numpy as np

from ._library import INT, POINTER, REAL, WHOLE, Context, Struct, lib
from ._outputs import output_names
from ._run import _ON_EVENT, Interrupt, Result
from ._solve import checked_times, forget, is_named, known, own, refuse, tolerances, words
from ._values import choice, real

_OK, _EVENT, _NO_CONVERGENCE = 0, 2, -6  # of base.h
_SCALES = ("auto", "log", "linear")  # enum steif_fit_scale


def _names_of(f, count):
    """k and m of f(t, y, k, m); p1, p2, ... where the callback does not say."""
    try:
        words = [p.name for p in inspect.signature(f).parameters.values()
                 if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)][2:]
    except (TypeError, ValueError):
        words = []
    return words if len(words) == count else ["p%d" % (k + 1) for k in range(count)]


class _Parametrised:
    """A problem with its parameters: a callback f(t, y, *p), or one of the library by its name."""

    def __init__(self, context, f, t_span, y0, p, jac, jac_sparsity, mass, endless=False):
        self.context, self.named = context, is_named(f)
        if self.named:
            refuse(f, y0=y0, jac=jac, jac_sparsity=jac_sparsity, mass=mass)
            self.run, self.t0, self.t1 = known(context, f, t_span, p, endless)
            self._of_the_library()
        else:
            if p is None:
                raise ValueError("the parameters p of f(t, y, *p) are missing")
            if hasattr(p, "items"):
                raise ValueError("p of f(t, y, *p) must be the values in their order, not a dict")
            self.value = np.array(real("p", p)).ravel()
            if not self.value.size:
                raise ValueError("p is empty: f(t, y, *p) needs one parameter at least")
            self.run, self.t0, self.t1 = own(f, t_span, y0, self.value, jac, jac_sparsity, mass, None)
            self.names = _names_of(f, self.value.size)
            self._own_struct()

    def _of_the_library(self):
        address = self.run.problem.get("parameters", POINTER)
        if not address:
            self.close()
            raise ValueError("this problem has no parameters")
        table = Struct("parameters", address=address)
        count = table.get("count", INT)
        self.value = np.frombuffer((REAL * count).from_address(table.get("value", POINTER)))
        names = table.get("name", POINTER)
        self.names = ([name.decode() for name in (c.c_char_p * count).from_address(names)] if names
                      else ["p%d" % (k + 1) for k in range(count)])

    def _own_struct(self):
        table, names = Struct("parameters"), words(self.names)
        table.set("count", INT, self.value.size)
        table.set("value", POINTER, self.value.ctypes.data)
        table.set("name", POINTER, names)
        self.run.problem.set("parameters", POINTER, table.address)
        self.run.problem.kept["parameters"] = table, self.value

    def number(self, one):
        """Of a name, or a number from 0."""
        if isinstance(one, str):
            k = lib.steif_parameter_find(self.context.pointer, self.run.problem.address, one.encode())
            if k < 0:
                raise ValueError("%s; there are %s" % (self.context.sentence(), ", ".join(self.names[:12])))
            return k
        if isinstance(one, (bool, np.bool_)) or not isinstance(one, (int, np.integer)) or not 0 <= one < len(self.names):
            raise ValueError("%r is no parameter: give one of the names %s, or a number from 0 to %d" % (
                one, ", ".join(self.names[:12]), len(self.names) - 1))
        return int(one)

    def numbers(self, which):
        """Of names, numbers from 0, or None: all."""
        if which is None:
            return np.arange(len(self.names), dtype=c.c_int)
        found = [self.number(one) for one in ([which] if isinstance(which, (str, int)) else which)]
        if not found or len(set(found)) < len(found):
            raise ValueError("by must name parameters, one at least and each once, got %r" % (which,))
        return np.array(found, dtype=c.c_int)

    def fitted(self):
        """The names that a model gives by `fit`, or None."""
        names = []
        while (name := lib.steif_model_fitted(self.run.problem.address, len(names))):
            names.append(name.decode())
        return names or None

    def measured(self, key):
        """Of an unknown its number, of output k of a model n + k."""
        names = list(self.run.names or ["y%d" % (i + 1) for i in range(self.run.n)]) + output_names(self.run.problem)
        if isinstance(key, str) and key in names:
            return names.index(key)
        if isinstance(key, (int, np.integer)) and not isinstance(key, bool) and 0 <= key < len(names):
            return int(key)
        near = difflib.get_close_matches(str(key), names, 1, 0.5)
        raise ValueError("no unknown %r; there are %s%s%s" % (
            key, ", ".join(names[:12]), ", ... (%d)" % len(names) if len(names) > 12 else "",
            "; did you mean %r?" % near[0] if near else ", by number from 0 to %d" % (len(names) - 1)))

    def check(self, code):
        if self.run.raised:
            raise self.run.raised
        if code:
            raise self.context.error()

    def close(self):
        if self.named:
            forget(self.context, self.run)


# -- derivatives ------------------------------------------------------------------------------------


def sensitivity(f, t_span=None, y0=None, *, p=None, by=None, method="radau:s=5", rtol=1e-6, atol=None,
                t_eval=None, jac=None, jac_sparsity=None, mass=None):
    """Derivatives dy/dp of a solution by its parameters, beside the solution.

    f       f(t, y, *p), or the name of a problem ("rober", "lotka.steif")
    p       values of the parameters; of a named problem a dict of those that are to be others
    by      names or numbers of the parameters to differentiate by; None: all
    t_eval  times of the output; None: the end
    method  collocation, BDF or DIRK, cvodes or idas; and the other arguments of `solve`

    Returns a Result: t, y (n x points), S (parameters x n x points), names (of the parameters), nsteps, method, status
    (0: the end was reached, 1: an event has ended the run), message. Where an event has, t ends with its time t_event,
    y and S with what they are before what it does, S being the derivative at that fixed time; dt_event (one for each
    parameter) is the derivative of t_event, and S_event (parameters x n) that of y at the event as it moves,
    S + y' dt_event. dt_event and S_event are nan where an event grazes. moved and notes are as of `solve`.
    """
    context, problem = Context(), None
    try:
        problem = _Parametrised(context, f, t_span, y0, p, jac, jac_sparsity, mass)
        run, which = problem.run, problem.numbers(by)
        if problem.t1 <= problem.t0:
            raise ValueError("t_span is the one point %g: derivatives need an interval" % problem.t0)
        tolerances(run, rtol, atol, run.n)
        for member, kind, value in (("t1", REAL, problem.t1), ("sensitivities", INT, 1),
                                    ("active_count", INT, which.size)):
            run.options.set(member, kind, value)
        run.options.set("active", POINTER, which.ctypes.data)
        times = checked_times(t_eval, problem.t0, problem.t1)
        with Interrupt(run.options, alone=problem.named):
            return _derivatives(problem, method, [problem.t1] if times is None else times, which)
    finally:
        if problem is not None:
            problem.close()
        context.close()


def _before_events(run):
    """A list that holds y before the event that came last."""
    seen = []

    def told(solver, t, y, fired, user):
        seen[:] = [np.array(run.read(y))]

    run.options.set("on_event", POINTER, _ON_EVENT(run.guarded(told)))
    return seen


def _at_event(problem, solver, work, view, which, r):
    """The derivatives of the time of the event that has ended a run, and of y there."""
    r.t_event, r.dt_event = float(r.t[-1]), np.full(which.size, np.nan)
    r.S_event, dt = np.full((which.size, problem.run.n), np.nan), REAL()
    for j, k in enumerate(which):
        if lib.steif_sensitivity_event(solver, int(k), c.byref(dt), work):
            r.message += "; no dt_event: " + lib.steif_message(problem.context.pointer).decode()
            break
        r.dt_event[j], r.S_event[j] = dt.value, view


def _derivatives(problem, method, times, which):
    run, pointer = problem.run, problem.context.pointer
    before = _before_events(run)
    solver = lib.steif_solver_new(pointer, run.problem.address, choice("method", method), run.options.address)
    if not solver:
        problem.check(lib.steif_status(pointer))
    work = lib.N_VClone(lib.steif_solution(solver))
    try:
        r, view = Result(), np.frombuffer((REAL * run.n).from_address(lib.N_VGetArrayPointer(work)))
        r.t, r.y = np.array(times, dtype=float), np.zeros((run.n, len(times)))
        r.S, r.status, r.message = np.zeros((which.size, run.n, len(times))), 0, "ok"
        for i, t in enumerate(r.t):
            code = lib.steif_solve_to(solver, t) if t > problem.t0 else 0
            problem.check(0 if code == _EVENT else code)
            r.y[:, i] = run.read(lib.steif_solution(solver))
            if code == _EVENT:
                r.status, r.message = 1, lib.steif_message(pointer).decode()
                r.t, r.y, r.S = r.t[:i + 1], r.y[:, :i + 1], r.S[:, :, :i + 1]
                r.t[i] = t = lib.steif_time(solver)
                r.y[:, i] = before[0]
            for j, k in enumerate(which):
                problem.check(lib.steif_sensitivity(solver, t, int(k), work))
                r.S[j, :, i] = view
            if code == _EVENT:
                _at_event(problem, solver, work, view, which, r)
                break
        stats = Struct("stats", address=lib.steif_statistics(solver))
        r.nsteps, r.method = stats.get("steps", c.c_long), lib.steif_method_used(solver).decode()
        r.names = [problem.names[k] for k in which]
        r.moved, r.notes = run.started(solver)
        return r
    finally:
        lib.N_VDestroy(work)
        lib.steif_solver_free(c.byref(POINTER(solver)))


# -- fits -------------------------------------------------------------------------------------------


def _columns(problem, t, data, sd):
    """Measurements one by one: times, values, standard deviations or None, components."""
    t = np.array(real("t", t)).ravel()
    keys = list(data) if isinstance(data, dict) else list(range(np.atleast_2d(data).shape[0]))
    rows = [real("data", data[k] if isinstance(data, dict) else np.atleast_2d(data)[k]) for k in keys]
    if any(row.shape != t.shape for row in rows):
        raise ValueError("data must have %d values for each unknown, one for each time" % t.size)
    if any(np.isinf(row).any() for row in rows):
        raise ValueError("data has an infinite value; nan is where nothing was measured")
    if not isinstance(data, dict) and len(rows) != problem.run.n:
        raise ValueError("data has %d rows, there are %d unknowns; a dict {unknown: values} names some"
                         % (len(rows), problem.run.n))
    if t.size and (np.min(t) < problem.t0 or np.max(t) > problem.t1 > problem.t0):
        raise ValueError("times of measurements lie outside of the interval from %g to %g: give t_span"
                         % (problem.t0, problem.t1))
    widths = None if sd is None else [_deviations(sd, i, k, t) for i, k in enumerate(keys)]
    given = [np.isfinite(row) for row in rows]
    pick = lambda parts: np.concatenate([np.asarray(part)[g] for part, g in zip(parts, given)])
    component = [np.full(t.shape, problem.measured(k)) for k in keys]
    return (pick([t] * len(rows)), pick(rows), None if widths is None else pick(widths),
            pick(component).astype(WHOLE))


def _deviations(sd, i, key, t):
    """Of row i of the data: one number, as many as there are times, or a row of an array like data."""
    if isinstance(sd, dict) and key not in sd:
        raise ValueError("sd has nothing of %r: give a number or an array for each key of data" % (key,))
    own = sd[key] if isinstance(sd, dict) else sd
    own = real("sd", own if isinstance(sd, dict) or np.ndim(sd) < 2 or i >= len(sd) else sd[i])
    if own.shape not in ((), (1,), t.shape):
        raise ValueError("sd has the shape %s, one number or %d, one for each time, are needed" % (own.shape, t.size))
    return np.broadcast_to(own, t.shape)


def _measurements(problem, t, data, sd):
    m = Struct("measurements")
    if data is None or isinstance(data, (str, bytes, os.PathLike)):
        widths = None if sd is None else np.atleast_1d(np.asarray(sd, dtype=float))
        code = lib.steif_measurements_read(
            problem.context.pointer, problem.run.problem.address,
            os.fsencode(data) if data is not None else None, problem.t1, 1,
            0 if widths is None else widths.size, None if widths is None else widths.ctypes.data,
            m.address)
        problem.check(code)
        return m, True
    times, values, widths, component = _columns(problem, t, data, sd)
    m.set("count", c.c_size_t, times.size)
    for member, array in (("t", times), ("value", values), ("sd", widths), ("component", component)):
        if array is not None:
            m.set(member, POINTER, array.ctypes.data)
            m.kept[member] = array
    return m, False


def _fit_options(problem, which, start, bounds, scale, starts):
    o = Struct("fit_options")
    o.set("run", POINTER, problem.run.options.address)
    o.set("count", INT, which.size)
    low, high, places = np.full(which.size, -np.inf), np.full(which.size, np.inf), list(which)
    for name, pair in (bounds or {}).items():
        k = problem.number(name)
        if k not in places:
            raise ValueError("bounds of %s, which is not fitted: name it in by" % name)
        if np.shape(pair) != (2,):
            raise ValueError("bounds of %s must be (low, high), None for no bound, got %r" % (name, pair))
        at = places.index(k)
        low[at], high[at] = (limit if value is None else value for value, limit in zip(pair, (-np.inf, np.inf)))
    for member, array in (("parameter", which), ("low", low), ("high", high), ("start", start)):
        o.set(member, POINTER, array.ctypes.data)
        o.kept[member] = array
    o.set("scale", INT, _SCALES.index(scale))
    o.set("starts", INT, int(starts))
    return o


def fit(f, t=None, data=None, *, p=None, y0=None, t_span=None, by=None, sd=None, bounds=None, scale="auto",
        starts=1, method="radau:s=3", rtol=1e-8, atol=None, jac=None, jac_sparsity=None, mass=None):
    """Find parameters from measurements by weighted least squares (Levenberg and Marquardt).

    f       f(t, y, *p), or the name of a problem ("lotka.steif")
    t       times of the measurements; of a CSV file None
    data    n x times, NaN where there is none; or {unknown or output: values}; or a CSV file (t, their names);
            None: the file that a model names, `data "FILE.csv"`
    p       values to begin with; of a named problem a dict of those that are to be others
    t_span  None: of f from 0 to the last time, of a named problem its own
    by      names or numbers of the parameters to find; None: those that a model names, `fit k`, else all
    sd      standard deviations: one number, an array like data, or {unknown: number or array}; None: not known.
            Given ones are taken for known: covariances are not scaled by chi2/dof, and intervals are normal, 1.96 sd
            to each side; else they are estimated by chi2/dof, and intervals are those of Student's t
    bounds  {name: (low, high)}, None for no bound
    scale   "log", "linear", or "auto": log where starts and bounds are positive
    starts  descents, the others from points between the bounds

    Returns a Result: p, names, sd, low, high (95 % intervals), covariance and correlation of p (sd is the root of the
    diagonal; inf and nan where the data do not tell), covariance_theta (of log p where `log`, else of p over its size),
    chi2, dof, probability (of a chi2 as large, where sd is given; else nan), known_sd, residual, undetermined, runs,
    method (what "auto" took), success, message.
    """
    if bounds is not None and not hasattr(bounds, "items"):
        raise ValueError("bounds must be a dict, {name: (low, high)}, got %r" % (bounds,))
    if scale not in _SCALES:
        raise ValueError("scale must be one of %s" % ", ".join(_SCALES))
    context, problem, found, data_read, own = Context(), None, Struct("fit"), None, False
    named = is_named(f)
    if data is None and not named:
        raise ValueError("data is missing: only a model names its own")
    if t is None and not isinstance(data, (str, bytes, os.PathLike, type(None))):
        raise ValueError("t is missing: the times of the measurements")
    if t_span is None and not named:
        if t is None or not np.size(t):
            raise ValueError("t_span is missing: (t0, t1), from the start to the last time of the file")
        t_span = (0.0, float(np.max(real("t", t))))
    try:
        problem = _Parametrised(context, f, t_span, y0, p, jac, jac_sparsity, mass, endless=True)
        which = problem.numbers(problem.fitted() if by is None else by)
        tolerances(problem.run, rtol, atol, problem.run.n)
        problem.run.options.set("t1", REAL, problem.t1)
        data_read, own = _measurements(problem, t, data, sd)
        options = _fit_options(problem, which, problem.value[which].copy(), bounds, scale, starts)
        with Interrupt(problem.run.options, alone=problem.named):
            code = lib.steif_fit_find(context.pointer, problem.run.problem.address, choice("method", method),
                                      data_read.address, options.address, found.address)
        if code != _NO_CONVERGENCE:
            problem.check(code)
        return _fitted(found, code, [problem.names[k] for k in which])
    finally:
        lib.steif_fit_free(context.pointer, found.address)
        if own:
            lib.steif_measurements_free(context.pointer, data_read.address)
        if problem is not None:
            problem.close()
        context.close()


def _fitted(found, code, names):
    r, count = Result(), found.get("count", INT)
    for member in ("p", "sd", "low", "high"):
        setattr(r, member, found.array(member, count))
    for member in ("covariance", "correlation", "covariance_theta"):
        setattr(r, member, found.array(member, count, count))
    r.residual = found.array("residual", found.get("residuals", c.c_size_t))
    r.names, r.log, r.chi2 = names, bool(found.get("log", INT)), found.get("chi2", REAL)
    r.dof, r.runs = found.get("dof", c.c_long), found.get("runs", c.c_long)
    r.known_sd, r.probability = bool(found.get("known", INT)), found.get("probability", REAL)
    r.method = found.text("used")
    r.undetermined, r.message = found.get("undetermined", INT), found.text("message")
    r.success = code == _OK
    return r
