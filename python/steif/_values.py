"""What users give and return, as numbers: wrong shapes and kinds get a sentence; vectors of the library for callbacks."""
import ctypes as c

import numpy as np

from ._library import REAL, WHOLE, lib

_DOUBLE = np.dtype(float)


def kind(value):
    return "None" if value is None else "the shape %s" % (np.shape(value),)


def _wrong(what, value, count):
    return ValueError("%s returned %s, an array or list of %d numbers is needed" % (what, kind(value), count))


def real(what, value):
    """An array of doubles, without a copy where it is one; TypeError for complex numbers, texts and objects."""
    try:
        a = np.asarray(value)
    except ValueError as reason:
        raise ValueError("%s is not an array of numbers, its rows have different lengths: %s" % (what, reason)) from None
    if a.dtype.kind == "c":
        raise TypeError("%s is complex; write real and imaginary parts as unknowns of their own" % what)
    if a.dtype.kind == "O" and a.size and not any(x is None for x in a.flat):
        try:
            return a.astype(float)  # numbers of other modules, such as fractions
        except OverflowError:
            raise ValueError("%s holds a whole number above the largest double, 1.8e308" % what) from None
        except (TypeError, ValueError):
            pass
    if a.dtype.kind not in "biuf":
        raise TypeError("%s is %s and must be numbers" % (
            what, "None" if value is None else "a %s" % type(value).__name__ if a.ndim == 0
            else "an array of texts" if a.dtype.kind in "US" else "an array that holds %s" % (
                "None" if any(x is None for x in a.flat) else type(a.flat[0]).__name__)))
    return a.astype(float, copy=False)


def returned(what, value, shape):
    """What a callback returned, in the shape that is needed; axes of length 1 may be missing or more."""
    count = int(np.prod(shape))
    if value is None:
        raise _wrong(what, value, count)
    if hasattr(value, "toarray"):
        value = value.toarray()
    a = real("what %s returned" % what, list(value) if isinstance(value, (range, map, zip)) else value)
    if a.size != count or sum(k != 1 for k in a.shape) > sum(k != 1 for k in shape):
        raise _wrong(what, value, count)
    return a.reshape(shape)


def memory(address, shape):
    """An array of NumPy on memory of the library."""
    return np.frombuffer((REAL * int(np.prod(shape))).from_address(address)).reshape(shape, order="F")


def reader(n):
    """Vectors of the library for callbacks, as copies that cannot be changed: the library's own memory is
    overwritten by the next step and freed after the run, while callbacks may keep what they were given."""
    address_of, views = lib.N_VGetArrayPointer, {}

    def read(v):
        address = address_of(v)
        view = views.get(address)
        if view is None:
            view = views[address] = memory(address, (n,))
        y = view.copy()
        y.setflags(write=False)
        return y

    return read


def right_hand_side(f, args, n, failed):
    """f as a callback of the library: `reader` and `returned` without calls between them, for it is called most.
    Lists of plain numbers go straight in."""
    address_of, copies, places, shape, ndarray, double = lib.N_VGetArrayPointer, {}, {}, (n,), np.ndarray, _DOUBLE
    cells, plain, what = REAL * n, frozenset((float, int, np.float64)).issuperset, "f(t, y)"
    more = len(args) > 0

    def call(t, y, out, user):
        try:
            address = address_of(y)
            copy = copies.get(address)
            if copy is None:
                copy = copies[address] = memory(address, shape).copy
            u = copy()
            u.setflags(False)
            value = f(t, u, *args) if more else f(t, u)
            address = address_of(out)
            place = places.get(address)
            if place is None:
                numbers = cells.from_address(address)
                place = places[address] = numbers, np.frombuffer(numbers)
            if type(value) is list and len(value) == n and plain(map(type, value)):
                place[0][:] = value
            elif type(value) is ndarray and value.dtype is double and value.shape == shape:
                place[1][:] = value
            else:
                place[1][:] = returned(what, value, shape)
            return 0
        except BaseException as reason:  # Ctrl-C as well
            return failed(reason, what)

    return call


def grids(shape):
    """Memory of the library as arrays of this shape, by columns, each made once."""
    views = {}

    def grid(address):
        view = views.get(address)
        if view is None:
            view = views[address] = memory(address, shape)
        return view

    return grid


def frozen(values):
    """An array that a callback cannot change."""
    a = np.array(values, dtype=float)
    a.setflags(write=False)
    return a


def explained(reason, what):
    """The exception of a callback; one that tried to write into what it was given, with a sentence."""
    if what and isinstance(reason, ValueError) and "read-only" in str(reason):
        told = ValueError("%s wrote into an array that is read-only: y must not be changed in place; write 2*y instead "
                          "of y *= 2, or begin with y = y.copy() (Cython: declare const double[:])" % what)
        told.__cause__ = reason
        return told
    return reason


def choice(name, value):
    """A text such as the name of a method."""
    if not isinstance(value, str):
        raise TypeError("%s is %r and must be a text, such as 'auto'" % (name, value))
    return value.encode()


def positive(name, value):
    if not isinstance(value, (str, bytes)) and np.ndim(value) == 0 and float(value) > 0:
        return float(value)
    raise ValueError("%s is %s and must be above 0" % (
        name, "%g" % value if isinstance(value, (int, float)) else repr(value)))


def sparse_columns(M, n, name):
    """A matrix of scipy.sparse, or an array of doubles, by columns: starts, rows, values."""
    if M.shape != (n, n):
        raise ValueError("%s has the shape %s, %s is needed" % (name, M.shape, (n, n)))
    if hasattr(M, "tocsc"):
        S = M.tocsc()
        if not S.has_canonical_format:
            S = S.copy()
            S.sum_duplicates()
        return S.indptr, S.indices, real(name, S.data)
    columns, rows = np.nonzero(M.T)
    return np.searchsorted(columns, np.arange(n + 1)), rows, M[rows, columns]


def places_of(pattern, n):
    """Of the entries of a pattern, once each: column * n + row, ascending; by columns: starts, rows."""
    stored = pattern.tocoo() if hasattr(pattern, "tocoo") else None  # zeros that are stored count
    rows, columns = (stored.row, stored.col) if stored is not None else np.nonzero(pattern)
    places = np.unique(columns.astype(np.int64) * n + rows)
    columns, rows = np.divmod(places, n)
    start = np.searchsorted(columns, np.arange(n + 1)).astype(WHOLE)
    return places, start, np.ascontiguousarray(rows, dtype=WHOLE)


def spread_sparse(columns, pattern, n, name):
    """The matrix with all places of the pattern, which factors are analysed for once; 0 where it has no entry."""
    places, start, rows = pattern
    begun, at, values = columns
    if values.size == rows.size and np.array_equal(begun, start) and np.array_equal(at, rows):
        return start, rows, values
    own = np.repeat(np.arange(n, dtype=np.int64), np.diff(begun)) * n + at
    own, values = own[values != 0], values[values != 0]
    found = np.searchsorted(places, own)
    known = found < places.size
    known[known] = places[found[known]] == own[known]
    if not known.all():
        column, row = np.divmod(own[~known][0], n)
        raise ValueError("%s has an entry in row %d, column %d (from 0), where its pattern has none: give jac_sparsity "
                         "with all places where there may be one" % (name, row, column))
    spread = np.zeros(places.size)
    spread[found] = values
    return start, rows, spread


def fill_sparse(to, columns):
    """Into a sparse matrix of the library, by columns."""
    start, rows, values = columns
    for address, array, kind in ((lib.SUNSparseMatrix_IndexPointers(to), start, WHOLE),
                                 (lib.SUNSparseMatrix_IndexValues(to), rows, WHOLE),
                                 (lib.SUNSparseMatrix_Data(to), values, REAL)):
        array = np.ascontiguousarray(array, dtype=kind)
        c.memmove(address, array.ctypes.data, array.nbytes)
