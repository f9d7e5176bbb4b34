#!/usr/bin/env python3
"""Searches with SciPy's differential evolution for the place of a wall where a flock does worst.
usage: scipy_search.py DIR (of the campaign; with that of a search that was stopped, it goes on)"""
import math
import sys

import gauntlet

try:
    from scipy.optimize import differential_evolution
except ImportError:
    sys.exit("This example needs SciPy: python3 -m pip install scipy, or the package python3-scipy.")


def wall(x, y, degrees):
    return {"obstacles": [{"x": x, "y": y, "length": 2.4, "width": 0.2, "orientation_deg": degrees}]}


def fitness(future):
    refused = getattr(future.exception(), "rule", None) is not None
    value = None if refused else future.result().fitness
    return math.inf if value is None else value


with gauntlet.open("flocking", dir=sys.argv[1]) as g:
    def generation(points):  # a column for each
        futures = [g.submit(case=wall(*point), replicates=10) for point in points.T.tolist()]
        return [fitness(future) for future in futures]

    found = differential_evolution(generation, [(-2, 2), (-2, 2), (0, 180)], maxiter=10, popsize=8, seed=1,
                                   polish=False, vectorized=True, updating="deferred")
print(f"mean fitness {found.fun:.3f} with the wall {wall(*found.x.round(3).tolist())['obstacles'][0]}")
