"""What the library keeps of a run: the steps, or the solution between them as polynomials."""
import ctypes as c

import numpy as np

from ._library import POINTER, lib
from ._values import real


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
    """The solution as a function: s(t) has n values, s([t1, t2, ...]) is n x points; of a model, s.outputs(t) is
    {name: values at t}."""

    def __init__(self, context, n, outputs=None):
        self.n, self._outputs, self._owned, self.start = n, outputs, None, None
        self.record = lib.steif_record_new(context.pointer, n, 10)  # degree of its polynomials
        if not self.record:
            raise context.error()

    def step(self, solver, t, y):
        if lib.steif_record_step(solver, t, y, self.record):
            raise ValueError("the solution between steps cannot be kept at t = %g: no memory" % t)

    def __call__(self, t):
        times = real("t", t)
        y = np.zeros((times.size, self.n))
        for i, time in enumerate(times.ravel()):
            if self.start is not None and time == self.start[0]:
                y[i] = self.start[1]
            elif not self.record or lib.steif_record_at(self.record, time, y[i].ctypes.data, None):
                raise ValueError("t = %g lies outside of the run" % time)
        return y[0] if times.ndim == 0 else y.T.reshape((self.n,) + times.shape)

    def outputs(self, t):
        if self._outputs is None:
            raise ValueError("only models have outputs")
        t = real("t", t)
        return self._outputs.at(t, self(t.ravel()))

    def keep(self, owned):
        """What the record needs is freed with it."""
        self._owned = owned

    def free(self):
        if self.record:
            lib.steif_record_free(c.byref(POINTER(self.record)))
            self.record = None

    def __del__(self):
        if self._owned is not None:
            self._owned.close()

    def __copy__(self):
        return self  # it does not change

    def __deepcopy__(self, known):
        return self

    def __reduce__(self):
        raise TypeError("sol is memory of libsteif and cannot be pickled: evaluate it, or set result.sol = None first")
