"""heyoka's Taylor integrator on B1 and B2 of src/problem.rs; one JSON object per measurement.

Usage: heyoka_peer.py

Equations and events of each mode are compiled once for each tolerance, which is not counted: a run is the way from mode to
mode. What of the wall is dented after lift-off is a mode of its own here, since an event is one function and not a minimum.
"""

import json
import math
import sys
import time

import heyoka as hy

FLIGHT, BEYOND, SLIP_POSITIVE, SLIP_NEGATIVE, ROLL = range(5)
SIGN = {SLIP_POSITIVE: 1.0, SLIP_NEGATIVE: -1.0}
M, K, D = 10.0, 4e5, 200.0
CLEARANCE, MU, SPIN, RADIUS, ECCENTRICITY = 3e-4, 0.3, 400.0, 2.5e-3, 1e-5
START_SPEED, T_END = 0.3, 0.2
SURFACE = SPIN * RADIUS
ARMED = 1e-12
FALLING, RISING = hy.event_direction.negative, hy.event_direction.positive


class Peer:
    """One integrator for each mode."""

    def __init__(self, k_c, tol):
        x, y, vx, vy = hy.make_vars("x", "y", "vx", "vy")
        d_c = 0.1 * math.sqrt(k_c * M)
        distance = hy.sqrt(x * x + y * y)
        nx, ny = x / distance, y / distance
        normal_speed, whirl_speed = vx * nx + vy * ny, vy * nx - vx * ny
        depth = distance - CLEARANCE
        force = k_c * depth + d_c * normal_speed
        unbalance = ECCENTRICITY * SPIN * SPIN
        ax = -(K * x + D * vx) / M + unbalance * hy.cos(SPIN * hy.time)
        ay = -(K * y + D * vy) / M + unbalance * hy.sin(SPIN * hy.time)
        needed = -M * (ay * nx - ax * ny - normal_speed * whirl_speed / distance)

        def integrator(fx, fy, events):
            equations = [(x, vx), (y, vy), (vx, ax + fx / M), (vy, ay + fy / M)]
            terminal = [hy.t_event(g, direction=direction) for g, direction in events]
            return hy.taylor_adaptive(equations, [0.0, 0.0, START_SPEED, 0.0], tol=tol, t_events=terminal)

        def contact(tangential, events):
            fx, fy = -force * nx - tangential * ny, -force * ny + tangential * nx
            return integrator(fx, fy, [(force, FALLING), *events])

        # The square of the distance is smooth in the middle, where a rotor starts.
        gap = x * x + y * y - CLEARANCE**2
        self.modes = {
            # Armed a rounding error outside: a root where the mode begins would hide the next one.
            FLIGHT: integrator(0.0, 0.0, [(gap - ARMED * CLEARANCE**2, RISING)]),
            BEYOND: integrator(0.0, 0.0, [(gap, FALLING), (force, RISING)]),
            ROLL: contact(needed, [(MU * force - needed, FALLING), (MU * force + needed, FALLING)]),
        }
        for mode, sign in SIGN.items():
            self.modes[mode] = contact(-sign * MU * force, [(sign * (SURFACE + whirl_speed), FALLING)])
        self.k_c, self.d_c = k_c, d_c

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

    def ride(self):
        """From mode to mode to the end: x, y, changes, steps."""
        mode, t, state, changes, steps = FLIGHT, 0.0, [0.0, 0.0, START_SPEED, 0.0], 0, 0
        while t < T_END:
            integrator = self.modes[mode]
            integrator.time = t
            integrator.state[:] = state
            integrator.reset_cooldowns()
            outcome, _, _, taken, *_ = integrator.propagate_until(T_END)
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


def main():
    for name, k_c in (("B1", 1e8), ("B2", 1e10)):
        for digits in range(4, 13):
            rtol = float(f"1e-{digits}")
            peer = Peer(k_c, rtol)
            record = {"problem": name, "solver": "heyoka", "rtol": rtol}
            best, repetitions = math.inf, 30
            for _ in range(repetitions):
                start = time.perf_counter()
                try:
                    x, y, changes, steps = peer.ride()
                except RuntimeError as error:
                    record["failed"] = str(error)
                    break
                finally:
                    best = min(best, time.perf_counter() - start)
                record |= {"x": x, "y": y, "changes": changes}
            # A step is one series, as the project counts it: an evaluation for each of its coefficients.
            order = peer.modes[FLIGHT].order
            record |= {"evaluations": (order + 1) * steps if "x" in record else 0, "factorisations": 0}
            record |= {"seconds": best, "repetitions": repetitions}
            print(json.dumps(record), flush=True)
        print(f"  {name} by heyoka", file=sys.stderr)


if __name__ == "__main__":
    main()
