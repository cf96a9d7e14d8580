"""One run: the callbacks of a problem in Python, the options, and what is left of it."""
import ctypes as c
import signal
import socket
import threading

import numpy as np

from ._library import INT, POINTER, REAL, WHOLE, SteifError, Struct, lib
from ._record import OBSERVER
from ._values import (choice, explained, fill_sparse, grids, kind, memory, places_of, reader, real, returned,
                      right_hand_side, sparse_columns, spread_sparse)

_RHS = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER)
_JACOBIAN = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER, POINTER, POINTER, POINTER, POINTER)
_FILL = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER, POINTER)
_VALUES = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER)
_OBSERVE = c.CFUNCTYPE(INT, POINTER, REAL, POINTER, POINTER)
_ON_EVENT = c.CFUNCTYPE(INT, POINTER, REAL, POINTER, POINTER, POINTER)
_JUMP = c.CFUNCTYPE(INT, REAL, POINTER, POINTER, POINTER)
STOP, EVENT, _SPARSE, _NO_MEMORY = -1, 2, 2, -1  # the third: STEIF_SPARSE of problem.h
_COUNTS = {"nfev": "nfe", "njev": "nje", "nlu": "nlu", "nsteps": "steps", "nrejected": "rejected"}


class Result:
    """What a run has left: t, y (n x points), sol (with dense_output), names (of the unknowns, or None), outputs (of a
    model: {name: values at t}), t_events, y_events, events ([(t, name, what it has become)] in their order), nfev, njev, nlu, nsteps, nrejected, method, status (0 the end was
    reached, 1 an event ended the run, negative a failure), message, success, moved (start values that did not fulfil
    the equations: {name, or number from 0: (given, used)}), notes (sentences on the start and on accuracy)."""

    def __repr__(self):
        return "\n".join("%10s: %s" % (key, getattr(self, key)) for key in sorted(vars(self)))


class Interrupt:
    """Ctrl-C sets the flag options.stop: an exception between two callbacks would be lost. Inside a callback it is
    raised at once, as anywhere in Python; where no callback is called (`alone`), a thread waits for the signal."""

    def __init__(self, options, alone=False):
        self.flag, self.alone, self.before, self.ends = INT(0), alone, None, None
        options.set("stop", POINTER, c.addressof(self.flag))

    def __enter__(self):
        usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if usual and threading.current_thread() is threading.main_thread():
            self.before = signal.signal(signal.SIGINT, self._raise)
            if self.alone:
                self._listen()

    def _listen(self):
        near, far = socket.socketpair()
        far.setblocking(False)
        old = signal.set_wakeup_fd(far.fileno(), warn_on_full_buffer=False)
        if old != -1:  # another has it, such as an event loop
            signal.set_wakeup_fd(old)
            near.close()
            far.close()
            return

        def wait():
            while (number := near.recv(1)) not in (b"", b"\0"):
                if number[0] == signal.SIGINT:
                    self.flag.value = 1

        self.ends = near, far, threading.Thread(target=wait, daemon=True)
        self.ends[2].start()

    def _raise(self, number, frame):
        self.flag.value = 1
        above = frame and frame.f_back
        while above is not None and above.f_code not in _GUARDS:
            above = above.f_back
        if above is not None and frame.f_code not in _GUARDS:
            raise KeyboardInterrupt

    def __exit__(self, *reason):
        if self.ends:
            signal.set_wakeup_fd(-1)
            near, far, thread = self.ends
            far.send(b"\0")
            thread.join()
            near.close()
            far.close()
        if self.before is not None:
            signal.signal(signal.SIGINT, self.before)
        if self.flag.value and self.before is not None:
            raise KeyboardInterrupt


def _guarded(run, work, what):
    """A callback of the library: an exception ends the run and is raised again after it."""

    def call(*arguments):
        try:
            work(*arguments)
            return 0
        except BaseException as reason:  # Ctrl-C as well
            return run.failed(reason, what)

    return call


_GUARDS = {_guarded(None, None, None).__code__, right_hand_side(None, (), 1, None).__code__}


class Run:
    """The problem, the options and the callbacks of one call."""

    def __init__(self, n, problem=None):
        self.n, self.raised, self.is_sparse = n, None, False
        self.read, self.problem, self.options = reader(n), problem or Struct("problem"), Struct("options")
        self.options.set("recompute", INT, 1)
        self.t, self.y, self.names, self.outputs, self.jumped = [], [], None, None, None
        self.t_events = self.y_events = None
        self.happened, self.event_names = [], []
        self.next, self.between = 0, {}

    def guarded(self, work, what=None):
        return _guarded(self, work, what)

    def give(self, member, shape, work, what=None):
        self.problem.set(member, POINTER, shape(self.guarded(work, what)))

    def failed(self, reason, what):
        """An exception ends the run and is raised again after it."""
        self.raised = self.raised or explained(reason, what)
        return STOP

    def right_hand_side(self, f, args):
        self.problem.set("f", POINTER, _RHS(right_hand_side(f, args, self.n, self.failed)))

    def jacobian(self, jac, args):
        read, n = self.read, self.n
        constant = None if callable(jac) else jac if hasattr(jac, "tocsc") else returned("jac", jac, (n, n))

        def value(t, y):
            return jac(t, read(y), *args) if constant is None else constant

        if self.is_sparse:
            def work(t, y, fy, J, user, a, b, d):
                M = value(t, y)
                M = M if hasattr(M, "tocsc") else returned("jac", M, (n, n))
                fill_sparse(J, spread_sparse(sparse_columns(M, n, "jac"), self.pattern, n, "jac"))
        else:
            grid = grids((n, n))

            def work(t, y, fy, J, user, a, b, d):
                M = value(t, y)
                if np.shape(M) != (n, n):
                    raise ValueError("jac returned %s, the shape %s is needed" % (kind(M), (n, n)))
                grid(lib.SUNDenseMatrix_Data(J))[:, :] = returned("jac", M, (n, n))

        self.give("jac", _JACOBIAN, work, "jac(t, y)")

    def mass(self, M):
        n = self.n
        if callable(M):
            raise ValueError("mass is a function and must be a constant matrix, %s" % ((n, n),))
        if np.shape(M) != (n, n):
            raise ValueError("mass has the shape %s, %s is needed" % (np.shape(M), (n, n)))
        if self.is_sparse:
            columns = sparse_columns(M if hasattr(M, "tocsc") else real("mass", M), n, "mass")
            self.problem.set("nnz_E", WHOLE, max(columns[2].size, 1))

            def work(t, y, yp, E, user):
                fill_sparse(E, columns)
        else:
            full = np.array(real("mass", M.toarray() if hasattr(M, "toarray") else M))

            def work(t, y, yp, E, user):
                memory(lib.SUNDenseMatrix_Data(E), (n, n))[:, :] = full

        self.give("E", _FILL, work)

    def watch(self, events, args):
        """Event functions; `terminal` may be a number, as in SciPy: the run ends at that occurrence."""
        read, count = self.read, len(events)
        rows, self.left = Struct("event", max(count, 1)), []
        for i, event in enumerate(events):
            if not callable(event):
                raise TypeError("event %d is %r and must be a function g(t, y)" % (i + 1, event))
            self.left.append(_whole_terminal(event, i))
            rows.row(i).set("direction", INT, _sign(event, i))
            rows.row(i).set("terminal", INT, int(self.left[i] == 1))

        def work(t, y, value, user):
            u, cells = read(y), (REAL * count).from_address(value)
            for i, event in enumerate(events):
                g = event(t, u, *args)
                cells[i] = g if type(g) is float or type(g) is np.float64 else _event_value(g, i)

        self.event_names = [getattr(event, "__name__", "g%d" % (i + 1)) for i, event in enumerate(events)]
        self.note_events(count)
        self.rows = rows
        if count:
            self.give("event", _VALUES, work, "an event function g(t, y)")
            self.problem.set("events", INT, count)
            self.problem.set("event_list", POINTER, rows.address)

    def note_events(self, count):
        read = self.read
        self.t_events, self.y_events = [[] for _ in range(count)], [[] for _ in range(count)]

        def fired(s, t, y, which, user):
            signs = (INT * count).from_address(which)
            for i in range(count):
                if signs[i]:
                    self.t_events[i].append(t)
                    self.happened.append((t, i, signs[i]))
                    self.y_events[i].append(read(y).copy())
                    self.occurred(i)
            if self.outputs:
                self.outputs.event(t)

        if count:
            self.options.set("on_event", POINTER, _ON_EVENT(self.guarded(fired)))

    def name_events(self, count):
        """What the library or the text of a model calls them."""
        rows = self.problem.get("event_list", POINTER)
        for i in range(count):
            name = Struct("event", address=rows).row(i).get("name", c.c_char_p) if rows else None
            self.event_names.append(name.decode() if name else "g%d" % (i + 1))

    def turn(self, i, sign):
        found = lib.steif_model_turn(self.problem.address, i, sign)
        return found.decode() if found else "rising" if sign > 0 else "falling"

    def occurred(self, i):
        """The library asks whether an event is terminal after this: the occurrence that `terminal` counts down to is."""
        if getattr(self, "left", None) and self.left[i] > 0:
            self.left[i] -= 1
            self.rows.row(i).set("terminal", INT, int(self.left[i] == 0))

    def sparse(self, pattern, given, name="jac_sparsity"):
        """Entries that df/dy may have: differences by groups of columns where it is not `given`, sparse
        matrices."""
        if np.shape(pattern) != (self.n, self.n):
            raise ValueError("%s has the shape %s, %s is needed" % (name, np.shape(pattern), (self.n, self.n)))
        self.is_sparse = True
        self.problem.set("storage", INT, _SPARSE)
        self.pattern = places, start, rows = places_of(pattern, self.n)
        if given:
            self.problem.set("nnz", WHOLE, max(places.size, 1))
            return
        kept = Struct("pattern")
        kept.set("column", POINTER, start.ctypes.data)
        kept.set("row", POINTER, rows.ctypes.data)
        self.problem.set("pattern", POINTER, kept.address)
        self.problem.kept["pattern"] = kept, start, rows

    def observe(self, steps, record, times):
        """All steps as points, or as polynomials in the record, by the library alone; both, and what is of a time
        before an event that changes the equations, by a callback."""
        outputs = self.outputs if self.outputs and self.outputs.remembers else None
        early = times if times is not None and self.problem.get("save", POINTER) else None
        kept = [one for one in (steps, record) if one is not None]
        if outputs is None and early is None and len(kept) < 2:
            if kept:
                self.options.set("observe", POINTER, OBSERVER)
                self.options.set("observer", POINTER, kept[0].record)
            return

        def keep(s, t, y, user):
            for one in kept:
                one.step(s, t, y)
            if outputs:
                outputs.step(t)
            if early is not None:
                self.before(s, t, y, early)

        self.options.set("observe", POINTER, _OBSERVE(self.guarded(keep)))

    def before(self, solver, t, y, times):
        """The solution at times asked for inside a step, while the equations are those of the step: an event at its end
        may change them, and dense output of some methods evaluates them."""
        while self.next < len(times) and times[self.next] < t:
            time = times[self.next]
            self.next += 1
            work = lib.N_VClone(y)
            if work and not lib.steif_dense(solver, time, work):
                self.between[time] = self.read(work).copy()
            lib.N_VDestroy(work)

    def jumps(self, t0):
        """x(t0-) and x(t0+) of a linear system that jumps at its start."""
        def jump(t, before, impulse, user):
            if t == t0 and self.jumped is None:
                found = Struct("impulse", address=impulse)
                self.jumped = (memory(before, (self.n,)).copy(), found.array("x_plus", self.n))

        self.options.set("jump", POINTER, _JUMP(self.guarded(jump)))

    def go(self, context, method, t0, t1, times, steps, record):
        if t1 == t0:  # the start, made consistent; options.t1 = 0 would be no end at all
            self.options.set("t1", REAL, t0 + 2 * max(1.0, abs(t0), self.options.get("h", REAL)))
        self.jumps(t0)
        with Interrupt(self.options, alone="f" not in self.problem.kept):
            solver = lib.steif_solver_new(context.pointer, self.problem.address, choice("method", method),
                                          self.options.address)
            if not solver:
                raise self.raised or self._not_made(context)
            try:
                return self._advance(context, solver, t0, t1, times, steps, record)
            finally:
                lib.steif_solver_free(c.byref(POINTER(solver)))

    def _not_made(self, context):
        error = context.error()
        if error.code == _NO_MEMORY and not self.is_sparse and "f" in self.problem.kept:
            return SteifError(error.code, "%s; give jac_sparsity or a sparse jac, or an explicit method" % context.sentence())
        return error

    def _advance(self, context, solver, t0, t1, times, steps, record):
        code = 0
        if self.outputs:
            self.outputs.begin(t0)
        if record is not None and t1 == t0:
            record.start = t0, self.read(lib.steif_solution(solver)).copy()
        if times is None:
            steps.step(solver, t0, lib.steif_solution(solver))
            code = lib.steif_solve_to(solver, t1) if t1 > t0 else 0
        else:
            for t in times:
                code = lib.steif_solve_to(solver, t) if t > t0 else 0
                if code in (0, EVENT):
                    self.t.append(lib.steif_time(solver))
                    seen = self.between.get(t) if code == 0 else None
                    self.y.append(self.read(lib.steif_solution(solver)) if seen is None else seen)
                if code:
                    break
            if not code and t1 > times[-1]:
                code = lib.steif_solve_to(solver, t1)
        if self.raised:
            raise self.raised
        points = (self._ended(solver, *steps.arrays()) if steps else
                  (np.array(self.t), np.array(self.y).reshape(len(self.t), self.n).T))
        r = self._result(context, solver, code, points)
        r.outputs = self.outputs.at(r.t, r.y, times is None) if self.outputs else {}
        return r

    def _ended(self, solver, t, y):
        """The steps as the method has them; unknowns of index 2 and 3 at the end recomputed, as at times asked for."""
        drift = REAL()
        if not lib.steif_recomputed(solver, c.byref(drift), None) and drift.value == drift.value and \
                t[-1] == lib.steif_time(solver):
            y[:, -1] = self.read(lib.steif_solution(solver))
        return t, y

    def _result(self, context, solver, code, points):
        r, stats = Result(), Struct("stats", address=lib.steif_statistics(solver))
        for name, member in _COUNTS.items():
            setattr(r, name, stats.get(member, c.c_long))
        r.t, r.y = points
        r.t_events = None if self.t_events is None else [np.array(t) for t in self.t_events]
        r.y_events = None if self.y_events is None else [np.array(y).reshape(-1, self.n) for y in self.y_events]
        r.events = [(t, self.event_names[i], self.turn(i, sign)) for t, i, sign in self.happened]
        r.names = self.names
        r.method = lib.steif_method_used(solver).decode()
        r.status = 0 if code == 0 else 1 if code == EVENT else code
        r.success = code in (0, EVENT)
        r.moved, r.notes = self.started(solver)
        rounding = stats.get("rounding", REAL)
        if r.success and rounding > 1:
            r.notes.append("rounding errors are about %.2g tolerances: small components are what is left of large "
                           "ones, and no step size gives more digits in double precision" % rounding)
        said = lib.steif_message(context.pointer).decode() if code else "ok"
        r.message = "; ".join([said] + r.notes)
        return r

    def started(self, solver):
        """Start values that were moved, {name or number: (given, used)}, and the sentences of the library on it."""
        repair, n = Struct("repair", address=lib.steif_initial_used(solver)), self.n
        jumped = "jumped at " + repair.text("jumped") if repair.get("jumps", INT) else ""
        notes = [note for note in (lib.steif_model_start(self.problem.address).decode(), repair.text("message"), jumped)
                 if note]
        used = repair.array("y", n)
        given = memory(self.problem.get("y0", POINTER), (n,)) if used is not None else None
        if used is None and self.jumped:
            given, used = self.jumped
        moved = {}
        for i in np.flatnonzero(used != given) if used is not None else ():
            moved[self.names[i] if self.names else int(i)] = (float(given[i]), float(used[i]))
        if self.jumped and moved:
            notes.append("start: jumped in %s, as x(t-) does not fulfil the equations; steif.impulse gives the impulses"
                         % ", ".join("%s from %.6g to %.6g" % (name if self.names else "y[%d]" % name, *pair)
                                     for name, pair in list(moved.items())[:4]))
        return moved, notes


def _whole_terminal(event, i):
    """0, or the occurrence of the event that ends the run."""
    terminal = getattr(event, "terminal", 0)
    if terminal is None:  # as in SciPy
        return 0
    if not isinstance(terminal, (bool, int, float, np.bool_, np.number)) or not 0 <= terminal == terminal // 1 < np.inf:
        raise ValueError("terminal of event %d is %r and must be True, False or the number of the occurrence that ends "
                         "the run" % (i + 1, terminal))
    return int(terminal)


def _sign(event, i):
    direction = getattr(event, "direction", 0)
    if not isinstance(direction, (int, float, np.number)) or direction != direction:
        raise ValueError("direction of event %d is %r and must be a number: 1 where g rises, -1 where it falls, 0 for both"
                         % (i + 1, direction))
    return int(np.sign(direction))


def _event_value(g, i):
    if isinstance(g, (bool, np.bool_)) or getattr(g, "dtype", None) == bool:
        raise TypeError("event %d returned %s: return a number that changes its sign at the event, y[0] - 1 instead of "
                        "y[0] > 1" % (i + 1, g))
    if g is None or np.size(g) != 1:
        raise ValueError("event %d returned %s, one number is needed" % (i + 1, kind(g)))
    return real("what event %d returned" % (i + 1), g).reshape(())
