"""Closes plant.fmu with a controller of one's own: the PID of scenes/controllers/pid.py; with supervisor.fmu that stands between.

python own_controller.py FOLDER [--supervised] > positions.csv
"""
import sys
from pathlib import Path
from types import SimpleNamespace

from fmpy import extract, instantiate_fmu, read_model_description

sys.path.append(str(Path(__file__).parents[2] / "scenes/controllers"))
from pid import Pid


class Unit:
    def __init__(self, file):
        self.model = read_model_description(file)
        self.number = {v.name: v.valueReference for v in self.model.modelVariables}
        self.fmu = instantiate_fmu(extract(file), self.model)
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def numbers(self, *names):
        return self.fmu.getFloat64([self.number[name] for name in names])

    def set(self, **values):
        self.fmu.setFloat64([self.number[name] for name in values], list(values.values()))


folder, supervised = Path(sys.argv[1]), "--supervised" in sys.argv
plant = Unit(folder / "plant.fmu")
supervisor = Unit(folder / "supervisor.fmu") if supervised else None
experiment = plant.model.defaultExperiment
period_s, end_s = float(experiment.stepSize), float(experiment.stopTime)
pid = Pid(SimpleNamespace(parameters=[5e5, 1e7, 1500.0, 1.5e-4], period_s=period_s, force_max_n=[1000.0]))
command_n, hold = [0.0, 0.0], False
for tick in range(round(end_s / period_s)):
    t_s, measured_m = tick * period_s, plant.numbers("measured_x_m", "measured_y_m")
    print(repr(t_s), *map(repr, plant.numbers("rotor_x_m", "rotor_y_m")), sep=",")
    force_n = pid.step(SimpleNamespace(position_m=measured_m, hold=hold))
    if supervisor:
        bits = [[unit.number[name] for name in ("sequence", "status")] for unit in (plant, supervisor)]
        supervisor.fmu.setUInt32(bits[1], plant.fmu.getUInt32(bits[0]))
        seen = ("measured_x_m", "measured_y_m", "spin_reported_rad_s", "applied_x_n", "applied_y_n")
        supervisor.set(**dict(zip(seen, plant.numbers(*seen))), levitation_x_n=force_n[0], levitation_y_n=force_n[1])
        supervisor.fmu.doStep(t_s, period_s)
        force_n = supervisor.numbers("command_x_n", "command_y_n")
        hold = supervisor.fmu.getBoolean([supervisor.number["integrator_hold"]])[0]
    plant.set(command_x_n=force_n[0], command_y_n=force_n[1])
    plant.fmu.doStep(t_s, period_s)
for unit in filter(None, [plant, supervisor]):
    unit.fmu.terminate()
    unit.fmu.freeInstance()
