"""Rotors of ROSS in both programs: natural frequencies over the spin to 0.1 %, unbalance response to 0.5 %.

    python compare.py PATH_TO_firmware-host [NAME_OF_ROTOR …]

Logarithmic decrements to 1 %. Ends with 1 where a number is farther off. Rotors are taken as `to_scene` takes them over, in
ROSS too: bearings and seals with their coefficients at the lowest speed. By shaft sections, ROSS's elements are cut into up to
a hundred in all, for they converge with the square of their length; by matrices they are as they are. Of modes that hardly
swing, damped by more than SWINGS of the critical or slower than LOWEST_HZ, nothing is compared: ROSS has them also of modes that
a scene leaves out.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import ross as rs

from ambwhirl.ross import CROSS, DIRECT, to_npz, to_scene

FREQUENCIES, DECREMENTS, RESPONSE = 1e-3, 1e-2, 5e-3
MODES = 6
SWINGS = 0.9
LOWEST_HZ = 5.0


def plain(rotor, cut, at=None):
    """The rotor with finer elements and its bearings at the lowest speed, or as `at` says; a cut of 0 leaves the elements alone."""
    shaft = [] if cut else rotor.shaft_elements
    for e in [] if cut == 0 else sorted(rotor.shaft_elements, key=lambda e: e.n):
        for _ in range(cut):
            shaft.append(
                rs.ShaftElement(
                    L=e.L / cut,
                    idl=0.5 * (e.idl + e.idr),
                    odl=0.5 * (e.odl + e.odr),
                    material=e.material,
                    shear_effects=True,
                    rotary_inertia=True,
                    gyroscopic=True,
                )
            )
    cut = max(cut, 1)
    discs = [rs.DiskElement(n=cut * d.n, m=d.m, Id=d.Id, Ip=d.Ip) for d in rotor.disk_elements]
    bearings = [
        rs.BearingElement(n=cut * b.n, **(at(b) if at else {name: float(getattr(b, name)[0]) for name in DIRECT + CROSS}))
        for b in rotor.bearing_elements
    ]
    return rs.Rotor(shaft, discs, bearings)


def rosss(rotor, spin):
    """Lateral modes that swing: natural frequencies [Hz] and logarithmic decrements, slowest first."""
    modal = rotor.run_modal(speed=spin, num_modes=60, sparse=False)
    values = modal.evalues
    lateral = []
    for i, value in enumerate(values):
        if value.imag <= 1.0 or -value.real > SWINGS * abs(value):
            continue
        # Degrees of freedom of a node: x, y, z, α, β, θ. Axial and torsional modes move z and θ alone.
        shape = np.abs(modal.evectors[: rotor.ndof, i])
        per = rotor.number_dof
        if per == 6 and max(shape[0::per].max(), shape[1::per].max()) < 1e-3 * shape.max():
            continue
        lateral.append((value.imag / (2 * math.pi), -2 * math.pi * value.real / value.imag))
    return sorted(lateral)


def levitated(rotor, cut, spin):
    """The same of a rotor in magnetic bearings. ROSS's modal analysis takes stiffness and damping of its controllers at one
    frequency for all modes; from there each mode is followed to where its own rate is the one that its controllers see."""

    controllers = {b.n: b.get_analog_controller() for b in rotor.bearing_elements}

    def force(bearing, rate):
        newtons = float(np.ravel(bearing.ki * bearing.k_amp * bearing.k_sense)[0])
        return bearing.ks + newtons * controllers[bearing.n](rate)

    def at(bearing, rate=300j):
        stiffness, damping = force(bearing, rate).real, force(bearing, rate).imag / rate.imag
        return dict(kxx=stiffness, kyy=stiffness, cxx=damping, cyy=damping)

    held = plain(rotor, cut, at)
    free = rs.Rotor(held.shaft_elements, held.disk_elements)
    inertia, damping, stiffness = free.M(), free.C(0.0) + spin * free.G(), free.K(0.0)
    ends = [(max(cut, 1) * b.n * free.number_dof + axis, b) for b in rotor.bearing_elements for axis in (0, 1)]

    def dynamic(rate):
        matrix = rate**2 * inertia + rate * damping + stiffness
        for place, bearing in ends:
            matrix[place, place] += force(bearing, rate)
        return matrix

    found = []
    for frequency, decrement in rosss(held, spin)[: MODES + 4]:
        rate = complex(-frequency * decrement, 2 * math.pi * frequency)
        slope = (dynamic(rate * (1 + 1e-6)) - dynamic(rate)) / (1e-6 * rate)
        shape = np.ones(len(inertia), dtype=complex)
        for _ in range(15):
            step = np.linalg.solve(dynamic(rate), slope @ shape)
            last, rate = rate, rate - 1.0 / np.vdot(shape, step)
            shape = step / np.linalg.norm(step)
            slope = (dynamic(rate * (1 + 1e-6)) - dynamic(rate)) / (1e-6 * rate)
            if abs(rate - last) < 1e-9 * abs(rate) or rate.imag < 2 * math.pi * LOWEST_HZ:
                break
        # Those of the rotor as a whole hardly swing: ROSS's gains just balance the magnets' pull.
        if rate.imag > 2 * math.pi * LOWEST_HZ and -rate.real <= SWINGS * abs(rate):
            found.append((rate.imag / (2 * math.pi), -2 * math.pi * rate.real / rate.imag))
    return sorted(found)


def response(rotor, node, moment, spins):
    """Largest distance from the middle at each node and spin [m]."""
    found = rotor.run_unbalance_response(
        node=node, unbalance_magnitude=moment, unbalance_phase=0.0, frequency=np.array(spins)
    )
    per = rotor.number_dof
    x, y = found.forced_resp[0::per], found.forced_resp[1::per]
    return 0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y))


def ours(host, folder, scene, to_hz, points, *more):
    path = Path(folder) / "scene.toml"
    path.write_text(scene)
    run = [host, "modes", path, "--json", "--to-hz", str(to_hz), "--points", str(points), *more]
    return json.loads(subprocess.run(run, check=True, capture_output=True).stdout)


def main():
    host = sys.argv[1]
    example, damped, magnetic = rs.rotor_example(), rs.rotor_example_with_damping(), rs.rotor_amb_example()
    rotors = [
        ("rotor_example", example, False),
        ("rotor_example", example, True),
        ("rotor_example_6dof", rs.rotor_example_6dof(), True),
        ("rotor_example_with_damping", damped, False),
        ("rotor_example_with_damping", damped, True),
        ("compressor_example", rs.compressor_example(), True),
        ("rotor_amb_example", magnetic, False),
        ("rotor_amb_example", magnetic, True),
    ]
    failed = False
    for name, given, by_matrices in [r for r in rotors if not sys.argv[2:] or r[0] in sys.argv[2:]]:
        cut = 0 if by_matrices else max(1, round(100 / len(given.shaft_elements) - 0.5))
        disc = given.disk_elements[0]
        moment = 1e-4
        folder = tempfile.mkdtemp()
        if by_matrices:
            to_npz(given, Path(folder) / "rotor.npz")
        is_magnetic = given is magnetic
        # Sampled so fast that it is as good as continuous: too fast for what a supervisor derives, which plays no part here.
        options = dict(sample_rate_hz=1e6, gravity_m_s2=0.0) if is_magnetic else {}
        scene = to_scene(given, name, bending_to_hz=3e4, matrices_file="rotor.npz" if by_matrices else None, **options)
        scene = scene.replace(', "supervisor"]', "]")
        scene += f"[[unbalance]]\nposition_m = {float(given.nodes_pos[disc.n])!r}\nmoment_kg_m = {moment}\n"
        points, to_hz = 5, 200.0
        found = ours(host, folder, scene, to_hz, points, *["--levitated"] * is_magnetic)
        spins = sorted({m["spin_rad_s"] for m in found["modes"]})
        worst = decays = 0.0
        for spin in spins:
            mine = [
                (m["frequency_hz"], 2 * math.pi * m["damping_ratio"] / math.sqrt(1 - m["damping_ratio"] ** 2))
                for m in found["modes"]
                if m["spin_rad_s"] == spin and abs(m["damping_ratio"]) <= SWINGS and m["frequency_hz"] > LOWEST_HZ
            ][:MODES]
            theirs = (levitated(given, cut, spin) if is_magnetic else rosss(plain(given, cut), spin))[:MODES]
            off = max(abs(a[0] / b[0] - 1) for a, b in zip(mine, theirs))
            # Against a decrement of a thousandth where there is less: of almost no damping a share says nothing.
            decay = max(abs(a[1] - b[1]) / max(abs(b[1]), 1e-3) for a, b in zip(mine, theirs))
            worst, decays = max(worst, off), max(decays, decay)
            if off > FREQUENCIES or decay > DECREMENTS:
                print(name, f"{spin:.0f} rad/s", mine, theirs)
        way = "matrices" if by_matrices else "sections"
        said = (
            f"{name} by {way}: {len(given.shaft_elements)} elements, {MODES} modes at {len(spins)} spins off by {worst:.1e}, "
            f"decrements by {decays:.1e}"
        )
        failed |= worst > FREQUENCIES or decays > DECREMENTS
        if not is_magnetic:
            bearings = [b for b in given.bearing_elements if type(b).__name__.endswith("BearingElement")][:4]
            # At standstill there is none.
            at = [s for s in found["unbalance_response"] if s["spin_rad_s"] > 0]
            theirs = response(plain(given, cut), max(cut, 1) * disc.n, moment, [s["spin_rad_s"] for s in at])
            farthest = 0.0
            for j, s in enumerate(at):
                for bearing, mine in zip(bearings, s["planes_m"]):
                    farthest = max(farthest, abs(mine / theirs[max(cut, 1) * bearing.n, j] - 1))
            said += f", unbalance response by {farthest:.1e}"
            failed |= farthest > RESPONSE
        print(said, flush=True)
    sys.exit(int(failed))


if __name__ == "__main__":
    main()
