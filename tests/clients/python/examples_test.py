#!/usr/bin/env python3
"""Runs the examples of clients/python: against fake_gauntlet.py, and against the program that GAUNTLET names.

Without GAUNTLET, irace (r-cran-irace) or SciPy, what needs it is skipped and says so.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
CLIENT = ROOT / "clients" / "python"
sys.path.insert(0, str(CLIENT))

import gauntlet  # noqa: E402

GAUNTLET = os.environ.get("GAUNTLET", "")
WHERE_IRACE_IS = ["Rscript", "-e", "cat(system.file('bin', 'irace', package = 'irace'))"]
IRACE = shutil.which("Rscript") and subprocess.run(WHERE_IRACE_IS, stdout=subprocess.PIPE, text=True).stdout
HAS_SCIPY = subprocess.run([sys.executable, "-c", "import scipy"], stderr=subprocess.DEVNULL).returncode == 0
FOUND = re.compile(r"^\d+ +(controller_parameters\.speed=.*)$", re.MULTILINE)  # irace's last list, best first


class Fixture(unittest.TestCase):
    program = str(HERE / "fake_gauntlet.py")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_in(self, folder, *command, stdin=""):
        environment = {**os.environ, "GAUNTLET": self.program, "PYTHONPATH": str(CLIENT),
                       "PYTHONDONTWRITEBYTECODE": "1"}
        ended = subprocess.run([str(word) for word in command], cwd=folder, input=stdin, env=environment,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended.stdout

    def example(self, name):
        return self.run_in(self.folder, sys.executable, CLIENT / "examples" / name, "campaign")

    def tuning(self):
        shutil.copytree(CLIENT / "examples" / "irace", self.folder / "irace")
        return self.folder / "irace"

    def irace(self, folder, experiments):
        printed = self.run_in(folder, IRACE, "--scenario", "scenario.txt", "--seed", 1, "--max-experiments",
                              experiments)
        best = FOUND.search(printed)
        self.assertIsNotNone(best, printed)
        return {key: float(value) for key, value in (word.split("=") for word in best.group(1).split())}


class WithTheFake(Fixture):
    """The fake's fitness is largest at the end of each range that is farthest from 0.5."""

    def test_the_cma_es_nears_the_best_settings_and_repeats_itself_without_a_run(self):
        printed = self.example("cma_es.py")
        self.assertLess(float(re.search(r"bird_speed': ([\d.]+)", printed).group(1)), 0.04)
        self.assertGreater(float(re.search(r"turn_rate': ([\d.]+)", printed).group(1)), 1.4)
        answers = (self.folder / "campaign" / "answers").read_text()
        self.assertEqual(self.example("cma_es.py"), printed)
        self.assertEqual((self.folder / "campaign" / "answers").read_text(), answers)

    @unittest.skipUnless(HAS_SCIPY, "there is no SciPy")
    def test_scipy_nears_the_best_place(self):
        printed = self.example("scipy_search.py")
        self.assertLess(float(re.search(r"mean fitness ([\d.]+)", printed).group(1)), 0.1)

    @unittest.skipIf(HAS_SCIPY, "there is SciPy")
    def test_scipy_is_asked_for_when_it_is_missing(self):
        ended = subprocess.run([sys.executable, str(CLIENT / "examples" / "scipy_search.py"), "campaign"],
                               env={**os.environ, "PYTHONPATH": str(CLIENT), "PYTHONDONTWRITEBYTECODE": "1"},
                               cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.assertEqual((ended.returncode, "needs SciPy" in ended.stderr), (1, True))

    def test_the_target_runner_prints_costs_in_the_order_of_the_experiments(self):
        lines = [f"cases/{case}.json\t{seed}\tcontroller_parameters.speed={speed}\n"
                 for case, seed, speed in (("a", 1, 0.5), ("b", 2, 0.5), ("a", 1, 1.5))]
        costs = self.run_in(self.tuning(), "./target-runner", stdin="".join(lines)).split()
        self.assertEqual([round(float(cost), 6) for cost in costs], [2.55, -0.17, 1.55])

    @unittest.skipUnless(IRACE, "there is no irace: install r-cran-irace")
    def test_irace_nears_the_best_settings(self):
        found = self.irace(self.tuning(), 180)
        self.assertGreater(found["controller_parameters.shyness"], 9.0)


@unittest.skipUnless(GAUNTLET, "GAUNTLET names no program")
class WithGauntlet(Fixture):
    program = GAUNTLET

    def test_the_cma_es_finds_parameters_that_fail_less(self):
        before, after = re.search(r"defaults: (\d+) of 100 .* found: (\d+) of 100",
                                  self.example("cma_es.py")).groups()
        self.assertLess(int(after), int(before) / 2)

    @unittest.skipUnless(IRACE, "there is no irace: install r-cran-irace")
    def test_irace_finds_parameters_of_the_sdk_s_controller_that_fail_less(self):
        folder = self.tuning()
        self.run_in(folder, GAUNTLET, "build-controller", ROOT / "sdk" / "example" / "my_bird.cc",
                    "-o", "libmy_bird.so")
        found = self.irace(folder, 180)
        with gauntlet.open(folder / "my-bird.toml", dir=folder / "compared", program=GAUNTLET) as g:
            answers = g.evaluate([{"file": case, "set": values, "seed": 7, "replicates": 50}
                                  for values in ({}, found) for case in sorted((folder / "cases").iterdir())])
        failures = [answer.failures for answer in answers]
        self.assertLess(sum(failures[3:]), sum(failures[:3]) / 2)


if __name__ == "__main__":
    unittest.main()
