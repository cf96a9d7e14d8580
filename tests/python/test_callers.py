"""What callbacks and arguments may do wrong, and what a caller who knows SciPy expects."""
import gc
import os
import pickle
import signal
import threading
import time
import unittest
from fractions import Fraction

import numpy as np
import steif

try:
    from scipy import sparse
    from scipy.integrate import solve_ivp
except ImportError:
    solve_ivp = sparse = None

E1 = np.exp(-1)


def decay(t, y):
    return -y


def oscillator(t, y):
    return [y[1], -y[0]]


class ReadOnly(unittest.TestCase):
    def test_no_callback_can_change_y(self):
        def f(t, y):
            y *= 2
            return y

        def late(t, y):
            if t > 0.5:
                y[0] = 0
            return -y

        def event(t, y):
            y[0] = 3
            return 1.0

        def jac(t, y):
            np.negative(y, out=y)
            return [[-1.0]]

        def jac_later(t, y):
            if t > 0.2:
                y.sort()
            return -np.eye(1)

        def parametrised(t, y, k):
            y.fill(0)
            return -k * y

        for name, run in ((r"f\(t, y\)", lambda: steif.solve(f, (0, 1), [1.0])),
                          (r"f\(t, y\)", lambda: steif.solve(late, (0, 1), [1.0])),
                          ("event function", lambda: steif.solve(decay, (0, 1), [1.0], events=event)),
                          ("jac", lambda: steif.solve(decay, (0, 1), [1.0], jac=jac, method="bdf")),
                          ("jac", lambda: steif.solve(lambda t, y: -y**3, (0, 9), [1.0], jac=jac_later, method="bdf")),
                          (r"f\(t, y\)", lambda: steif.sensitivity(parametrised, (0, 1), [1.0], p=[1])),
                          (r"f\(t, y\)", lambda: steif.fit(parametrised, [1], [[1]], y0=[1.0], p=[1]))):
            with self.assertRaisesRegex(ValueError, name + ".*wrote into.*read-only.*y.copy") as caught:
                run()
            self.assertIn("read-only", str(caught.exception.__cause__))

    def test_y_may_be_kept_and_copied(self):
        kept = []

        def f(t, y):
            kept.append((t, y, y[1:]))
            return -y

        steif.solve(f, (0, 1), [1.0, 2.0], rtol=1e-9)
        gc.collect()
        first = kept[0]
        np.testing.assert_array_equal(first[1], [1, 2])
        for t, y, part in kept:  # near the solution of that time, not what the memory held at the end
            np.testing.assert_allclose(y, np.exp(-t) * np.array([1, 2]), rtol=0.1)
            self.assertEqual(part[0], y[1])

        def doubling(t, y):
            y = y.copy()
            y *= -1
            return y

        self.assertAlmostEqual(steif.solve(doubling, (0, 1), [1.0], rtol=1e-9).y[0, -1], E1, 8)


class Values(unittest.TestCase):
    def test_kinds_of_starts(self):
        for y0 in ([1, 2], (1, 2), range(1, 3), np.array([1, 2], dtype=np.float32), np.array([1, 9, 2])[::2],
                   np.array([1, 2], dtype=">f8"), [Fraction(1), 2], np.ma.array([1.0, 2.0])):
            s = steif.solve(decay, (0, 1), y0, rtol=1e-8)
            np.testing.assert_allclose(s.y[:, -1], [E1, 2 * E1], rtol=1e-6)
        start = np.array([1.0, 2.0])
        steif.solve(decay, (0, 1), start)
        np.testing.assert_array_equal(start, [1, 2])

    def test_kinds_of_returned_values(self):
        for g in (lambda y: -y.astype(np.float32), lambda y: tuple(-y), lambda y: [-y[0], -y[1]], lambda y: list(-y),
                  lambda y: np.array([-y[0], 0, -y[1]])[::2], lambda y: np.array([-y, y]).T[:, 0],
                  lambda y: np.array(-y, dtype=">f8"), lambda y: map(lambda v: -v, y), lambda y: (-y).reshape(2, 1),
                  lambda y: [-Fraction(y[0]), -Fraction(y[1])]):
            s = steif.solve(lambda t, y: g(y), (0, 1), [1, 2], rtol=1e-6)
            np.testing.assert_allclose(s.y[:, -1], [E1, 2 * E1], rtol=1e-4)
        s = steif.solve(lambda t, y: [1, 2], (0, 1), [0, 0])
        np.testing.assert_allclose(s.y[:, -1], [1, 2], rtol=1e-9)

    def test_values_that_are_none(self):
        two = [1.0, 2.0]
        for kind, sentence, f, y0 in (
                (TypeError, "complex", lambda t, y: np.array([1j, 0]), two),
                (TypeError, "complex", lambda t, y: [np.complex128(1j), 0], two),
                (TypeError, "complex", lambda t, y: np.emath.sqrt([0.5 - t, 1]), two),
                (TypeError, "texts", lambda t, y: ["1", "2"], two),
                (TypeError, "holds None", lambda t, y: [None, 1], two),
                (TypeError, "a set", lambda t, y: {1, 2}, two),
                (TypeError, "a generator", lambda t, y: (v for v in y), two),
                (ValueError, "different lengths", lambda t, y: [[1], [1, 2]], two),
                (ValueError, r"shape \(2, 2\)", lambda t, y: np.eye(2), two),
                (ValueError, r"shape \(1,\)", lambda t, y: y if t < 0.5 else y[:1], two),
                (TypeError, "y0 is complex", decay, np.array([1j])),
                (TypeError, "y0 is an array of texts", decay, ["1"]),
                (ValueError, "y0 is empty", decay, []), (ValueError, "above the largest double", decay, [10 ** 400]),
                (ValueError, "one dimension", decay, 1.0)):
            with self.assertRaisesRegex(kind, sentence):
                steif.solve(f, (0, 1), y0)

    def test_arguments_that_are_none(self):
        for kind, sentence, given in (
                (TypeError, r"args=\(5,\)", {"args": 5}), (TypeError, "method is None", {"method": None}),
                (TypeError, "event 1 is 3", {"events": 3}), (TypeError, "y\\[0\\] - 1", {"events": lambda t, y: y[0] > 1}),
                (TypeError, "event 1 returned is a str", {"events": lambda t, y: "a"}),
                (TypeError, "event 1 returned is complex", {"events": lambda t, y: 1j}),
                (ValueError, "atol is 0", {"atol": 0}), (ValueError, "atol is 0", {"atol": [0]}),
                (ValueError, "rtol is nan", {"rtol": np.nan}), (ValueError, "one number", {"rtol": [1e-3]}),
                (ValueError, "max_steps is 0", {"max_steps": 0}), (ValueError, "h is 'a'", {"h": "a"}),
                (ValueError, "mass is a function", {"mass": lambda t, y: [[1]]}),
                (TypeError, "mass is complex", {"mass": [[1j]]}), (TypeError, "jac .* complex", {"jac": [[1j]]}),
                (TypeError, "jac .* a str", {"jac": "2-point"}), (TypeError, "a generator", {"t_eval": (v for v in [1])}),
                (ValueError, "one at least", {"t_eval": []}), (steif.SteifError, "dopri87", {"method": "RK45"})):
            with self.assertRaisesRegex(kind, sentence):
                steif.solve(decay, (0, 1), [1.0], **given)
        with self.assertRaisesRegex(steif.SteifError, "backwards"):
            steif.solve(decay, (1, 0), [1.0])
        s = steif.solve(decay, (0, 1), [1.0], events=[], max_step=np.inf)
        self.assertEqual((s.t_events, s.success), ([], True))
        with self.assertRaisesRegex(TypeError, "E is complex"):
            steif.impulse(np.array([[1j]]), [[1]], [1])

    @unittest.skipIf(sparse is None, "no SciPy")
    def test_every_format_of_sparse_matrices(self):
        dense = np.array([[-1.0, 0], [1, -2]])
        exact = [E1, E1 - np.exp(-2)]  # of x' = -x, y' = x - 2 y from (1, 0)
        given = [getattr(sparse, kind + end)(dense) for kind in ("csr", "csc", "coo", "lil", "dok", "dia", "bsr")
                 for end in ("_matrix", "_array")]
        long = sparse.csc_matrix(dense)
        long.indices, long.indptr = long.indices.astype(np.int64), long.indptr.astype(np.int64)
        given += [long, sparse.coo_matrix(([-0.5, -0.5, 1, -2], ([0, 0, 1, 1], [0, 0, 0, 1]))),
                  sparse.csc_matrix((np.array([1.0, -1, -2]), np.array([1, 0, 1]), np.array([0, 2, 3])))]
        for A in given:
            for more in (dict(jac=A), dict(jac=lambda t, y: A), dict(jac_sparsity=A),
                         dict(jac=A, mass=sparse.identity(2, format=A.format))):
                s = steif.solve(lambda t, y: A @ y, (0, 1), [1, 0], rtol=1e-9, method="radau:s=3", **more)
                np.testing.assert_allclose(s.y[:, -1], exact, atol=1e-8)


class Endings(unittest.TestCase):
    def test_exceptions_of_every_callback(self):
        def fails(*arguments):
            raise KeyError("lost")

        for given in ({"f": fails}, {"jac": fails, "method": "bdf"}, {"events": fails},
                      {"jac": lambda t, y: fails() if t > 0.1 else [[-3 * y[0] ** 2]], "method": "bdf"}):
            with self.assertRaisesRegex(KeyError, "lost"):
                steif.solve(given.pop("f", lambda t, y: -y ** 3), (0, 9), [1.0], **given)
        for kind in (KeyboardInterrupt, SystemExit, GeneratorExit, RecursionError, StopIteration):
            def ends(t, y):
                if t > 0.5:
                    raise kind()
                return -y

            with self.assertRaises(kind):
                steif.solve(ends, (0, 1), [1.0])

    def test_solve_within_solve_and_in_threads(self):
        # y' = -z(0.1) with z' = -z, z(0) = y: y' = -exp(-0.1) y
        s = steif.solve(lambda t, y: -steif.solve(decay, (0, 0.1), y, rtol=1e-9).y[:, -1], (0, 1), [1.0], rtol=1e-7)
        self.assertAlmostEqual(s.y[0, -1], np.exp(-np.exp(-0.1)), 6)
        found = [None] * 6

        def work(i):
            found[i] = steif.solve(lambda t, y: [-(i + 1) * y[0]], (0, 1), [1.0], rtol=1e-9).y[0, -1]

        threads = [threading.Thread(target=work, args=(i,)) for i in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_allclose(found, np.exp(-np.arange(1.0, 7)), rtol=1e-6)

    def test_an_error_reaches_another_process(self):
        with self.assertRaises(steif.SteifError) as caught:
            steif.solve("robber")
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((again.code, str(again)), (caught.exception.code, str(caught.exception)))

    def test_interrupts_without_and_within_callbacks(self):
        model = "param k = 1\nstate x = 1, v = 0\nx' = v\nv' = -k*x\ntime 0 to 1e7\n"
        many = dict(rtol=1e-10, max_steps=10 ** 9)
        for run in (lambda: steif.solve(model, t_eval=[1], **many), lambda: steif.sensitivity(model, rtol=1e-10),
                    lambda: steif.solve(lambda t, y: (time.sleep(20), -y)[1], (0, 1), [1.0])):
            timer, began = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)), time.monotonic()
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                run()
            timer.join()
            self.assertLess(time.monotonic() - began, 10)
            self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_terminal_counts_as_in_scipy(self):
        for count in (True, 1, 2, 3):
            def crossing(t, y):
                return y[0]

            crossing.terminal = count
            s = steif.solve(oscillator, (0, 20), [1, 0], events=crossing, rtol=1e-9)
            np.testing.assert_allclose(s.t_events[0], np.pi * (np.arange(int(count)) + 0.5), rtol=1e-7)
            self.assertEqual((s.status, s.t[-1]), (1, s.t_events[0][-1]))
        for wrong in (-1, 1.5, "a", np.inf, np.nan):
            crossing.terminal = wrong
            with self.assertRaisesRegex(ValueError, "occurrence"):
                steif.solve(oscillator, (0, 20), [1, 0], events=crossing)
        crossing.terminal, crossing.direction = False, "up"
        with self.assertRaisesRegex(ValueError, "direction of event 1 is 'up'"):
            steif.solve(oscillator, (0, 20), [1, 0], events=crossing)


def robertson(t, y):
    a, b, c = 0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] ** 2
    return [-a + b, a - b - c, c]


def brusselator(t, y):
    return [1 + y[0] ** 2 * y[1] - 4 * y[0], 3 * y[0] - y[0] ** 2 * y[1]]


def orbit(t, y):
    r = np.hypot(y[0], y[1]) ** 3
    return np.array([y[2], y[3], -y[0] / r, -y[1] / r])


TEN = {
    "decay": (decay, (0, 5), [1.0], 1),
    "oscillator": (oscillator, (0, 20), [1, 0], 10),
    "Van der Pol": (lambda t, y: [y[1], 50 * (1 - y[0] ** 2) * y[1] - y[0]], (0, 5), [2, 0], 100),
    "Robertson": (robertson, (0, 40), [1, 0, 0], 10),
    "Lotka and Volterra": (lambda t, y: [1.5 * y[0] - y[0] * y[1], y[0] * y[1] - 3 * y[1]], (0, 15), [10, 5], 100),
    "Brusselator": (brusselator, (0, 20), [1.5, 3], 100),
    "orbit": (orbit, (0, 10), [0.5, 0, 0, np.sqrt(3)], 1000),
    "Prothero and Robinson": (lambda t, y: [-1e4 * (y[0] - np.cos(t)) - np.sin(t)], (0, 3), [1.0], 10),
    "logistic": (lambda t, y: y * (1 - y), (0, 10), [0.01], 100),
    "heat": (lambda t, u: (np.r_[u[1:], 0] - 2 * u + np.r_[0, u[:-1]]) * 441, (0, 0.2), np.sin(np.arange(1, 21) / 3), 10),
}


STIFF = ("Van der Pol", "Robertson", "Prothero and Robinson", "heat")


class AsSciPy(unittest.TestCase):
    @unittest.skipIf(solve_ivp is None, "no SciPy")
    def test_ten_problems(self):
        rtol = 1e-7
        for name, (f, span, y0, factor) in TEN.items():
            with self.subTest(name):
                t = np.linspace(*span, 11)
                r = solve_ivp(f, span, y0, method="Radau" if name in STIFF else "DOP853", rtol=1e-10, atol=1e-12,
                              t_eval=t)
                s = steif.solve(f, span, y0, rtol=rtol, t_eval=t)
                np.testing.assert_array_equal(s.t, r.t)
                self.assertEqual((s.y.shape, s.success), (r.y.shape, True))
                np.testing.assert_allclose(s.y, r.y, rtol=factor * rtol, atol=factor * rtol)

    @unittest.skipIf(solve_ivp is None, "no SciPy")
    def test_events_and_arguments(self):
        def crossing(t, y, w):
            return y[0]

        crossing.direction = -1
        run = dict(args=(2.0,), events=[crossing], t_eval=[1, 2], dense_output=True, rtol=1e-9, atol=1e-9)
        f = lambda t, y, w: [w * y[1], -w * y[0]]
        s, r = steif.solve(f, (0, 6), [1, 0], **run), solve_ivp(f, (0, 6), [1, 0], method="Radau", **run)
        np.testing.assert_allclose(s.t_events[0], r.t_events[0], atol=1e-7)
        np.testing.assert_allclose(s.y_events[0], r.y_events[0], atol=1e-7)
        np.testing.assert_allclose(s.sol([0.5, 3]), r.sol([0.5, 3]), atol=1e-7)
        self.assertEqual((s.y.shape, s.status), (r.y.shape, r.status))


if __name__ == "__main__":
    unittest.main()
