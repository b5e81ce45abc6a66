"""SciPy's DOP853 and Radau on the problems of src/problem.rs; one JSON object per measurement.

Usage: scipy_peers.py times
       scipy_peers.py sweep REFERENCES.jsonl   (of `peers sweep soft`: starts and references)
"""

import json
import math
import multiprocessing
import sys
import time
import warnings

import numpy as np
from scipy.integrate import solve_ivp

FLIGHT, SLIP_POSITIVE, SLIP_NEGATIVE, ROLL = range(4)
SIGN = {SLIP_POSITIVE: 1.0, SLIP_NEGATIVE: -1.0}
NO_SPEED = 1e-12  # m/s
ARMED = 1e-9  # see `ARMED` in src/problem.rs
TOO_MANY = 10_000


class Problem:
    """Equations, guards and changes of mode, on plain floats: faster than arrays of two."""

    m, k, d = 10.0, 4e5, 200.0
    clearance, mu, spin, radius, eccentricity = 3e-4, 0.3, 400.0, 2.5e-3, 1e-5

    def __init__(self, k_c, d_c=None, m_s=0.0, start_speed=0.3, t_end=0.2):
        self.k_c = k_c
        self.d_c = 0.1 * math.sqrt(k_c * self.m) if d_c is None else d_c
        self.m_s, self.k_s, self.d_s = m_s, 2e7, 3000.0
        self.start_speed, self.t_end = start_speed, t_end
        self.mobility = 1 / self.m + (1 / m_s if m_s else 0.0)
        self.evaluations = 0

    def start(self):
        y = np.zeros(8 if self.m_s else 4)
        y[2] = self.start_speed
        return y

    def relative(self, y):
        if self.m_s:
            return y[0] - y[4], y[1] - y[5], y[2] - y[6], y[3] - y[7]
        return y[0], y[1], y[2], y[3]

    def contact(self, y):
        """Distance, normal, normal and whirl speed, normal force; the tangent is (-ny, nx)."""
        ux, uy, wx, wy = self.relative(y)
        distance = math.hypot(ux, uy)
        nx, ny = (ux / distance, uy / distance) if distance else (1.0, 0.0)
        normal_speed, whirl_speed = wx * nx + wy * ny, wy * nx - wx * ny
        force = self.k_c * (distance - self.clearance) + self.d_c * normal_speed
        return distance, nx, ny, normal_speed, whirl_speed, force

    def linear(self, y):
        """Accelerations of rotor and stator by springs and dampers to ground."""
        rotor = [-(self.k * y[i] + self.d * y[i + 2]) / self.m for i in (0, 1)]
        if not self.m_s:
            return rotor, [0.0, 0.0]
        return rotor, [-(self.k_s * y[i] + self.d_s * y[i + 2]) / self.m_s for i in (4, 5)]

    def free(self, t, y):
        """The same with the unbalance."""
        rotor, stator = self.linear(y)
        unbalance = self.eccentricity * self.spin**2
        rotor[0] += unbalance * math.cos(self.spin * t)
        rotor[1] += unbalance * math.sin(self.spin * t)
        return rotor, stator

    def rolling_force(self, t, y, c):
        (ax, ay), (bx, by) = self.free(t, y)
        distance, nx, ny, normal_speed, whirl_speed, _ = c
        across = (ay - by) * nx - (ax - bx) * ny
        return -(across - normal_speed * whirl_speed / distance) / self.mobility

    def assemble(self, y, rotor, stator, fx, fy):
        out = [y[2], y[3], rotor[0] + fx / self.m, rotor[1] + fy / self.m]
        if self.m_s:
            out += [y[6], y[7], stator[0] - fx / self.m_s, stator[1] - fy / self.m_s]
        return out

    def rhs(self, mode, t, y):
        self.evaluations += 1
        y = y.tolist()
        rotor, stator = self.free(t, y)
        if mode == FLIGHT:
            return self.assemble(y, rotor, stator, 0.0, 0.0)
        c = self.contact(y)
        _, nx, ny, _, _, force = c
        tangential = self.rolling_force(t, y, c) if mode == ROLL else -SIGN[mode] * self.mu * force
        fx, fy = -force * nx - tangential * ny, -force * ny + tangential * nx
        return self.assemble(y, rotor, stator, fx, fy)

    def jacobian(self, mode, t, y):
        self.evaluations += 1
        y = y.tolist()
        return np.array([self.tangent(mode, t, y, v) for v in np.eye(len(y)).tolist()]).T

    def tangent(self, mode, t, y, v):
        rotor, stator = self.linear(v)
        if mode == FLIGHT:
            return self.assemble(v, rotor, stator, 0.0, 0.0)
        c = self.contact(y)
        distance, nx, ny, normal_speed, whirl_speed, force = c
        dux, duy, dwx, dwy = self.relative(v)
        stretch, turn = dux * nx + duy * ny, (duy * nx - dux * ny) / distance
        d_normal = dwx * nx + dwy * ny + whirl_speed * turn
        d_whirl = dwy * nx - dwx * ny - normal_speed * turn
        d_force = self.k_c * stretch + self.d_c * d_normal
        if mode == ROLL:
            (ax, ay), (bx, by) = self.free(t, y)
            product = d_normal * whirl_speed + normal_speed * d_whirl
            product -= normal_speed * whirl_speed * stretch / distance
            base = (rotor[1] - stator[1]) * nx - (rotor[0] - stator[0]) * ny
            base -= turn * ((ax - bx) * nx + (ay - by) * ny) + product / distance
            f, df = self.rolling_force(t, y, c), -base / self.mobility
        else:
            by_force = -SIGN[mode] * self.mu
            f, df = by_force * force, by_force * d_force
        along_t, along_n = df - force * turn, d_force + f * turn
        fx, fy = -along_t * ny - along_n * nx, along_t * nx - along_n * ny
        return self.assemble(v, rotor, stator, fx, fy)

    def guards(self, mode, since):
        """Event functions of a mode that began at `since`."""
        scale = self.k_c * self.clearance

        def guard(value):
            def event(t, y):
                y = y.tolist()
                g = value(t, y, self.contact(y))
                return max(g, ARMED) if t == since else g

            event.terminal, event.direction = True, -1
            return event

        if mode == FLIGHT:
            return [guard(lambda t, y, c: -min(c[5] / scale, c[0] / self.clearance - 1))]
        force = guard(lambda t, y, c: c[5] / scale)
        if mode == ROLL:
            edge = lambda sign: guard(
                lambda t, y, c: (self.mu * c[5] + sign * self.rolling_force(t, y, c)) / scale
            )
            return [force, edge(-1.0), edge(1.0)]
        surface = self.spin * self.radius
        return [force, guard(lambda t, y, c: SIGN[mode] * (surface + c[4]) / surface)]

    def next(self, mode, guard, t, y):
        """The mode after a guard has fallen; takes out what is left of a speed that stops."""
        _, nx, ny, _, whirl_speed, _ = self.contact(y)
        speed = self.spin * self.radius + whirl_speed
        if mode != FLIGHT and guard == 0:
            return FLIGHT
        if mode == FLIGHT and abs(speed) > NO_SPEED:
            return SLIP_POSITIVE if speed > 0 else SLIP_NEGATIVE
        impulse = -speed / self.mobility
        tangent = np.array([-ny, nx])
        y[2:4] += impulse / self.m * tangent
        if self.m_s:
            y[6:8] -= impulse / self.m_s * tangent
        c = self.contact(y)
        needed = self.rolling_force(t, y, c)
        if mode != ROLL and abs(needed) <= self.mu * c[5]:
            return ROLL
        return SLIP_NEGATIVE if needed > 0 else SLIP_POSITIVE


def ride(problem, method, rtol):
    """From mode to mode to the end: x, y, changes, evaluations, factorisations."""
    mode, t, y, changes, factorisations = FLIGHT, 0.0, problem.start(), 0, 0
    problem.evaluations = 0
    scales = np.tile([problem.clearance] * 2 + [problem.start_speed] * 2, len(y) // 4)
    while t < problem.t_end:
        extra = {"jac": lambda t, y: problem.jacobian(mode, t, y)} if method == "Radau" else {}
        solution = solve_ivp(
            lambda t, y: problem.rhs(mode, t, y),
            (t, problem.t_end),
            y,
            method=method,
            rtol=rtol,
            atol=rtol * scales,
            events=problem.guards(mode, t),
            **extra,
        )
        if solution.status < 0:
            raise RuntimeError(solution.message)
        factorisations += solution.nlu
        t, y = solution.t[-1], solution.y[:, -1].copy()
        if solution.status == 0:
            break
        changes += 1
        if changes > TOO_MANY:
            raise RuntimeError("chatters")
        guard = next(i for i, times in enumerate(solution.t_events) if len(times))
        mode = problem.next(mode, guard, t, y)
    return y[0], y[1], changes, problem.evaluations, factorisations


def measure(name, problem, method, tolerances, repetitions):
    for rtol in tolerances:
        best = math.inf
        record = {"problem": name, "solver": f"SciPy {method}", "rtol": rtol}
        for i in range(repetitions):
            start = time.process_time()
            try:
                x, y, changes, evaluations, factorisations = ride(problem, method, rtol)
            except RuntimeError as error:
                record["failed"] = str(error)
                break
            finally:
                best = min(best, time.process_time() - start)
            record |= {"x": x, "y": y, "changes": changes}
            record |= {"evaluations": evaluations, "factorisations": factorisations}
        record |= {"seconds": best, "repetitions": i + 1}
        print(json.dumps(record), flush=True)
    print(f"  {name} by SciPy {method}", file=sys.stderr)


def times():
    tolerances = [float(f"1e-{digits}") for digits in range(4, 13)]
    for name, k_c in (("B1", 1e8), ("B2", 1e10)):
        measure(name, Problem(k_c), "DOP853", tolerances, 3)
        measure(name, Problem(k_c), "Radau", tolerances[:5], 1)
    for name, m_s, d_c in (("B3a", 1.0, 2e4), ("B3b", 1.0, 2e6), ("B3c", 0.1, 2e6)):
        problem = Problem(1e10, d_c, m_s, t_end=0.02)
        measure(name, problem, "Radau", tolerances[:6], 1)


def judge(task):
    """Whether a run of B1 is "right", has "other_changes" or an "other_end", or "failed"."""
    (speed, x_ref, y_ref, changes_ref), rtol = task
    problem = Problem(1e8, start_speed=speed)
    try:
        x, y, changes, _, _ = ride(problem, "DOP853", rtol)
    except RuntimeError:
        return "failed"
    off = math.hypot(x - x_ref, y - y_ref) / problem.clearance
    if changes != changes_ref:
        return "other_changes"
    return "right" if off < 0.5 else "other_end"


def sweep(path):
    """B1, DOP853 and every second start only: all of it would need hours."""
    with open(path) as lines:
        records = map(json.loads, lines)
        starts = next(r["starts"] for r in records if r.get("references") == "B1")[::2]
    with multiprocessing.Pool() as pool:
        for rtol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
            found = pool.map(judge, [(start, rtol) for start in starts], chunksize=1)
            record = {"sweep": "B1", "solver": "SciPy DOP853", "rtol": rtol, "runs": len(starts)}
            record |= {what: found.count(what) for what in ("other_changes", "failed")}
            record["wrong"] = found.count("other_changes") + found.count("other_end")
            print(json.dumps(record), flush=True)
            print(f"  sweep B1 by SciPy at {rtol:g}", file=sys.stderr)


def main():
    # SciPy warns that it raises rtol below 100 times the rounding error: never reached here.
    warnings.simplefilter("ignore")
    match sys.argv[1:]:
        case ["times"]:
            times()
        case ["sweep", path]:
            sweep(path)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
