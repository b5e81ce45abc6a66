"""Units under FMPy: python fmu_units.py CHECK FILES…; what does not hold is an exception.

valid UNIT…              FMPy's validation finds nothing
equal UNIT POLICY TRACE… [KEY=VALUE…]
                         the closed loop's outputs are the rows of the traces (one a plane), to the last bit
positions CSV TRACE      times and positions are those of the trace, to the last bit
traces TRACE TRACE       two runs are the same, to the last bit
ticks SUPERVISOR CSV     commands to the samples of a table are those that stand there, to the last bit
errors PLANT             what is wrong ends in an error with its text in the log
early PLANT              a step of many samples ends where the rotor touches
"""
import sys

import numpy as np
import pandas as pd
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave, fmi3LogMessageCallback
from fmpy.validation import validate_fmu

POLICIES = ["passive", "radial", "damping", "levitation", "supervisor"]
CONTACT = ["flight", "slip+", "slip-", "roll", "seated"]


def valid(*units):
    for unit in units:
        problems = validate_fmu(unit)
        assert not problems, (unit, problems)


def same(computed, native, what):
    computed = np.ascontiguousarray(computed, dtype=float)[: len(native)]
    unlike = computed.view(np.int64) != np.ascontiguousarray(native, dtype=float).view(np.int64)
    assert not unlike.any(), f"{what}: {unlike.sum()} of {len(native)} rows, first {unlike.argmax()}"


def equal(unit, policy, *arguments):
    traces = [a for a in arguments if "=" not in a]
    start = dict(a.split("=") for a in arguments if "=" in a)
    model = read_model_description(unit)
    outputs = [v.name for v in model.modelVariables if v.causality == "output"]
    experiment = model.defaultExperiment
    step_s = float(experiment.stepSize)
    rows = simulate_fmu(
        unit,
        start_values={"policy": POLICIES.index(policy), **start},
        stop_time=float(experiment.stopTime),
        step_size=step_s,
        output_interval=step_s,
        output=outputs,
    )
    compared, contact_force_n = 0, 0.0
    for plane, trace in enumerate(traces):
        prefix = f"plane[{plane}]." if len(traces) > 1 else ""
        native = pd.read_parquet(trace)
        # Rows between samples no step ends at; at the last one nothing is sampled any more.
        native = native[~native["mode_change"]]
        assert len(native) == len(rows) and len(native) > 100
        native = native[:-1]
        contact_force_n = max(contact_force_n, native["contact_force_n"].max())
        for column in native.columns:
            if prefix + column in outputs and native[column].dtype == float:
                same(rows[prefix + column], native[column], prefix + column)
                compared += 1
        modes = [CONTACT[int(m)] for m in rows[prefix + "mode"][:-1]]
        assert modes == list(native["mode"])
        if policy == "supervisor":
            of = next(v.declaredType for v in model.modelVariables if v.name == prefix + "supervisor_mode")
            names = {int(item.value): item.name for item in of.items}
            said = [names[int(m)] for m in rows[prefix + "supervisor_mode"][:-1]]
            assert said == list(native["supervisor_mode"])
            events = rows[prefix + "supervisor_events"][:-1] != 0
            assert list(events) == list(native["supervisor_events"] != "")
    # What never touches shows little.
    assert contact_force_n > 0
    assert compared >= 25 * len(traces), compared
    print(f"{len(rows)} rows, {compared} columns the same")


def positions(table, trace):
    computed, native = pd.read_csv(table, header=None), pd.read_parquet(trace)
    native = native[~native["mode_change"]][:-1]
    assert len(computed) == len(native)
    for column, name in enumerate(["t_s", "rotor_x_m", "rotor_y_m"]):
        same(computed[column], native[name], name)
    print(f"{len(native)} positions the same")


def ticks(unit, table):
    native = pd.read_csv(table, float_precision="round_trip")
    model = read_model_description(unit)
    variables = {v.name: v for v in model.modelVariables if v.causality in ("input", "output")}
    assert set(native.columns) == set(variables), set(native.columns) ^ set(variables)
    fmu = instantiate_fmu(extract(unit), model)
    if model.fmiVersion == "2.0":
        fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        calls = {"Real": "Real", "Integer": "Integer", "Boolean": "Boolean", "Enumeration": "Integer"}
    else:
        fmu.enterInitializationMode(startTime=0.0)
        calls = {"Float64": "Float64", "UInt32": "UInt32", "Boolean": "Boolean", "Enumeration": "Int64"}
    fmu.exitInitializationMode()
    # Variables of one type and direction go in one call.
    groups = {}
    for name in native.columns:
        groups.setdefault((variables[name].causality, calls[variables[name].type]), []).append(name)
    groups = [(side, call, names, [variables[n].valueReference for n in names]) for (side, call), names in groups.items()]
    period_s = float(model.defaultExperiment.stepSize)
    computed = {name: [] for name in native.columns}
    for tick, row in enumerate(native.to_dict("records")):
        for side, call, names, references in groups:
            if side == "input":
                getattr(fmu, "set" + call)(references, [row[name] for name in names])
        fmu.doStep(tick * period_s, period_s)
        for side, call, names, references in groups:
            if side == "output":
                for name, value in zip(names, getattr(fmu, "get" + call)(references)):
                    computed[name].append(value)
    fmu.terminate()
    fmu.freeInstance()
    outputs = [name for name, v in variables.items() if v.causality == "output"]
    for name in outputs:
        same(computed[name], native[name], name)
    planes = {name.split(".")[0] for name in outputs}
    assert len(outputs) == 7 * len(planes)
    print(f"{len(native)} ticks of {len(planes)} planes the same")


def traces(one, other):
    one, other = pd.read_parquet(one), pd.read_parquet(other)
    assert list(one.columns) == list(other.columns) and len(one) == len(other) > 100
    for column in one.columns:
        if one[column].dtype == float:
            same(one[column], other[column], column)
        else:
            assert (one[column] == other[column]).all(), column
    print(f"{len(one)} rows the same")


def begun(unit, early=False, **start):
    """An instance that stands at its first sample, its variables by name, and its log."""
    log = []
    model = read_model_description(unit)
    number = {v.name: v.valueReference for v in model.modelVariables}
    fmu = FMU3Slave(
        guid=model.instantiationToken,
        unzipDirectory=extract(unit),
        modelIdentifier=model.coSimulation.modelIdentifier,
        instanceName="tested",
    )
    said = lambda environment, status, category, text: log.append((status, text.decode()))
    fmu.callback = fmi3LogMessageCallback(said)
    fmu.instantiate(logMessage=fmu.callback, earlyReturnAllowed=early)
    for name, value in start.items():
        fmu.setFloat64([number[name.replace("__", ".")]], [value])
    fmu.enterInitializationMode(startTime=0.0)
    return fmu, number, log


def refused(log, text, call, *arguments):
    """A call that ends with an error of this text, said once."""
    log.clear()
    try:
        call(*arguments)
    except FMICallException as error:
        assert error.status == 3, error.status
    else:
        raise AssertionError(f"{text}: was not refused")
    assert len(log) == 1 and log[0][0] == 3 and text in log[0][1], log


def errors(unit):
    fmu, number, log = begun(unit)
    fmu.exitInitializationMode()
    period_s = 5e-5
    refused(log, "it has to be a whole number of control periods", fmu.doStep, 0.0, 1.5 * period_s)
    refused(log, "the unit stands at 0 s", fmu.doStep, 0.1, period_s)
    refused(log, "is for reading", fmu.setFloat64, [number["rotor_x_m"]], [0.0])
    refused(log, "is set before the first step", fmu.setFloat64, [number["rotor.mass_kg"]], [1.0])
    refused(log, "there is no variable 100000", fmu.getFloat64, [100000])
    refused(log, "of another type", fmu.getInt64, [number["rotor_x_m"]])
    refused(log, "friction.coefficient", fmu.setFloat64, [number["friction.coefficient"]], [-1.0])
    # None of these has ended it.
    fmu.doStep(0.0, period_s)
    fmu.setFloat64([number["friction.coefficient"]], [0.2])
    fmu.setFloat64([number["load_x_n"]], [1e12])
    refused(log, "far beyond its stator", fmu.doStep, period_s, 2000 * period_s)
    refused(log, "it failed before", fmu.doStep, 2 * period_s, period_s)
    fmu.reset()
    fmu.enterInitializationMode(startTime=3.0)
    fmu.exitInitializationMode()
    fmu.doStep(3.0, period_s)
    assert fmu.getFloat64([0]) == [3.0 + period_s]
    fmu.terminate()
    fmu.freeInstance()
    fmu, number, log = begun(unit, rotor__mass_kg=-1.0)
    refused(log, "rotor.mass_kg: is -1, expected a finite number greater than 0", fmu.exitInitializationMode)
    fmu.freeInstance()
    # A unit whose description is another's.
    model = read_model_description(unit)
    model.instantiationToken = model.instantiationToken[:-1] + "x"
    try:
        instantiate_fmu(extract(unit), model)
    except Exception as error:
        assert "Failed to instantiate" in str(error), error
    else:
        raise AssertionError("another token was taken")


def early(unit):
    ends_s = {}
    for allowed in (False, True):
        fmu, number, _ = begun(unit, allowed)
        fmu.exitInitializationMode()
        t_s, returns = 0.0, 0
        while t_s < 0.1 - 1e-9:
            _, _, returned, t_s = fmu.doStep(t_s, 0.1 - t_s)
            returns += returned
        ends_s[allowed] = (returns, fmu.getFloat64([number["rotor_x_m"]]))
        fmu.terminate()
        fmu.freeInstance()
    assert ends_s[False][0] == 0 and ends_s[True][0] > 3, ends_s
    # Where it stops on the way changes nothing.
    assert ends_s[False][1] == ends_s[True][1]
    print(f"{ends_s[True][0]} early returns")


if __name__ == "__main__":
    check, *files = sys.argv[1:]
    checks = {"valid": valid, "equal": equal, "positions": positions, "traces": traces, "ticks": ticks, "errors": errors, "early": early}
    checks[check](*files)
