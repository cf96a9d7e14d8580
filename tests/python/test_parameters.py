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

    def test_an_event_ends_the_run(self):
        # y = h - g t^2/2 is 0 at sqrt(2 h/g), where v = -sqrt(2 g h) turns to -e v: y and S are those before that.
        h, g = 2, 9.81
        text = ("param h = 2, g = 9.81, e = 0.5\nstate y = h, v = 0\ny' = v\nv' = -g\n"
                "when y < 0:\n v = -e*v\n stop \"landed\"\nend\ntime 0 to 5\n")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "drop.steif")
            with open(path, "w") as file:
                file.write(text)
            s = steif.sensitivity(path, t_eval=[0.2, 0.4, 3.0], method="radau:s=3", rtol=1e-9)
        tau = math.sqrt(2 * h / g)
        self.assertEqual((s.status, s.S.shape), (1, (3, 2, 3)))
        self.assertIn("landed", s.message)
        np.testing.assert_allclose(s.t, [0.2, 0.4, tau], rtol=1e-10)
        self.assertAlmostEqual(s.t_event, tau, 10)
        np.testing.assert_allclose(s.dt_event, [tau / (2 * h), -tau / (2 * g), 0], rtol=1e-8, atol=1e-12)
        np.testing.assert_allclose(s.y[1, -1], -g * tau, rtol=1e-9)
        np.testing.assert_allclose(s.S[:, 1, -1], [0, -tau, 0], rtol=1e-8, atol=1e-10)
        np.testing.assert_allclose(s.S_event[:, 1], [-g * tau / (2 * h), -tau / 2, 0], rtol=1e-8, atol=1e-10)

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

    def test_covariances_and_intervals(self):
        data = second(self.t, 0.9, 0.25) + 0.01 * np.cos(7 * self.t)
        for sd in (0.01, None):
            r = steif.fit(chain, self.t, {1: data}, p=[0.3, 0.1], y0=[1, 0], sd=sd)
            self.assertEqual((r.log, r.known_sd), (True, sd is not None))
            np.testing.assert_allclose(np.sqrt(np.diag(r.covariance)), r.sd, rtol=1e-12)
            np.testing.assert_allclose(r.covariance, np.outer(r.p, r.p) * r.covariance_theta, rtol=1e-12)
            quantile = np.log(r.high / r.p) / np.sqrt(np.diag(r.covariance_theta))
            np.testing.assert_allclose(quantile, 1.959964 if sd else 2.364624, rtol=1e-6)  # t of 7
            self.assertEqual(math.isnan(r.probability), sd is None)

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
        with self.assertRaisesRegex(ValueError, "no parameter 'q'"):
            steif.fit(chain, self.t, data, p=[1, 2], y0=[1, 0], bounds={"q": (0, 1)})
        with self.assertRaisesRegex(ValueError, "bounds of m, which is not fitted"):
            steif.fit(chain, self.t, data, p=[1, 2], y0=[1, 0], by=["k"], bounds={"m": (0, 1)})
        with self.assertRaisesRegex(ValueError, "low, high"):
            steif.fit(chain, self.t, data, p=[1, 2], y0=[1, 0], bounds={"m": 3})
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

    def test_multipliers_are_recomputed(self):
        # The tension at 2 by the equation of the angle; radau:s=3 itself has two digits of it, sweep and solve show it
        # recomputed from the position.
        path, truth = os.path.join(MODELS, "pendulum.steif"), 17.9076820729608
        swept = steif.sweep(path, {"g": [9.81]}, method="radau:s=3")
        steps, at = (steif.solve(path, method="radau:s=3", t_eval=times) for times in (None, [1.0, 2.0]))
        for found in (swept.y[:, 0], steps.y[:, -1], at.y[:, -1]):
            self.assertLess(abs(found[swept.names.index("tension")] - truth), 1e-5)
        np.testing.assert_array_equal(swept.y[:, 0], steps.y[:, -1])

    def test_threads_are_whole(self):
        for wrong in (2.7, True, "2"):
            with self.assertRaisesRegex(ValueError, "threads is .* whole number"):
                steif.sweep("rober", {"k1": [0.04]}, t1=1, threads=wrong)
        self.assertEqual(steif.sweep("rober", {"k1": [0.04]}, t1=1, threads=np.int64(2)).status[0], 0)

    def test_what_fails_is_told(self):
        r = steif.sweep("rober", {"k1": [0.04, math.nan]}, t1=1)
        self.assertEqual(r.status[0], 0)
        self.assertLess(r.status[1], 0)
        self.assertTrue(np.isnan(r.y[:, 1]).all() and np.isfinite(r.y[:, 0]).all())
        with self.assertRaisesRegex(ValueError, "same for all"):
            steif.sweep("rober", {"k1": [1, 2], "k2": [1]})

    def test_what_cannot_run_is_told_before(self):
        for wrong, sentence in ((lambda: steif.sweep("rober", {"K1": [1.0]}, t1=1), "did you mean 'k1'"),
                                (lambda: steif.sweep("rober", {"K1": [math.nan]}, t1=1), "did you mean 'k1'"),
                                (lambda: steif.sweep(chain, {"k": [1]}), "name of a problem"),
                                (lambda: steif.sweep("rober", [1, 2]), "must be a dict"),
                                (lambda: steif.sweep("rober", {"k1": [1]}, t1=-1), "after the start"),
                                (lambda: steif.sweep("heat", {"n": [10, 20]}, t1=0.1), "10 unknowns and .* 400"),
                                (lambda: steif.sensitivity("rober", (0, 1), by="K1"), "did you mean 'k1'"),
                                (lambda: steif.sensitivity("rober", (0, 1), p={"K1": 1}), "did you mean 'k1'"),
                                (lambda: steif.sensitivity("rober", (0, 1), p=[1]), "must be a dict"),
                                (lambda: steif.sensitivity("rober", (0, 1), by=-1), "number from 0 to 2"),
                                (lambda: steif.sensitivity("rober", (0, 0)), "interval"),
                                (lambda: steif.fit("rober", [1, 2], {"y1": [1, 1]}, p={"K1": 1}), "did you mean 'k1'"),
                                (lambda: steif.fit("rober", [1, 2], {"Y1": [1, 1]}), "did you mean 'y1'"),
                                (lambda: steif.fit(chain, [1], {0: [1]}, p=[1, 2], y0=[1, 0], sd={1: 1}), "sd has nothing"),
                                (lambda: steif.fit(chain, [1, 2], {0: [1, 2]}, p=[1, 2], y0=[1, 0], sd=[1, 2, 3]),
                                 "sd has the shape"),
                                (lambda: steif.fit(chain, [-1, 2], {0: [1, 2]}, p=[1, 2], y0=[1, 0]), "give t_span"),
                                (lambda: steif.sensitivity(chain, (0, 1), [1, 0], p=[]), "p is empty"),
                                (lambda: steif.fit(chain, [1, 2], {0: [1, math.inf]}, p=[1, 2], y0=[1, 0]), "infinite"),
                                (lambda: steif.fit("rober", None, {"y1": [1, 1]}), "t is missing")):
            with self.assertRaisesRegex(ValueError, sentence):
                wrong()
        with self.assertRaisesRegex(steif.SteifError, "did you mean 'radau'"):
            steif.sweep("rober", {"k1": [0.04]}, t1=1, method="radua")
        r = steif.sweep("rober", {"k1": [0.04, math.nan]}, t1=1)
        self.assertEqual(r.messages[0], "")
        self.assertIn("k1", r.messages[1])


if __name__ == "__main__":
    unittest.main()
