"""A levitation controller that is a co-simulation unit (FMI 2.0 or 3.0): controller.fmu beside this file, run by FMPy.

The unit's inputs of numbers are, in their order, x and y of each sensor [m], its outputs x and y of each magnet [N]. A Boolean
input named "hold" is told while integrators are to stand. Its parameters are, in their order, controller.parameters.
"""
from pathlib import Path
from shutil import rmtree

from fmpy import extract, instantiate_fmu, read_model_description

FILE = Path(__file__).with_name("controller.fmu")


class Unit:
    def __init__(self, scene):
        model = read_model_description(FILE)
        number = lambda v: v.type in ("Real", "Float64")
        of = lambda cause: [v.valueReference for v in model.modelVariables if v.causality == cause and number(v)]
        self.inputs, self.outputs = of("input"), of("output")
        self.hold = [v.valueReference for v in model.modelVariables if v.name == "hold" and v.causality == "input"]
        if (len(self.inputs), len(self.outputs)) != (2 * scene.sensors, 2 * scene.magnets):
            raise ValueError(f"{FILE.name}: {len(self.inputs)} inputs and {len(self.outputs)} outputs of numbers")
        self.period_s, self.folder = scene.period_s, extract(FILE)
        self.fmu = instantiate_fmu(self.folder, model, fmi_type="CoSimulation")
        two = model.fmiVersion == "2.0"
        self.set, self.get = (self.fmu.setReal, self.fmu.getReal) if two else (self.fmu.setFloat64, self.fmu.getFloat64)
        parameters = of("parameter")[: len(scene.parameters)]
        self.set(parameters, scene.parameters[: len(parameters)])
        if two:
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def step(self, sample):
        self.set(self.inputs, sample.position_m)
        if self.hold:
            self.fmu.setBoolean(self.hold, [sample.hold])
        self.fmu.doStep(sample.t_s, self.period_s)
        return self.get(self.outputs)

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        rmtree(self.folder, ignore_errors=True)


make = Unit
