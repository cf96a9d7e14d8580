"""Derivatives by parameters, fits and sweeps from Python, against closed forms."""
import math
import os
import tempfile
import unittest

import numpy as np
import steif

MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "models")


def chain(t, y, k, m):
    return [-k * y[0], k * y[0] - m * y[1]]


def second(t, k, m):
    return k / (m - k) * (np.exp(-k * t) - np.exp(-m * t))


class Sensitivity(unittest.TestCase):
    def test_closed_form_of_a_callback(self):
        t, k = np.linspace(0.25, 2, 8), 1.7
        s = steif.sensitivity(lambda t, y, k: -k * y, (0, 2), [3.0], p=[k], t_eval=t, rtol=1e-9)
        self.assertEqual(s.S.shape, (1, 1, 8))
        self.assertEqual(s.names, ["k"])
        np.testing.assert_allclose(s.y[0], 3 * np.exp(-k * t), rtol=1e-7)
        np.testing.assert_allclose(s.S[0, 0], -3 * t * np.exp(-k * t), rtol=1e-6)

    def test_a_model_by_one_of_its_parameters(self):
        path = os.path.join(MODELS, "lotka.steif")
        s = steif.sensitivity(path, (0, 2), p={"p1": 1.5}, by="p3", rtol=1e-9)
        self.assertEqual((s.names, s.S.shape), (["p3"], (1, 2, 1)))
        d = 1e-4
        ends = [steif.sensitivity(path, (0, 2), p={"p1": 1.5, "p3": 2.8 + e}, rtol=1e-11).y[:, -1]
                for e in (-d, d)]
        np.testing.assert_allclose(s.S[0, :, -1], (ends[1] - ends[0]) / (2 * d), rtol=1e-5)

    def test_bad_requests(self):
        with self.assertRaisesRegex(ValueError, "no parameter 'q'"):
            steif.sensitivity(chain, (0, 1), [1, 0], p=[1, 2], by="q")
        with self.assertRaisesRegex(ValueError, "p of f"):
            steif.sensitivity(chain, (0, 1), [1, 0])
        with self.assertRaisesRegex(steif.SteifError, "rodas4"):
            steif.sensitivity(chain, (0, 1), [1, 0], p=[1, 2], method="rodas4")
        with self.assertRaises(ZeroDivisionError):
            steif.sensitivity(lambda t, y, k: 1 / 0, (0, 1), [1], p=[1])


class Fit(unittest.TestCase):
    t = np.arange(1.0, 10)

    def test_exact_data_give_the_parameters(self):
        for by, p in ((None, [0.3, 0.1]), (["m"], [0.9, 0.1])):
            r = steif.fit(chain, self.t, {1: second(self.t, 0.9, 0.25)}, p=p, y0=[1, 0], by=by, sd=0.01)
            self.assertTrue(r.success)
            np.testing.assert_allclose(r.p, [0.9, 0.25] if by is None else [0.25], rtol=1e-6)
            self.assertEqual(r.dof, 9 - len(r.p))
            self.assertLess(r.chi2, 1e-6)

    def test_errors_of_a_known_size(self):
        # y' = -k y, log of y is linear in k: sd(k) from J = -t exp(-k t) at the minimum
        k, sd, t = 0.7, 1e-3, np.linspace(0.5, 4, 8)
        data = np.exp(-k * t) + sd * np.array([1, -1, 1, 1, -1, 1, -1, -1])
        r = steif.fit(lambda t, y, k: -k * y, t, [data], p=[0.2], y0=[1.0], sd=sd, scale="linear")
        found = r.p[0]
        expected = sd / math.sqrt(np.sum((t * np.exp(-found * t)) ** 2))
        self.assertAlmostEqual(r.sd[0] / expected, 1, 5)
        self.assertLess(r.low[0], k)
        self.assertGreater(r.high[0], k)
        slope = np.sum((np.exp(-found * t) - data) * t * np.exp(-found * t))
        self.assertLess(abs(slope), 1e-8)

    def test_an_output_is_measured(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "gain.steif")
            with open(path, "w") as file:
                file.write("param k = 1, gain = 2\nstate x = 1\nx' = -k*x\noutput signal = gain*x^2\n")
            t = np.linspace(0, 2, 9)
            r = steif.fit(path, t, {"signal": 1.7 * np.exp(-2.6 * t)}, sd=0.01)
        np.testing.assert_allclose(r.p, [1.3, 1.7], rtol=1e-6)

    def test_a_model_and_a_file(self):
        r = steif.fit(os.path.join(MODELS, "lotka.steif"), None, os.path.join(MODELS, "lotka.csv"), sd=0.05)
        self.assertEqual(r.names, ["p1", "p2", "p3", "p4"])
        for low, truth, high in zip(r.low, (1.5, 1, 3, 1), r.high):  # as the file says
            self.assertTrue(low < truth < high)

    def test_a_model_that_names_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "decay.steif")
            with open(path, "w") as file:
                file.write("param k = 1, gain = 2\nstate x = 1\nx' = -k*x\ntime 0 to 2\n"
                           'data "decay.csv", signal = gain*x sd 0.01\nfit k\n')
            with open(os.path.join(folder, "decay.csv"), "w") as file:
                file.write("t,signal\n" + "".join("%g,%.15g\n" % (t, 2 * np.exp(-1.3 * t)) for t in (0.5, 1, 2)))
            r = steif.fit(path)
        self.assertEqual(r.names, ["k"])
        np.testing.assert_allclose(r.p, [1.3], rtol=1e-6)
        with self.assertRaisesRegex(ValueError, "only a model names its own"):
            steif.fit(chain, p=[1, 2], y0=[1, 0])

    def test_missing_values_bounds_and_bad_requests(self):
        data = np.array([np.full(9, np.nan), second(self.t, 0.9, 0.25)])
        r = steif.fit(chain, self.t, data, p=[0.3, 0.2], y0=[1, 0], sd=0.01, bounds={"m": (None, 0.24)})
        self.assertAlmostEqual(r.p[1], 0.24, 12)
        with self.assertRaisesRegex(ValueError, "9 values"):
            steif.fit(chain, self.t, {1: [1, 2]}, p=[1, 2], y0=[1, 0])
        with self.assertRaisesRegex(ValueError, "not fitted"):
            steif.fit(chain, self.t, data, p=[1, 2], y0=[1, 0], bounds={"q": (0, 1)})
        with self.assertRaisesRegex(ValueError, "no unknown 'z'"):
            steif.fit(chain, self.t, {"z": self.t}, p=[1, 2], y0=[1, 0])


class Sweep(unittest.TestCase):
    def test_members_are_the_runs_one_by_one(self):
        path = os.path.join(MODELS, "lotka.steif")
        values = {"p1": [1.4, 1.5, 1.6, 1.7], "p3": [3.0, 2.9, 2.8, 2.7]}
        r = steif.sweep(path, values, t1=2, method="radau:s=3", threads=2)
        self.assertEqual((r.y.shape, list(r.status)), ((2, 4), [0] * 4))
        for i in range(4):
            s = steif.solve("%s:p1=%r,p3=%r" % (path, values["p1"][i], values["p3"][i]), (0, 2),
                            method="radau:s=3")
            np.testing.assert_array_equal(r.y[:, i], s.y[:, -1])

    def test_what_fails_is_told(self):
        r = steif.sweep("rober", {"k1": [0.04, math.nan]}, t1=1)
        self.assertEqual(r.status[0], 0)
        self.assertLess(r.status[1], 0)
        self.assertTrue(np.isnan(r.y[:, 1]).all() and np.isfinite(r.y[:, 0]).all())
        with self.assertRaisesRegex(ValueError, "same for all"):
            steif.sweep("rober", {"k1": [1, 2], "k2": [1]})
        r = steif.sweep("rober", {"q": [1.0]}, t1=1)
        self.assertLess(r.status[0], 0)


if __name__ == "__main__":
    unittest.main()
