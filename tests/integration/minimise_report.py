#!/usr/bin/env python3
"""How small cases become, at what cost, and how well what is left fails.

Prints, for each behaviour, a table of cases that fail (in at least 90 % of 20 runs with fresh seeds), half of them
random and half evolved: obstacles left, simulations, and how much of the case's failure probability is kept in 100
further runs. Run by hand: minimise_report.py PROGRAM [--seed S] [--dir DIR] [--cases N] [BEHAVIOUR...]
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

# The experiment, what a run must say to count as failing, and so many random cases that enough of them fail often.
BEHAVIOURS = {
    "flocking": ("flocking", "total_failure", 400),
    "partitioning": ("task-partitioning", "total_failure", 400),
    "foraging": ("foraging", "condition_2", 1600),
}
BARS = {"flocking": (3, 160), "partitioning": (3, 160), "foraging": (4, 300)}
FRESH_RUNS = 20
FURTHER_RUNS = 100


def call(program, *arguments, codes=(0,)):
    done = subprocess.run([program, *map(str, arguments), "--json", "--quiet"], capture_output=True, text=True)
    if done.returncode not in codes:
        raise SystemExit(f"{' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def failing_runs(program, directory, failing):
    """The first failing run of every different case, evolved ones from the newest generation backwards."""
    shown = subprocess.run([program, "show", directory, "--json", "--runs"], capture_output=True, text=True, check=True)
    runs = json.loads(shown.stdout)["runs"]
    runs.sort(key=lambda run: -run["generation"])
    chosen, seen = [], set()
    for run in runs:
        if run["verdict"] == "completed" and float(run[failing]) == 1.0 and run["individual"] not in seen:
            seen.add(run["individual"])
            chosen.append(run["id"])
    return chosen


def confirmed(program, directory, failing, wanted):
    """Cases that fail in at least 90 % of fresh runs, as {run: failures}."""
    found = {}
    candidates = failing_runs(program, directory, failing)
    while candidates and len(found) < wanted:
        some, candidates = candidates[:20], candidates[20:]
        for case in call(program, "confirm", directory, *some, "--replicates", FRESH_RUNS)["cases"]:
            if case["n"] == FRESH_RUNS and case["k"] >= 0.9 * FRESH_RUNS and len(found) < wanted:
                found[case["run"]] = case["k"]
    return found


def probability(program, experiment, case, failing, directory, seed):
    """Of failing, in further runs."""
    path = directory.with_suffix(".json")
    path.write_text(json.dumps(case))
    evaluated = call(program, "evaluate", experiment, "--case", path, "--replicates", FURTHER_RUNS, "--seed", seed,
                     "--dir", directory)
    runs = evaluated["cases"][0]["runs"]
    fails = [run["failure"]["total"] if failing == "total_failure" else run["metrics"][failing] == 1 for run in runs]
    return sum(fails) / len(fails)


def measure(program, behaviour, seed, count, scratch):
    experiment, failing, random_cases = BEHAVIOURS[behaviour]
    rows = []
    for origin in ("random", "evolved"):
        campaign = scratch / f"{behaviour}-{origin}"
        if not campaign.exists():
            length = ["random", experiment, "--cases", random_cases] if origin == "random" else ["evolve", experiment]
            call(program, *length, "--seed", seed, "--dir", campaign)
        cases = confirmed(program, campaign, failing, count)
        if not cases:
            continue
        for one in call(program, "minimise", campaign, *cases, codes=(0, 2))["cases"]:
            left = one["minimised"]
            row = {"case": f"{origin} {one['run']}", "obstacles": one["original"]["obstacles"], "left": None,
                   "simulations": one["simulations"], "remark": one["remark"]}
            if left is not None:
                kept = left["case"].pop("lineage")["parent"]
                name = f"{behaviour}-{origin}-{one['run']}"
                row["left"] = left["obstacles"]
                row["before"] = probability(program, experiment, kept, failing, scratch / f"{name}-before", seed + 7000)
                row["after"] = probability(program, experiment, left["case"], failing, scratch / f"{name}-after",
                                           seed + 7000)
            rows.append(row)
    return rows


def report(behaviour, rows):
    print(f"\n{behaviour}\n  {'case':<14}{'obstacles':>10}{'left':>6}{'runs':>6}{'before':>8}{'after':>7}")
    for row in rows:
        if row["left"] is None:
            print(f"  {row['case']:<14}{row['obstacles']:>10}{'-':>6}{row['simulations']:>6}  {row['remark']}")
            continue
        print(f"  {row['case']:<14}{row['obstacles']:>10}{row['left']:>6}{row['simulations']:>6}"
              f"{row['before']:>8.2f}{row['after']:>7.2f}  {row['remark']}")
    done = [row for row in rows if row["left"] is not None]
    if not done:
        return
    most_left, most_runs = BARS[behaviour]
    left = statistics.median(row["left"] for row in done)
    runs = statistics.median(row["simulations"] for row in done)
    kept = [row["after"] >= 0.8 * row["before"] for row in done]
    print(f"  {len(done)} of {len(rows)} cases minimised; median {left:g} obstacles left (bar {most_left}), median {runs:g} "
          f"runs, at most {max(row['simulations'] for row in done)} (bar {most_runs}); {sum(kept)} of {len(kept)} keep at "
          "least .8 of the probability (bar 90 %)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("behaviours", nargs="*", default=list(BEHAVIOURS))
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--dir", type=pathlib.Path)
    parser.add_argument("--cases", type=int, default=10, help="of each origin")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        for behaviour in options.behaviours:
            directory = options.dir or pathlib.Path(scratch)
            report(behaviour, measure(options.program, behaviour, options.seed, options.cases, directory))


if __name__ == "__main__":
    main()
