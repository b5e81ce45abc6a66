#!/usr/bin/env python3
"""Robust levitation loops of the rotors P5 to P8: loop shaping in H-infinity after McFarlane and Glover.

The plant of a scene, sampled with its hold and delay, goes to the w-plane by the bilinear transform, which keeps norms in
H-infinity. There it is shaped by mode, the controller that stands the largest change of the coprime factors is computed in
closed form from two Riccati equations, and all goes back to the z-plane: nothing is approximated.

    python3 robust.py                     writes p5_robust.toml to p8_robust.toml beside the plants' scenes
    python3 robust.py --check             says by how much those files differ from what it computes now
    python3 robust.py --search HOST       tries the grid of shapes with the host HOST (target/release/firmware-host)

It needs Python 3.11 with NumPy and SciPy.
"""

import argparse
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import tomllib
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm, solve_continuous_are

HERE = pathlib.Path(__file__).resolve().parent


class Shape(NamedTuple):
    """What is free: where the shaped plant crosses one [Hz], the tilt's over the translation's, and the lead."""

    crossover_hz: float
    tilt: float
    lead: float


# What the search has found.
CHOSEN = {
    "p5": Shape(137.0, 1.4, 3.0),
    "p6": Shape(137.0, 1.4, 3.0),
    "p7": Shape(137.0, 1.4, 3.0),
    "p8": Shape(205.0, 1.4, 3.0),
}

# How much more than the least norm is asked for: at the least itself the controller has no unique form.
MARGIN = 1.1
# An engineer accepts a loop with a peak sensitivity below this and less than this share of the cap for noise.
SENSITIVITY, IDLE_NOISE = 3.0, 0.05
# Speeds that a search tries: from this on [m/s], each by this factor.
FIRST_M_S, STEP = 0.4, 1.1
# Largest relative difference of stored and computed controllers over frequency.
SAME = 1e-6


class System(NamedTuple):
    """A, B, C, D."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray

    def after(self, first):
        """This one behind another."""
        a = np.block([[self.a, self.b @ first.c], [np.zeros((len(first.a), len(self.a))), first.a]])
        b = np.vstack([self.b @ first.d, first.b])
        c = np.hstack([self.c, self.d @ first.c])
        return System(a, b, c, self.d @ first.d)

    def at(self, s):
        """The transfer matrix."""
        return self.c @ np.linalg.solve(s * np.eye(len(self.a)) - self.a, self.b) + self.d


class Plant:
    """What a scene says of its rotor. Coordinates: x, y, both slopes, then x and y of each bending mode."""

    def __init__(self, name):
        self.name = name
        self.text = (HERE / f"{name}.toml").read_text(encoding="utf-8")
        self.scene = scene = tomllib.loads(self.text)
        rotor = scene["rotor"]
        self.period_s = 1.0 / scene["run"]["sample_rate_hz"]
        self.mass_kg, self.inertia_kg_m2 = rotor["mass_kg"], rotor["transverse_inertia_kg_m2"]
        self.planes_m = [plane["position_m"] for plane in scene["plane"]]
        of = lambda plane, key: plane.get(key, scene.get(key, {}))
        self.magnets = [of(plane, "magnet") for plane in scene["plane"]]
        place = lambda plane, key: of(plane, key).get("position_m", plane["position_m"])
        self.magnets_m = [place(plane, "magnet") for plane in scene["plane"]]
        self.sensors_m = [place(plane, "sensor") for plane in scene["plane"]]
        self.noise_m = scene["sensor"]["noise_rms_m"]
        self.bending = rotor.get("bending", [])

    def ports(self, places_m):
        """Displacements in x and y at places, by the coordinates."""
        rows = []
        for z in places_m:
            shapes = [np.interp(z, mode["positions_m"], mode["displacements"]) for mode in self.bending]
            line = np.array([1.0, z, *shapes])
            for axis in (0, 1):
                row = np.zeros(2 * len(line))
                row[axis::2] = line
                rows.append(row)
        return np.array(rows)

    def sampled(self):
        """From forces that are asked for to positions, in the z-plane: amplifiers, hold, one sample of delay."""
        spin = 2.0 * math.pi * self.scene["spin"]["frequency_hz"]
        frequencies = [2.0 * math.pi * mode["frequency_hz"] for mode in self.bending]
        mass = np.repeat([self.mass_kg, self.inertia_kg_m2, *[self.mass_kg] * len(frequencies)], 2)
        n = len(mass)
        gyro = np.zeros((n, n))
        gyro[2, 3] = spin * self.scene["rotor"]["polar_inertia_kg_m2"]
        gyro[3, 2] = -gyro[2, 3]
        damping, stiffness = np.zeros(n), np.zeros(n)
        for i, (omega, mode) in enumerate(zip(frequencies, self.bending)):
            at = slice(4 + 2 * i, 6 + 2 * i)
            damping[at] = 2.0 * mode.get("damping_ratio", 0.0) * omega * self.mass_kg
            stiffness[at] = omega * omega * self.mass_kg
        at_magnets, at_sensors = self.ports(self.magnets_m), self.ports(self.sensors_m)
        pull = np.repeat([magnet.get("negative_stiffness_n_m", 0.0) for magnet in self.magnets], 2)
        spring = np.diag(stiffness) - at_magnets.T @ np.diag(pull) @ at_magnets
        over_mass = np.diag(1.0 / mass)
        lag = np.repeat([magnet["lag_s"] for magnet in self.magnets], 2)
        m = len(lag)
        a = np.block([
            [np.zeros((n, n)), np.eye(n), np.zeros((n, m))],
            [-over_mass @ spring, -over_mass @ (gyro + np.diag(damping)), over_mass @ at_magnets.T],
            [np.zeros((m, 2 * n)), -np.diag(1.0 / lag)],
        ])
        b = np.vstack([np.zeros((2 * n, m)), np.diag(1.0 / lag)])
        held = expm(self.period_s * np.block([[a, b], [np.zeros((m, 2 * n + 2 * m))]]))
        states = 2 * n + m
        a_z, b_z = held[:states, :states], held[:states, states:]
        # The command of the sample before is in effect.
        return System(
            np.block([[a_z, b_z], [np.zeros((m, states + m))]]),
            np.vstack([np.zeros((states, m)), np.eye(m)]),
            np.hstack([at_sensors, np.zeros((len(at_sensors), states - n + m))]),
            np.zeros((len(at_sensors), m)),
        )

    def modal(self):
        """Readings to translation and tilt, forces of both to those of the magnets."""
        both = np.array([[1.0, 1.0], self.magnets_m])
        return (
            np.kron(np.linalg.inv(np.array([[1.0, z] for z in self.sensors_m])), np.eye(2)),
            np.kron(np.linalg.inv(both), np.eye(2)),
        )


def to_w(z, period_s):
    """z = (1 + w T/2)/(1 - w T/2)."""
    eye = np.eye(len(z.a))
    inverse = np.linalg.inv(eye + z.a)
    root = 2.0 / math.sqrt(period_s)
    return System(
        2.0 / period_s * (z.a - eye) @ inverse,
        root * inverse @ z.b,
        root * z.c @ inverse,
        z.d - z.c @ inverse @ z.b,
    )


def to_z(w, period_s):
    """The way back."""
    eye = np.eye(len(w.a))
    inverse = np.linalg.inv(eye - 0.5 * period_s * w.a)
    root = math.sqrt(period_s)
    return System(
        (eye + 0.5 * period_s * w.a) @ inverse,
        root * inverse @ w.b,
        root * w.c @ inverse,
        w.d + 0.5 * period_s * w.c @ inverse @ w.b,
    )


def weight(plant, shape):
    """What shapes the plant, from four forces by mode to those: stiffness by mode, with a lead where there is one."""
    omega = 2.0 * math.pi * shape.crossover_hz * np.array([1.0, 1.0, shape.tilt, shape.tilt])
    stiffness = omega**2 * np.repeat([plant.mass_kg, plant.inertia_kg_m2], 2)
    if shape.lead == 0.0:
        return System(np.zeros((0, 0)), np.zeros((0, 4)), np.zeros((4, 0)), np.diag(stiffness))
    # (1 + lead s/omega)/(1 + s/(20 omega)), of size one at the crossover.
    far = 20.0 * omega
    size = math.hypot(1.0, 1.0 / 20.0) / math.hypot(1.0, shape.lead)
    high = size * stiffness * shape.lead * 20.0
    return System(-np.diag(far), np.eye(4), np.diag((size * stiffness - high) * far), np.diag(high))


def most_robust(g):
    """The controller u = K y that stands the largest change of normalised coprime factors, and the norm that it has."""
    s_inverse = np.linalg.inv(np.eye(g.d.shape[1]) + g.d.T @ g.d)
    r_inverse = np.linalg.inv(np.eye(g.d.shape[0]) + g.d @ g.d.T)
    a = g.a - g.b @ s_inverse @ g.d.T @ g.c
    x = solve_continuous_are(a, g.b, g.c.T @ r_inverse @ g.c, np.linalg.inv(s_inverse))
    z = solve_continuous_are(a.T, g.c.T, g.b @ s_inverse @ g.b.T, np.linalg.inv(r_inverse))
    gamma = MARGIN * math.sqrt(1.0 + max(np.linalg.eigvals(x @ z).real))
    f = -s_inverse @ (g.d.T @ g.c + g.b.T @ x)
    l = (1.0 - gamma**2) * np.eye(len(g.a)) + x @ z
    gain = gamma**2 * np.linalg.solve(l.T, z @ g.c.T)
    return System(g.a + g.b @ f + gain @ (g.c + g.d @ f), gain, g.b.T @ x, -g.d.T), gamma


def designed(plant, shape):
    """The controller from readings [m] to forces [N] in the z-plane, and its norm."""
    by_mode, to_magnets = plant.modal()
    own = to_w(plant.sampled(), plant.period_s)
    seen = System(own.a, own.b @ to_magnets, by_mode @ own.c, by_mode @ own.d @ to_magnets)
    before = weight(plant, shape)
    k, gamma = most_robust(seen.after(before))
    whole = to_z(before.after(k), plant.period_s)
    return System(whole.a, whole.b @ by_mode, to_magnets @ whole.c, to_magnets @ whole.d @ by_mode), gamma


def loop(plant, k):
    """Largest singular value of the sensitivity at the sensors, and the force for noise as a share of the cap of the magnet
    that has the least room; None where the loop is unstable."""
    g = plant.sampled()
    closed = np.block([[g.a + g.b @ k.d @ g.c, g.b @ k.c], [k.b @ g.c, k.a]])
    if max(abs(np.linalg.eigvals(closed))) >= 1.0 - 1e-9:
        return None
    rates = np.geomspace(1.0, 0.5 / plant.period_s, 600)
    peak = 0.0
    for z in np.exp(2j * math.pi * rates * plant.period_s):
        returned = np.eye(len(g.c)) - g.at(z) @ k.at(z)
        peak = max(peak, 1.0 / np.linalg.svd(returned, compute_uv=False)[-1])
    b = np.vstack([g.b @ k.d, k.b])
    c = np.hstack([k.d @ g.c, k.c])
    forces = np.sqrt(np.diag(c @ spread(closed, b) @ c.T + k.d @ k.d.T)) * plant.noise_m
    caps = np.repeat([magnet["force_max_n"] for magnet in plant.magnets], 2)
    return peak, max(forces / caps)


def spread(a, b):
    """The covariance of states that white noise drives, summed by doubling: states of very different size stay apart."""
    covariance, power = b @ b.T, a
    for _ in range(60):
        covariance = covariance + power @ covariance @ power.T
        power = power @ power
    return covariance


def numbers(matrix):
    """Rows of a matrix as TOML."""
    rows = ["    " + ", ".join(repr(float(f"{x:.14g}")) for x in row) + "," for row in np.atleast_2d(matrix)]
    return "[\n" + "\n".join(rows) + "\n]"


def state_space(k):
    """The table of scenes."""
    parts = [f"{name} = {numbers(part)}" for name, part in zip("abcd", k)]
    return "[state_space]\n" + "\n".join(parts) + "\n"


def in_place_of_gains(text, table):
    """The scene with another table in the place of [levitation]."""
    begin = text.index("[levitation]")
    end = text.index("\n[", begin) + 1
    return text[:begin] + table + "\n" + text[end:]


def scene_text(plant, shape):
    """The scene as it is stored."""
    k, gamma = designed(plant, shape)
    peak, noise = loop(plant, k)
    title = plant.scene["title"]
    story = (
        f"{plant.name}.toml with a robust levitation loop: H-infinity loop shaping, crossover {shape.crossover_hz:.0f} Hz, "
        f"tilt {shape.tilt:g} times that,\nlead {shape.lead:g}. Norm {gamma:.2f}, peak sensitivity {peak:.2f}, "
        f"{100.0 * noise:.2f} % of the cap for noise. Written by robust.py.\n"
    )
    text = plant.text.replace(f'title = "{title}"', f'title = "{title}, robust loop"', 1)
    begin = text.index('story = """') + len('story = """\n')
    text = text[:begin] + story + text[text.index('"""', begin) :]
    return in_place_of_gains(text, state_space(k))


def stored(name):
    """The controller of the stored scene."""
    written = tomllib.loads((HERE / f"{name}_robust.toml").read_text(encoding="utf-8"))["state_space"]
    states = math.isqrt(len(written["a"]))
    sizes = [(states, states), (states, 4), (4, states), (4, 4)]
    return System(*[np.array(written[key]).reshape(size) for key, size in zip("abcd", sizes)])


def difference(plant, one, other):
    """Largest difference of two controllers over frequency, of the size of the first there."""
    rates = np.geomspace(1.0, 0.49 / plant.period_s, 200)
    points = np.exp(2j * math.pi * rates * plant.period_s)
    norm = lambda m: np.linalg.norm(m, 2)
    return max(norm(one.at(z) - other.at(z)) / norm(one.at(z)) for z in points)


def grid():
    """Shapes that are tried: crossovers of the other loops' grid, and one step beyond it."""
    for crossover_hz in (61.0, 91.0, 137.0, 205.0, 308.0):
        for tilt in (1.0, 1.4, 2.0):
            for lead in (1.0, 3.0):
                yield Shape(crossover_hz, tilt, lead)


def blows(plant):
    """Velocity of the centre and tilt rate for a blow that gives the plane that it moves most 1 m/s, as the catalogue's."""
    first, second = plant.planes_m
    far = max(abs(first), abs(second))
    mobility = lambda z: 1.0 / plant.mass_kg + z * z / plant.inertia_kg_m2
    end = lambda z: (1.0 / mobility(z) / plant.mass_kg, z / mobility(z) / plant.inertia_kg_m2)
    return [(1.0, 0.0), end(first), end(second), (0.0, 1.0 / far)]


def hardest_m_s(host, text, blow, folder):
    """The hardest blow that the host says is recovered from, with all slighter ones of a grid."""
    scene = pathlib.Path(folder) / "tried.toml"
    scene.write_text(text, encoding="utf-8")
    sin, cos = math.sin(0.4), math.cos(0.4)
    speed, last = FIRST_M_S, 0.0
    while speed < 6.0:
        centre, tilt = (speed * part for part in blow)
        sets = [
            f"start.velocity_m_s=[{centre * cos}, {centre * sin}]",
            f"start.tilt_rate_rad_s=[{tilt * cos}, {tilt * sin}]",
        ]
        command = [host, "run", scene, "--json", "--no-trace", "--threads", "1", "--out", pathlib.Path(folder) / "run"]
        sets += ["run.seed=1", "run.duration_s=0.3"]
        command += [part for given in sets for part in ("--set", given)]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            break
        if not json.loads(ran.stdout)["policies"]["levitation"]["recovered"]:
            break
        last = speed
        speed *= STEP
    return last


def tried(host, plant, shape):
    """Score of a shape: the geometric mean of the hardest blows [m/s]; None where the loop is not fit."""
    try:
        k, _ = designed(plant, shape)
        of_loop = loop(plant, k)
    except (np.linalg.LinAlgError, ValueError):
        return None
    if of_loop is None or of_loop[0] >= SENSITIVITY or of_loop[1] >= IDLE_NOISE:
        return None
    text = in_place_of_gains(plant.text, state_space(k))
    text = text.replace('policies = ["passive", "levitation", "supervisor"]', 'policies = ["levitation"]')
    with tempfile.TemporaryDirectory() as folder:
        found = [max(hardest_m_s(host, text, blow, folder), 1e-3) for blow in blows(plant)]
    return math.prod(found) ** 0.25


def search(host, names):
    """The best shape of each plant."""
    for name in names:
        plant = Plant(name)
        shapes = list(grid())
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            scores = list(pool.map(lambda shape: tried(host, plant, shape), shapes))
        rated = [(score, shape) for score, shape in zip(scores, shapes) if score is not None]
        print(f"{name}: {len(rated)} of {len(shapes)} are fit")
        for score, shape in sorted(rated, key=lambda of: (-of[0], of[1]))[:5]:
            print(f"    {score:.3f} m/s  {shape}")
        sys.stdout.flush()


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true", help="compare the stored files with what is computed")
    parser.add_argument("--search", metavar="HOST", help="try the grid of shapes with this host")
    parser.add_argument("names", nargs="*", default=["p5", "p6", "p7", "p8"])
    args = parser.parse_args()
    if args.search:
        search(args.search, args.names)
        return 0
    worst = 0.0
    for name in args.names:
        plant = Plant(name)
        if args.check:
            k, _ = designed(plant, CHOSEN[name])
            off = difference(plant, stored(name), k)
            print(f"{name} {off:.3e}")
            worst = max(worst, off)
        else:
            text = scene_text(plant, CHOSEN[name])
            (HERE / f"{name}_robust.toml").write_text(text, encoding="utf-8")
    return 0 if worst < SAME else 1


if __name__ == "__main__":
    sys.exit(main())
