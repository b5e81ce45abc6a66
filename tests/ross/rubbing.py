"""Friction of a spinning shaft that is pressed against the wall at rest, by ROSS's Rubbing and by this project's plant.

    python rubbing.py PATH_TO_firmware-host

Friction acts against the sliding: on a shaft that turns counter-clockwise clockwise along the wall, wherever it touches. Prints
the angle between that direction and each program's friction, at eleven places round the wall; ends with 1 where the plant's is
not along it.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import ross as rs
from ross.faults.rubbing import Rubbing

CLEARANCE_M, DEPTH_M, STIFFNESS_N_M, FRICTION = 1e-4, 1e-6, 1e8, 0.3
SPIN_RAD_S = 2 * np.pi * 100
PLACES = 11
# So far off still counts as against the sliding.
NEAR_DEG = 10

SCENE = """
title = "A shaft at rest against the wall"
[run]
duration_s = 5e-5
sample_rate_hz = 20000
policies = ["passive"]
[rotor]
mass_kg = 10.0
contact_radius_m = 0.05
[spin]
frequency_hz = 100.0
[start]
position_m = [{x!r}, {y!r}]
[contact]
clearance_m = {clearance!r}
stiffness_n_m = {stiffness!r}
[friction]
coefficient = {friction!r}
[verdict]
whirl_speed_m_s = 1.0
"""


def of_ross(rub, x, y):
    """Friction of ROSS [N]: what is more than without it."""
    place, speed = np.zeros(12), np.zeros(12)
    place[:2] = x, y
    # With no speed at all ROSS divides by it.
    speed[:2] = 1e-9 * x, 1e-9 * y
    with_friction = rub.compute_rubbing_force(place, speed, SPIN_RAD_S)[:2]
    rub.friction_coeff, kept = 0.0, rub.friction_coeff
    without = rub.compute_rubbing_force(place, speed, SPIN_RAD_S)[:2]
    rub.friction_coeff = kept
    return with_friction - without


def of_plant(host, folder, x, y):
    """Friction of the plant [N], along the wall as its trace has it."""
    scene = Path(folder) / "scene.toml"
    values = dict(clearance=CLEARANCE_M, stiffness=STIFFNESS_N_M, friction=FRICTION)
    scene.write_text(SCENE.format(x=float(x), y=float(y), **values))
    out = Path(folder) / "out"
    subprocess.run([host, "run", scene, "--out", out], check=True, capture_output=True)
    trace = out / "trace_passive.parquet"
    subprocess.run([host, "export", trace, "--to", "csv"], check=True, capture_output=True)
    lines = trace.with_suffix(".csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")]
    tangential = float(rows[1][rows[0].index("sliding_force_n")])
    return tangential * np.array([-y, x]) / np.hypot(x, y)


def main(host):
    shaft = rs.rotor_example_with_damping()
    gap = dict(distance=CLEARANCE_M, contact_stiffness=STIFFNESS_N_M, contact_damping=0.0)
    rub = Rubbing(shaft, n=12, friction_coeff=FRICTION, **gap)
    right = {"ROSS": 0, "plant": 0}
    print(f"ROSS {rs.__version__}\n at [deg]  ROSS off by [deg]  plant off by [deg]")
    with tempfile.TemporaryDirectory() as folder:
        for place in range(PLACES):
            angle = 2 * np.pi * place / PLACES
            x, y = (CLEARANCE_M + DEPTH_M) * np.cos(angle), (CLEARANCE_M + DEPTH_M) * np.sin(angle)
            against = np.array([np.sin(angle), -np.cos(angle)])
            off = {}
            for name, force in (("ROSS", of_ross(rub, x, y)), ("plant", of_plant(host, folder, x, y))):
                cosine = force @ against / np.linalg.norm(force)
                off[name] = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
                right[name] += off[name] < NEAR_DEG
            print(f"{np.degrees(angle):9.1f}{off['ROSS']:19.1f}{off['plant']:20.1f}")
    print(f"within {NEAR_DEG}° against the sliding at {right['ROSS']} and {right['plant']} of {PLACES} places")
    return right["plant"] != PLACES


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
