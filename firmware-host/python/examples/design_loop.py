"""Designs a levitation controller on the plant of a scene, with python-control:

    firmware-host export SCENE.toml --plant --out .
    python design_loop.py SCENE_plant.npz controller.npz

and in the scene, in the place of [levitation]:

    [state_space]
    file = "controller.npz"
"""

import json
import sys

import control
import numpy as np

file = np.load(sys.argv[1])
names = json.loads(file["names.json"])
plant = control.ss(file["Ad"], file["Bd"], file["Cd"], file["Dd"], names["sample_period_s"])

# What a place off the middle is worth in force, and what forces and noise are expected.
PLACE_M, FORCE_N, PUSH_N, NOISE_M = 1e-5, 30.0, 50.0, 1e-6
readings, forces = plant.noutputs, plant.ninputs
gain, _, _ = control.dlqr(plant, plant.C.T @ plant.C / PLACE_M**2, np.eye(forces) / FORCE_N**2)
seen, _, _ = control.dlqe(plant.A, plant.B, plant.C, PUSH_N**2 * np.eye(forces), NOISE_M**2 * np.eye(readings))
controller = control.ss(
    plant.A - plant.B @ gain - seen @ plant.C, seen, -gain, np.zeros((forces, readings)), plant.dt
)
closed = control.feedback(plant, controller, sign=1)
np.savez(sys.argv[2], A=controller.A, B=controller.B, C=controller.C, D=controller.D)
rates = np.log(closed.poles()) / plant.dt
slowest = max(rates.real)
print(json.dumps({"growth_1_s": slowest, "rates_1_s": [[rate.real, rate.imag] for rate in rates]}))
