"""Joins the measurements into result.json and prints them as Markdown.

Usage: report.py MEASUREMENTS.jsonl...
"""

import json
import math
import sys

CLEARANCE = 3e-4
# Where the runs end, m: from reference/reference.c.
REFERENCES = {
    "B1": (-4.205650712467251225e-04, -2.680261826220661629e-04),
    "B2": (2.999149339596915691e-04, -4.508778179133114607e-05),
    "B3a": (2.884189842900710277e-04, 3.635701631807502338e-04),
    "B3b": (3.087230269639085417e-04, 3.486426392106153471e-04),
}
# B3c is too fast for 128-bit arithmetic: this solver's finest run.
FINEST = "diffsol tsit45"
TARGET = 1e-7  # error / clearance at which times are compared
PROJECT = "project, series"


def read(paths):
    for path in paths:
        with open(path) as lines:
            yield from map(json.loads, lines)


def add_errors(runs):
    references = dict(REFERENCES)
    for run in runs:
        if run["solver"] == FINEST and run["rtol"] == 1e-12 and "x" in run:
            references.setdefault(run["problem"], (run["x"], run["y"]))
    for run in runs:
        if "x" in run:
            x, y = references[run["problem"]]
            run["error"] = math.hypot(run["x"] - x, run["y"] - y) / CLEARANCE


def time_to(runs, target):
    """Seconds to reach an error, log-log between the two tolerances where it is first reached; and
    whether that only bounds the time: "<" if the loosest tolerance is already better, ">" if the
    tightest is not good enough. None for a solver that never succeeds."""
    before = None
    for run in sorted((r for r in runs if "error" in r), key=lambda r: -r["rtol"]):
        if run["error"] <= target:
            if before is None:
                return run["seconds"], "<"
            share = math.log(before["error"] / target) / math.log(before["error"] / run["error"])
            ratio = run["seconds"] / before["seconds"]
            return before["seconds"] * ratio**share, ""
        before = run
    return (before["seconds"], ">") if before else (None, "")


def table(title, header, rows):
    print(f"\n## {title}\n")
    print("| " + " | ".join(header) + " |")
    print("|" + "---|" * len(header))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def seconds(value):
    return f"{value * 1e3:.3g} ms"


def main():
    records = list(read(sys.argv[1:]))
    runs = [r for r in records if "problem" in r]
    sweeps = [r for r in records if "sweep" in r]
    left_out = {r["references"]: r["left_out"] for r in records if "references" in r}
    add_errors(runs)
    problems = list(dict.fromkeys(r["problem"] for r in runs))
    ratios = []
    for problem in problems:
        here = [r for r in runs if r["problem"] == problem]
        table(
            f"{problem}: error / δ, best time, right-hand sides, mode changes",
            ["solver", "rtol", "error", "time", "evaluations", "changes"],
            (
                [r["solver"], f"{r['rtol']:.0e}"]
                + (
                    [f"{r['error']:.1e}", seconds(r["seconds"]), str(r["evaluations"]), str(r["changes"])]
                    if "error" in r
                    else ["failed", r["failed"], "", ""]
                )
                for r in here
            ),
        )
        for solver in dict.fromkeys(r["solver"] for r in here):
            time, how = time_to([r for r in here if r["solver"] == solver], TARGET)
            ratios.append({"problem": problem, "solver": solver, "seconds": time, "how": how})
    for ratio in ratios:
        base = next(
            r["seconds"] for r in ratios if r["problem"] == ratio["problem"] and r["solver"] == PROJECT
        )
        ratio["ratio"] = ratio["seconds"] / base if ratio["seconds"] and base else None
    table(
        f"Time to an error of {TARGET:g} δ, relative to {PROJECT}",
        ["problem", "solver", "time", "ratio"],
        (
            [r["problem"], r["solver"]]
            + (
                [r["how"] + seconds(r["seconds"]), r["how"] + f"{r['ratio']:.2f}"]
                if r["seconds"]
                else ["–", "–"]
            )
            for r in ratios
        ),
    )
    table(
        "Silently wrong runs: another number of mode changes, or off by more than 0.5 δ",
        ["problem", "solver", "rtol", "wrong", "failed with an error", "runs"],
        (
            [s["sweep"], s["solver"], f"{s['rtol']:.0e}", str(s["wrong"]), str(s["failed"]), str(s["runs"])]
            for s in sweeps
        ),
    )
    for problem, starts in left_out.items():
        print(f"\n{problem}: {len(starts)} starts left out, their reference is not confirmed.")
    with open("result.json", "w") as out:
        json.dump({"runs": runs, "time_to_error": ratios, "sweeps": sweeps, "left_out": left_out}, out, indent=1)
        out.write("\n")


if __name__ == "__main__":
    main()
