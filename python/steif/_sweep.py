"""Many runs of a named problem at once, by the threads of the library."""
import ctypes as c
import os

import numpy as np

from ._library import INT, POINTER, REAL, WHOLE, Context, SteifError, Struct, lib
from ._run import Interrupt, Result
from ._solve import forget, is_named, known, tolerances, words
from ._values import choice, real

_OK, _EVENT, _UNKNOWN_NAME = 0, 2, -3  # of base.h
_MEMBER = c.CFUNCTYPE(INT, POINTER, c.c_longlong, POINTER, POINTER, POINTER)
_DONE = c.CFUNCTYPE(INT, POINTER, c.c_longlong, POINTER, POINTER, INT, POINTER, POINTER)


def _told(run, work):
    """A callback whose code counts; an exception is raised again after the runs."""

    def call(*arguments):
        try:
            return work(*arguments)
        except BaseException as reason:
            run.raised = run.raised or reason
            return -1

    return call


def _sweep_columns(f, values):
    if not is_named(f) or (isinstance(f, str) and "\n" in f):
        raise ValueError("sweep needs the name of a problem or of a model file, for threads read it themselves: write %s"
                         % ("the text into a file" if is_named(f) else "f as a model, or call solve in a loop"))
    if not hasattr(values, "items"):
        raise ValueError("values must be a dict, {name: one value for each run}, got %r" % (values,))
    columns = {name: np.array(real("values of %s" % name, column)).ravel() for name, column in values.items()}
    lengths = {column.size for column in columns.values()}
    if len(lengths) != 1 or not min(lengths):
        raise ValueError("values must hold one number for each run, the same for all parameters")
    return columns, lengths.pop()


def _known_names(context, problem, columns):
    """Names that the problem does not have, before any run: each is tried with one of its values."""
    for name, column in columns.items():
        other, value = Struct("problem"), np.append(column[np.isfinite(column)], 1.0)[:1]
        code = lib.steif_problem_vary(context.pointer, problem.address, 1, words([name]), value.ctypes.data,
                                      other.address)
        if code == _UNKNOWN_NAME:
            raise ValueError(context.sentence())
        if not code:
            lib.steif_problem_clear(context.pointer, other.address)


class _Members:
    """The runs of a sweep: how one is made, and what it leaves."""

    def __init__(self, run, columns, count):
        self.run, self.n, self.names = run, run.n, words(columns)
        self.rows = np.ascontiguousarray(np.array(list(columns.values())).T)
        self.y, self.status = np.full((run.n, count), np.nan), np.zeros(count, dtype=int)
        self.messages = [""] * count

    def make(self, ctx, i, to, options, user):
        other = Struct("problem")
        code = lib.steif_problem_vary(ctx, to, self.rows.shape[1], self.names, self.rows[i].ctypes.data,
                                      other.address)
        if code:
            return code
        n = other.get("n", WHOLE)
        if n != self.n:
            lib.steif_problem_clear(ctx, other.address)
            raise ValueError("run %d has %d unknowns and the problem as it is named %d, y would have rows of two lengths: "
                             "write the size into the name, 'heat:n=%d'" % (i, n, self.n, n))
        c.memmove(to, other.address, other.size)
        return code

    def take(self, ctx, i, own, solver, code, record, user):
        self.status[i] = code
        if code not in (_OK, _EVENT):
            self.messages[i] = lib.steif_message(ctx).decode()
        elif solver:
            self.y[:, i] = self.run.read(lib.steif_solution(solver))
        return 0


def sweep(f, values, *, t1=None, method="auto", rtol=1e-6, atol=None, threads=0):
    """End values of a named problem, or model file, for many values of its parameters, on all cores.

    values   {name: one value for each run}; all of one length
    threads  0: as many as there are cores

    Returns a Result: y (n x runs, NaN where a run failed), status (of each, 0: fine, 2: fine, ended by an event),
    messages (why a run failed, "" where it did not), values, names. A name that the problem does not have is a ValueError before the first run.
    """
    columns, count = _sweep_columns(f, values)
    if isinstance(threads, bool) or not hasattr(threads, "__index__"):
        raise ValueError("threads is %r and must be a whole number: 0 for one on each core" % (threads,))
    context, run = Context(), None
    try:
        run, start, end = known(context, f, None, endless=t1 is not None)
        end = end if t1 is None else float(real("t1", t1))
        if not end > start:
            raise ValueError("t1 is %g and must be after the start, %g" % (end, start))
        _known_names(context, run.problem, columns)
        tolerances(run, rtol, atol, run.n)
        run.options.set("t1", REAL, end)
        members = _Members(run, columns, count)
        calls = _MEMBER(_told(run, members.make)), _DONE(_told(run, members.take))
        e, interrupt = Struct("ensemble_options"), Interrupt(run.options, alone=True)
        for name, kind, value in (("problem", POINTER, c.c_char_p(os.fsencode(f))),
                                  ("method", POINTER, c.c_char_p(choice("method", method))),
                                  ("options", POINTER, run.options.address),
                                  ("stop", POINTER, c.addressof(interrupt.flag)),
                                  ("threads", INT, threads.__index__())):
            e.set(name, kind, value)
        with interrupt:
            code = lib.steif_ensemble(context.pointer, count, calls[0], calls[1], e.address)
        if run.raised:
            raise run.raised
        if code:
            raise context.error()
        if np.all(members.status == _UNKNOWN_NAME):  # of the method
            raise SteifError(_UNKNOWN_NAME, members.messages[0])
        r = Result()
        r.y, r.status, r.messages, r.values, r.names = members.y, members.status, members.messages, columns, run.names
        return r
    finally:
        if run is not None:
            forget(context, run)
        context.close()
