"""Evaluates test cases with Gauntlet, for any optimiser. Needs Python 3.8 or later and nothing else.

    import gauntlet

    with gauntlet.open("flocking", workers=4, dir="campaigns/mine") as g:
        wall = {"x": 0.5, "y": -1.0, "length": 1.6, "width": 0.2, "orientation_deg": 45}
        evaluation = g.submit(case={"obstacles": [wall]}, replicates=20).result()
        print(evaluation.fitness, evaluation.failures)

A child process, `gauntlet evaluate EXPERIMENT --stdin`, simulates with all its workers.

The id of a request is made from its content: the SHA-256 of its JSON (and of the file that it names), and how
often this session has asked for the same. Gauntlet stores every answer under its id before it gives it. So a
script that is started again with the same `dir`, also after it was killed, gets what is stored without a run
and goes on from there, if it asks for the same again: an optimiser has to begin with the same random seed.
"""
from __future__ import annotations

import collections
import contextlib
import dataclasses
import hashlib
import json
import math
import os
import pathlib
import queue
import signal
import subprocess
import sys
import threading
from concurrent.futures import Future
from typing import Any, Callable, ContextManager, Dict, Iterable, List, Mapping, Optional, Sequence, Union

PROTOCOL = 1  # of the lines between both processes
_PATIENCE = 30.0  # s: a child that was told to end, or has closed its output, is killed after this time

Path = Union[str, "os.PathLike[str]"]
Request = Union[Path, Mapping[str, Any]]  # what Evaluator.evaluate says


class GauntletError(Exception):
    """Gauntlet could not be started, speaks another protocol, or ended before it gave all its answers."""


class EvaluationError(GauntletError):
    """One request was refused; the others go on."""

    rule: Optional[str] = None  # that the case breaks, such as "no-path"; None when something else is wrong


@dataclasses.dataclass(frozen=True)
class Evaluation:
    """The answer to one request."""

    fitness: Optional[float]  # mean of the completed runs, lower is tougher; None when no run was completed
    failures: int  # runs that failed, as the scenario defines it
    runs: List[Dict[str, Any]]  # id, seed (text), fitness, verdict, metrics, failure and hash of each
    individual: int  # number in the campaign
    raw: Dict[str, Any]  # the whole answer


def open(experiment: Path, *, dir: Optional[Path] = None, workers: Optional[int] = None,
         set: Optional[Mapping[str, Any]] = None, program: Union[str, Sequence[str], None] = None,
         options: Sequence[str] = (), quiet: bool = True) -> Evaluator:
    """Starts Gauntlet and waits until it is ready.

    experiment: the name of a shipped experiment, or a TOML file
    dir: of the campaign; that of an earlier session is gone on with; by default a new one
    workers: how many processes simulate, 1 or more; by default one for each core
    set: values of the experiment, such as {"controller_parameters.turn_rate": 0.5}
    program: a path or the beginning of a command line; by default $GAUNTLET, or gauntlet in PATH
    options: further arguments of `gauntlet evaluate`, such as ["--plugin", "libmine.so"]
    quiet: False lets Gauntlet tell on standard error how far it is

    Raises GauntletError when the program is missing, ends at once or speaks another protocol.
    """
    program = program or os.environ.get("GAUNTLET") or "gauntlet"
    command = [program] if isinstance(program, str) else list(program)
    command += ["evaluate", os.fspath(experiment), "--stdin", *options]
    command += ["--dir", os.fspath(dir)] if dir is not None else []
    command += ["--workers", str(workers)] if workers is not None else []
    for key, value in (set or {}).items():
        command += ["--set", f"{key}={value if isinstance(value, str) else json.dumps(value)}"]
    return Evaluator(command + (["--quiet"] if quiet else []))


class Evaluator(ContextManager["Evaluator"]):
    """A running Gauntlet, made by `open`; after its `with` statement no process is left.

    All methods may be called from any thread; a callback of a future may call `submit` only. `directory` is
    the campaign's, `greeting` what Gauntlet said first, with gauntlet (the version), experiment, seed (text).
    """

    def __init__(self, command: Sequence[str]) -> None:
        """Starts a whole command line; raises as `open` does."""
        pipe = subprocess.PIPE
        try:
            self._process: Any = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe)
        except OSError as error:
            raise GauntletError(f"{command[0]} cannot be started ({error.strerror}): put gauntlet into PATH, "
                                "or give it as program=... or in the environment variable GAUNTLET") from None
        self._lock = threading.Lock()  # of what submit changes, the next four
        self._waiting: Dict[int, Future[Any]] = {0: Future()}  # by the line that asks; 0: the greeting
        self._lines = 0  # that were submitted
        self._asked: Dict[str, int] = collections.defaultdict(int)  # how often, by content
        self._over = ""  # why nothing can be submitted any more
        self._to_write: queue.SimpleQueue[Optional[bytes]] = queue.SimpleQueue()  # None: that was all
        self._last_words: collections.deque[str] = collections.deque(maxlen=20)  # of standard error
        self.directory: Optional[str] = None
        ready, works = self._waiting[0], (self._overhear, self._write, self._read)
        self._threads = [threading.Thread(target=work, daemon=True) for work in works]
        for thread in self._threads:
            thread.start()
        try:
            self.greeting: Dict[str, Any] = ready.result()
            theirs = self.greeting.get("protocol")
            if theirs != PROTOCOL:
                raise GauntletError(f"{command[0]} speaks protocol {theirs}, this gauntlet.py {PROTOCOL}: "
                                    f"use the one of release {self.greeting.get('gauntlet')}")
        except BaseException:
            self.terminate()
            raise

    def submit(self, case: Optional[Mapping[str, Any]] = None, file: Optional[Path] = None,
               set: Optional[Mapping[str, Any]] = None, seed: Optional[int] = None,
               replicates: Optional[int] = None) -> Future[Evaluation]:
        """Asks for one evaluation and returns at once; the future cannot be cancelled.

        case, file: one of both, a dict as in a case file or the path of a case file
        set: values that this evaluation has instead of the experiment's
        seed: 0 to 2^64 - 1; without one, the same case and settings have the same seeds each time
        replicates: how many runs, 1 or more; by default those of the experiment

        The future raises EvaluationError when the request is refused, GauntletError when Gauntlet ends first.
        Raises GauntletError when Gauntlet has ended, OSError when the file cannot be read, and TypeError or
        ValueError for what JSON cannot hold (write float(x) or int(x) for numbers of NumPy).
        """
        if (case is None) == (file is None):
            raise ValueError("a request needs either a case or a file")
        path = None if file is None else os.fspath(file)
        given = {"case": case, "file": path, "set": set, "seed": seed, "replicates": replicates}
        request = {key: value for key, value in given.items() if value is not None}
        if path is not None and os.path.exists(path) and not os.path.isfile(path):
            raise ValueError(f"{path} is no regular file")  # reading a pipe or a device may never end
        named = b"" if path is None else pathlib.Path(path).read_bytes()  # another when the file has changed
        content = hashlib.sha256(_line(request) + named).hexdigest()
        future: Future[Evaluation] = Future()
        future.set_running_or_notify_cancel()
        with self._lock:
            if self._over:
                raise GauntletError(self._over)
            self._lines += 1
            self._asked[content] += 1
            self._waiting[self._lines] = future
            self._to_write.put(_line({"id": f"{content}-{self._asked[content]}", **request}))
        return future

    def evaluate(self, requests: Iterable[Request]) -> List[Evaluation]:
        """Evaluates cases (dicts), case files (paths), or arguments of submit (dicts with "case" or "file").

        Returns the answers in the order of the requests, or raises the first error in that order: where cases
        may be refused, use `submit` and ask each future.
        """
        return [future.result() for future in [self._submit(request) for request in requests]]

    def optimise(self, optimiser: Any, to_request: Callable[[Any], Request], evaluations: int,
                 at_once: int = 8, refused: float = math.inf,
                 score: Callable[[Evaluation], Optional[float]] = lambda answer: answer.fitness) -> None:
        """Lets an optimiser search that minimises and has `ask() -> point` and `tell(point, score)`.

        to_request: makes of a point what `evaluate` takes
        evaluations: how many points are asked for
        at_once: how many of them are evaluated at the same time, 1 or more
        refused: what the optimiser is told where a case breaks a validity rule or the score is None
        score: what it is told elsewhere

        Points are told in the order of asking, each before the one `at_once` later is asked for, so a search
        depends neither on the number of workers nor on their speed. Raises what
        `submit` and its futures raise, but nothing for validity rules.
        """
        if at_once < 1:
            raise ValueError(f"at_once is {at_once}, expected 1 or more")
        waiting: collections.deque[Any] = collections.deque()
        for number in range(evaluations + at_once):
            if number >= at_once:
                point, future = waiting.popleft()
                told = None
                try:
                    told = score(future.result())
                except EvaluationError as error:
                    if error.rule is None:
                        raise
                optimiser.tell(point, refused if told is None else told)
            if number < evaluations:
                point = optimiser.ask()
                waiting.append((point, self._submit(to_request(point))))

    def close(self) -> None:
        """Takes no more requests, and waits until all are answered and the process has ended."""
        self._end("this evaluator was closed")
        try:
            self._threads[-1].join()
        except BaseException:
            self.terminate()
            raise

    def terminate(self) -> None:
        """Ends the process (SIGTERM) and waits for that; open futures fail, what is stored remains."""
        self._end("this evaluator was terminated")
        self._process.terminate()
        self._wait()
        self._threads[-1].join()

    def __exit__(self, kind: Any, error: Any, traceback: Any) -> None:
        (self.close if kind is None else self.terminate)()

    def _submit(self, request: Request) -> Future[Evaluation]:
        if not isinstance(request, Mapping):
            return self.submit(file=request)
        return self.submit(**(request if "case" in request or "file" in request else {"case": request}))

    def _end(self, why: str) -> None:
        with self._lock:
            self._over = self._over or why
        self._to_write.put(None)

    def _wait(self) -> None:
        try:
            self._process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _write(self) -> None:
        with contextlib.suppress(OSError), self._process.stdin as stream:  # why it reads no more, _read tells
            for line in iter(self._to_write.get, None):
                stream.write(line)
                stream.flush()

    def _overhear(self) -> None:
        with self._process.stderr as stream:
            for line in stream:
                self._last_words.append(line.decode(errors="replace").rstrip())
                with contextlib.suppress(OSError, ValueError):  # of a standard error that is closed
                    print(self._last_words[-1], file=sys.stderr, flush=True)

    def _read(self) -> None:
        nonsense = ""
        with self._process.stdout as stream:
            for line in stream:
                if not line.endswith(b"\n"):
                    break  # it died while it wrote
                try:
                    self._take(json.loads(line))
                except (ValueError, KeyError, TypeError, AttributeError):
                    nonsense = f"gauntlet wrote what is no answer: {line[:200]!r}; "
                    self._process.terminate()
                    break
        self._wait()
        self._threads[0].join()  # all that it said was heard
        code = self._process.returncode
        ending = f"by {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
        advice = f"; its answers are stored: to go on, ask the same again with dir={self.directory!r}"
        why = f"{nonsense}gauntlet ended {ending}{advice if self.directory else ''}"
        why = "\n  ".join([why, *self._last_words])
        self._end(why)
        for future in self._waiting.values():
            future.set_exception(GauntletError(why))

    def _take(self, answer: Dict[str, Any]) -> None:
        number = answer.get("line", 0)  # the greeting has none
        future = self._waiting[number]
        if number == 0:
            self.directory = answer.get("directory")
            future.set_result(answer)
        elif "error" in answer:
            error = EvaluationError(answer["error"])
            error.rule = answer.get("rule")
            future.set_exception(error)
        else:
            future.set_result(Evaluation(answer["fitness"], answer["failures"], answer["runs"],
                                         answer["individual"], answer))
        del self._waiting[number]


def _line(request: Mapping[str, Any]) -> bytes:
    return json.dumps(request, sort_keys=True, separators=(",", ":"), allow_nan=False).encode() + b"\n"
