"""libsteif through ctypes: functions, struct members by offset, arrays without copies."""
import ctypes as c
import os
import sys

POINTER, REAL, INT = c.c_void_p, c.c_double, c.c_int


class SteifError(RuntimeError):
    """A failure of the library: `code` and its sentence."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


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


def _declare(name, result, *arguments):
    function = getattr(lib, name)
    function.restype, function.argtypes = result, arguments


for _row in (
    ("steif_context_new", POINTER, POINTER),
    ("steif_context_free", None, POINTER),
    ("steif_message", c.c_char_p, POINTER),
    ("steif_status", INT, POINTER),
    ("steif_version", c.c_char_p),
    ("steif_layout", c.c_long, c.c_char_p),
    ("steif_problem_find", INT, POINTER, c.c_char_p, POINTER),
    ("steif_problem_clear", None, POINTER, POINTER),
    ("steif_solver_new", POINTER, POINTER, POINTER, c.c_char_p, POINTER),
    ("steif_solver_free", None, POINTER),
    ("steif_solve_to", INT, POINTER, REAL),
    ("steif_method_used", c.c_char_p, POINTER),
    ("steif_solution", POINTER, POINTER),
    ("steif_time", REAL, POINTER),
    ("steif_statistics", POINTER, POINTER),
    ("N_VGetArrayPointer", POINTER, POINTER),
    ("SUNDenseMatrix_Data", POINTER, POINTER),
):
    _declare(*_row)


def version():
    """The version of the library at hand."""
    return lib.steif_version().decode()


class Struct:
    """Zeroed memory of a struct of the library; members are set and read by their offsets."""

    def __init__(self, kind):
        self.kind, self.kept = kind, {}
        self.memory = c.create_string_buffer(lib.steif_layout(kind.encode()))
        self.address = c.addressof(self.memory)

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

    def error(self):
        return SteifError(lib.steif_status(self.pointer), lib.steif_message(self.pointer).decode())

    def close(self):
        if self.pointer:
            lib.steif_context_free(c.byref(POINTER(self.pointer)))
            self.pointer = None
