"""Outputs of models, starts that are moved, parameters of named problems: what Results tell beside t and y."""
import copy
import os
import pathlib
import pickle
import tempfile
import unittest

import numpy as np
import steif

DECAY = """param k = 1, x0 = 2
state x = x0
x' = -k*x
output square = x^2 {m^2}, late = t*x
time 0 to 2
"""
# a valve opens at h = 1 and closes at h = 0.5: up for 1, down for 0.5 by turns
TANK = """state h = 0
discrete open = 0
h' = 1 - 2*open
when h > 1: open = 1
when h < 0.5: open = 0
output valve = open, twice = 2*h
time 0 to 3
"""


def valve(t):
    """Open from 1 to 1.5, 2 to 2.5, 3 to ..."""
    return (t >= 1) & ((2 * t) % 2 < 1)


class Outputs(unittest.TestCase):
    def test_values_at_the_times_of_the_result(self):
        for given in ({}, {"t_eval": [0, 0.5, 2]}, {"dense_output": True}, {"t_eval": [0.25], "dense_output": True}):
            s = steif.solve(DECAY, rtol=1e-9, **given)
            self.assertEqual(list(s.outputs), ["square", "late"])
            np.testing.assert_array_equal(s.outputs["square"], s.y[0] ** 2)
            np.testing.assert_array_equal(s.outputs["late"], s.t * s.y[0])
            np.testing.assert_allclose(s.outputs["late"], 2 * s.t * np.exp(-s.t), rtol=1e-7)
            if given.get("dense_output"):
                t = np.linspace(0, 2, 7)
                np.testing.assert_allclose(s.sol.outputs(t)["late"], 2 * t * np.exp(-t), rtol=1e-7, atol=1e-9)
                self.assertAlmostEqual(s.sol.outputs(1.0)["square"], 4 * np.exp(-2), 7)
                self.assertEqual(s.sol(t[:6].reshape(2, 3)).shape, (1, 2, 3))
                np.testing.assert_array_equal(s.sol.outputs(t[:6].reshape(2, 3))["late"].ravel(),
                                              s.sol.outputs(t)["late"][:6])
                with self.assertRaisesRegex(ValueError, "outside"):
                    s.sol.outputs(2.5)
        s = steif.solve(lambda t, y: -y, (0, 1), [1], dense_output=True)
        self.assertEqual(s.outputs, {})
        with self.assertRaisesRegex(ValueError, "only models"):
            s.sol.outputs(0.5)

    def test_a_jump_by_an_impulse_is_told(self):
        # Charge is kept: 1 * 4 = (1 + 3) v.
        text = ("state v1 = 4, v2 = 0, i = 0\ndiscrete on = 0\nv1' = -i\n3*v2' = i\n"
                "0 = if on > 0.5 then v1 - v2 else i\nat 1: on = 1\ntime 0 to 2\n")
        s = steif.solve(text, method="bdf", rtol=1e-8, dense_output=True)
        self.assertTrue(s.success and "jumped at t = 1: " in s.message, s.message)
        np.testing.assert_allclose(s.sol([0.999, 1, 1.5]), [[4, 1, 1], [0, 1, 1], [0, 0, 0]], atol=1e-6)

    def test_what_events_change_is_that_of_the_time(self):
        # the events are within 4 rounding errors of 1, 1.5, ...
        for method in ("auto", "radau:s=3", "bdf", "cvode"):
            t = np.array([0, 0.5, 0.999, 1.001, 1.499, 1.501, 1.75, 2.001, 2.25, 2.75])
            s = steif.solve(TANK, method=method, t_eval=t, dense_output=True, rtol=1e-9)
            np.testing.assert_array_equal(s.outputs["valve"], valve(t))
            np.testing.assert_array_equal(s.outputs["twice"], 2 * s.y[0])
            for order in (t, t[::-1], t[[5, 1, 7, 2]]):
                np.testing.assert_array_equal(s.sol.outputs(order)["valve"], valve(order))
            s = steif.solve(TANK, method=method, rtol=1e-9)
            inside = np.min(np.abs(s.t[:, None] - [1, 1.5, 2, 2.5, 3]), axis=1) > 1e-9
            np.testing.assert_array_equal(s.outputs["valve"][inside], valve(s.t[inside]))
            at = np.flatnonzero(np.abs(s.t - 1) < 1e-9)  # both sides of the first event
            np.testing.assert_array_equal(s.outputs["valve"][at[-2:]], [0, 1])

    def test_times_before_an_event_within_a_step(self):
        # x' = -k x with k = 1 until 0.5, then 2: by dense output that evaluates f, which the event has changed
        text = ("state x = 1\ndiscrete k = 1\nx' = -k*x\nwhen t > 0.5: k = 2\ntime 0 to 1\n", "output rate = k*x\n")
        t = np.linspace(0, 1, 12)
        k, exact = np.where(t > 0.5, 2, 1), np.exp(-np.where(t > 0.5, 2 * t - 0.5, t))
        for method in ("dopri87", "radau:s=3", "bdf", "rodas5p", "cvode"):
            for more in ({}, {"dense_output": True}):
                s = steif.solve("".join(text), method=method, t_eval=t, rtol=1e-9, **more)
                np.testing.assert_allclose(s.y[0], exact, rtol=1e-6)
                np.testing.assert_allclose(s.outputs["rate"], k * exact, rtol=1e-6)
            np.testing.assert_array_equal(steif.solve(text[0], method=method, t_eval=t, rtol=1e-9).y, s.y)

    def test_a_record_outlives_its_run(self):
        s = steif.solve(DECAY, dense_output=True)
        for other in (copy.copy(s), copy.deepcopy(s)):
            sol = other.sol
            del other
            self.assertAlmostEqual(sol(1.0)[0], s.sol(1.0)[0], 14)
        del s
        self.assertAlmostEqual(sol.outputs(1.0)["late"], sol(1.0)[0], 14)
        with self.assertRaisesRegex(TypeError, "evaluate it"):
            pickle.dumps(sol)
        kept = pickle.loads(pickle.dumps(steif.solve(DECAY)))
        np.testing.assert_array_equal(kept.outputs["square"], kept.y[0] ** 2)

    def test_parameters_and_paths(self):
        s = steif.solve(DECAY, (0, 1), p={"k": 3, "x0": 5}, rtol=1e-9)
        self.assertAlmostEqual(s.y[0, -1], 5 * np.exp(-3), 7)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a folder" / "\u00fcber" / "decay.steif"
            path.parent.mkdir(parents=True)
            path.write_text(DECAY)
            for name in (path, str(path), os.fsencode(path)):
                np.testing.assert_array_equal(steif.solve(name, (0, 1), p={"k": 3, "x0": 5}, rtol=1e-9).y, s.y)
        for p, sentence in (({"K": 1}, "nearest is 'k'"), ([1], "must be a dict"), ({"k": np.nan}, "finite"),
                            ({"k": [1, 2]}, "one finite number")):
            with self.assertRaisesRegex(ValueError, sentence):
                steif.solve(DECAY, p=p)
        with self.assertRaisesRegex(TypeError, "parameter k is a str"):
            steif.solve(DECAY, p={"k": "1"})
        with self.assertRaisesRegex(ValueError, r"args=\(a, b\)"):
            steif.solve(lambda t, y, k: -k * y, (0, 1), [1], p={"k": 1})
        with self.assertRaisesRegex(ValueError, "says no end"):
            steif.solve("state x = 1\nx' = -x\n")
        with self.assertRaisesRegex(steif.SteifError, "model:2:"):
            steif.solve("state x = 1\nx' = 2y\n")


class Starts(unittest.TestCase):
    def test_a_start_that_was_moved(self):
        # x' = z, 0 = z^2 - x from x = 1: z is 1, given as 1.5
        s = steif.solve(lambda t, y: [y[1], y[1] ** 2 - y[0]], (0, 1), [1, 1.5], mass=[[1, 0], [0, 0]], rtol=1e-8)
        self.assertEqual(list(s.moved), [1])
        self.assertEqual(s.moved[1][0], 1.5)
        self.assertAlmostEqual(s.moved[1][1], 1, 7)
        self.assertEqual(s.moved[1][1], s.y[1, 0])
        self.assertRegex(s.notes[0], "start: moved .* by -0.5")
        self.assertTrue(s.message.startswith("ok; start: moved"))
        s = steif.solve(lambda t, y: [y[1], y[1] ** 2 - y[0]], (0, 1), [1, 1], mass=[[1, 0], [0, 0]], rtol=1e-8)
        self.assertEqual((s.moved, s.notes, s.message), ({}, [], "ok"))

    def test_names_of_a_model(self):
        text = "state x = 1, z ~ 1.5\nx' = z\n0 = z^2 - x\ntime 0 to 1\n"  # a guess, which reading replaces
        s = steif.solve(text, rtol=1e-8)
        self.assertEqual(s.moved, {})
        self.assertRegex(s.notes[0], "z from 1.5 to 1")
        self.assertIn(s.notes[0], s.message)
        self.assertAlmostEqual(s.y[1, 0], 1, 7)
        s = steif.solve(text.replace("z ~ 1.5", "z ~ 1"), rtol=1e-8)
        self.assertEqual(s.notes, [])

    def test_a_linear_system_that_jumps(self):
        # x = sin t, y = x' = cos t: from (2, 0) to (0, 1), with an impulse
        s = steif.solve("state x = 2, y = 0\nx' = y\n0 = x - sin(t)\ntime 0 to 1\n", rtol=1e-8)
        self.assertEqual(s.moved, {"x": (2, 0), "y": (0, 1)})
        self.assertRegex(" ".join(s.notes), "x from 2 to 0")
        np.testing.assert_allclose(s.y[:, -1], [np.sin(1), np.cos(1)], atol=1e-7)

    def test_an_interval_of_no_length(self):
        def f(t, y):
            return [y[1], y[1] ** 2 - y[0]]

        for t0 in (0, -2, 1e9):
            s = steif.solve(f, (t0, t0), [1, 1.5], mass=[[1, 0], [0, 0]], rtol=1e-8, dense_output=True)
            self.assertTrue(s.success)
            np.testing.assert_array_equal(s.t, [t0])
            np.testing.assert_allclose(s.y, [[1], [1]], rtol=1e-7)
            np.testing.assert_array_equal(s.sol(t0), s.y[:, 0])
            self.assertEqual(list(s.moved), [1])
        s = steif.solve(lambda t, y: -y, (1, 1), [3], t_eval=[1], events=lambda t, y: y[0] - 3)
        self.assertEqual((s.t.tolist(), s.y.tolist(), s.t_events[0].size), ([1], [[3]], 0))
        s = steif.solve(DECAY, (0, 0))
        self.assertEqual((s.y.tolist(), s.outputs["square"].tolist()), ([[2]], [4]))
        with self.assertRaisesRegex(ValueError, "3 numbers|returned the shape"):  # f is called all the same
            steif.solve(lambda t, y: [1, 2, 3], (1, 1), [3])

    def test_events_in_their_order(self):
        s = steif.solve(TANK + "every 0.75 from 0.2: h = h\n", (0, 2.9), rtol=1e-8)
        up, down, tick = ("h > 1 (line 4)", "true"), ("h < 0.5 (line 5)", "true"), ("every 0.75 from 0.2 (line 8)", "time")
        shown = [(round(t, 6), (name, what)) for t, name, what in s.events if what != "false"]
        self.assertEqual(shown, [(0.2, tick), (0.95, tick), (1, up), (1.5, down), (1.7, tick), (2, up), (2.45, tick),
                                 (2.5, down)])
        self.assertEqual(sum(len(t) for t in s.t_events), len(s.events))

        def low(t, y):
            return y[0] - 0.5

        s = steif.solve(lambda t, y: [-y[0]], (0, 1), [1], events=[low, lambda t, y: t - 0.9])
        self.assertEqual([(name, what) for _, name, what in s.events], [("low", "falling"), ("<lambda>", "rising")])
        self.assertEqual([what for _, _, what in steif.solve("bounce").events][:2], ["falling"] * 2)
        self.assertEqual(steif.solve("vdpol").events, [])


if __name__ == "__main__":
    unittest.main()
