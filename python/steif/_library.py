"""libsteif through ctypes: functions, struct members by offset, arrays without copies."""
import ctypes as c
import os
import sys

import numpy as np

POINTER, REAL, INT = c.c_void_p, c.c_double, c.c_int


class SteifError(RuntimeError):
    """A failure of the library: `code` and its sentence."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code

    def __reduce__(self):  # for other processes
        return type(self), (self.code, str(self))


def _candidates():
    if os.environ.get("STEIF_LIBRARY"):
        yield os.environ["STEIF_LIBRARY"]
        return
    name = "libsteif.dylib" if sys.platform == "darwin" else "libsteif.so"
    here = os.path.dirname(os.path.abspath(__file__))
    beside = (here, os.path.join(here, "..", "..", ".."))  # PREFIX/lib/python3/dist-packages/steif
    for path in (os.path.join(folder, name) for folder in beside):
        if os.path.exists(path):
            yield path
    yield name
    yield name + ".0"


def _open():
    reasons = []
    for path in _candidates():
        try:
            return c.CDLL(path)
        except OSError as reason:
            reasons.append(str(reason))
    raise ImportError("libsteif was not found; set STEIF_LIBRARY to its path. Tried: "
                      + "; ".join(reasons))


lib = _open()
lib.steif_layout.restype, lib.steif_layout.argtypes = c.c_long, (c.c_char_p,)
WHOLE = c.c_int64 if lib.steif_layout(b"sunindextype") == 8 else c.c_int32  # of sizes and rows


def _declare(name, result, *arguments):
    function = getattr(lib, name)
    function.restype, function.argtypes = result, arguments


for _row in (
    ("steif_context_new", POINTER, POINTER),
    ("steif_context_free", None, POINTER),
    ("steif_message", c.c_char_p, POINTER),
    ("steif_status", INT, POINTER),
    ("steif_version", c.c_char_p),
    ("steif_problem_find", INT, POINTER, c.c_char_p, POINTER),
    ("steif_problem_clear", None, POINTER, POINTER),
    ("steif_solver_new", POINTER, POINTER, POINTER, c.c_char_p, POINTER),
    ("steif_solver_free", None, POINTER),
    ("steif_solve_to", INT, POINTER, REAL),
    ("steif_method_used", c.c_char_p, POINTER),
    ("steif_solution", POINTER, POINTER),
    ("steif_dense", INT, POINTER, REAL, POINTER),
    ("steif_time", REAL, POINTER),
    ("steif_recomputed", INT, POINTER, POINTER, POINTER),
    ("steif_statistics", POINTER, POINTER),
    ("steif_record_new", POINTER, POINTER, WHOLE, INT),
    ("steif_record_free", None, POINTER),
    ("steif_record_step", INT, POINTER, REAL, POINTER, POINTER),
    ("steif_record_steps", c.c_size_t, POINTER, POINTER),
    ("steif_record_values", POINTER, POINTER),
    ("steif_record_at", INT, POINTER, REAL, POINTER, POINTER),
    ("steif_model_output", c.c_char_p, POINTER, c.c_size_t),
    ("steif_model_outputs", INT, POINTER, REAL, POINTER, POINTER),
    ("steif_model_turn", c.c_char_p, POINTER, INT, INT),
    ("steif_model_parse", INT, POINTER, c.c_char_p, c.c_char_p, POINTER, POINTER),
    ("steif_model_start", c.c_char_p, POINTER),
    ("steif_initial_used", POINTER, POINTER),
    ("steif_parameter_find", INT, POINTER, POINTER, c.c_char_p),
    ("steif_model_fitted", c.c_char_p, POINTER, c.c_size_t),
    ("steif_problem_vary", INT, POINTER, POINTER, INT, POINTER, POINTER, POINTER),
    ("steif_sensitivity", INT, POINTER, REAL, INT, POINTER),
    ("steif_sensitivity_event", INT, POINTER, INT, POINTER, POINTER),
    ("steif_measurements_read", INT, POINTER, POINTER, c.c_char_p, REAL, INT, INT, POINTER, POINTER),
    ("steif_measurements_free", None, POINTER, POINTER),
    ("steif_fit_find", INT, POINTER, POINTER, c.c_char_p, POINTER, POINTER, POINTER),
    ("steif_fit_free", None, POINTER, POINTER),
    ("steif_ensemble", INT, POINTER, c.c_longlong, POINTER, POINTER, POINTER),
    ("N_VGetArrayPointer", POINTER, POINTER),
    ("N_VClone", POINTER, POINTER),
    ("N_VNew_Serial", POINTER, WHOLE, POINTER),
    ("N_VDestroy", None, POINTER),
    ("SUNDenseMatrix_Data", POINTER, POINTER),
    ("steif_sundials", POINTER, POINTER),
    ("SUNDenseMatrix", POINTER, WHOLE, WHOLE, POINTER),
    ("SUNSparseMatrix", POINTER, WHOLE, WHOLE, WHOLE, INT, POINTER),
    ("SUNSparseMatrix_Data", POINTER, POINTER),
    ("SUNSparseMatrix_NNZ", WHOLE, POINTER),
    ("SUNSparseMatrix_IndexPointers", POINTER, POINTER),
    ("SUNSparseMatrix_IndexValues", POINTER, POINTER),
    ("SUNMatDestroy", None, POINTER),
    ("steif_structure_find", INT, POINTER, POINTER, POINTER, POINTER, POINTER),
    ("steif_structure_clear", None, POINTER, POINTER),
    ("steif_linear_of", INT, POINTER, POINTER, POINTER),
    ("steif_impulse_find", INT, POINTER, POINTER, POINTER, POINTER, REAL, POINTER, POINTER, POINTER,
     POINTER, POINTER),
    ("steif_impulse_clear", None, POINTER, POINTER),
    ("steif_function_parse", POINTER, POINTER, c.c_char_p, WHOLE, POINTER),
    ("steif_function_free", None, POINTER),
    ("steif_function_breaks", c.c_size_t, POINTER, REAL, REAL, c.c_size_t, POINTER),
    ("steif_convention_usual", INT, POINTER, c.c_char_p, c.c_char_p, POINTER),
    ("steif_weak_measure", INT, POINTER, POINTER, POINTER, POINTER),
    ("steif_c2d", INT, POINTER, POINTER, c.c_char_p, REAL, POINTER),
    ("steif_discrete_clear", None, POINTER, POINTER),
    ("steif_finite_part_find", INT, POINTER, POINTER, POINTER, POINTER),
    ("steif_finite_part_clear", None, POINTER, POINTER),
):
    _declare(*_row)


def version():
    """The version of the library at hand."""
    return lib.steif_version().decode()


class Struct:
    """Zeroed memory of a struct of the library; members are set and read by their offsets."""

    def __init__(self, kind, count=1, address=None):
        self.kind, self.kept = kind, {}
        self.size = lib.steif_layout(kind.encode())
        if self.size < 0:
            raise SteifError(-2, "this libsteif has no struct %s" % kind)
        self.memory = None if address else c.create_string_buffer(self.size * count)
        self.address = address or c.addressof(self.memory)

    def row(self, i):
        """Struct i of an array of them."""
        return Struct(self.kind, address=self.address + i * self.size)

    def inner(self, member, kind):
        """A struct that is a member of this one."""
        place = self._place(member, c.c_char)
        return Struct(kind, address=c.addressof(place))

    def text(self, member):
        """A member that is an array of characters."""
        return c.string_at(c.addressof(self._place(member, c.c_char))).decode()

    def array(self, member, *shape, order="C"):
        """A copy of the numbers that a pointer leads to; None for NULL."""
        address = self.get(member, POINTER)
        count = int(np.prod(shape))
        if not address:
            return None if count else np.zeros(shape)
        return np.array((REAL * count).from_address(address)).reshape(shape, order=order)

    def _place(self, member, kind):
        at = lib.steif_layout(("%s.%s" % (self.kind, member)).encode())
        if at < 0:
            raise SteifError(-2, "this libsteif has no member %s.%s" % (self.kind, member))
        return kind.from_address(self.address + at)

    def set(self, member, kind, value):
        """Set a member; what a pointer leads to is kept alive with the struct."""
        self.kept[member] = value
        address = POINTER if kind is POINTER else kind
        if kind is POINTER and not isinstance(value, int):
            value = c.cast(value, POINTER).value
        self._place(member, address).value = value

    def get(self, member, kind):
        return self._place(member, kind).value


class Context:
    """A context of the library; its last sentence becomes an exception."""

    def __init__(self):
        self.pointer = lib.steif_context_new(None)
        if not self.pointer:
            raise MemoryError("no memory for a context of libsteif")

    def sentence(self):
        """The last one, without the name of its code."""
        return lib.steif_message(self.pointer).decode().split(" [STEIF_")[0]

    def error(self):
        return SteifError(lib.steif_status(self.pointer), lib.steif_message(self.pointer).decode())

    def close(self):
        if self.pointer:
            lib.steif_context_free(c.byref(POINTER(self.pointer)))
            self.pointer = None
