#!/usr/bin/env python3
"""Holds clients/python/gauntlet.py against fake_gauntlet.py, which says what each way of going wrong is."""
import json
import os
import pathlib
import random
import sys
import tempfile
import threading
import unittest
from unittest import mock

HERE = pathlib.Path(__file__).resolve().parent
FAKE = HERE / "fake_gauntlet.py"
sys.path.insert(0, str(HERE.parents[2] / "clients" / "python"))

import gauntlet  # noqa: E402

DEADLINE = 60  # s, which only a deadlock exceeds


def wall(x, y=-1.0, **more):
    return {"obstacles": [{"x": x, "y": y, "length": 1.0, "width": 0.2}], **more}


class Fixture(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "campaign"
        silence = mock.patch("sys.stderr")
        silence.start()
        self.addCleanup(silence.stop)

    def open(self, mode="", **more):
        with mock.patch.dict(os.environ, FAKE_GAUNTLET=mode):
            return gauntlet.open("flocking", dir=self.folder, program=[sys.executable, str(FAKE)], **more)

    def stored(self):
        return [json.loads(line) for line in (self.folder / "answers").read_text().splitlines()]

    def assert_no_process_is_left(self):
        with self.assertRaises(ProcessLookupError):
            os.kill(int((self.folder / "pid").read_text()), 0)


class Answers(Fixture):
    def test_have_what_gauntlet_said(self):
        with self.open() as g:
            self.assertEqual((g.directory, g.greeting["seed"]), (str(self.folder), "123"))
            answer = g.submit(case=wall(3.0), seed=2**64 - 1, replicates=2).result(DEADLINE)
        self.assertEqual((answer.fitness, answer.failures, answer.individual), (4.0, 2, 1))
        self.assertEqual([run["seed"] for run in answer.runs], ["18446744073709551615"] * 2)
        self.assertEqual(answer.raw["line"], 1)
        self.assert_no_process_is_left()

    def test_come_in_the_order_of_the_requests(self):
        with self.open("reversed") as g:
            futures = [g.submit(case=wall(float(x))) for x in range(5)]
            g.close()
            self.assertEqual([future.result(0).fitness for future in futures], [1.0, 0.0, 1.0, 4.0, 9.0])

    def test_are_given_for_cases_files_and_arguments(self):
        path = self.folder.parent / "case.json"
        path.write_text(json.dumps(wall(2.0)))
        with self.open() as g:
            answers = g.evaluate([wall(3.0), path, str(path), {"file": path, "set": {"a": 1.5}},
                                  {"case": wall(1.0)}])
        self.assertEqual([answer.fitness for answer in answers], [4.0, 1.0, 1.0, 2.0, 0.0])

    def test_go_to_whom_they_belong_when_threads_ask_at_once(self):
        answers = {}

        def ask(g, x):
            answers[x] = g.submit(case=wall(float(x))).result(DEADLINE).fitness

        with self.open() as g:
            threads = [threading.Thread(target=ask, args=(g, x)) for x in range(20)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join(DEADLINE)
        self.assertEqual(answers, {x: (x - 1.0) ** 2 for x in range(20)})

    def test_of_a_callback_may_be_asked_for(self):
        second = []
        with self.open() as g:
            asked = threading.Event()

            def ask(_):
                second.append(g.submit(case=wall(2.0)))
                asked.set()

            g.submit(case=wall(3.0)).add_done_callback(ask)
            self.assertTrue(asked.wait(DEADLINE))
        self.assertEqual(second[0].result(0).fitness, 1.0)


class Ids(Fixture):
    def test_are_of_the_content_and_of_how_often_it_was_asked_for(self):
        with self.open() as g:
            g.evaluate([wall(2.0), wall(3.0), dict(reversed(list(wall(2.0, name="").items()))), wall(2.0)])
        ids = [said["request"]["id"] for said in self.stored()]
        self.assertEqual(ids[3], ids[0][:-1] + "2")
        self.assertEqual(len(set(ids)), 4)
        with self.open() as g:
            g.evaluate([wall(2.0, name="")])
        self.assertEqual(len(self.stored()), 4)

    def test_give_what_is_stored_to_a_script_that_is_started_again(self):
        with self.open() as g:
            first = g.evaluate([wall(2.0), {"case": wall(2.0), "seed": 1}])
        with self.open() as g:
            again = g.evaluate([wall(2.0), {"case": wall(2.0), "seed": 1}, {"case": wall(2.0), "seed": 2}])
        self.assertEqual([a.individual for a in again], [1, 2, 3])
        self.assertEqual([a.raw for a in again[:2]], [a.raw for a in first])

    def test_change_with_the_content_of_a_file(self):
        path = self.folder.parent / "case.json"
        fitness = []
        for x in (2.0, 3.0):
            path.write_text(json.dumps(wall(x)))
            with self.open() as g:
                fitness.append(g.evaluate([path])[0].fitness)
        self.assertEqual(fitness, [1.0, 4.0])


class Errors(Fixture):
    def test_of_a_line_are_those_of_its_future(self):
        with self.open() as g:
            refused, good = g.submit(case=wall(2.0, name="refused")), g.submit(case=wall(2.0))
            with self.assertRaisesRegex(gauntlet.EvaluationError, "no path is left") as caught:
                refused.result(DEADLINE)
            self.assertEqual(caught.exception.rule, "no-path")
            self.assertEqual(good.result(DEADLINE).fitness, 1.0)
            with self.assertRaises(gauntlet.EvaluationError):
                g.evaluate([wall(2.0), wall(2.0, name="refused")])

    def test_of_the_arguments_are_told_at_once(self):
        with self.open() as g:
            for arguments in ({}, {"case": {}, "file": "case.json"}, {"case": wall(float("nan"))},
                              {"file": "/dev/zero"}):
                with self.assertRaises(ValueError):
                    g.submit(**arguments)
            with self.assertRaises(FileNotFoundError):
                g.submit(file=self.folder / "none.json")
            with self.assertRaises(TypeError):
                g.submit(case={"obstacles": {1, 2}})
            self.assertEqual(g.evaluate([wall(2.0)])[0].raw["line"], 1)

    def test_name_a_missing_program(self):
        with self.assertRaisesRegex(gauntlet.GauntletError, "nowhere/g cannot be started .No such file"):
            gauntlet.open("flocking", program="nowhere/g")

    def test_quote_a_program_that_ends_at_once(self):
        with self.assertRaisesRegex(gauntlet.GauntletError, "exit code 1\n.*did you mean 'flocking'"):
            self.open("dumb")

    def test_name_another_protocol(self):
        with self.assertRaisesRegex(gauntlet.GauntletError, "protocol 2, this gauntlet.py 1: .* 1.0.0"):
            self.open("protocol")
        self.assert_no_process_is_left()

    def test_say_how_to_go_on_after_a_death(self):
        with self.open("killed") as g:
            futures = [g.submit(case=wall(2.0, name="x" * length)) for length in (1, 2, 5000000)]
            for future in futures:
                with self.assertRaisesRegex(gauntlet.GauntletError, "SIGKILL.*dir='.*campaign'\n  no memory"):
                    future.result(DEADLINE)
            with self.assertRaisesRegex(gauntlet.GauntletError, "no memory is left"):
                g.submit(case=wall(2.0))
        self.assert_no_process_is_left()

    def test_follow_half_a_line(self):
        with self.open("half") as g:
            first, second = g.submit(case=wall(2.0)), g.submit(case=wall(3.0))
            self.assertEqual(first.result(DEADLINE).fitness, 1.0)
            with self.assertRaisesRegex(gauntlet.GauntletError, "exit code 3"):
                second.result(DEADLINE)

    def test_quote_what_is_no_answer(self):
        with self.open("mumbles") as g:
            with self.assertRaisesRegex(gauntlet.GauntletError, r"""no answer: b'"what\?"""):
                g.submit(case=wall(2.0)).result(DEADLINE)


class Ends(Fixture):
    def test_when_closed_with_every_answer(self):
        g = self.open()
        futures = [g.submit(case=wall(float(x))) for x in range(300)]
        g.close()
        self.assertTrue(all(future.done() for future in futures))
        self.assert_no_process_is_left()
        with self.assertRaisesRegex(gauntlet.GauntletError, "was closed"):
            g.submit(case=wall(2.0))
        g.close()

    def test_by_an_exception_although_nothing_is_read(self):
        with self.assertRaises(KeyboardInterrupt):
            with self.open("deaf") as g:
                futures = [g.submit(case=wall(2.0, name="x" * 100000)) for _ in range(50)]
                raise KeyboardInterrupt
        for future in futures:
            self.assertRegex(str(future.exception(0)), "SIGTERM")
        self.assert_no_process_is_left()

    def test_by_force_when_it_hears_nothing(self):
        with mock.patch.object(gauntlet, "_PATIENCE", 0.1):
            self.open("stubborn").terminate()
        self.assert_no_process_is_left()


class Command(Fixture):
    def test_holds_all_that_is_given(self):
        program = {"GAUNTLET": str(FAKE), "FAKE_GAUNTLET": ""}
        with mock.patch.dict(os.environ, program):
            values = {"controller": "my-bird", "genome.lights": True, "genome.genes": 4}
            gauntlet.open(pathlib.Path("mine.toml"), dir=self.folder, workers=2, set=values,
                          options=["--plugin", "a.so"]).close()
        self.assertEqual((self.folder / "arguments").read_text().split("\n"), [
            "evaluate", "mine.toml", "--stdin", "--plugin", "a.so", "--dir", str(self.folder),
            "--workers", "2", "--set", "controller=my-bird", "--set", "genome.lights=true",
            "--set", "genome.genes=4", "--quiet"])


class Walk:
    """Asks for points around the best one, and notes what happens."""

    def __init__(self):
        self.random, self.best, self.notes = random.Random(1), (9.0, 0.0), []

    def ask(self):
        point = self.best[1] + self.random.gauss(0.0, 0.5)
        self.notes.append(("ask", point))
        return point

    def tell(self, point, score):
        self.notes.append(("tell", point, score))
        self.best = min(self.best, (score, point))


class Optimisers(Fixture):
    def test_are_told_in_the_order_of_asking(self):
        walk = Walk()
        with self.open() as g:
            g.optimise(walk, wall, 40, at_once=3)
        asked = [note[1] for note in walk.notes if note[0] == "ask"]
        self.assertEqual([note[1] for note in walk.notes if note[0] == "tell"], asked)
        self.assertEqual("".join(note[0][0] for note in walk.notes), "aaa" + "ta" * 37 + "ttt")
        self.assertLess(walk.best[0], 0.1)

    def test_are_told_of_refused_cases_and_by_another_score(self):
        walk = Walk()
        with self.open() as g:
            g.optimise(walk, lambda x: wall(x, name="refused" if x > 0 else ""), 4, at_once=9,
                       score=lambda answer: -answer.failures, refused=7.0)
        told = [note[1:] for note in walk.notes if note[0] == "tell"]
        self.assertEqual(told, [(x, 7.0 if x > 0 else -1) for x, _ in told])
        self.assertEqual({score for _, score in told}, {7.0, -1})


if __name__ == "__main__":
    unittest.main()
