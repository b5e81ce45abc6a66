"""Rotors of ROSS in both programs: natural frequencies over the spin to 0.1 %, unbalance response to 0.5 %.

    python compare.py PATH_TO_firmware-host

Logarithmic decrements to 1 %. Ends with 1 where a number is farther off. Rotors are taken as `to_scene` takes them over, in
ROSS too: bearings and seals with their coefficients at the lowest speed. By shaft sections, ROSS's elements are cut into some 120 in all, for they
converge with the square of their length; by matrices they are as they are. Of modes that hardly swing, damped by more than
SWINGS of the critical, the frequency is not compared: ROSS has them also of modes that a scene leaves out.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import ross as rs

from to_npz import to_npz
from to_scene import CROSS, DIRECT, coefficients, to_scene

FREQUENCIES, DECREMENTS, RESPONSE = 1e-3, 1e-2, 5e-3
MODES = 6
SWINGS = 0.9


def plain(rotor, cut):
    """The rotor with finer elements and its bearings at the lowest speed; a cut of 0 leaves the elements alone."""
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
        rs.BearingElement(
            n=cut * b.n,
            **dict(zip(DIRECT + CROSS, coefficients(b, DIRECT + CROSS))),
        )
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


def response(rotor, node, moment, spins):
    """Largest distance from the middle at each node and spin [m]."""
    found = rotor.run_unbalance_response(
        node=node, unbalance_magnitude=moment, unbalance_phase=0.0, frequency=np.array(spins)
    )
    per = rotor.number_dof
    x, y = found.forced_resp[0::per], found.forced_resp[1::per]
    return 0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y))


def ours(host, folder, scene, to_hz, points):
    path = Path(folder) / "scene.toml"
    path.write_text(scene)
    run = [host, "modes", path, "--json", "--to-hz", str(to_hz), "--points", str(points)]
    return json.loads(subprocess.run(run, check=True, capture_output=True).stdout)


def main():
    host = sys.argv[1]
    example, damped, compressor = rs.rotor_example(), rs.rotor_example_with_damping(), rs.compressor_example()
    rotors = [
        ("rotor_example", example, False),
        ("rotor_example", example, True),
        ("rotor_example_with_damping", damped, False),
        ("rotor_example_with_damping", damped, True),
        ("compressor_example", compressor, True),
    ]
    failed = False
    for name, given, by_matrices in rotors:
        cut = 0 if by_matrices else max(1, round(120 / len(given.shaft_elements)))
        rotor = plain(given, cut)
        cut = max(cut, 1)
        disc = given.disk_elements[0]
        moment = 1e-4
        folder = tempfile.mkdtemp()
        if by_matrices:
            to_npz(given, Path(folder) / "rotor.npz")
        scene = to_scene(given, name, bending_to_hz=3e4, matrices_file="rotor.npz" if by_matrices else None)
        scene += f"[[unbalance]]\nposition_m = {float(given.nodes_pos[disc.n])!r}\nmoment_kg_m = {moment}\n"
        points, to_hz = 5, 200.0
        found = ours(host, folder, scene, to_hz, points)
        spins = sorted({m["spin_rad_s"] for m in found["modes"]})
        worst = decays = 0.0
        for spin in spins:
            mine = [
                (m["frequency_hz"], 2 * math.pi * m["damping_ratio"] / math.sqrt(1 - m["damping_ratio"] ** 2))
                for m in found["modes"]
                if m["spin_rad_s"] == spin and m["damping_ratio"] <= SWINGS
            ][:MODES]
            theirs = rosss(rotor, spin)[:MODES]
            off = max(abs(a[0] / b[0] - 1) for a, b in zip(mine, theirs))
            # Against a decrement of a thousandth where there is less: of almost no damping a share says nothing.
            decay = max(abs(a[1] - b[1]) / max(abs(b[1]), 1e-3) for a, b in zip(mine, theirs))
            worst, decays = max(worst, off), max(decays, decay)
            if off > FREQUENCIES or decay > DECREMENTS:
                print(name, f"{spin:.0f} rad/s", mine, theirs)
        bearings = [b for b in given.bearing_elements if type(b).__name__.endswith("BearingElement")][:4]
        # At standstill there is none.
        at = [s for s in found["unbalance_response"] if s["spin_rad_s"] > 0]
        theirs = response(rotor, cut * disc.n, moment, [s["spin_rad_s"] for s in at])
        farthest = 0.0
        for j, s in enumerate(at):
            for bearing, mine in zip(bearings, s["planes_m"]):
                farthest = max(farthest, abs(mine / theirs[cut * bearing.n, j] - 1))
        way = "matrices" if by_matrices else "sections"
        print(f"{name} by {way}: {len(given.shaft_elements)} elements, {MODES} modes at {len(spins)} spins off by {worst:.1e}, "
              f"decrements by {decays:.1e}, "
              f"unbalance response off by {farthest:.1e}")
        failed |= worst > FREQUENCIES or decays > DECREMENTS or farthest > RESPONSE
    sys.exit(failed)


if __name__ == "__main__":
    main()
