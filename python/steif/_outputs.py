"""The outputs of a model at points of a run, each with what events had changed by then."""
import bisect
import ctypes as c
import threading

import numpy as np

from ._library import INT, POINTER, REAL, lib

_BEGIN = c.CFUNCTYPE(INT, REAL, POINTER)
_SAVE = c.CFUNCTYPE(c.c_long, POINTER, POINTER)
_RESTORE = c.CFUNCTYPE(INT, POINTER, c.c_size_t, POINTER)


def output_names(problem):
    names = []
    while (name := lib.steif_model_output(problem.address, len(names))):
        names.append(name.decode())
    return names


class Outputs:
    """Switches of a model that events flip are noted as the run goes on: an output may depend on them."""

    def __init__(self, context, problem, n):
        self.problem, self.n, self.names = problem, n, output_names(problem)
        self.user, save = problem.get("user", POINTER), problem.get("save", POINTER)
        self.remembers = bool(save)
        if save:
            self.call_begin = _BEGIN(problem.get("begin", POINTER))
            self.call_save, self.call_restore = _SAVE(save), _RESTORE(problem.get("restore", POINTER))
        self.rows, self.times, self.states, self.row, self.event_time = [], [], [], 0, None
        self.one_at_a_time = threading.Lock()
        self.vector = lib.N_VNew_Serial(n, lib.steif_sundials(context.pointer))
        if not self.vector:
            raise MemoryError("no memory for %d unknowns" % n)

    # -- while the run goes on: the memory of the model, where it has changed

    def begin(self, t0):
        self.t0 = t0
        self._note(t0)

    def step(self, t):
        self.row += 1
        self._note(t if self.event_time is None else self.event_time)
        self.event_time = None

    def event(self, t):
        """Before the event is handled: what the one before it has changed."""
        if self.remembers:
            if self.event_time is not None:
                self._note(self.event_time)
            self.event_time = t

    def _note(self, t):
        if not self.remembers:
            return
        size = self.call_save(None, self.user)
        if size < 0:
            raise RuntimeError("what events have changed in the model cannot be read at t = %g" % t)
        state = c.create_string_buffer(size)
        self.call_save(state, self.user)
        if not self.states or self.states[-1] != state.raw:
            self.rows.append(self.row)
            self.times.append(t)
            self.states.append(state.raw)

    # -- after it

    def _put(self, state):
        if self.call_begin(self.t0, self.user) or self.call_restore(c.c_char_p(state), len(state), self.user):
            raise RuntimeError("what events had changed in the model cannot be put back")

    def at(self, t, y, steps=False):
        """{name: values} at times t with the solution y (n x points); of all steps, with both sides of events."""
        with self.one_at_a_time:
            return self._at(t, y, steps)

    def _at(self, t, y, steps):
        y, t = np.asarray(y, dtype=float).reshape(self.n, -1), np.asarray(t, dtype=float)
        value = np.empty((t.size, len(self.names)))
        u = np.frombuffer((REAL * self.n).from_address(lib.N_VGetArrayPointer(self.vector)))
        shown = None
        for i, time in enumerate(t.ravel()):
            if self.remembers:
                place = (bisect.bisect_right(self.rows, i) if steps else bisect.bisect_right(self.times, time)) - 1
                if self.states[max(place, 0)] is not shown:
                    shown = self.states[max(place, 0)]
                    self._put(shown)
            u[:] = y[:, i]
            lib.steif_model_outputs(self.problem.address, time, self.vector, value[i].ctypes.data)
        return {name: value[:, k].reshape(t.shape) if t.ndim else float(value[0, k])
                for k, name in enumerate(self.names)}

    def close(self):
        if self.vector:
            lib.N_VDestroy(self.vector)
            self.vector = None
