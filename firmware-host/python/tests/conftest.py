"""What the tests share: where the project is, and the program that the figures are compared with."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SCENES = ROOT / "firmware-host" / "scenes"


@pytest.fixture(scope="session")
def scenes():
    return SCENES


@pytest.fixture(scope="session")
def host():
    """Runs `firmware-host` with these words, in a folder; what it prints comes back. `cargo build --release` makes it."""
    program = Path(os.environ.get("FIRMWARE_HOST", ROOT / "target" / "release" / "firmware-host"))
    assert program.is_file(), f"{program} is missing: cargo build --release"

    def run(*words, code=0, cwd=ROOT):
        done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=cwd)
        assert done.returncode == code, done.stderr
        return done.stdout if code == 0 else done.stderr

    return run


@pytest.fixture
def plain():
    """A scene of one plane without a controller, from its text."""
    return """title = "Plain"
[run]
duration_s = 0.02
sample_rate_hz = 20000
policies = ["levitation"]
[rotor]
mass_kg = 10.0
contact_radius_m = 0.03
[spin]
frequency_hz = 150.0
[start]
position_m = [2e-5, 0.0]
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.6
[friction]
coefficient = 0.15
[magnet]
force_max_n = 1000.0
lag_s = 1.6e-4
"""
