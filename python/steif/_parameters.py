"""Parameters of a problem: derivatives of its solution, fits to measurements, many runs at once."""
import ctypes as c
import inspect
import os

import numpy as np

from ._library import INT, POINTER, REAL, WHOLE, Context, Struct, lib
from ._solve import Result, _Interrupt, _known, _own, _refuse, _times, _tolerances

_OK, _EVENT, _NO_CONVERGENCE = 0, 2, -6  # of base.h
_SCALES = ("auto", "log", "linear")  # enum steif_fit_scale
_MEMBER = c.CFUNCTYPE(INT, POINTER, c.c_longlong, POINTER, POINTER, POINTER)
_DONE = c.CFUNCTYPE(INT, POINTER, c.c_longlong, POINTER, POINTER, INT, POINTER, POINTER)


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

    def __init__(self, context, f, t_span, y0, p, jac, jac_sparsity, mass):
        self.context, self.named = context, isinstance(f, (str, bytes, os.PathLike))
        if self.named:
            _refuse(f, y0=y0, jac=jac, jac_sparsity=jac_sparsity, mass=mass)
            self.run, self.t0, self.t1 = _known(context, f, t_span)
            self._of_the_library(p)
        else:
            if p is None:
                raise ValueError("the parameters p of f(t, y, *p) are missing")
            self.value = np.array(p, dtype=float).ravel()
            self.run, self.t0, self.t1 = _own(f, t_span, y0, self.value, jac, jac_sparsity, mass, None)
            self.names = _names_of(f, self.value.size)
            self._own_struct()

    def _of_the_library(self, p):
        address = self.run.problem.get("parameters", POINTER)
        if not address:
            raise ValueError("this problem has no parameters")
        table = Struct("parameters", address=address)
        count = table.get("count", INT)
        self.value = np.frombuffer((REAL * count).from_address(table.get("value", POINTER)))
        names = table.get("name", POINTER)
        self.names = ([name.decode() for name in (c.c_char_p * count).from_address(names)] if names
                      else ["p%d" % (k + 1) for k in range(count)])
        if p is not None:
            self._vary(dict(p))

    def _vary(self, p):
        """The problem with other values, in the place of the one at hand."""
        for name in p:
            if name not in self.names:
                raise ValueError("no parameter %r; there are %s" % (name, ", ".join(self.names)))
        old, names, values = self.run.problem, _words(p), _reals(p.values())
        new = Struct("problem")
        code = lib.steif_problem_vary(self.context.pointer, old.address, len(p), names,
                                      values.ctypes.data, new.address)
        if code:
            raise self.context.error()
        lib.steif_problem_clear(self.context.pointer, old.address)
        self.run.problem = new
        self._of_the_library(None)

    def _own_struct(self):
        table, words = Struct("parameters"), _words(self.names)
        table.set("count", INT, self.value.size)
        table.set("value", POINTER, self.value.ctypes.data)
        table.set("name", POINTER, words)
        self.run.problem.set("parameters", POINTER, table.address)
        self.run.problem.kept["parameters"] = table, self.value

    def numbers(self, which):
        """Of names, numbers from 0, or None: all."""
        if which is None:
            return np.arange(len(self.names), dtype=c.c_int)
        found = []
        for one in [which] if isinstance(which, (str, int)) else which:
            if isinstance(one, str) and one not in self.names:
                raise ValueError("no parameter %r; there are %s" % (one, ", ".join(self.names)))
            found.append(self.names.index(one) if isinstance(one, str) else int(one))
        return np.array(found, dtype=c.c_int)

    def fitted(self):
        """The names that a model gives by `fit`, or None."""
        names = []
        while (name := lib.steif_model_fitted(self.run.problem.address, len(names))):
            names.append(name.decode())
        return names or None

    def measured(self, key):
        """Of an unknown its number, of output k of a model n + k."""
        if isinstance(key, str):
            names = list(self.run.names or ["y%d" % (i + 1) for i in range(self.run.n)])
            while (output := lib.steif_model_output(self.run.problem.address, len(names) - self.run.n)):
                names.append(output.decode())
            if key not in names:
                raise ValueError("no unknown %r; there are %s" % (key, ", ".join(names[:12])))
            return names.index(key)
        return int(key)

    def check(self, code):
        if self.run.raised:
            raise self.run.raised
        if code:
            raise self.context.error()

    def close(self):
        if self.named:
            lib.steif_problem_clear(self.context.pointer, self.run.problem.address)


def _words(names):
    return (c.c_char_p * max(len(names), 1))(*[str(name).encode() for name in names])


def _reals(values):
    return np.ascontiguousarray(list(values), dtype=float)


# -- derivatives ------------------------------------------------------------------------------------


def sensitivity(f, t_span=None, y0=None, *, p=None, by=None, method="radau:s=5", rtol=1e-6, atol=None,
                t_eval=None, jac=None, jac_sparsity=None, mass=None):
    """Derivatives dy/dp of a solution by its parameters, beside the solution.

    f       f(t, y, *p), or the name of a problem ("rober", "lotka.steif")
    p       values of the parameters; of a named problem a dict of those that are to be others
    by      names or numbers of the parameters to differentiate by; None: all
    t_eval  times of the output; None: the end
    method  collocation, BDF or DIRK, cvodes or idas; and the other arguments of `solve`

    Returns a Result: t, y (n x points), S (parameters x n x points), names (of the parameters), nsteps, method.
    """
    context, problem = Context(), None
    try:
        problem = _Parametrised(context, f, t_span, y0, p, jac, jac_sparsity, mass)
        run, which = problem.run, problem.numbers(by)
        _tolerances(run, rtol, atol, run.n)
        for member, kind, value in (("t1", REAL, problem.t1), ("sensitivities", INT, 1),
                                    ("active_count", INT, which.size)):
            run.options.set(member, kind, value)
        run.options.set("active", POINTER, which.ctypes.data)
        times = _times(t_eval, problem.t0, problem.t1)
        with _Interrupt(run.options):
            return _derivatives(problem, method, [problem.t1] if times is None else times, which)
    finally:
        if problem is not None:
            problem.close()
        context.close()


def _derivatives(problem, method, times, which):
    run, pointer = problem.run, problem.context.pointer
    solver = lib.steif_solver_new(pointer, run.problem.address, method.encode(), run.options.address)
    if not solver:
        problem.check(lib.steif_status(pointer))
    work = lib.N_VClone(lib.steif_solution(solver))
    try:
        r, view = Result(), np.frombuffer((REAL * run.n).from_address(lib.N_VGetArrayPointer(work)))
        r.t, r.y = np.array(times, dtype=float), np.zeros((run.n, len(times)))
        r.S = np.zeros((which.size, run.n, len(times)))
        for i, t in enumerate(r.t):
            problem.check(lib.steif_solve_to(solver, t) if t > problem.t0 else 0)
            r.y[:, i] = run.arrays.vector(lib.steif_solution(solver), run.n)
            for j, k in enumerate(which):
                problem.check(lib.steif_sensitivity(solver, t, int(k), work))
                r.S[j, :, i] = view
        stats = Struct("stats", address=lib.steif_statistics(solver))
        r.nsteps, r.method = stats.get("steps", c.c_long), lib.steif_method_used(solver).decode()
        r.names = [problem.names[k] for k in which]
        return r
    finally:
        lib.N_VDestroy(work)
        lib.steif_solver_free(c.byref(POINTER(solver)))


# -- fits -------------------------------------------------------------------------------------------


def _columns(problem, t, data, sd):
    """Measurements one by one: times, values, standard deviations or None, components."""
    t = np.asarray(t, dtype=float).ravel()
    keys = list(data) if isinstance(data, dict) else list(range(np.atleast_2d(data).shape[0]))
    rows = [np.asarray(data[k] if isinstance(data, dict) else np.atleast_2d(data)[k], dtype=float)
            for k in keys]
    if any(row.shape != t.shape for row in rows):
        raise ValueError("data must have %d values for each unknown, one for each time" % t.size)
    if not isinstance(data, dict) and len(rows) != problem.run.n:
        raise ValueError("data has %d rows, there are %d unknowns; a dict {unknown: values} names some"
                         % (len(rows), problem.run.n))
    widths = None
    if sd is not None:
        widths = [np.broadcast_to(np.asarray(sd[k] if isinstance(sd, dict) else sd, dtype=float)
                                  if isinstance(sd, dict) or np.ndim(sd) < 2 else np.asarray(sd)[i],
                                  t.shape) for i, k in enumerate(keys)]
    given = [np.isfinite(row) for row in rows]
    pick = lambda parts: np.concatenate([np.asarray(part)[g] for part, g in zip(parts, given)])
    component = [np.full(t.shape, problem.measured(k)) for k in keys]
    return (pick([t] * len(rows)), pick(rows), None if widths is None else pick(widths),
            pick(component).astype(WHOLE))


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
    low, high = np.full(which.size, -np.inf), np.full(which.size, np.inf)
    for i, k in enumerate(which):
        a, b = (bounds or {}).get(problem.names[k], (None, None))
        low[i], high[i] = (-np.inf if a is None else a), (np.inf if b is None else b)
    unknown = set(bounds or {}) - {problem.names[k] for k in which}
    if unknown:
        raise ValueError("bounds of %s, which is not fitted" % ", ".join(sorted(unknown)))
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
    sd      standard deviations: one number, an array like data, or {unknown: number or array}; None: not known
    bounds  {name: (low, high)}, None for no bound
    scale   "log", "linear", or "auto": log where starts and bounds are positive
    starts  descents, the others from points between the bounds

    Returns a Result: p, names, sd, low, high (95 % intervals), covariance and correlation (of log p, or p over its
    size: `log` says which), chi2, dof, residual, undetermined, runs, success, message.
    """
    if scale not in _SCALES:
        raise ValueError("scale must be one of %s" % ", ".join(_SCALES))
    context, problem, found, data_read, own = Context(), None, Struct("fit"), None, False
    named = isinstance(f, (str, bytes, os.PathLike))
    if data is None and not named:
        raise ValueError("data is missing: only a model names its own")
    if t_span is None and not named:
        t_span = (0.0, float(np.max(t)))
    try:
        problem = _Parametrised(context, f, t_span, y0, p, jac, jac_sparsity, mass)
        which = problem.numbers(problem.fitted() if by is None else by)
        _tolerances(problem.run, rtol, atol, problem.run.n)
        problem.run.options.set("t1", REAL, problem.t1)
        data_read, own = _measurements(problem, t, data, sd)
        options = _fit_options(problem, which, problem.value[which].copy(), bounds, scale, starts)
        with _Interrupt(problem.run.options):
            code = lib.steif_fit_find(context.pointer, problem.run.problem.address, method.encode(),
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
    for member in ("covariance", "correlation"):
        setattr(r, member, found.array(member, count, count))
    r.residual = found.array("residual", found.get("residuals", c.c_size_t))
    r.names, r.log, r.chi2 = names, bool(found.get("log", INT)), found.get("chi2", REAL)
    r.dof, r.runs = found.get("dof", c.c_long), found.get("runs", c.c_long)
    r.undetermined, r.message = found.get("undetermined", INT), found.text("message")
    r.success = code == _OK
    return r


# -- many runs --------------------------------------------------------------------------------------


def _told(run, work):
    """A callback whose code counts; an exception is raised again after the runs."""

    def call(*arguments):
        try:
            return work(*arguments)
        except BaseException as reason:
            run.raised = run.raised or reason
            return -1

    return call


def sweep(f, values, *, t1=None, method="auto", rtol=1e-6, atol=None, threads=0):
    """End values of a named problem, or model file, for many values of its parameters, on all cores.

    values   {name: one value for each run}; all of one length
    threads  0: as many as there are cores

    Returns a Result: y (n x runs, NaN where a run failed), status (of each, 0: fine), values, names.
    """
    columns = {name: np.asarray(column, dtype=float).ravel() for name, column in values.items()}
    lengths = {column.size for column in columns.values()}
    if len(lengths) != 1 or not min(lengths):
        raise ValueError("values must hold one number for each run, the same for all parameters")
    count, context, problem = lengths.pop(), Context(), None
    try:
        problem, start, end = _known(context, f, None)
        end = end if t1 is None else float(t1)
        _tolerances(problem, rtol, atol, problem.n)
        problem.options.set("t1", REAL, end)
        r = Result()
        r.y, r.status = np.full((problem.n, count), np.nan), np.zeros(count, dtype=int)
        r.values, r.names = columns, problem.names
        names, rows = _words(columns), np.ascontiguousarray(np.array(list(columns.values())).T)

        def member(ctx, i, to, options, user):
            other = Struct("problem")
            code = lib.steif_problem_vary(ctx, to, len(columns), names, rows[i].ctypes.data,
                                          other.address)
            if not code:
                c.memmove(to, other.address, other.size)
            return code

        def done(ctx, i, own, solver, code, record, user):
            r.status[i] = code
            if solver and code in (_OK, _EVENT):
                r.y[:, i] = (REAL * problem.n).from_address(
                    lib.N_VGetArrayPointer(lib.steif_solution(solver)))
            return 0

        calls = _MEMBER(_told(problem, member)), _DONE(_told(problem, done))
        e, interrupt = Struct("ensemble_options"), _Interrupt(problem.options)
        for name, kind, value in (("problem", POINTER, c.c_char_p(os.fspath(f).encode())),
                                  ("method", POINTER, c.c_char_p(method.encode())),
                                  ("options", POINTER, problem.options.address),
                                  ("stop", POINTER, c.addressof(interrupt.flag)),
                                  ("threads", INT, int(threads))):
            e.set(name, kind, value)
        with interrupt:
            code = lib.steif_ensemble(context.pointer, count, calls[0], calls[1], e.address)
        if problem.raised:
            raise problem.raised
        if code:
            raise context.error()
        return r
    finally:
        if problem is not None:
            lib.steif_problem_clear(context.pointer, problem.problem.address)
        context.close()
