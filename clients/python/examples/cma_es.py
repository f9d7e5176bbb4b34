#!/usr/bin/env python3
"""Searches with a CMA-ES for parameters of a flock that passes three walls, which break it with the defaults.
usage: cma_es.py DIR (of the campaign; with that of a search that was stopped, it goes on)"""
import math
import pathlib
import random
import sys

import gauntlet

WALLS = pathlib.Path(__file__).resolve().parent / "irace/cases/a.json"
RANGES = {"bird_speed": (0.03, 0.1), "turn_rate": (0.3, 1.5), "separation_distance": (0.18, 0.6)}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class CmaEs:
    """Minimises, with the constants of N. Hansen's tutorial (arXiv:1604.00772) and positive weights only."""

    def __init__(self, mean, sigma, seed):
        n = len(mean)
        self.mean, self.sigma, self.random, self.told = mean, sigma, random.Random(seed), []
        self.population = 4 + int(3 * math.log(n))
        weights = [math.log((self.population + 1) / 2 / (i + 1)) for i in range(self.population // 2)]
        self.weights = [w / sum(weights) for w in weights]
        self.covariance = [[float(i == j) for j in range(n)] for i in range(n)]
        self.root = [row[:] for row in self.covariance]  # Cholesky's
        self.path, self.sigma_path = [0.0] * n, [0.0] * n

    def ask(self):
        drawn = [self.random.gauss(0, 1) for _ in self.mean]
        return [m + self.sigma * dot(row, drawn) for m, row in zip(self.mean, self.root)]

    def tell(self, point, score):
        self.told.append((score, point))
        if len(self.told) == self.population:
            best, self.told = sorted(self.told)[:len(self.weights)], []
            self.adapt([[(x - m) / self.sigma for x, m in zip(point, self.mean)] for _, point in best])

    def adapt(self, steps):
        n, mu = len(self.mean), 1 / dot(self.weights, self.weights)
        cs, cc, c1 = (mu + 2) / (n + mu + 5), (4 + mu / n) / (n + 4 + 2 * mu / n), 2 / ((n + 1.3) ** 2 + mu)
        cmu = min(1 - c1, 2 * (mu - 2 + 1 / mu) / ((n + 2) ** 2 + mu))
        step, white = [dot(self.weights, column) for column in zip(*steps)], []
        for row, y in zip(self.root, step):  # white is what the root makes the step of
            white.append((y - dot(row, white)) / row[len(white)])
        self.mean = [m + self.sigma * y for m, y in zip(self.mean, step)]
        self.path = [(1 - cc) * p + math.sqrt(cc * (2 - cc) * mu) * y for p, y in zip(self.path, step)]
        scale = math.sqrt(cs * (2 - cs) * mu)
        self.sigma_path = [(1 - cs) * p + scale * z for p, z in zip(self.sigma_path, white)]
        length = math.sqrt(dot(self.sigma_path, self.sigma_path) / n) / (1 - 1 / (4 * n) + 1 / (21 * n * n))
        self.sigma *= math.exp(cs * (length - 1) / (1 + cs + 2 * max(0, math.sqrt((mu - 1) / (n + 1)) - 1)))
        learned = [*zip(self.weights, steps), (c1 / cmu, self.path)]
        for i in range(n):
            for j in range(i + 1):
                spread = cmu * sum(weight * s[i] * s[j] for weight, s in learned)
                self.covariance[i][j] = (1 - c1 - cmu) * self.covariance[i][j] + spread
                rest = self.covariance[i][j] - dot(self.root[i][:j], self.root[j][:j])
                self.root[i][j] = math.sqrt(rest) if i == j else rest / self.root[j][j]


def request(point):
    values = {}
    for x, (name, (low, high)) in zip(point, RANGES.items()):
        inside = 1 - abs(1 - x % 2)  # mirrored at both ends of the range
        values[f"controller_parameters.{name}"] = low + inside * (high - low)
    return {"file": WALLS, "set": values, "replicates": 20}


with gauntlet.open("flocking", dir=sys.argv[1]) as g:
    search = CmaEs([0.5] * len(RANGES), sigma=0.2, seed=1)
    g.optimise(search, request, evaluations=140, at_once=4, score=lambda answer: -answer.fitness)
    found = request(search.mean)["set"]
    fresh = {"file": WALLS, "replicates": 100, "seed": 7}
    before, after = g.evaluate([fresh, {**fresh, "set": found}])
print(f"defaults: {before.failures} of 100 fresh runs fail; found: {after.failures} of 100 fail, with", found)
