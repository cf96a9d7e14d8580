"""One integration: callbacks from Python, arrays of NumPy on the memory of the library."""
import ctypes as c
import os
import signal
import threading

import numpy as np

from ._library import (INT, POINTER, REAL, WHOLE, Context, SteifError, Struct, fill_sparse, lib,
                       sparse_columns)
from ._record import OBSERVER, Dense, Steps

_RHS = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER)
_JACOBIAN = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER, POINTER, POINTER, POINTER, POINTER)
_FILL = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER, POINTER)
_VALUES = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER)
_OBSERVE = c.CFUNCTYPE(INT, POINTER, REAL, POINTER, POINTER)
_ON_EVENT = c.CFUNCTYPE(INT, POINTER, REAL, POINTER, POINTER, POINTER)
_STOP, _EVENT, _SPARSE = -1, 2, 2  # the last: STEIF_SPARSE of problem.h
_COUNTS = {"nfev": "nfe", "njev": "nje", "nlu": "nlu", "nsteps": "steps", "nrejected": "rejected"}


class Result:
    """What a run has left: t, y (n x points), sol (with dense_output), names (of the unknowns, or None),
    t_events, y_events, nfev, njev, nlu, nsteps, nrejected, method, status (0 the end was reached, 1 an
    event ended the run, negative a failure), message, success."""

    def __repr__(self):
        return "\n".join("%10s: %s" % (key, getattr(self, key)) for key in sorted(vars(self)))


class _Arrays:
    """NumPy views of vectors and matrices of the library, made once for each address."""

    def __init__(self):
        self.views = {}

    def _view(self, address, shape):
        key = (address, shape)
        view = self.views.get(key)
        if view is None:
            count = int(np.prod(shape))
            view = np.frombuffer((REAL * count).from_address(address)).reshape(shape, order="F")
            self.views[key] = view
        return view

    def vector(self, v, n):
        return self._view(lib.N_VGetArrayPointer(v), (n,))

    def matrix(self, m, n):
        return self._view(lib.SUNDenseMatrix_Data(m), (n, n))

    def plain(self, address, n):
        return self._view(address, (n,))


def _kind(value):
    return "None" if value is None else "the shape %s" % (np.shape(value),)


def _wrong(what, value, n):
    kind = np.asarray(value).dtype.kind if value is not None else "f"
    if kind == "c":
        return TypeError("%s is complex; write real and imaginary parts as unknowns of their own" % what)
    return ValueError("%s returned %s, an array or list of %d numbers is needed" % (what, _kind(value), n))


def _matrix(M):
    return M if hasattr(M, "tocsc") else np.asarray(M, dtype=float)


class _Interrupt:
    """Ctrl-C sets the flag options.stop: an exception between two callbacks would be lost."""

    def __init__(self, options):
        self.flag = INT(0)
        options.set("stop", POINTER, c.addressof(self.flag))
        self.before = None

    def __enter__(self):
        usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if usual and threading.current_thread() is threading.main_thread():
            self.before = signal.signal(signal.SIGINT, self._raise)

    def _raise(self, number, frame):
        self.flag.value = 1

    def __exit__(self, *reason):
        if self.before is not None:
            signal.signal(signal.SIGINT, self.before)
        if self.flag.value:
            raise KeyboardInterrupt


class _Run:
    """The problem, the options and the callbacks of one call."""

    def __init__(self, n):
        self.n, self.arrays, self.raised, self.is_sparse = n, _Arrays(), None, False
        self.problem, self.options = Struct("problem"), Struct("options")
        self.t, self.y, self.names = [], [], None

    def guarded(self, work):
        """A callback of the library: an exception ends the run and is raised again after it."""

        def call(*arguments):
            try:
                work(*arguments)
                return 0
            except BaseException as reason:  # Ctrl-C as well
                self.raised = self.raised or reason
                return _STOP

        return call

    def give(self, member, kind, work):
        self.problem.set(member, POINTER, kind(self.guarded(work)))

    def right_hand_side(self, f, args):
        vector, n = self.arrays.vector, self.n

        def work(t, y, out, user):
            value = f(t, vector(y, n), *args)
            to = vector(out, n)
            try:
                to[:] = value
            except (ValueError, TypeError):
                raise _wrong("f(t, y)", value, n) from None
            short = n > 1 and (not hasattr(value, "__len__") or len(value) == 1)
            if value is None or (short and np.size(value) != n):
                raise _wrong("f(t, y)", value, n)

        self.give("f", _RHS, work)

    def jacobian(self, jac, args):
        vector, matrix, n = self.arrays.vector, self.arrays.matrix, self.n

        def value(t, y):
            return jac(t, y, *args) if callable(jac) else jac

        if self.is_sparse:
            def work(t, y, fy, J, user, a, b, d):
                fill_sparse(J, sparse_columns(_matrix(value(t, vector(y, n))), n, "jac"), "jac")
        else:
            def work(t, y, fy, J, user, a, b, d):
                M = value(t, vector(y, n))
                if np.shape(M) != (n, n):
                    raise ValueError("jac returned %s, the shape %s is needed" % (_kind(M), (n, n)))
                matrix(J, n)[:, :] = M

        self.give("jac", _JACOBIAN, work)

    def mass(self, M):
        matrix, n = self.arrays.matrix, self.n
        if np.shape(M) != (n, n):
            raise ValueError("mass has the shape %s, %s is needed" % (np.shape(M), (n, n)))
        if self.is_sparse:
            columns = sparse_columns(_matrix(M), n, "mass")
            self.problem.set("nnz_E", WHOLE, max(columns[2].size, 1))

            def work(t, y, yp, E, user):
                fill_sparse(E, columns, "mass")
        else:
            full = np.asarray(M.toarray() if hasattr(M, "toarray") else M, dtype=float)

            def work(t, y, yp, E, user):
                matrix(E, n)[:, :] = full

        self.give("E", _FILL, work)

    def watch(self, events, args):
        vector, plain, n, count = self.arrays.vector, self.arrays.plain, self.n, len(events)
        size = lib.steif_layout(b"event")
        rows = c.create_string_buffer(size * count)
        for i, event in enumerate(events):
            for member in ("direction", "terminal"):
                at = lib.steif_layout(("event." + member).encode())
                value = int(np.sign(float(getattr(event, member, 0))))
                INT.from_address(c.addressof(rows) + i * size + at).value = value

        def work(t, y, value, user):
            u = vector(y, n)
            for i, event in enumerate(events):
                g = event(t, u, *args)
                if np.size(g) != 1 or g is None:
                    raise ValueError("event %d returned %s, one number is needed" % (i + 1, _kind(g)))
                plain(value, count)[i] = g if np.ndim(g) == 0 else np.ravel(g)[0]

        self.give("event", _VALUES, work)
        self.problem.set("events", INT, count)
        self.problem.set("event_list", POINTER, rows)
        self.note_events(count)

    def note_events(self, count):
        vector, n = self.arrays.vector, self.n
        self.t_events, self.y_events = [[] for _ in range(count)], [[] for _ in range(count)]

        def fired(s, t, y, which, user):
            signs = (INT * count).from_address(which)
            for i in range(count):
                if signs[i]:
                    self.t_events[i].append(t)
                    self.y_events[i].append(vector(y, n).copy())

        self.options.set("on_event", POINTER, _ON_EVENT(self.guarded(fired)))

    def sparse(self, pattern, given):
        """Entries that df/dy may have: differences by groups of columns where it is not `given`, sparse
        matrices."""
        if np.shape(pattern) != (self.n, self.n):
            raise ValueError("jac_sparsity has the shape %s, %s is needed"
                             % (np.shape(pattern), (self.n, self.n)))
        self.is_sparse = True
        self.problem.set("storage", INT, _SPARSE)
        if given:
            self.problem.set("nnz", WHOLE, max(int(pattern.nnz if hasattr(pattern, "nnz")
                                                   else np.count_nonzero(pattern)), 1))
            return
        rows, columns = pattern.nonzero() if hasattr(pattern, "nonzero") else np.nonzero(pattern)
        order = np.lexsort((rows, columns))
        start = np.searchsorted(columns[order], np.arange(self.n + 1)).astype(WHOLE)
        rows, kept = rows[order].astype(WHOLE), Struct("pattern")
        kept.set("column", POINTER, start.ctypes.data)
        kept.set("row", POINTER, rows.ctypes.data)
        self.problem.set("pattern", POINTER, kept.address)
        self.problem.kept["pattern"] = kept, start, rows

    def observe(self, steps, record):
        """All steps as points, or as polynomials in the record, by the library alone; both by a callback."""
        if steps is None or record is None:
            kept = steps or record
            if kept is not None:
                self.options.set("observe", POINTER, OBSERVER)
                self.options.set("observer", POINTER, kept.record)
            return

        def keep(s, t, y, user):
            steps.step(s, t, y)
            record.step(s, t, y)

        self.options.set("observe", POINTER, _OBSERVE(self.guarded(keep)))

    def go(self, context, method, t0, t1, times, steps):
        with _Interrupt(self.options):
            solver = lib.steif_solver_new(context.pointer, self.problem.address, method.encode(),
                                          self.options.address)
            if not solver:
                raise self.raised or context.error()
            try:
                return self._advance(context, solver, t0, t1, times, steps)
            finally:
                lib.steif_solver_free(c.byref(POINTER(solver)))

    def _advance(self, context, solver, t0, t1, times, steps):
        vector, n, code = self.arrays.vector, self.n, 0
        if times is None:
            steps.step(solver, t0, lib.steif_solution(solver))
            code = lib.steif_solve_to(solver, t1)
        else:
            for t in times:
                code = lib.steif_solve_to(solver, t) if t > t0 else 0
                if code in (0, _EVENT):
                    self.t.append(lib.steif_time(solver))
                    self.y.append(vector(lib.steif_solution(solver), n).copy())
                if code:
                    break
            if not code and t1 > times[-1]:
                code = lib.steif_solve_to(solver, t1)
        if self.raised:
            raise self.raised
        points = steps.arrays() if steps else (np.array(self.t), np.array(self.y).T)
        return self._result(context, solver, code, points)

    def _result(self, context, solver, code, points):
        r, stats = Result(), Struct("stats")
        stats.address = lib.steif_statistics(solver)
        for name, member in _COUNTS.items():
            setattr(r, name, stats.get(member, c.c_long))
        r.t, r.y = points
        r.t_events = [np.array(t) for t in self.t_events] if hasattr(self, "t_events") else None
        r.y_events = [np.array(y) for y in self.y_events] if hasattr(self, "y_events") else None
        r.names = self.names
        r.method = lib.steif_method_used(solver).decode()
        r.status = 0 if code == 0 else 1 if code == _EVENT else code
        r.message = lib.steif_message(context.pointer).decode()
        r.success = code in (0, _EVENT)
        return r


def _positive(name, value):
    if not float(value) > 0:
        raise ValueError("%s is %g and must be above 0" % (name, value))
    return float(value)


def _tolerances(run, rtol, atol, n):
    if rtol == 0:
        raise ValueError("rtol is 0 and must be above 0, 1e-14 at least")
    run.options.set("rtol", REAL, float(rtol))
    if atol is None:
        return
    if np.ndim(atol) == 0:
        run.options.set("atol", REAL, float(atol))
        return
    each = np.ascontiguousarray(atol, dtype=float)
    if each.shape != (n,):
        raise ValueError("atol has the shape %s, %s is needed" % (each.shape, (n,)))
    run.options.set("atols", POINTER, each.ctypes.data)
    run.options.kept["atols"] = each


def _times(t_eval, t0, t1):
    if t_eval is None:
        return None
    times = np.asarray(t_eval, dtype=float)
    if times.ndim != 1 or times.size == 0 or not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0):
        raise ValueError("t_eval must hold ascending times")
    if times[0] < t0 or times[-1] > t1:
        raise ValueError("t_eval must lie within the interval from %g to %g" % (t0, t1))
    return times


def _known(context, spec, t_span):
    """A problem of the collection or a model file."""
    found = Struct("problem")
    code = lib.steif_problem_find(context.pointer, os.fspath(spec).encode(), found.address)
    if code:
        raise context.error()
    run = _Run(found.get("n", WHOLE))
    run.problem = found
    if found.get("events", INT):
        run.note_events(found.get("events", INT))
    names = found.get("names", POINTER)
    unknown = Struct("names", address=names).get("unknown", POINTER) if names else None
    if unknown:
        run.names = [name.decode() for name in (c.c_char_p * run.n).from_address(unknown)]
    t0, t1 = found.get("t0", REAL), found.get("t1", REAL)
    if t_span is None:
        return run, t0, t1
    if np.shape(t_span) != (2,) or float(t_span[0]) != t0:
        lib.steif_problem_clear(context.pointer, found.address)
        raise ValueError("t_span must be (%g, t1), for %r begins at %g; got %r" % (t0, spec, t0, t_span))
    return run, t0, float(t_span[1])


def _refuse(spec, **given):
    """What a named problem has itself."""
    for name, value in given.items():
        if value is not None:
            raise ValueError("%s is given, but %r has its own: leave it None%s" % (
                name, spec, ", and set a parameter: 'FILE.steif:x0=1'" if name in ("y0", "args") else ""))


def _own(f, t_span, y0, args, jac, jac_sparsity, mass, events):
    if t_span is None or y0 is None or not callable(f):
        raise ValueError("solve needs f(t, y), (t0, t1) and y0, or the name of a problem")
    start = np.array(y0, dtype=float)
    if start.ndim != 1:
        raise ValueError("y0 must have one dimension, it has %d: write [1.0] for one unknown" % start.ndim)
    run = _Run(start.size)
    if np.shape(t_span) != (2,):
        raise ValueError("t_span must be (t0, t1), got %r" % (t_span,))
    t0, t1 = (float(t) for t in t_span)
    for member, kind, value in (("n", WHOLE, start.size), ("t0", REAL, t0), ("t1", REAL, t1)):
        run.problem.set(member, kind, value)
    run.problem.set("name", POINTER, c.c_char_p(b"f"))
    run.problem.set("y0", POINTER, start.ctypes.data)
    run.problem.kept["y0"] = start
    run.right_hand_side(f, args)
    if jac is not None and jac_sparsity is None:
        first = jac(t0, start.copy(), *args) if callable(jac) else jac
        jac_sparsity = first if hasattr(first, "tocsc") else None
    if jac_sparsity is not None:
        run.sparse(jac_sparsity, jac is not None)
    if jac is not None:
        run.jacobian(jac, args)
    if mass is not None:
        run.mass(mass)
    if events is not None:
        run.watch(list(events) if isinstance(events, (list, tuple)) else [events], args)
    return run, t0, t1


def solve(f, t_span=None, y0=None, *, method="auto", rtol=1e-6, atol=None, t_eval=None,
          dense_output=False, jac=None, jac_sparsity=None, mass=None, events=None, args=(), h=None,
          first_step=None, max_step=None, max_steps=None):
    """Integrate y' = f(t, y), or mass y' = f(t, y) with a constant, possibly singular matrix.

    f             f(t, y) -> array or list; or the name of a problem ("rober", "pendulum.steif:k=3"), which has its
                  own y0, jac, mass and events: parameters change it
    t_span        (t0, t1); of a named problem None: its own, or another t1
    method        a spec of steif: "auto", "radau:s=3", "bdf", "cvode", ...
    atol          a number or one for each component; None: rtol times the scale of the problem (1)
    t_eval        times of the output; None: the steps
    dense_output  True: .sol(t) is the solution at any time of the run
    jac           jac(t, y) -> n x n, or a constant array, of NumPy or scipy.sparse; None: differences
    jac_sparsity  n x n, not 0 where df/dy may have an entry (NumPy or scipy.sparse): for large n; beside
                  a sparse jac only where it may get more entries than it has at the start
    events        g(t, y) or several; .terminal and .direction as in SciPy
    h             a constant step size instead of tolerances

    Returns a Result. A run that stops early has success False and says why in message; bad input is a
    SteifError or ValueError; an exception in a callback ends the run and is raised again.
    """
    context = Context()
    named = isinstance(f, (str, bytes, os.PathLike))
    run = record = steps = result = None
    try:
        if named:
            _refuse(f, y0=y0, args=args or None, jac=jac, jac_sparsity=jac_sparsity, mass=mass, events=events)
            run, t0, t1 = _known(context, f, t_span)
        else:
            run, t0, t1 = _own(f, t_span, y0, tuple(args), jac, jac_sparsity, mass, events)
        _tolerances(run, rtol, atol, run.n)
        run.options.set("t1", REAL, t1)
        for member, name, value in (("h", "h", h), ("h0", "first_step", first_step),
                                    ("h_max", "max_step", max_step)):
            if value is not None:
                run.options.set(member, REAL, _positive(name, value))
        if max_steps is not None:
            run.options.set("max_steps", c.c_long, int(max_steps))
        times = _times(t_eval, t0, t1)
        record = Dense(context, run.n) if dense_output else None
        steps = Steps(context, run.n) if times is None else None
        run.observe(steps, record)
        result = run.go(context, method, t0, t1, times, steps)
        result.sol = record  # which keeps the context from here on
        return result
    finally:
        if steps is not None:
            steps.close()
        if named and run is not None:
            lib.steif_problem_clear(context.pointer, run.problem.address)
        if result is None or record is None:
            (record or context).close()
