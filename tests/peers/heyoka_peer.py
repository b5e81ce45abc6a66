"""heyoka's Taylor integrator on B1 and B2 of src/problem.rs; one JSON object per measurement.

Usage: heyoka_peer.py              one run, from mode to mode
       heyoka_peer.py batch PEERS  many starts, in turns with the project's own (PEERS is the native program)

Equations and events are compiled once for each tolerance, which is not counted. What of the wall is dented after lift-off is a
mode of its own here, since an event is one function and not a minimum.
"""

import json
import math
import subprocess
import sys
import time

import heyoka as hy
import numpy as np

FLIGHT, BEYOND, SLIP_POSITIVE, SLIP_NEGATIVE, ROLL, IDLE = range(6)
SIGN = {SLIP_POSITIVE: 1.0, SLIP_NEGATIVE: -1.0}
M, K, D = 10.0, 4e5, 200.0
CLEARANCE, MU, SPIN, RADIUS, ECCENTRICITY = 3e-4, 0.3, 400.0, 2.5e-3, 1e-5
START_SPEED, T_END = 0.3, 0.2
# Those of the sweeps in src/main.rs.
START_SPEEDS = [0.05 + 0.399 * i / 399 for i in range(400)]
ROUNDS = 10
SURFACE = SPIN * RADIUS
ARMED = 1e-12
FALLING, RISING = hy.event_direction.negative, hy.event_direction.positive

# Parameters of a batch in each mode, factors of: contact, friction, the force that rolling needs, softening of the distance; gap,
# force and 1 in the first event; force, sliding speed and needed force in the second; force, needed force and 1 in the third.
# All events fall.
FACTORS = {
    FLIGHT: (0, 0, 0, 1, -1, 0, ARMED * CLEARANCE**2, 0, 0, 0, 0, 0, 1),
    BEYOND: (0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 1),
    ROLL: (1, 0, 1, 0, 0, 1, 0, MU, 0, -1, MU, 1, 0),
    SLIP_POSITIVE: (1, -MU, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1),
    SLIP_NEGATIVE: (1, MU, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1),
    # Nothing is left to do: flight without an end.
    IDLE: (0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1),
}


class Equations:
    """Expressions of the state in contact with the wall."""

    def __init__(self, k_c, now=hy.time, softening=0.0):
        self.state = hy.make_vars("x", "y", "vx", "vy")
        x, y, vx, vy = self.state
        square = x * x + y * y
        distance = hy.sqrt(square + softening)
        nx, ny = self.normal = x / distance, y / distance
        normal_speed, whirl_speed = vx * nx + vy * ny, vy * nx - vx * ny
        unbalance = ECCENTRICITY * SPIN * SPIN
        ax = -(K * x + D * vx) / M + unbalance * hy.cos(SPIN * now)
        ay = -(K * y + D * vy) / M + unbalance * hy.sin(SPIN * now)
        self.free = ax, ay
        # The square of the distance is smooth in the middle, where a rotor starts.
        self.gap = square - CLEARANCE**2
        self.force = k_c * (distance - CLEARANCE) + damping(k_c) * normal_speed
        self.speed = SURFACE + whirl_speed
        self.needed = -M * (ay * nx - ax * ny - normal_speed * whirl_speed / distance)

    def system(self, pressing, tangential):
        """The equations under forces of the wall along its normal and its tangent."""
        (nx, ny), (ax, ay), (x, y, vx, vy) = self.normal, self.free, self.state
        fx, fy = -pressing * nx - tangential * ny, -pressing * ny + tangential * nx
        return [(x, vx), (y, vy), (vx, ax + fx / M), (vy, ay + fy / M)]


def damping(k_c):
    return 0.1 * math.sqrt(k_c * M)


class Modes:
    """What follows on what."""

    def __init__(self, k_c):
        self.k_c, self.d_c = k_c, damping(k_c)

    def contact(self, state, t):
        """Depth, normal force, sliding speed, tangential force that rolling needs, tangent."""
        x, y, vx, vy = state
        distance = math.hypot(x, y)
        nx, ny = x / distance, y / distance
        normal_speed, whirl_speed = vx * nx + vy * ny, vy * nx - vx * ny
        force = self.k_c * (distance - CLEARANCE) + self.d_c * normal_speed
        unbalance = ECCENTRICITY * SPIN * SPIN
        ax = -(K * x + D * vx) / M + unbalance * math.cos(SPIN * t)
        ay = -(K * y + D * vy) / M + unbalance * math.sin(SPIN * t)
        needed = -M * (ay * nx - ax * ny - normal_speed * whirl_speed / distance)
        return distance - CLEARANCE, force, SURFACE + whirl_speed, needed, (-ny, nx)

    def next(self, mode, event, state, t):
        """The mode after an event; takes out what is left of a speed that stops."""
        depth, force, speed, needed, (tx, ty) = self.contact(state, t)
        if mode == BEYOND and event == 0:
            return FLIGHT
        if mode in (FLIGHT, BEYOND):
            return SLIP_POSITIVE if speed > 0 else SLIP_NEGATIVE
        if event == 0:
            return BEYOND if depth > 0 else FLIGHT
        state[2] -= speed * tx
        state[3] -= speed * ty
        _, force, _, needed, _ = self.contact(state, t)
        if mode != ROLL and abs(needed) <= MU * force:
            return ROLL
        return SLIP_NEGATIVE if needed > 0 else SLIP_POSITIVE


class Peer(Modes):
    """One integrator for each mode."""

    def __init__(self, k_c, tol):
        super().__init__(k_c)
        self.inside = 0.0
        e = Equations(k_c)

        def integrator(pressing, tangential, events):
            terminal = [hy.t_event(g, direction=direction) for g, direction in events]
            system = e.system(pressing, tangential)
            return hy.taylor_adaptive(system, [0.0, 0.0, START_SPEED, 0.0], tol=tol, t_events=terminal)

        def contact(tangential, events):
            return integrator(e.force, tangential, [(e.force, FALLING), *events])

        self.modes = {
            # Armed a rounding error outside: a root where the mode begins would hide the next one.
            FLIGHT: integrator(0.0, 0.0, [(e.gap - ARMED * CLEARANCE**2, RISING)]),
            BEYOND: integrator(0.0, 0.0, [(e.gap, FALLING), (e.force, RISING)]),
            ROLL: contact(e.needed, [(MU * e.force - e.needed, FALLING), (MU * e.force + e.needed, FALLING)]),
        }
        for mode, sign in SIGN.items():
            self.modes[mode] = contact(-sign * MU * e.force, [(sign * e.speed, FALLING)])

    def ride(self, start_speed=START_SPEED):
        """From mode to mode to the end: x, y, changes, steps."""
        mode, t, state, changes, steps = FLIGHT, 0.0, [0.0, 0.0, start_speed, 0.0], 0, 0
        while t < T_END:
            integrator = self.modes[mode]
            integrator.time = t
            integrator.state[:] = state
            integrator.reset_cooldowns()
            begin = time.process_time()
            outcome, _, _, taken, *_ = integrator.propagate_until(T_END)
            self.inside += time.process_time() - begin
            steps += taken
            t, state = integrator.time, list(integrator.state)
            event = -int(outcome) - 1
            if outcome == hy.taylor_outcome.time_limit:
                break
            if not 0 <= event < 3:
                raise RuntimeError(str(outcome))
            new = self.next(mode, event, state, t)
            # Beyond and inside are both flight.
            changes += {mode, new} != {FLIGHT, BEYOND}
            mode = new
            if changes > 10_000:
                raise RuntimeError("chatters")
        return state[0], state[1], changes, steps


class Batch(Modes):
    """Many runs at once, in batches of a size: one integrator, whose parameters are the mode of each run.

    An event sets the next mode in its callback, and where a run is over the next start takes its place. Each run has its own
    time: the integrator's and an offset, which is a parameter too.
    """

    def __init__(self, k_c, tol, size):
        super().__init__(k_c)
        self.size = size
        contact, friction, rolling, soft, *f = (hy.par[i + 1] for i in range(13))
        now = hy.time + hy.par[0]
        # In flight a rotor crosses the middle, where the normal of the wall is not defined.
        e = Equations(k_c, now, soft * CLEARANCE**2)
        events = [
            f[0] * e.gap + f[1] * e.force + f[2],
            f[3] * e.force + f[4] * e.speed + f[5] * e.needed,
            f[6] * e.force + f[7] * e.needed + f[8],
            T_END - now,
        ]
        terminal = [hy.t_event_batch(g, direction=FALLING, callback=self.callback(i)) for i, g in enumerate(events)]
        self.integrator = hy.taylor_adaptive_batch(
            e.system(contact * e.force, friction * e.force + rolling * e.needed),
            np.zeros((4, size)),
            pars=np.zeros((14, size)),
            tol=tol,
            t_events=terminal,
        )

    def set(self, integrator, lane, mode, state):
        self.modes[lane] = mode
        integrator.state[:, lane] = state
        integrator.pars[1:, lane] = FACTORS[mode]
        # An event of another mode is another one.
        integrator.reset_cooldowns(lane)

    def begin(self, integrator, lane):
        """The next start in a place, or nothing."""
        index = self.runs[lane] = next(self.waiting, None)
        mode, t, speed = (IDLE, -1e3, 0.0) if index is None else (FLIGHT, 0.0, self.start_speeds[index])
        self.set(integrator, lane, mode, (0.0, 0.0, speed, 0.0))
        integrator.pars[0, lane] = t - integrator.time[lane]

    def happened(self, event, integrator, lane):
        """Goes on unless all runs are over."""
        mode, state = self.modes[lane], integrator.state[:, lane].tolist()
        index = self.runs[lane]
        if event == 3:
            self.ends[index] = (*state[:2], self.changes[index])
            self.left -= 1
            self.begin(integrator, lane)
            return self.left > 0
        t = float(integrator.time[lane] + integrator.pars[0, lane])
        new = self.next(mode, event, state, t)
        self.changes[index] += {mode, new} != {FLIGHT, BEYOND}
        self.set(integrator, lane, new, state)
        return True

    def callback(self, event):
        def call(integrator, _, lane):
            begin = time.process_time()
            go_on = self.happened(event, integrator, lane)
            self.in_callbacks += time.process_time() - begin
            return go_on

        return call

    def sweep(self, start_speeds):
        """x, y and changes of each start, and the time that Python took of it."""
        count = len(start_speeds)
        self.start_speeds, self.waiting, self.left = start_speeds, iter(range(count)), count
        self.ends, self.changes = [None] * count, [0] * count
        self.modes, self.runs, self.in_callbacks = [IDLE] * self.size, [None] * self.size, 0.0
        self.integrator.set_time(0.0)
        for lane in range(self.size):
            self.begin(self.integrator, lane)
        self.integrator.propagate_until(1e3)
        return self.ends, self.in_callbacks


def one_run():
    for name, k_c in (("B1", 1e8), ("B2", 1e10)):
        for digits in range(4, 13):
            rtol = float(f"1e-{digits}")
            peer = Peer(k_c, rtol)
            record = {"problem": name, "solver": "heyoka", "rtol": rtol}
            best, repetitions = math.inf, 30
            for _ in range(repetitions):
                start = time.process_time()
                try:
                    x, y, changes, steps = peer.ride()
                except RuntimeError as error:
                    record["failed"] = str(error)
                    break
                finally:
                    best = min(best, time.process_time() - start)
                record |= {"x": x, "y": y, "changes": changes}
            # A step is one series, as the project counts it: an evaluation for each of its coefficients.
            order = peer.modes[FLIGHT].order
            record |= {"evaluations": (order + 1) * steps if "x" in record else 0, "factorisations": 0}
            record |= {"seconds": best, "repetitions": repetitions}
            print(json.dumps(record), flush=True)
        print(f"  {name} by heyoka", file=sys.stderr)


def native(peers, name, rtol):
    """The project's measurements of a batch."""
    run = subprocess.run([peers, "batch", name, f"{rtol:g}"], capture_output=True, text=True, check=True)
    return map(json.loads, run.stdout.splitlines())


def one_by_one(peer):
    """x, y and changes of each start, and the CPU time that Python took of it."""
    peer.inside = 0.0
    begin = time.process_time()
    ends = [peer.ride(speed)[:3] for speed in START_SPEEDS]
    return ends, time.process_time() - begin - peer.inside


def many_starts(peers):
    """Best CPU times of a run, all solvers in turns; those of heyoka also without what Python does between events."""
    for name, k_c in (("B1", 1e8), ("B2", 1e10)):
        for rtol in (1e-5, 1e-7, 1e-9, 1e-11):
            peer = Peer(k_c, rtol)
            batches = {size: Batch(k_c, rtol, size) for size in (4, 8)}
            solvers = {"heyoka": lambda peer=peer: one_by_one(peer)}
            for size, batch in batches.items():
                solvers[f"heyoka, batch of {size}"] = lambda batch=batch: batch.sweep(START_SPEEDS)
            best = {}
            for _ in range(ROUNDS):
                records = list(native(peers, name, rtol))
                for solver, run in solvers.items():
                    begin = time.process_time()
                    ends, in_python = run()
                    whole = time.process_time() - begin
                    record = {"batch": name, "solver": solver, "rtol": rtol, "ends": ends}
                    times = {"seconds": whole - in_python, "seconds_with_python": whole}
                    records.append(record | {key: value / len(ends) for key, value in times.items()})
                for record in records:
                    before = best.setdefault(record["solver"], record)
                    best[record["solver"]] = min(before, record, key=lambda r: r["seconds"])
            for record in best.values():
                print(json.dumps(record), flush=True)
        print(f"  {name} in batches", file=sys.stderr)


if __name__ == "__main__":
    match sys.argv[1:]:
        case []:
            one_run()
        case ["batch", program]:
            many_starts(program)
        case _:
            sys.exit(__doc__)
