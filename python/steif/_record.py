"""What the library keeps of a run: the steps, or the solution between them as polynomials."""
import ctypes as c

import numpy as np

from ._library import POINTER, lib


# The function of the library as an observer: no step calls Python.
OBSERVER = c.cast(lib.steif_record_step, POINTER).value


class Steps:
    """t and y of all steps, both sides of events."""

    def __init__(self, context, n):
        self.context, self.n = context, n
        self.record = lib.steif_record_new(context.pointer, n, -1)
        if not self.record:
            raise context.error()

    def step(self, solver, t, y):
        if lib.steif_record_step(solver, t, y, self.record):
            raise self.context.error()

    def arrays(self):
        t = POINTER()
        rows = lib.steif_record_steps(self.record, c.byref(t)) + 1
        y = lib.steif_record_values(self.record)
        return (np.array((c.c_double * rows).from_address(t.value)),
                np.array((c.c_double * (rows * self.n)).from_address(y)).reshape(rows, self.n).T)

    def close(self):
        lib.steif_record_free(c.byref(POINTER(self.record)))


class Dense:
    """The solution as a function: s(t) has n values, s([t1, t2, ...]) is n x points."""

    def __init__(self, context, n):
        self.context, self.n = context, n
        self.record = lib.steif_record_new(context.pointer, n, 10)  # degree of its polynomials
        if not self.record:
            raise context.error()

    def step(self, solver, t, y):
        if lib.steif_record_step(solver, t, y, self.record):
            raise self.context.error()

    def __call__(self, t):
        times = np.asarray(t, dtype=float)
        y = np.zeros((times.size, self.n))
        for i, time in enumerate(times.ravel()):
            if lib.steif_record_at(self.record, time, y[i].ctypes.data, None):
                raise ValueError("t = %g lies outside of the run" % time)
        return y[0] if times.ndim == 0 else y.T

    def close(self):
        if self.record:
            lib.steif_record_free(c.byref(POINTER(self.record)))
            self.record = None
            self.context.close()

    __del__ = close
