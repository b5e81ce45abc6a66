"""Joins the measurements into result.json and writes the page of the book with its plots.

Usage: report.py MEASUREMENTS.jsonl...   (in this directory, after the stages of `run`)
"""

import datetime
import importlib.metadata
import json
import math
import os
import platform
import re
import statistics
import subprocess
import sys

BOOK = "../../docs/src/theory/"
PAGE = "error-against-run-time"
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
COSTS = ("seconds", "seconds_with_python", "evaluations", "factorisations")
TARGET = 1e-7  # error / clearance at which times are compared
LEVELS = (1e-3, 1e-5, 1e-7, 1e-9)
SERIES, AUTO = "project, series", "project, auto"
# Claim: on B1 the series reaches TARGET this many times as fast as the faster solver of each peer.
CLAIMS = (("ivp", 2), ("CVODE", 10), ("SciPy", 100))
LANES, BATCHES = "project, lanes", ("heyoka, batch of 4", "heyoka, batch of 8")
# Claims: a run by lanes takes at most this of one in heyoka's best batch, and so much of one alone.
OF_BATCH, OF_SERIES = 0.5, 1 / 1.8
PLOTTED = ("B1", "B2", "B3c")
NO_BREAK = "\u00a0"  # between number and unit, where a narrow column must not break


# ---------------------------------------------------------------------------------------- numbers


def short(value):
    """Two digits, without an exponent."""
    return f"{float(f'{value:.2g}'):g}"


def power(value, digits=0):
    """Like 3e-7."""
    mantissa, exponent = f"{value:.{digits}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def clearances(error):
    return f"{power(error)}{NO_BREAK}δ"


def seconds(value):
    for factor, unit in ((1, "s"), (1e3, "ms")):
        if value * factor >= 1:
            break
    return f"{short(value * factor)}{NO_BREAK}{unit}"


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


# ----------------------------------------------------------------------------------- measurements


def read(paths):
    for path in paths:
        with open(path) as lines:
            yield from map(json.loads, lines)


def to(runs, target):
    """What it takes to reach an error: log-log between the two tolerances where it is first
    reached. `how` tells whether that is only a bound: "<" if the loosest tolerance is already
    better, ">" if the tightest is not good enough. None for a solver that never succeeds."""
    before = None
    for run in sorted(runs, key=lambda r: -r["rtol"]):
        if run["error"] <= target:
            if before is None:
                return run | {"how": "<"}
            share = math.log(before["error"] / target)
            share /= math.log(before["error"] / max(run["error"], 1e-16))
            between = {
                key: before[key] * (run[key] / before[key]) ** share if before[key] else run[key]
                for key in COSTS
                if key in run
            }
            return run | between | {"how": ""}
        before = run
    return before and before | {"how": ">"}


def apart(ends, others):
    """Distances of the ends of two batches in clearances, and in how many runs the changes of mode differ."""
    pairs = list(zip(ends, others, strict=True))
    distances = [math.dist(a[:2], b[:2]) / CLEARANCE for a, b in pairs]
    return distances, sum(a[2] != b[2] for a, b in pairs)


class Results:
    def __init__(self, records):
        self.runs = [r for r in records if "problem" in r]
        self.sweeps = [r for r in records if "sweep" in r]
        self.batches = [r for r in records if "batch" in r]
        starts = {r["references"]: r["starts"] for r in records if "references" in r}
        for batch in self.batches:
            # Of each start that has one.
            references = {f"{speed:.6f}": end for speed, *end in starts[batch["batch"]]}
            known = [references.get(f"{0.05 + 1e-3 * i:.6f}") for i in range(len(batch["ends"]))]
            pairs = [(e, k) for e, k in zip(batch["ends"], known, strict=True) if k]
            distances, batch["other_changes"] = apart(*zip(*pairs))
            batch["error"] = statistics.median(distances)
        self.left_out = {r["references"]: r["left_out"] for r in records if "references" in r}
        self.problems = list(dict.fromkeys(r["problem"] for r in self.runs))
        self.solvers = [s for s in dict.fromkeys(r["solver"] for r in self.runs) if s != AUTO]
        self.solvers.sort(key=list(STYLES).index)
        references = dict(REFERENCES)
        for run in self.of(None, FINEST):
            if run["rtol"] == 1e-12:
                references.setdefault(run["problem"], (run["x"], run["y"]))
        for run in self.runs:
            if "x" in run:
                x, y = references[run["problem"]]
                run["error"] = math.hypot(run["x"] - x, run["y"] - y) / CLEARANCE

    def of(self, problem, solver):
        """Runs that ended without an error."""
        return [
            r
            for r in self.runs
            if problem in (None, r["problem"]) and r["solver"] == solver and "x" in r
        ]

    def many(self, problem, solver, rtol=None):
        """Batches of a solver, at one tolerance or all."""
        found = [r for r in self.batches if (r["batch"], r["solver"]) == (problem, solver)]
        return [r for r in found if rtol in (None, r["rtol"])]

    def at(self, problem, solver, rtol):
        return next((r for r in self.of(problem, solver) if r["rtol"] == rtol), None)

    def to(self, problem, solver, target):
        return to(self.of(problem, solver), target)

    def best(self, problem, target, solvers, key):
        """The solver that reaches an error with least, or None."""
        found = [self.to(problem, s, target) for s in solvers]
        found = [f for f in found if f and f["how"] != ">"]
        return min(found, key=lambda f: f[key], default=None)


def is_project(solver):
    return solver.startswith("project")


def peers(results):
    return [s for s in results.solvers if not is_project(s)]


# ------------------------------------------------------------------------------- parts of the page


def choice(results, rtol):
    """Error and time on each problem at a tolerance, as cells of a table."""
    runs = [results.at(problem, AUTO, float(rtol)) for problem in results.problems]
    return " | ".join(
        f"{clearances(r['error'])}, {seconds(r['seconds'])}" if r else "fails" for r in runs
    )


def worst_factor(results):
    """Largest error by tolerance, above what round-off leaves."""
    return max(r["error"] / r["rtol"] for r in results.of(None, AUTO) if r["rtol"] > 1e-12)


def losses(results):
    """Where a peer reaches an error sooner than the method that a user gets."""
    rows = []
    for problem in results.problems:
        for level in LEVELS:
            peer = results.best(problem, level, peers(results), "seconds")
            own = results.best(problem, level, [AUTO], "seconds")
            if not peer or (own and own["seconds"] <= peer["seconds"]):
                continue
            cells = [
                f"{f['how']}{seconds(f['seconds'])}" if f else "not reached" for f in (peer, own)
            ]
            cells[0] = f"{peer['solver']}, {cells[0]}"
            ratio = f"{own['seconds'] / peer['seconds']:.1f}" if own else "–"
            rows.append([problem, clearances(level), *cells, ratio])
    if not rows:
        return "None of the peers that took part."
    header = ["problem", "error", "fastest peer", "project (`auto`)", "peer faster by"]
    return table(header, rows)


def time_table(results):
    rows = []
    for solver in results.solvers:
        row = [f"**{solver}**" if is_project(solver) else solver]
        for problem in results.problems:
            found, base = (results.to(problem, s, TARGET) for s in (solver, SERIES))
            if not any(r["problem"] == problem and r["solver"] == solver for r in results.runs):
                row.append("not run")
            elif not found:
                row.append("fails")
            else:
                ratio = short(found["seconds"] / base["seconds"])
                value = seconds(found["seconds"]) if solver == SERIES else ratio
                row.append(found["how"] + value)
        rows.append(row)
    return table(["solver", *results.problems], rows)


def many_rows(results):
    """Of each problem at each tolerance, and to an error: each solver, and heyoka's best batch."""
    for problem in dict.fromkeys(r["batch"] for r in results.batches):
        for rtol in (*sorted({r["rtol"] for r in results.batches}, reverse=True), None):

            def of(solver, problem=problem, rtol=rtol):
                runs = results.many(problem, solver, rtol)
                return to(runs, TARGET) if rtol is None else runs[0]

            best = min(map(of, BATCHES), key=lambda r: r["seconds"])
            yield problem, rtol, of(SERIES), of(LANES), of("heyoka"), best


def many_table(results):
    rows = []
    for problem, rtol, series, lanes, alone, best in many_rows(results):
        times = [f"{r.get('how', '')}{short(1e3 * r['seconds'])}" for r in (series, lanes, alone, best)]
        ratio = f"{lanes['seconds'] / best['seconds']:.2f}"
        with_python = f"{lanes['seconds'] / best['seconds_with_python']:.2f}"
        if rtol:
            label, *errors = power(rtol), *(clearances(r["error"]) for r in (lanes, best))
        else:
            label, errors = f"to {clearances(TARGET)}", ["", ""]
        rows.append([problem, label, *times, f"{ratio} ({with_python})", *errors])
    header = ["problem", "`rtol`", "project, one by one", "**lanes**"]
    header += ["heyoka, one by one", "heyoka, best batch", "lanes / batch", "error, lanes", "error, heyoka"]
    return table(header, rows)


def many_agree(results, solvers, alone):
    """How far runs at once and runs one by one end apart."""
    batches = [r for r in results.batches if r["solver"] in solvers]
    found = [
        apart(r["ends"], results.many(r["batch"], alone, r["rtol"])[0]["ends"]) for r in batches
    ]
    worst, others = max(max(d) for d, _ in found), sum(n for _, n in found)
    return f"{others} of {sum(len(d) for d, _ in found)} runs, {clearances(worst)}"


def lanes_off(results, rtol):
    """Errors by lanes at the start speed of the single runs, against their references."""
    at = round((0.3 - 0.05) / 1e-3)
    found = []
    for problem in ("B1", "B2"):
        end = results.many(problem, LANES, float(rtol))[0]["ends"][at]
        error = math.dist(end[:2], REFERENCES[problem]) / CLEARANCE
        found.append(f"{clearances(error)} on {problem}")
    return " and ".join(found)


def many_claims(results):
    spread = lambda ratios: f"{short(min(ratios))} to {short(max(ratios))}"
    *_, series, lanes, _, best = zip(*many_rows(results))
    of_batch, with_python, of_series = (
        [a["seconds"] / b[key] for a, b in zip(lanes, others)]
        for others, key in ((best, "seconds"), (best, "seconds_with_python"), (series, "seconds"))
    )
    claim = f"B1 and B2, a run by lanes: at most {OF_BATCH} of the time in heyoka's best batch"
    measured = f"{spread(of_batch)}; {spread(with_python)} with what Python does for heyoka"
    yield claim, measured, max(of_batch) <= OF_BATCH
    claim = f"B1 and B2, a run by lanes: at least {short(1 / OF_SERIES)} times as fast as alone"
    yield claim, f"{spread([1 / r for r in of_series])} times", max(of_series) <= OF_SERIES


def wrong_runs(results):
    """On the problems themselves, by solver and tolerance."""
    tolerances = sorted({s["rtol"] for s in results.sweeps}, reverse=True)
    rows = []
    for problem in results.problems:
        here = [s for s in results.sweeps if s["sweep"] == problem]
        for solver in results.solvers:
            by_rtol = {s["rtol"]: s for s in here if s["solver"] == solver}
            if not by_rtol:
                continue
            row = [problem, solver]
            for rtol in tolerances:
                s = by_rtol.get(rtol)
                failed = f", {s['failed']} failed" if s and s["failed"] else ""
                other = f" ({s['other_changes']})" if s and s["other_changes"] else ""
                row.append(f"{s['wrong']}{other}{failed}" if s else "not run")
            rows.append(row)
    return table(["problem", "solver", *map(power, tolerances)], rows)


def variants(results):
    """Silently wrong runs of the series on variants of the problems, over all tolerances."""
    found = [s for s in results.sweeps if s["sweep"] not in results.problems]
    found = [s for s in found if s["solver"] == SERIES]
    wrong, runs = (sum(s[key] for s in found) for key in ("wrong", "runs"))
    return f"{wrong} of {runs} runs are wrong, over all tolerances"


def verdicts(results):
    """Claim, what was measured, met or not."""
    found = []
    base = results.to("B1", SERIES, TARGET)
    for peer, factor in CLAIMS:
        solvers = [s for s in peers(results) if s.startswith(peer)]
        best = results.best("B1", TARGET, solvers, "seconds")
        claim = f"B1 to {power(TARGET)} δ: at least {factor} times as fast as {peer}"
        if best:
            ratio = best["seconds"] / base["seconds"]
            found.append((claim, f"{short(ratio)} times ({best['solver']})", ratio >= factor))
        else:
            bound = min(results.to("B1", s, TARGET)["seconds"] for s in solvers) / base["seconds"]
            found.append(
                (claim, f"{peer} does not reach it in {short(bound)} times the time", bound >= factor)
            )
    tight = [s for s in results.sweeps if s["solver"] == SERIES and s["rtol"] <= 1e-6]
    wrong, failed, runs = (sum(s[key] for s in tight) for key in ("wrong", "failed", "runs"))
    claim = "no silently wrong run of the project's series at 1e-6 and below"
    found.append((claim, f"{wrong} of {runs}, {failed} failed with an error", wrong == 0))
    return [*found, *many_claims(results)]


def b3c_uncertainty(results):
    series = results.at("B3c", SERIES, 1e-12)
    return clearances(series["error"]) if series else "(series fails)"


# ------------------------------------------------------------------------------------ the machine


def first_line(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0]


def content(path):
    with open(path) as file:
        return file.read()


def found_in(path, pattern):
    match = re.search(pattern, content(path), re.MULTILINE)
    return match[1].strip() if match else "unknown"


def machine():
    lock = lambda crate: found_in("Cargo.lock", rf'name = "{crate}"\nversion = "(.*)"')
    sundials = found_in("/usr/include/sundials/sundials_config.h", r'SUNDIALS_VERSION "(.*)"')
    python = " ".join(f"{p} {importlib.metadata.version(p)}" for p in ("heyoka", "scipy", "numpy"))
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
        "cpu": found_in("/proc/cpuinfo", r"^model name\s*:(.*)$"),
        "cores": os.cpu_count(),
        "load": " and ".join(content("out/load").split()),
        "compilers": f"{first_line('rustc', '--version')}; {first_line('cc', '--version')}",
        "libraries": f"SUNDIALS {sundials}, ivp {lock('ivp')}, diffsol {lock('diffsol')}, "
        f"{python.replace(' scipy', ', scipy').replace(' numpy', ', numpy')}, Python {platform.python_version()}",
    }


# ------------------------------------------------------------------------------------------- plots

# Colour, marker, dashes; all on white, told apart without colour too.
STYLES = {
    "project, series": ("#08306b", "circle", ""),
    "project, collocation": ("#008080", "diamond", ""),
    "ivp DOP853": ("#d62728", "triangle", ""),
    "CVODE Adams": ("#e08214", "square", "6 3"),
    "CVODE BDF": ("#8c510a", "circle", "6 3"),
    "heyoka": ("#2ca02c", "diamond", ""),
    "diffsol tsit45": ("#df65b0", "triangle", "2 3"),
    "diffsol BDF": ("#7a0177", "diamond", "2 3"),
    "SciPy DOP853": ("#7f7f7f", "square", "8 3 2 3"),
    "SciPy Radau": ("#252525", "diamond", "8 3 2 3"),
}
SIZE = (820, 500)
FRAME = (70, 40, 620, 440)  # left, top, right, bottom
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def marker(shape, x, y, colour):
    if shape == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>'
    offsets = {
        "square": ((-3, -3), (3, -3), (3, 3), (-3, 3)),
        "diamond": ((0, -4.5), (4.5, 0), (0, 4.5), (-4.5, 0)),
        "triangle": ((0, -4.5), (4.2, 3), (-4.2, 3)),
    }[shape]
    points = " ".join(f"{x + dx:.1f},{y + dy:.1f}" for dx, dy in offsets)
    return f'<polygon points="{points}" fill="{colour}"/>'


def text(x, y, words, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{extra}>{words}</text>'


def line(x1, y1, x2, y2, colour, width=1):
    place = f'x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"'
    return f'<line {place} stroke="{colour}" stroke-width="{width}"/>'


def decades(values):
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return low, max(high, low + 1)


def plot(results, problem):
    curves = {s: [r for r in results.of(problem, s) if r["error"] > 0] for s in results.solvers}
    curves = {s: runs for s, runs in curves.items() if runs}
    every = [r for runs in curves.values() for r in runs]
    (x0, x1), (y0, y1) = (decades([r[key] for r in every]) for key in ("seconds", "error"))
    left, top, right, bottom = FRAME
    at_x = lambda value: left + (right - left) * (math.log10(value) - x0) / (x1 - x0)
    at_y = lambda value: bottom - (bottom - top) * (math.log10(value) - y0) / (y1 - y0)
    width, height = SIZE
    area = f'width="{width}" height="{height}"'
    font = 'font-family="sans-serif" font-size="12" fill="#222222"'
    heading = f"{problem}: error at the end against run time"
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {area} viewBox="0 0 {width} {height}" role="img" {font}>',
        f"<title>{heading}</title>",
        f'<rect {area} fill="#ffffff"/>',
        text(left, top - 16, heading, "start", ' font-size="15"'),
    ]
    for exponent in range(x0, x1 + 1):
        x = at_x(10.0**exponent)
        if exponent < x1:
            for digit in range(2, 10):
                minor = at_x(digit * 10.0**exponent)
                parts.append(line(minor, top, minor, bottom, "#f0f0f0"))
        parts.append(line(x, top, x, bottom, "#c8c8c8"))
        parts.append(text(x, bottom + 18, f"10{str(exponent).translate(SUPERSCRIPT)}"))
    for exponent in range(y0, y1 + 1):
        y = at_y(10.0**exponent)
        labelled = exponent % 2 == 0
        parts.append(line(left, y, right, y, "#c8c8c8" if labelled else "#e8e8e8"))
        if labelled:
            parts.append(text(left - 8, y + 4, f"10{str(exponent).translate(SUPERSCRIPT)}", "end"))
    frame = f'x="{left}" y="{top}" width="{right - left}" height="{bottom - top}"'
    parts.append(f'<rect {frame} fill="none" stroke="#555555"/>')
    parts.append(text((left + right) / 2, bottom + 42, "run time [s]"))
    middle = (top + bottom) / 2
    turned = f' transform="rotate(-90 20 {middle:.1f})"'
    parts.append(text(20, middle, "error [clearances δ]", extra=turned))
    for i, (solver, runs) in enumerate(curves.items()):
        colour, shape, dashes = STYLES[solver]
        stroke = f'fill="none" stroke="{colour}" stroke-width="{2.6 if is_project(solver) else 1.5}"'
        stroke += f' stroke-dasharray="{dashes}"' if dashes else ""
        spots = [(at_x(r["seconds"]), at_y(r["error"])) for r in runs]
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in spots)
        parts.append(f"<g><title>{solver}</title>")
        parts.append(f'<polyline points="{points}" {stroke}/>')
        parts += [marker(shape, x, y, colour) for x, y in spots]
        y = top + 10 + 22 * i
        parts.append(f'<polyline points="{right + 16},{y} {right + 52},{y}" {stroke}/>')
        parts.append(marker(shape, right + 34, y, colour))
        parts.append(text(right + 60, y + 4, solver, "start") + "</g>")
    return "\n".join([*parts, "</svg>", ""])


# -------------------------------------------------------------------------------------------- main


def page(results, claims):
    values = {
        "worst_factor": short(worst_factor(results)),
        "losses": losses(results),
        "target": clearances(TARGET),
        "times": time_table(results),
        "wrong_runs": wrong_runs(results),
        "many": many_table(results),
        "lanes_agree": many_agree(results, [LANES], SERIES),
        "batches_agree": many_agree(results, BATCHES, "heyoka"),
        "b3c_uncertainty": b3c_uncertainty(results),
        "left_out": str(sum(map(len, results.left_out.values()))),
        "variants": variants(results),
        "verdicts": table(
            ["claim", "measured", "met"], [[c, m, "yes" if met else "**no**"] for c, m, met in claims]
        ),
        **{key: str(value) for key, value in machine().items()},
    }

    def value(match):
        name, *argument = match[1].split()
        if name == "choice":
            return choice(results, *argument)
        if name == "lanes_off":
            return lanes_off(results, *argument)
        if name == "changes":
            return str(results.at(*argument, SERIES, 1e-12)["changes"])
        return values[name]

    return re.sub(r"\{\{(.*?)\}\}", value, content("page.md"))


def beside_others(results):
    """The paragraph of the comparison with other tools."""

    def ratio(problem, solver):
        found, base = (results.to(problem, s, TARGET) for s in (solver, SERIES))
        reached = found and found["how"] != ">"
        return found["seconds"] / base["seconds"] if reached else None

    heyoka = [short(ratio(problem, "heyoka")) for problem in ("B1", "B2")]
    others = [ratio(p, s) for p in ("B1", "B2") for s in peers(results) if s != "heyoka"]
    others = [r for r in others if r]
    *_, lanes, _, best = zip(*many_rows(results))
    of_batch = [a["seconds"] / b["seconds"] for a, b in zip(lanes, best)]
    page = f"theory/{PAGE}.md"
    return (
        f"To an error of {power(TARGET)} clearances on the two problems with a rigid wall, [heyoka](https://github.com/bluescarni/heyoka), "
        f"which also computes Taylor series, needs {heyoka[0]} and [{heyoka[1]} times]({page}#where-the-project-is-slower) the project's time; "
        f"the other solvers that get there need {short(min(others))} to {short(max(others))} times it ([table]({page})). "
        f"Many runs at once, by lanes, take [{short(min(of_batch))} to {short(max(of_batch))}]({page}#many-runs-at-once) of the time of heyoka's batches."
    )


def put(path, words):
    """Between the marks of a page."""
    begin, end = "<!-- written by tests/peers/run -->", "<!-- end -->"
    before, rest = content(path).split(begin)
    _, after = rest.split(end)
    with open(path, "w") as out:
        out.write(f"{before}{begin}\n{words}\n{end}{after}")


def main():
    results = Results(list(read(sys.argv[1:])))
    claims = verdicts(results)
    with open("result.json", "w") as out:
        record = {
            "machine": machine(),
            "runs": results.runs,
            "sweeps": results.sweeps,
            "batches": [{k: v for k, v in b.items() if k != "ends"} for b in results.batches],
            "left_out": results.left_out,
            "claims": [dict(zip(("claim", "measured", "met"), c)) for c in claims],
        }
        json.dump(record, out, indent=1)
        out.write("\n")
    for problem in PLOTTED:
        with open(f"{BOOK}{PAGE}-{problem.lower()}.svg", "w") as out:
            out.write(plot(results, problem))
    with open(f"{BOOK}{PAGE}.md", "w") as out:
        out.write(page(results, claims))
    put("../../docs/src/comparison.md", beside_others(results))
    for claim, measured, met in claims:
        print(f"{'met    ' if met else 'NOT MET'}  {claim}: {measured}")


if __name__ == "__main__":
    main()
