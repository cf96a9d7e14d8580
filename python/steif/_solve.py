"""solve: a problem in Python, a model or a problem of the library, integrated."""
import ctypes as c
import os
from contextlib import ExitStack

import numpy as np

from ._library import POINTER, REAL, WHOLE, INT, Context, SteifError, Struct, lib
from ._outputs import Outputs, output_names
from ._record import Dense, Steps
from ._run import Run
from ._values import explained, frozen, positive, real

_UNKNOWN_NAME, _BAD_INPUT = -3, -2  # of base.h


def words(names):
    return (c.c_char_p * max(len(names), 1))(*[str(name).encode() for name in names])


def is_named(f):
    return isinstance(f, (str, bytes, os.PathLike))


def tolerances(run, rtol, atol, n):
    for name, value in (("rtol", rtol), ("atol", atol)):
        if value is not None and (np.any(real(name, value) < 0) or np.any(np.isnan(real(name, value)))):
            raise ValueError("%s is %s and must be above 0" % (name, value))
    if rtol is None or np.ndim(rtol):
        raise ValueError("rtol is %r and must be one number; tolerances of components are given by atol" % (rtol,))
    if rtol == 0:
        raise ValueError("rtol is 0 and must be above 0, 1e-14 at least")
    run.options.set("rtol", REAL, float(rtol))
    if atol is None:
        return
    if np.any(np.asarray(atol) == 0):
        raise ValueError("atol is 0 and must be above 0: where small values matter take a small one, such as 1e-30")
    if np.ndim(atol) == 0:
        run.options.set("atol", REAL, float(atol))
        return
    each = np.array(real("atol", atol))
    if each.shape != (n,):
        raise ValueError("atol has the shape %s, %s is needed" % (each.shape, (n,)))
    run.options.set("atols", POINTER, each.ctypes.data)
    run.options.kept["atols"] = each


def checked_times(t_eval, t0, t1):
    if t_eval is None:
        return None
    times = np.array(real("t_eval", t_eval))
    if times.ndim != 1 or times.size == 0 or not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0):
        raise ValueError("t_eval must hold ascending times, one at least")
    if times[0] < t0 or times[-1] > t1:
        raise ValueError("t_eval must lie within the interval from %g to %g" % (t0, t1))
    return times


def _interval(t_span):
    if t_span is None or np.shape(t_span) != (2,):
        raise ValueError("t_span must be (t0, t1), got %r" % (t_span,))
    t0, t1 = (float(t) for t in real("t_span", t_span))
    if t1 < t0:
        raise SteifError(_BAD_INPUT, "t_span runs backwards, from %g to %g: integrate g(s, y) = -f(-s, y) over (%g, %g), "
                         "s = -t" % (t0, t1, -t0, -t1))
    return t0, t1


def _find(context, spec, found):
    """A problem by its name, a model file, or a text of several lines that is a model."""
    pointer = context.pointer
    if "\0" in str(spec):
        raise ValueError("a model, or its name, has a character of value 0, which ends texts")
    if isinstance(spec, str) and "\n" not in spec and ("'" in spec or spec.startswith("state ")):
        raise ValueError("%r is no model: a text has a line for each statement, \"state x = 1\\nx' = -x\\n\"" % spec)
    if isinstance(spec, str) and "\n" in spec:
        code = lib.steif_model_parse(pointer, spec.encode(), b"model", None, found.address)
    else:
        code = lib.steif_problem_find(pointer, os.fsencode(spec), found.address)
    if code:
        raise context.error()


def vary(context, problem, p):
    """The problem with other values of its parameters, in the place of the one at hand."""
    if not hasattr(p, "items"):
        raise ValueError("p of a named problem must be a dict, {name: value}, got %r" % (p,))
    for name, value in p.items():
        if np.ndim(value) or not np.all(np.isfinite(real("parameter %s" % name, value))):
            raise ValueError("parameter %s is %r and must be one finite number" % (name, value))
    other, values = Struct("problem"), np.array([float(value) for value in p.values()])
    code = lib.steif_problem_vary(context.pointer, problem.address, len(p), words(p), values.ctypes.data, other.address)
    if code:
        raise ValueError(context.sentence()) if code == _UNKNOWN_NAME else context.error()
    lib.steif_problem_clear(context.pointer, problem.address)
    c.memmove(problem.address, other.address, other.size)


def opened(context, spec, p=None):
    """A problem by its name, model file or text, with other values of its parameters; to be cleared."""
    found = Struct("problem")
    _find(context, spec, found)
    try:
        if p is not None:
            vary(context, found, p)
    except BaseException:
        lib.steif_problem_clear(context.pointer, found.address)
        raise
    return found


def known(context, spec, t_span, p=None, endless=False):
    """A problem of the collection or a model, and its interval; to be cleared with `forget`."""
    found = opened(context, spec, p)
    try:
        run = Run(found.get("n", WHOLE), found)
        if found.get("events", INT):
            run.name_events(found.get("events", INT))
            run.note_events(found.get("events", INT))
        names = found.get("names", POINTER)
        unknown = Struct("names", address=names).get("unknown", POINTER) if names else None
        if unknown:
            run.names = [name.decode() for name in (c.c_char_p * run.n).from_address(unknown)]
        t0, t1 = found.get("t0", REAL), found.get("t1", REAL)
        if t_span is not None:
            first, t1 = _interval(t_span)
            if first != t0:
                raise ValueError("t_span must be (%g, t1), for %r begins at %g; got %r" % (t0, spec, t0, t_span))
            found.set("t1", REAL, t1)
        elif t1 <= t0 and not endless:
            raise ValueError("%r says no end: give t_span=(%g, t1), or add a line such as 'time %g to 10' to the model"
                             % (spec, t0, t0))
        return run, t0, t1
    except BaseException:
        lib.steif_problem_clear(context.pointer, found.address)
        raise


def forget(context, run):
    lib.steif_problem_clear(context.pointer, run.problem.address)


_INSTEAD = {
    "args": "; names of its `param` lines are set by p={name: value}",
    "y0": "; a start that is to change is a parameter: `param x0 = 1` and `state x = x0` in the model, then p={'x0': 2}",
}


def refuse(spec, **given):
    """What a named problem has itself."""
    for name, value in given.items():
        if value is not None:
            raise ValueError("%s is given, but %r has its own: leave it None%s" % (name, spec, _INSTEAD.get(name, "")))


def _start(y0):
    start = np.array(real("y0", y0))
    if start.ndim != 1:
        raise ValueError("y0 must have one dimension, it has %d: write [1.0] for one unknown" % start.ndim)
    if not start.size:
        raise ValueError("y0 is empty: give a start value for each unknown, one at least")
    return start


def _first(jac, t0, start, args):
    try:
        return jac(t0, frozen(start), *args)
    except ValueError as reason:
        told = explained(reason, "jac(t, y)")
        if told is reason:
            raise
        raise told from reason


def own(f, t_span, y0, args, jac, jac_sparsity, mass, events):
    """A problem whose callbacks are functions in Python."""
    if t_span is None or y0 is None or not callable(f):
        missing = ("f(t, y), or the name of a problem" if not callable(f) else
                   "t_span (t0, t1)" if t_span is None else "y0 (the values at the start)")
        raise ValueError(f"{missing} is missing")
    start, (t0, t1) = _start(y0), _interval(t_span)
    run = Run(start.size)
    for member, shape, value in (("n", WHOLE, start.size), ("t0", REAL, t0), ("t1", REAL, t1)):
        run.problem.set(member, shape, value)
    run.problem.set("name", POINTER, c.c_char_p(b"f"))
    run.problem.set("y0", POINTER, start.ctypes.data)
    run.problem.kept["y0"] = start
    run.right_hand_side(f, args)
    name = "jac_sparsity" if jac_sparsity is not None else "jac"
    if jac is not None and jac_sparsity is None:
        first = _first(jac, t0, start, args) if callable(jac) else jac
        jac_sparsity = first if hasattr(first, "tocsc") else None
    if jac_sparsity is not None:
        run.sparse(jac_sparsity, jac is not None, name)
    if jac is not None:
        run.jacobian(jac, args)
    if mass is not None:
        run.mass(mass)
    if events is not None:
        run.watch(list(events) if isinstance(events, (list, tuple)) else [events], args)
    return run, t0, t1


def _arguments(args):
    if isinstance(args, (str, bytes)) or not hasattr(args, "__iter__"):
        raise TypeError("args is %r and must be a tuple: args=(%r,)" % (args, args))
    return tuple(args)


def _limits(run, h, first_step, max_step, max_steps):
    for member, name, value in (("h", "h", h), ("h0", "first_step", first_step), ("h_max", "max_step", max_step)):
        if value is not None and not (name == "max_step" and value == np.inf):
            run.options.set(member, REAL, positive(name, value))
    if max_steps is not None:
        run.options.set("max_steps", c.c_long, int(positive("max_steps", max_steps)))


def solve(f, t_span=None, y0=None, *, method="auto", rtol=1e-6, atol=None, t_eval=None,
          dense_output=False, jac=None, jac_sparsity=None, mass=None, events=None, args=(), h=None,
          first_step=None, max_step=None, max_steps=None, p=None):
    """Integrate y' = f(t, y), or mass y' = f(t, y) with a constant, possibly singular matrix.

    f             f(t, y) -> array or list, y is read-only; or the name of a problem ("rober"), a model file or the text
                  of a model, which have their own y0, jac, mass and events: parameters change them
    t_span        (t0, t1), the start alone for t1 = t0; of a named problem None: its own, or another t1
    method        a spec of steif: "auto", "radau:s=3", "bdf", "cvode", ...
    atol          a number or one for each component; None: rtol times the scale of the problem (1)
    t_eval        times of the output; None: the steps
    dense_output  True: .sol(t) is the solution at any time of the run
    jac           jac(t, y) -> n x n, or a constant array, of NumPy or scipy.sparse; None: differences
    jac_sparsity  n x n, not 0 where df/dy may have an entry (NumPy or scipy.sparse): for large n; beside
                  a sparse jac only where it may get more entries than it has at the start
    events        g(t, y) or several; .terminal and .direction as in SciPy
    p             of a named problem: {parameter: value}
    h             a constant step size instead of tolerances

    Returns a Result. A run that stops early has success False and says why in message; bad input is a
    SteifError or ValueError; an exception in a callback ends the run and is raised again.
    """
    with ExitStack() as stack:
        context = Context()
        stack.callback(context.close)
        if is_named(f):
            refuse(f, y0=y0, args=args or None, jac=jac, jac_sparsity=jac_sparsity, mass=mass, events=events)
            run, t0, t1 = known(context, f, t_span, p)
            stack.callback(forget, context, run)
            if output_names(run.problem):
                run.outputs = Outputs(context, run.problem, run.n)
                stack.callback(run.outputs.close)
        elif p is not None:
            raise ValueError("p sets parameters of a named problem; those of f(t, y, a, b) are args=(a, b)")
        else:
            run, t0, t1 = own(f, t_span, y0, _arguments(args), jac, jac_sparsity, mass, events)
        tolerances(run, rtol, atol, run.n)
        run.options.set("t1", REAL, t1)
        _limits(run, h, first_step, max_step, max_steps)
        times, record, steps = checked_times(t_eval, t0, t1), None, None
        if dense_output:
            record = Dense(context, run.n, run.outputs)
            stack.callback(record.free)
        if times is None:
            steps = Steps(context, run.n)
        try:
            run.observe(steps, record, times)
            result = run.go(context, method, t0, t1, times, steps, record)
        finally:
            if steps is not None:
                steps.close()
        result.sol = record
        if record is not None:
            record.keep(stack.pop_all())
        return result
