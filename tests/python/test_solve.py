"""The Python module: solutions, counts, events, errors, against closed forms and SciPy."""
import math
import os
import signal
import tempfile
import threading
import unittest

import numpy as np
import steif

try:
    from scipy import sparse
    from scipy.integrate import solve_ivp
except ImportError:
    solve_ivp = sparse = None


def vdpol(t, y, mu=100.0):
    return [y[1], mu * (1 - y[0] ** 2) * y[1] - y[0]]


class Solve(unittest.TestCase):
    def test_closed_solution_at_given_times(self):
        t = np.linspace(0, 2, 9)
        for method in ("auto", "radau:s=3", "bdf", "rodas5p", "dopri87", "cvode"):
            s = steif.solve(lambda t, y: [y[1], -y[0]], (0, 2), [1, 0], method=method, rtol=1e-8,
                            t_eval=t)
            self.assertTrue(s.success)
            self.assertEqual(s.y.shape, (2, 9))
            np.testing.assert_array_equal(s.t, t)
            np.testing.assert_allclose(s.y, [np.cos(t), -np.sin(t)], atol=3e-6)

    def test_steps_are_kept(self):
        s = steif.solve(lambda t, y: -y, (0, 1), [1.0], rtol=1e-8)
        self.assertEqual(s.t[0], 0)
        self.assertEqual(s.t[-1], 1)
        self.assertEqual(len(s.t), s.nsteps + 1)
        np.testing.assert_allclose(s.y[0], np.exp(-s.t), rtol=1e-6)
        self.assertGreater(s.nfev, 0)

    @unittest.skipIf(solve_ivp is None, "no SciPy")
    def test_stiff_as_scipy(self):
        s = steif.solve(vdpol, (0, 50), [2, 0], rtol=1e-9)
        r = solve_ivp(vdpol, (0, 50), [2, 0], method="Radau", rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(s.y[:, -1], r.y[:, -1], rtol=1e-6, atol=1e-6)

    def test_jacobian_arguments_and_constant_step(self):
        def jac(t, y, mu):
            return [[0, 1], [-2 * mu * y[0] * y[1] - 1, mu * (1 - y[0] ** 2)]]

        s = steif.solve(vdpol, (0, 1), [2, 0], args=(5.0,), jac=jac, rtol=1e-8, method="radau:s=3")
        p = steif.solve(vdpol, (0, 1), [2, 0], args=(5.0,), rtol=1e-8, method="bdf")
        np.testing.assert_allclose(s.y[:, -1], p.y[:, -1], rtol=1e-5)
        e = steif.solve(lambda t, y: -y, (0, 1), [1], method="be", h=0.1)
        self.assertAlmostEqual(e.y[0, -1], 1.1 ** -10, 12)

    def test_singular_mass_and_a_start_that_is_repaired(self):
        # x' = z, 0 = z^2 - x: z = 1 + t/2
        s = steif.solve(lambda t, y: [y[1], y[1] ** 2 - y[0]], (0, 1), [1, 1],
                        mass=[[1, 0], [0, 0]], rtol=1e-8)
        np.testing.assert_allclose(s.y[:, -1], [2.25, 1.5], rtol=1e-7)

    def test_events(self):
        def ground(t, y):
            return y[0]

        ground.terminal, ground.direction = True, -1
        s = steif.solve(lambda t, y: [y[1], -9.81], (0, 10), [1, 0], events=ground, rtol=1e-9)
        self.assertEqual(s.status, 1)
        self.assertAlmostEqual(s.t_events[0][0], math.sqrt(2 / 9.81), 8)
        self.assertAlmostEqual(s.t[-1], math.sqrt(2 / 9.81), 8)
        self.assertEqual(s.y_events[0][0].shape, (2,))

    def test_dense_output(self):
        s = steif.solve(lambda t, y: [y[1], -y[0]], (0, 6), [1, 0], rtol=1e-10, dense_output=True,
                        method="radau:s=3")
        t = np.linspace(0, 6, 200)
        np.testing.assert_allclose(s.sol(t), [np.cos(t), -np.sin(t)], atol=1e-6)
        np.testing.assert_allclose(s.sol(s.t), s.y, atol=1e-12)
        self.assertEqual(s.sol(2.5).shape, (2,))
        for outside in (-0.1, 6.1, float("nan")):
            with self.assertRaisesRegex(ValueError, "outside"):
                s.sol(outside)
        r = steif.solve(lambda t, y: [1.0], (0, 1), [0], t_eval=[0.5], dense_output=True)
        self.assertEqual(r.t.size, 1)
        self.assertAlmostEqual(r.sol(0.25)[0], 0.25, 6)  # within rtol
        with self.assertRaises(ZeroDivisionError):  # the record is freed with the run
            steif.solve(lambda t, y: [1 / 0], (0, 1), [0], dense_output=True)

    def test_a_model_keeps_its_own(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "decay.steif")
            with open(path, "w") as file:
                file.write("param x0 = 1\nstate x = x0\nx' = -x\ntime 1 to 2\n")
            self.assertAlmostEqual(steif.solve(path + ":x0=10", (1, 3)).y[0, -1], 10 * np.exp(-2), 4)
            for given in ({"y0": [10.0]}, {"args": (3,)}, {"mass": [[5]]}, {"events": lambda t, y: y[0]},
                          {"jac": [[1]]}, {"t_span": (0, 2)}, {"t_span": 2}):
                with self.assertRaises(ValueError):
                    steif.solve(path, **given)
        with self.assertRaisesRegex(ValueError, "ascending"):
            steif.solve(lambda t, y: [1.0], (0, 1), [0], t_eval=[0, float("nan"), 1])

    def test_sparse_jacobian(self):
        # u_t = u_xx on a grid: the sine decays by its eigenvalue; few evaluations for 300 unknowns
        n = 300
        dx, x = 1 / (n + 1), np.arange(1, n + 1) / (n + 1)

        def f(t, u):
            return (np.r_[u[1:], 0] - 2 * u + np.r_[0, u[:-1]]) / dx ** 2

        pattern = np.eye(n) + np.eye(n, k=1) + np.eye(n, k=-1)
        decay = math.exp(-4 * math.sin(math.pi * dx / 2) ** 2 / dx ** 2 * 0.1)
        s = steif.solve(f, (0, 0.1), np.sin(math.pi * x), jac_sparsity=pattern, rtol=1e-8)
        np.testing.assert_allclose(s.y[:, -1], decay * np.sin(math.pi * x), atol=1e-7)
        self.assertLess(s.nfev, n)
        with self.assertRaisesRegex(ValueError, "shape"):
            steif.solve(f, (0, 0.1), np.sin(math.pi * x), jac_sparsity=np.eye(3))

    @unittest.skipIf(sparse is None, "no SciPy")
    def test_sparse_jacobians_whose_entries_change_place(self):
        def jac(t, y):
            return sparse.csr_matrix([[-1, 1e-9], [0, -1]] if t < 0.3 else [[-1, 0], [1e-9, -1]])

        def f(t, y):
            return [-y[0], -y[1]]

        for method in ("auto", "bdf", "radau:s=3", "cvode", "ida", "arkode"):
            sol = steif.solve(f, (0, 5), [1, 1], jac=jac, jac_sparsity=np.ones((2, 2)), method=method, rtol=1e-8)
            np.testing.assert_allclose(sol.y[:, -1], np.exp(-5), atol=1e-7)
        with self.assertRaisesRegex(ValueError, "row 1, column 0 .* give jac_sparsity"):
            steif.solve(f, (0, 5), [1, 1], jac=jac, method="rodas4p", rtol=1e-8)

    @unittest.skipIf(sparse is None, "no SciPy")
    def test_sparse_jacobians_as_scipy_takes_them(self):
        # u' = L u - u^3 on 20 x 20 points, with a mass matrix 2 I over twice the time, and differences
        m = 20
        line = sparse.diags([1, -2, 1], [-1, 0, 1], shape=(m, m)) * (m + 1) ** 2
        L = (sparse.kron(sparse.identity(m), line) + sparse.kron(line, sparse.identity(m))).tocsc()
        x = np.sin(np.pi * np.arange(1, m + 1) / (m + 1))
        calls = []

        def f(t, u):
            return L @ u - u ** 3

        def jac(t, u):
            calls.append(t)
            return L + sparse.diags(-3 * u ** 2)

        run = dict(rtol=1e-8, method="radau:s=3")
        own = steif.solve(f, (0, 0.1), np.outer(x, x).ravel(), jac=jac, **run)
        self.assertGreater(len(calls), 1)
        for kind in (sparse.csr_matrix, sparse.coo_matrix):
            s = steif.solve(f, (0, 0.1), np.outer(x, x).ravel(), jac=lambda t, u: kind(jac(t, u)), **run)
            np.testing.assert_array_equal(s.y, own.y)
        for more in (dict(jac=jac), dict(jac_sparsity=L)):
            s = steif.solve(f, (0, 0.2), np.outer(x, x).ravel(), mass=2 * sparse.identity(m * m), **more, **run)
            np.testing.assert_allclose(s.y[:, -1], own.y[:, -1], atol=1e-7)
        s = steif.solve(f, (0, 0.1), np.outer(x, x).ravel(), jac_sparsity=L, **run)
        self.assertLess(own.nfev, s.nfev)
        np.testing.assert_allclose(s.y[:, -1], own.y[:, -1], atol=1e-7)

    @unittest.skipIf(sparse is None, "no SciPy")
    def test_entries_that_come_later_need_a_pattern(self):
        def jac(t, y):
            return sparse.csc_matrix([[-1.0, 0], [t, -1]])

        def f(t, y):
            return [-y[0], t * y[0] - y[1]]

        with self.assertRaisesRegex(ValueError, "give jac_sparsity"):
            steif.solve(f, (0, 1), [1, 0], jac=jac, method="radau:s=3")
        s = steif.solve(f, (0, 1), [1, 0], jac=jac, jac_sparsity=np.tril(np.ones((2, 2))), method="radau:s=3",
                        rtol=1e-9)
        np.testing.assert_allclose(s.y[:, -1], [math.exp(-1), math.exp(-1) / 2], rtol=1e-7)


    def test_wrong_shapes_are_named(self):
        f, y0 = lambda t, y: [y[1], -y[0]], [1, 0]
        for wrong, sentence in (
                (lambda: steif.solve(lambda t, y: [1, 2, 3], (0, 1), y0), "f.t, y. returned the shape .3,."),
                (lambda: steif.solve(lambda t, y: 1.0, (0, 1), y0), "2 numbers"),
                (lambda: steif.solve(lambda t, y: [1.0], (0, 1), y0), "2 numbers"),
                (lambda: steif.solve(lambda t, y: None, (0, 1), y0), "returned None"),
                (lambda: steif.solve(f, (0, 1), y0, events=lambda t, y: y), "event 1 returned the shape"),
                (lambda: steif.solve(f, (0, 1), y0, method="bdf", jac=np.eye(3)), "jac returned"),
                (lambda: steif.solve(f, (0, 1), y0, rtol=0), "rtol is 0"),
                (lambda: steif.solve(f, (0, 1), y0, max_step=0), "max_step is 0"),
                (lambda: steif.solve(f, 10, y0), "t_span"),
                (lambda: steif.solve(f, (0, 1)), "y0 .* is missing"),
                (lambda: steif.solve(f, y0=y0), "t_span .* is missing"),
                (lambda: steif.solve("state x = 1\nx' = -x\n\0\n", (0, 1)), "character of value 0")):
            with self.assertRaisesRegex(ValueError, sentence):
                wrong()
        with self.assertRaisesRegex(TypeError, "complex"):
            steif.solve(lambda t, y: [1j, 0], (0, 1), y0)
        self.assertTrue(steif.solve(lambda t, y: -y[0], (0, 1), [1.0]).success)

    def test_named_problems(self):
        s = steif.solve("rober", method="radau:s=3", rtol=1e-8)
        self.assertEqual(s.t[-1], 1e11)
        self.assertAlmostEqual(s.y[0, -1] / 2.0833401497e-8, 1, 5)
        self.assertEqual(steif.solve(lambda t, y: -y, (0, 1), [1]).names, None)
        with self.assertRaisesRegex(steif.SteifError, "did you mean 'rober'"):
            steif.solve("rober1")

    def test_model_file(self):
        path = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "models", "bounce.steif")
        s = steif.solve(path, rtol=1e-9)
        self.assertEqual(s.names, ["h", "v"])
        first, e = math.sqrt(2 / 9.81), 0.8
        known = [first * (1 + 2 * sum(e ** i for i in range(1, k))) for k in range(1, 7)]
        np.testing.assert_allclose(s.t_events[0], known, rtol=1e-8)
        s = steif.solve(path + ":e=0.5", (0, 0.4), rtol=1e-9)
        self.assertAlmostEqual(s.y[0, -1], 1 - 9.81 * 0.4 ** 2 / 2, 8)

    def test_exceptions_come_back(self):
        def bad(t, y):
            if t > 0.5:
                raise KeyError("lost")
            return -y

        with self.assertRaisesRegex(KeyError, "lost"):
            steif.solve(bad, (0, 1), [1.0])
        with self.assertRaises(ValueError):
            steif.solve(lambda t, y: [1, 2, 3], (0, 1), [1.0, 2.0])
        with self.assertRaises(steif.SteifError) as caught:
            steif.solve(lambda t, y: -y, (0, 1), [1.0], method="radua:s=3")
        self.assertIn("radau", str(caught.exception))
        with self.assertRaises(steif.SteifError):
            steif.solve(lambda t, y: -y, (1, 0), [1.0])
        with self.assertRaises(steif.SteifError):
            steif.solve(lambda t, y: -y, (0, 1), [float("nan")])

    def test_a_run_that_stops_says_why(self):
        s = steif.solve(lambda t, y: y ** 2, (0, 2), [1.0])
        self.assertFalse(s.success)
        self.assertLess(s.status, 0)
        self.assertAlmostEqual(s.t[-1], 1, 3)
        self.assertIn("t =", s.message)

    def test_interrupt(self):
        def slow(t, y):
            return [math.cos(1e5 * t)]

        timer = threading.Timer(0.3, signal.raise_signal, (signal.SIGINT,))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            steif.solve(slow, (0, 1000), [0.0], rtol=1e-10, max_steps=10 ** 8)
        timer.join()


if __name__ == "__main__":
    unittest.main()
