#!/usr/bin/env python3
"""Speaks the protocol of `gauntlet evaluate EXPERIMENT --stdin` without a simulator.

The fitness of a case is the squared distance of its first obstacle from (1, -1), and of the values that are
set from 0.5; a case called "refused" breaks a rule. Answers are kept in DIR/answers, a line each. What goes
wrong, the environment variable FAKE_GAUNTLET says:

    dumb       ends before the greeting
    protocol   another protocol
    reversed   answers when standard input has ended, the last request first
    deaf       never reads
    killed     reads two lines and is killed while the third is written
    half       writes half an answer to the second line and ends
    mumbles    writes what is no answer
    stubborn   as deaf, and hears no SIGTERM
"""
import json
import os
import pathlib
import signal
import sys

MODE = os.environ.get("FAKE_GAUNTLET", "")


def say(answer, end="\n"):
    sys.stdout.write(json.dumps(answer) + end)
    sys.stdout.flush()


def evaluate(request):
    case = request["case"] if "case" in request else json.loads(pathlib.Path(request["file"]).read_text())
    if case.get("name") == "refused":
        return {"error": "no path is left for the prey", "rule": "no-path"}
    values = [value for value in request.get("set", {}).values() if isinstance(value, float)]
    obstacles = case.get("obstacles") or [{"x": 1.0, "y": -1.0}]
    fitness = sum((value - 0.5) ** 2 for value in values)
    fitness += (obstacles[0]["x"] - 1) ** 2 + (obstacles[0]["y"] + 1) ** 2
    run = {"id": 1, "seed": str(request.get("seed", 7)), "fitness": fitness, "verdict": "completed",
           "metrics": {}, "failure": {"total": False, "type": None, "label": ""}, "hash": "0123456789abcdef"}
    replicates = request.get("replicates", 1)
    return {"fitness": fitness, "failures": int(fitness > 1) * replicates, "runs": [run] * replicates}


def answer(stored, folder, number, line):
    request = json.loads(line)
    name = request.get("id")
    said = stored.get(name)
    if said is None:
        said = {"individual": len(stored) + 1, "request": request, **evaluate(request)}
        stored[name] = said
        with (folder / "answers").open("a") as file:
            file.write(json.dumps(said) + "\n")
    elif said["request"] != request:
        said = {"error": "this id was given to another request"}
    return {"id": name, "line": number, **{key: said[key] for key in said if key != "request"}}


def main(arguments):
    given = {key: arguments[i + 1] for i, key in enumerate(arguments[:-1]) if key.startswith("--")}
    folder = pathlib.Path(given.get("--dir", "campaigns/fake"))
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / "answers"
    answers = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    stored = {said["request"]["id"]: said for said in answers}
    (folder / "arguments").write_text("\n".join(arguments))
    (folder / "pid").write_text(str(os.getpid()))
    if MODE == "dumb":
        sys.exit("unknown experiment 'fockling'; did you mean 'flocking'?")
    if MODE == "stubborn":
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
    say({"gauntlet": "1.0.0", "protocol": 2 if MODE == "protocol" else 1, "experiment": arguments[1],
         "directory": str(folder), "seed": "123", "replicates": 1})
    while MODE in ("deaf", "stubborn"):
        signal.pause()
    answered = []
    for number, line in enumerate(sys.stdin, 1):
        if MODE == "killed":
            if number == 2:
                sys.stdin.buffer.raw.read(1)
                print("no memory is left", file=sys.stderr, flush=True)
                os.kill(os.getpid(), signal.SIGKILL)
            continue
        if MODE == "half" and number == 2:
            sys.stdout.write('{"id": "a", "li')
            sys.exit(3)
        if MODE == "mumbles":
            say("what?")
        answered.append(answer(stored, folder, number, line))
        if MODE != "reversed":
            say(answered[-1])
    for one in reversed(answered if MODE == "reversed" else []):
        say(one)


main(sys.argv[1:])
