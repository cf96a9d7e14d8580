"""Jumps, impulses, weak convergence and time grids from Python, against closed forms and SciPy."""
import math
import unittest

import numpy as np
import steif

try:
    import scipy.linalg
    import scipy.signal
    import scipy.sparse
except ImportError:
    scipy = None

# Two capacitors of 2 and 3 uF, charged to 5 and 1 V, joined by a wire: x = (v1, v2, i).
E = np.diag([2e-6, 3e-6, 0])
F = np.array([[0, 0, 1], [0, 0, -1], [1, -1, 0.0]])


def nilpotent(k):
    return np.diag(np.ones(k - 1), 1), np.eye(k)


class Impulse(unittest.TestCase):
    def test_charge_is_kept(self):
        r = steif.impulse(E, F, [5, 1, 0])
        np.testing.assert_allclose(r.x_plus, [2.6, 2.6, 0], rtol=1e-14)
        self.assertEqual(r.impulses.shape, (1, 3))
        np.testing.assert_allclose(r.impulses[0], [0, 0, 2e-6 * (5 - 2.6)], rtol=1e-12, atol=1e-20)
        self.assertEqual((r.index, r.finite, r.infinite, r.certified), (2, 1, 2, True))
        self.assertIn("certified", r.message)
        np.testing.assert_array_equal(r.x_minus, [5, 1, 0])

    def test_forcings_of_every_kind_agree(self):
        # N x' + x = f: x = sum (-1)^i N^i f^(i), c_i = (-1)^i N^(i+1) (x(0-) - x(0+))
        N, one = nilpotent(3)
        x0, t = np.array([1.0, 2.0, 4.0]), 0.3
        f = [lambda t: np.array([math.sin(t), math.cos(t), math.exp(2 * t)]),
             lambda t: np.array([math.cos(t), -math.sin(t), 2 * math.exp(2 * t)]),
             lambda t: np.array([-math.sin(t), -math.cos(t), 4 * math.exp(2 * t)])]
        plus = f[0](t) - N @ f[1](t) + N @ N @ f[2](t)
        known = [N @ (x0 - plus), -N @ N @ (x0 - plus)]
        for forcing in ("sin(t); cos(t); exp(2*t)", lambda t, order: f[order](t)):
            r = steif.impulse(N, one, x0, forcing, t=t)
            np.testing.assert_allclose(r.x_plus, plus, rtol=1e-13)
            np.testing.assert_allclose(r.impulses, known, rtol=1e-13)
        r = steif.impulse(N, one, x0, [7, 8, 9])
        np.testing.assert_allclose(r.x_plus, [7, 8, 9], rtol=1e-13)

    @unittest.skipIf(scipy is None, "no SciPy")
    def test_sparse_matrices_of_every_format(self):
        dense = steif.impulse(E, F, [5, 1, 0])
        for kind in ("csc_matrix", "csr_matrix", "coo_matrix", "csc_array", "lil_matrix", "dia_matrix"):
            make = getattr(scipy.sparse, kind)
            r = steif.impulse(make(E), make(F), [5, 1, 0])
            np.testing.assert_allclose(r.x_plus, dense.x_plus, rtol=1e-13)
            np.testing.assert_allclose(r.impulses, dense.impulses, rtol=1e-12, atol=1e-18)
        r = steif.impulse(E, scipy.sparse.csc_matrix(F), [5, 1, 0])  # one of each
        np.testing.assert_allclose(r.x_plus, dense.x_plus, rtol=1e-13)
        # a large one: chains of length 2 beside an ordinary part, doubled entries in COO form
        n = 600
        at = np.arange(n)
        large = scipy.sparse.coo_matrix((np.full(2 * n, 0.5), (np.r_[at, at], np.r_[at, at])))
        first = scipy.sparse.diags([np.where(at % 3 == 0, 1.0, 0), np.where(at % 3 == 1, 1.0, 0)[:-1]],
                                   [0, 1])
        r = steif.impulse(first, large, np.ones(n))
        self.assertEqual(r.index, 2)
        np.testing.assert_allclose(r.x_plus, at % 3 == 0, atol=1e-12)
        np.testing.assert_allclose(r.impulses[0], at % 3 == 1, atol=1e-12)

    def test_models_and_problems_by_name(self):
        # v = 4/(1 + C), and the impulse of i is the charge C v that the second capacitor takes.
        text = "param C = 3\nstate v1 = 4, v2 = 0, i = 0\nv1' = -i\nC*v2' = i\n0 = v1 - v2\n"
        r = steif.impulse(text)
        np.testing.assert_allclose(r.x_plus, [1, 1, 0], atol=1e-12)
        np.testing.assert_allclose(r.impulses, [[0, 0, 3]], atol=1e-12)
        r = steif.impulse(text, x0=[2, 2, 5], p={"C": 1}, t=7)
        np.testing.assert_allclose(r.x_plus, [2, 2, 0], atol=1e-12)
        self.assertEqual((r.index, r.certified), (2, True))
        r = steif.impulse("switchrlc")  # charge: (2*5 + 3*1)/5
        np.testing.assert_allclose(r.x_plus[:2], [2.6, 2.6], rtol=1e-12)
        for wrong, words in ((("rober",), "form ode"), (("switchrlc", np.eye(5)), "its own F"),
                             ((np.eye(2),), "E and F are needed"), ((np.eye(2), np.eye(2)), "x0 is needed"),
                             (("state x = 1",), "a line for each statement")):
            with self.assertRaisesRegex((ValueError, steif.SteifError), words):
                steif.impulse(*wrong)
        with self.assertRaisesRegex(ValueError, "p belongs to models"):
            steif.impulse(np.eye(2), np.eye(2), [1, 1], p={"C": 1})

    def test_failures_say_why(self):
        with self.assertRaisesRegex(steif.SteifError, "singular"):
            steif.impulse(np.zeros((2, 2)), np.zeros((2, 2)), [1, 1])
        with self.assertRaisesRegex(ValueError, "one size"):
            steif.impulse(np.eye(2), np.eye(3), [1, 1])
        with self.assertRaisesRegex(ValueError, "3 values, 2 are needed"):
            steif.impulse(np.eye(2), np.eye(2), [1, 1, 1])
        with self.assertRaises(steif.SteifError):
            steif.impulse(np.eye(2), np.eye(2), [1, float("nan")])
        with self.assertRaises(steif.SteifError):
            steif.impulse([[float("nan"), 0], [0, 1]], np.eye(2), [1, 1])
        with self.assertRaises(steif.SteifError):
            steif.impulse(np.eye(2), np.eye(2), [1, 1], "sin(t)")  # one expression too few
        N, one = nilpotent(2)
        with self.assertRaises(steif.SteifError):  # the derivative is needed and unknown
            steif.impulse(N, one, [1, 1], lambda t, order: None if order else [1, 1])
        with self.assertRaisesRegex(KeyError, "lost"):
            def bad(t, order):
                raise KeyError("lost")
            steif.impulse(N, one, [1, 1], bad)
        with self.assertRaisesRegex(ValueError, "algorithm"):
            steif.impulse(E, F, [5, 1, 0], algorithm="schur")


class Weak(unittest.TestCase):
    def test_jordan_block_of_the_collection(self):
        # S. L. Campbell (1988): backward Euler converges weakly, of order 1. The weak order at index k is the
        # pointwise order of the adjoint method at index k - 1: Gauss's of two stages has 0 at index 2
        r = steif.weak("be", "jordan:k=3,case=H-inc")
        self.assertIs(r.converges, True)
        self.assertEqual((r.index, r.convention), (3, "R"))
        self.assertAlmostEqual(r.order[-1], 1, 1)
        np.testing.assert_allclose(r.value - r.exact, r.error, rtol=1e-12)
        r = steif.weak("gauss:s=2", "jordan:k=3,case=H-inc")
        self.assertIs(r.converges, False)
        self.assertEqual(r.convention, "stage")

    def test_own_matrices(self):
        # the same block from matrices: <c_i delta^(i), g> = (-1)^i g^(i)(0) c_i, g = (1 - t)^8
        N, one = nilpotent(3)
        x0 = np.array([1.0, 2.0, 4.0])
        r = steif.weak("radau:s=2", N, one, x0)
        c0, c1 = N @ x0, -N @ N @ x0
        np.testing.assert_allclose(r.exact, c0 + 8 * c1, rtol=1e-12)
        self.assertIs(r.converges, True)
        self.assertEqual(r.value.shape, (5, 3))
        one_only = steif.weak("radau:s=2", N, one, x0, component=1, halvings=3)
        np.testing.assert_allclose(one_only.value, r.value[:4, 1], rtol=1e-12)
        self.assertEqual(one_only.h.size, 4)

    def test_breaks_of_a_text_are_its_own(self):
        # x' + x = step(t - 1/2) from 0: the text declares the break, a function needs to be told
        args = np.eye(1), np.eye(1), [0.0]
        a = steif.weak("radau:s=2", *args, "step(t - 0.5)", h=1 / 32)
        b = steif.weak("radau:s=2", *args, lambda t, k: [float(t >= 0.5) if k == 0 else 0.0], h=1 / 32,
                       breaks=[0.5])
        self.assertIs(a.converges, True)
        np.testing.assert_allclose(a.exact, b.exact, rtol=1e-9)

    def test_wrong_calls(self):
        with self.assertRaisesRegex(steif.SteifError, "radau"):
            steif.weak("radua:s=2", "jordan:k=3,case=H-inc")
        with self.assertRaisesRegex(ValueError, "E, F and x0"):
            steif.weak("be", np.eye(2))
        with self.assertRaisesRegex(ValueError, "convention"):
            steif.weak("be", "jordan:k=3,case=H-inc", convention="S")
        with self.assertRaisesRegex(ValueError, "halvings"):
            steif.weak("be", "jordan:k=3,case=H-inc", halvings=1)
        with self.assertRaises(steif.SteifError):
            steif.weak("be", "rober")


class TimeGrids(unittest.TestCase):
    A, B, C, D = [[0, 1], [-4, -0.5]], [[0], [1.0]], [[1, 0.0]], [[0.25]]

    @unittest.skipIf(scipy is None, "no SciPy")
    def test_schemes_of_scipy(self):
        for ours, theirs in (("zoh", "zoh"), ("foh", "foh"), ("bilinear", "bilinear"),
                             ("backward", "backward_diff"), ("forward", "euler"), ("impulse", "impulse")):
            D = [[0.0]] if ours == "impulse" else self.D  # SciPy refuses another
            r = steif.c2d(self.A, self.B, self.C, D, dt=0.1, scheme=ours)
            s = scipy.signal.cont2discrete((np.array(self.A), np.array(self.B), np.array(self.C),
                                            np.array(D)), 0.1, theirs)
            z = np.exp(1j * np.array([0.0, 0.3, 1.1, 2.9]))
            H = [[(M[2] @ np.linalg.solve(x * np.eye(2) - M[0], M[1]) + M[3])[0, 0] for x in z]
                 for M in ((r.A, r.B, r.C, r.D), s[:4])]
            np.testing.assert_allclose(H[0], H[1], rtol=1e-9, atol=1e-12, err_msg=ours)
            np.testing.assert_allclose(sorted(r.eigenvalues), sorted(np.linalg.eigvals(r.A)), rtol=1e-10)

    def test_weights_and_vectors(self):
        r = steif.c2d(self.A, [0, 1.0], dt=0.1, scheme="foh")
        # a ramp is followed exactly: the weights sum to phi_1, and B1 to phi_2
        np.testing.assert_allclose(r.B0 + r.B1, steif.c2d(self.A, self.B, dt=0.1).B, rtol=1e-13)
        self.assertEqual((r.B.shape, r.C.shape, r.D.shape), ((2, 1), (0, 2), (0, 1)))
        r = steif.c2d(self.A, dt=0.1)
        self.assertEqual(r.B.shape, (2, 0))

    def test_singular_E(self):
        # x1' = -x1 + u, 0 = x2 - x1 - u: y = x has D = (0, 1); the finite part is x1
        r = steif.c2d([[-1, 0], [-1, 1.0]], [[1], [-1.0]], dt=0.2, E=np.diag([1, 0]))
        self.assertEqual((r.index, r.polynomial, r.A.shape), (1, [], (1, 1)))
        self.assertAlmostEqual(r.A[0, 0], math.exp(-0.2), 13)
        steady = r.C @ np.linalg.solve(np.eye(1) - r.A, r.B) + r.D
        np.testing.assert_allclose(steady, [[1], [2]], rtol=1e-12)
        # index 2: x2 = u, x1 = -u' from N x' + x = B u; no finite part at all
        N, one = nilpotent(2)
        with self.assertRaisesRegex(steif.SteifError, "finite part"):
            steif.c2d(-one, [[0], [1.0]], dt=0.2, E=N)
        three = np.zeros((3, 3))
        three[:2, :2], three[2, 2] = N, 1
        r = steif.c2d(-np.eye(3), [[0], [1.0], [1.0]], dt=0.2, E=three)
        self.assertEqual(r.index, 2)
        np.testing.assert_allclose(r.polynomial[0], [[-1], [0], [0]], atol=1e-14)
        np.testing.assert_allclose(r.D, [[0], [1], [0]], atol=1e-14)

    @unittest.skipIf(scipy is None, "no SciPy")
    def test_sparse(self):
        S = scipy.sparse.csr_matrix(self.A)
        np.testing.assert_array_equal(steif.c2d(S, self.B, dt=0.1).A, steif.c2d(self.A, self.B, dt=0.1).A)

    def test_wrong_calls(self):
        with self.assertRaisesRegex(ValueError, "D needs C"):
            steif.c2d(self.A, self.B, None, self.D, dt=0.1)
        with self.assertRaisesRegex(ValueError, "shape"):
            steif.c2d(self.A, [1, 2, 3.0], dt=0.1)
        with self.assertRaisesRegex(steif.SteifError, "zoh|scheme"):
            steif.c2d(self.A, self.B, dt=0.1, scheme="zog")
        for dt in (0, -1, float("nan")):
            with self.assertRaises(steif.SteifError):
                steif.c2d(self.A, self.B, dt=dt)


if __name__ == "__main__":
    unittest.main()
