"""steif: stiff ODEs and DAEs, with the look of scipy.integrate.solve_ivp.

    import steif
    s = steif.solve(lambda t, y: [y[1], 100*(1 - y[0]**2)*y[1] - y[0]], (0, 100), [2, 0])
    s.t, s.y            # t: n_points, y: n x n_points
    steif.solve("rober", method="radau:s=3", rtol=1e-8)        # a problem of the collection
    steif.solve("pendulum.steif")                              # or a model file

    steif.impulse(E, F, x0, f="sin(t); 0")      # the jump and the impulses of E x' + F x = f
    steif.weak("bdf:p=2", E, F, x0)             # does the method converge to them
    steif.c2d(A, B, dt=0.1, scheme="foh")       # x' = A x + B u on a time grid

    steif.sensitivity(f, (t0, t1), y0, p=[0.04])           # dy/dp of y' = f(t, y, *p)
    steif.fit(f, t, data, p=[0.1], y0=y0)                  # p from measurements
    steif.sweep("lotka.steif", {"p1": [1.4, 1.5, 1.6]})    # many runs on all cores

The library is found by the environment variable STEIF_LIBRARY, else beside this file, else by the loader.
"""
from ._library import SteifError, version
from ._linear import c2d, impulse, weak
from ._parameters import fit, sensitivity
from ._run import Result
from ._solve import solve
from ._sweep import sweep

__all__ = ["solve", "sensitivity", "fit", "sweep", "impulse", "weak", "c2d", "Result", "SteifError", "version"]
