"""E x' + F x = f: jumps and impulses, weak convergence, time grids; matrices of NumPy or scipy.sparse."""
import ctypes as c
import os

import numpy as np

from ._library import INT, POINTER, REAL, WHOLE, Context, SteifError, Struct, lib
from ._run import Result
from ._solve import opened
from ._values import choice, memory, real, returned

_FORCING = c.CFUNCTYPE(INT, REAL, INT, POINTER, POINTER)
_CSC = 0  # CSC_MAT of SUNDIALS
_CONVENTIONS = ("P", "R", "C", "stage")
_ALGORITHMS = ("auto", "staircase", "qz", "contour")
_BREAKS = 64


def _dense(name, matrix, rows=None, columns=None):
    """A matrix by columns; a vector of the right length counts as one column."""
    M = real(name, matrix.toarray() if hasattr(matrix, "toarray") else matrix)
    if M.ndim == 1:
        M = M[:, None] if columns in (None, 1) or rows == M.size else M[None, :]
    if M.ndim != 2 or (rows is not None and M.shape[0] != rows) or (
            columns is not None and M.shape[1] != columns):
        raise ValueError("%s has the shape %s, (%s, %s) is needed" % (
            name, M.shape, "any" if rows is None else rows, "any" if columns is None else columns))
    return np.asfortranarray(M)


def _vector(name, values, n):
    x = np.array(real(name, values)).ravel()
    if x.size != n:
        raise ValueError("%s has %d values, %d are needed" % (name, x.size, n))
    return x


def _copy(address, values, kind):
    values = np.ascontiguousarray(values, dtype=kind)
    c.memmove(address, values.ctypes.data, values.nbytes)


class _System:
    """E and F in the library, f as a callback; to be used in a with statement."""

    x0, t0 = None, 0.0

    def __init__(self, E, F, f, breaks=()):
        shape = np.shape(E)
        if len(shape) != 2 or shape[0] != shape[1] or np.shape(F) != shape:
            raise ValueError("E and F must be square and of one size; they have the shapes %s and %s"
                             % (shape, np.shape(F)))
        self.n, self.raised, self.text, self.matrices = shape[0], None, None, []
        self.context = Context()
        self.given = E, F, f
        self.breaks = np.array(sorted(breaks), dtype=float)

    def __enter__(self):
        try:
            E, F, f = self.given
            self.E, self.F = self._matrix("E", E), self._matrix("F", F)
            self.callback, self.user = self._forcing(f)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *reason):
        for matrix in self.matrices:
            lib.SUNMatDestroy(matrix)
        if self.text:
            lib.steif_function_free(c.byref(POINTER(self.text)))
        self.context.close()

    def _matrix(self, name, matrix):
        sun, n = lib.steif_sundials(self.context.pointer), self.n
        if hasattr(matrix, "tocsc"):
            S = matrix.tocsc().copy()
            S.sum_duplicates()
            values = real(name, S.data)
            M = lib.SUNSparseMatrix(n, n, max(S.nnz, 1), _CSC, sun)
            if M:
                _copy(lib.SUNSparseMatrix_Data(M), values, float)
                _copy(lib.SUNSparseMatrix_IndexValues(M), S.indices, WHOLE)
                _copy(lib.SUNSparseMatrix_IndexPointers(M), S.indptr, WHOLE)
        else:
            M = lib.SUNDenseMatrix(n, n, sun)
            if M:
                _copy(lib.SUNDenseMatrix_Data(M), _dense(name, matrix, n, n).ravel("F"), float)
        if not M:
            raise MemoryError("no memory for a matrix of %d x %d" % (n, n))
        self.matrices.append(M)
        return M

    def _forcing(self, f):
        """None, text for the library, constant values, or f(t, order of the derivative)."""
        if f is None:
            return None, None
        if isinstance(f, str):
            self.text = lib.steif_function_parse(self.context.pointer, f.encode(), self.n, None)
            if not self.text:
                raise self.context.error()
            return c.cast(lib.steif_function_value, POINTER), self.text
        if callable(f):
            value = f
        else:
            constant = _vector("f", f, self.n)

            def value(t, order):
                return 0 if order else constant

        def work(t, order, g, user):
            try:
                out = np.frombuffer((REAL * self.n).from_address(lib.N_VGetArrayPointer(g)))
                values = value(t, order)
                if values is None:
                    return 1  # this derivative is not known
                out[:] = returned("f(t, order)", values, (self.n,)) if np.ndim(values) else real("f(t, order)", values)
                return 0
            except BaseException as reason:  # raised again by `check`
                self.raised = self.raised or reason
                return -1

        self.kept = _FORCING(work)
        return c.cast(self.kept, POINTER), None

    def breaks_within(self, t1):
        """Those given, and those that the text of f declares, inside (0, t1)."""
        own = np.zeros(_BREAKS)
        count = lib.steif_function_breaks(self.text, 0, t1, _BREAKS, own.ctypes.data) if self.text else 0
        if count > _BREAKS:
            raise ValueError("f has %d breaks up to t = %g; %d are the most" % (count, t1, _BREAKS))
        every = np.concatenate([own[:count], self.breaks])
        return np.unique(every[(every > 0) & (every < t1)])

    def check(self, code):
        if self.raised:
            raise self.raised
        if code:
            raise self.context.error()

    def linear(self):
        linear = Struct("linear")
        for member, value in (("E", self.E), ("F", self.F)):
            linear.set(member, POINTER, value)
        if self.callback:
            linear.set("f", POINTER, self.callback.value)
        if self.user:
            linear.set("user", POINTER, self.user)
        return linear


class _Model(_System):
    """A linear model or problem of the collection, by the same names."""

    def __init__(self, spec, p):
        self.raised, self.text, self.matrices, self.given = None, None, [], (spec, p)
        self.context, self.problem = Context(), None

    def __enter__(self):
        spec, p = self.given
        context, linear = self.context.pointer, Struct("linear")
        try:
            self.problem = opened(self.context, spec, p)
            self.check(lib.steif_linear_of(context, self.problem.address, linear.address))
        except BaseException:
            self.__exit__()
            raise
        self.E, self.F = linear.get("E", POINTER), linear.get("F", POINTER)
        self.matrices += [self.E, self.F]
        self.callback, self.user = linear.get("f", POINTER), linear.get("user", POINTER)
        self.n, self.t0 = self.problem.get("n", WHOLE), self.problem.get("t0", REAL)
        start = self.problem.get("y0", POINTER)
        self.x0 = memory(start, (self.n,)).copy() if start else None
        return self

    def __exit__(self, *reason):
        if self.problem is not None:
            lib.steif_problem_clear(self.context.pointer, self.problem.address)
        super().__exit__(*reason)


def _system(E, F, f, p):
    if not isinstance(E, (str, os.PathLike)):
        if p is not None:
            raise ValueError("p belongs to models and problems by name; E and F are matrices here")
        if F is None:
            raise ValueError("E and F are needed, or the name of a linear model or problem in the place of E")
        return _System(E, F, f)
    if F is not None or f is not None:
        raise ValueError("%r has its own F and f: leave them None" % (E,))
    return _Model(E, p)


def _structure(system, analysis, r):
    """The index and what else the matrices tell; the struct goes to steif_impulse_find, too."""
    found, context = Struct("structure"), system.context.pointer
    system.check(lib.steif_structure_find(context, system.E, system.F, analysis.address,
                                          found.address))
    r.structure = found.text("message")
    r.finite, r.infinite = (found.get(member, WHOLE) for member in ("finite", "infinite"))
    return found


def impulse(E, F=None, x0=None, f=None, *, t=None, p=None, algorithm="auto"):
    """The start of E x' + F x = f from any values x0 = x(0-): x(0+) and the impulses at t.

    E, F: NumPy arrays, or matrices of scipy.sparse, n x n with a regular pencil s E + F.
    f: None (0), n constant values, a text such as "sin(t); 0; exp(-t)" with an expression for each
    equation, or a function f(t, order) that returns the derivative of this order (None: unknown); orders up
    to index - 1 are asked for.
    impulse("circuit.steif", p={"C": 2}): a linear model, its text, or a problem of the collection in the place of E;
    x0 and t (else 0) are then by default its start, p other values of its parameters.

    Returns a Result: x_plus (n), impulses (index - 1 rows of n: row i belongs to the i-th derivative of
    Dirac's delta), index, certified, message, and x_minus, finite and infinite (numbers of eigenvalues),
    structure (a sentence), estimate (of the error of x_plus), resolution, method. A singular pencil and
    a missing derivative raise SteifError.
    """
    if algorithm not in _ALGORITHMS:
        raise ValueError("algorithm must be one of %s" % ", ".join(_ALGORITHMS))
    with _system(E, F, f, p) as system:
        if x0 is None and system.x0 is None:
            raise ValueError("x0 is needed: the values x(0-), %d of them" % system.n)
        start, r = _vector("x0", system.x0 if x0 is None else x0, system.n), Result()
        t = system.t0 if t is None else t
        analysis, answer = Struct("analysis"), Struct("impulse")
        analysis.set("algorithm", INT, _ALGORITHMS.index(algorithm))
        context, found = system.context.pointer, _structure(system, analysis, r)
        try:
            system.check(lib.steif_impulse_find(
                context, system.E, system.F, start.ctypes.data, float(t), system.callback,
                system.user, analysis.address, found.address, answer.address))
            r.index, count = answer.get("index", INT), answer.get("count", INT)
            r.x_minus, r.x_plus = start.copy(), answer.array("x_plus", system.n)
            r.impulses = answer.array("c", count, system.n)
            r.certified = bool(answer.get("certified", INT))
            r.estimate, r.resolution = answer.get("estimate", REAL), answer.get("resolution", REAL)
            r.method, r.message = answer.get("method", c.c_char_p).decode(), answer.text("message")
            return r
        finally:
            lib.steif_impulse_clear(context, answer.address)
            lib.steif_structure_clear(context, found.address)


def _convention(context, query, method, start, convention):
    if convention is not None:
        if convention not in _CONVENTIONS:
            raise ValueError("convention must be one of %s" % ", ".join(_CONVENTIONS))
        query.set("convention", INT, _CONVENTIONS.index(convention))
        return convention
    usual = INT(0)
    if lib.steif_convention_usual(context.pointer, choice("method", method), start and start.encode(),
                                  c.byref(usual)):
        raise context.error()
    query.set("convention", INT, usual.value)
    return _CONVENTIONS[usual.value]


def _weak_query(method, start, h, halvings, component):
    if component is not None and (not isinstance(component, (int, np.integer)) or component < 0):
        raise ValueError("component is %r and must be a whole number from 0, or None for all" % (component,))
    query = Struct("weak_query")
    query.set("method", POINTER, c.c_char_p(choice("method", method)))
    if start is not None:
        query.set("start", POINTER, c.c_char_p(start.encode()))
    query.set("h", REAL, 0.0 if h is None else float(h))
    query.set("rows", c.c_size_t, halvings + 1)
    query.set("component", INT, -1 if component is None else int(component))
    return query


def _weak_result(context, query, rows, n):
    row, result, r = Struct("weak_row", rows), Struct("weak_result"), Result()
    values, exacts = np.zeros((rows, n)), np.zeros(n)
    if n:
        query.set("values", POINTER, values.ctypes.data)
        query.set("exacts", POINTER, exacts.ctypes.data)
    code = lib.steif_weak_measure(context.pointer, query.address, row.address, result.address)
    for member in ("h", "error", "order", "rounding"):
        setattr(r, member, np.array([row.row(i).get(member, REAL) for i in range(rows)]))
    r.usable = np.array([bool(row.row(i).get("usable", INT)) for i in range(rows)])
    r.value = values if n else np.array([row.row(i).get("value", REAL) for i in range(rows)])
    r.exact = exacts if n else result.get("exact", REAL)
    r.converges = {1: True, 0: False}.get(result.get("converges", INT))
    r.index, r.message = result.get("index", INT), result.text("verdict")
    r.source, r.note, r.mesh = result.text("source"), result.text("note"), result.text("mesh")
    return code, r


def weak(method, E, F=None, x0=None, f=None, *, h=None, halvings=4, component=None, convention=None,
         start=None, breaks=(), restart=False):
    """Does a method converge weakly (as a distribution, impulses included) on E x' + F x = f from x(0-) = x0?

    weak("be", E, F, x0, f) with matrices and f as for `impulse`, or weak("be", "jordan:k=3,case=H-inc") with a
    linear problem of the collection in the place of E. The method runs with steps h, h/2, ... on [0, 1], and
    <x_h, g> is compared with <x, g>, g = (1 - t)^8. component: counted from 0; None: all (of the collection:
    the first). convention: "P", "R", "C" or "stage"; None: the usual one of the method. breaks: times where
    f or a derivative of it jumps; a text f declares its own. restart: at each break, with steps near h
    between breaks, which otherwise happens only where no constant step fits them all (Result.mesh tells).

    Returns a Result: converges (True, False, or None: undecided), message, and arrays h, value, error, order,
    rounding, usable over the runs, exact, index, convention, source, note, mesh.
    """
    if not isinstance(halvings, (int, np.integer)) or not 2 <= halvings <= 20:
        raise ValueError("halvings must be a whole number from 2 to 20, not %r: three runs give a verdict" % halvings)
    if isinstance(E, str):
        context = Context()
        try:
            query = _weak_query(method, start, h, halvings, component or 0)
            used = _convention(context, query, method, start, convention)
            query.set("problem", POINTER, c.c_char_p(E.encode()))
            code, r = _weak_result(context, query, halvings + 1, 0)
            if code:
                raise context.error()
        finally:
            context.close()
    else:
        if F is None or x0 is None:
            raise ValueError("weak needs E, F and x0, or the name of a problem in the place of E")
        with _System(E, F, f, breaks) as system:
            values, times = _vector("x0", x0, system.n), system.breaks_within(1.0)
            query, linear = _weak_query(method, start, h, halvings, component), system.linear()
            used = _convention(system.context, query, method, start, convention)
            query.set("linear", POINTER, linear.address)
            query.set("x0", POINTER, values.ctypes.data)
            query.set("break_count", c.c_size_t, times.size)
            query.set("breaks", POINTER, times.ctypes.data)
            query.set("restart", INT, int(restart))
            code, r = _weak_result(system.context, query, halvings + 1,
                                   system.n if component is None else 0)
            system.check(code)
    r.convention = used
    return r


def _state_space(A, B, C, D):
    A = _dense("A", A)
    n = A.shape[0]
    A = _dense("A", A, n, n)
    B = np.zeros((n, 0), order="F") if B is None else _dense("B", B, n)
    if D is not None and C is None:
        raise ValueError("D needs C")
    C = np.zeros((0, n), order="F") if C is None else _dense("C", C, None, n)
    D = None if D is None else _dense("D", D, C.shape[0], B.shape[1])
    s = Struct("state_space")
    for member, value in (("n", n), ("m", B.shape[1]), ("p", C.shape[0])):
        s.set(member, INT, value)
    for member, M in (("A", A), ("B", B), ("C", C), ("D", D)):
        if M is not None and M.size:
            s.set(member, POINTER, M.ctypes.data)
            s.kept[member] = M
    return s


def _matrices(r, form):
    n, m, p = (form.get(member, INT) for member in ("n", "m", "p"))
    for member, shape in (("A", (n, n)), ("B", (n, m)), ("C", (p, n)), ("D", (p, m))):
        M = form.array(member, *shape, order="F")
        setattr(r, member, np.zeros(shape) if M is None else M)
    return n, m, p


def c2d(A, B=None, C=None, D=None, *, dt, scheme="zoh", E=None):
    """x' = A x + B u, y = C x + D u (or E x' = A x + B u on its finite part) on a grid of step dt.

    scheme: "zoh", "foh", "bilinear", "bilinear:w=2", "gbt:alpha=0.7", ...: `steif list schemes`. Matrices are
    of NumPy or scipy.sparse; computed are dense ones.

    Returns a Result: A, B, C, D of x_{k+1} = A x_k + B u_k, y_k = C x_k + D u_k; B0, Bm, B1 of h_{k+1} = A h_k +
    B0 u_k + Bm u(t_k + dt/2) + B1 u_{k+1}; eigenvalues of A; alias (from 1 on frequencies alias); scheme;
    and with E: index, and polynomial, a list of P_j of y = ... + sum_j P_j u^(j).
    """
    context, d, part, r = Context(), Struct("discrete"), Struct("finite_part"), Result()
    try:
        s = _state_space(A, B, C, D)
        if E is not None:
            n = s.get("n", INT)
            if lib.steif_finite_part_find(context.pointer, s.address,
                                          _dense("E", E, n, n).ctypes.data, part.address):
                raise context.error()
            outputs, s = s.get("p", INT) or n, part.inner("form", "state_space")
            r.index, terms = part.get("index", INT), part.get("terms", INT)
            if not s.get("n", INT):
                raise SteifError(-8, "E x' = A x + B u has no finite part")
            P = part.array("polynomial", terms, s.get("m", INT), outputs)
            r.polynomial = [P[j].T for j in range(terms)]
        if lib.steif_c2d(context.pointer, s.address, choice("scheme", scheme), float(dt), d.address):
            raise context.error()
        n, m, p = _matrices(r, d.inner("form", "state_space"))
        for member in ("B0", "Bm", "B1"):
            M = d.array(member, n, m, order="F")
            setattr(r, member, np.zeros((n, m)) if M is None else M)
        r.eigenvalues = d.array("re", n) + 1j * d.array("im", n)
        r.alias, r.dt = d.get("alias", REAL), d.get("dt", REAL)
        r.scheme = d.get("scheme", c.c_char_p).decode()
        return r
    finally:
        lib.steif_discrete_clear(context.pointer, d.address)
        lib.steif_finite_part_clear(context.pointer, part.address)
        context.close()
