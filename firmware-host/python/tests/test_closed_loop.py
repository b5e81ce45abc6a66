"""Closed loops: the figures of the command line, controllers of one's own, and what goes wrong with them."""

import importlib.util
import json
import math

import ambwhirl
import numpy as np
import pyarrow.parquet as pq
import pytest

TIMES = {"run_time_s", "real_time_ratio"}


def without_times(verdict):
    return {key: value for key, value in verdict.items() if key not in TIMES}


def compare(run, verdict):
    """Every figure of a run with those that the program has written, to the last bit."""
    supervision = verdict.pop("supervision", None)
    verdict.pop("planes", None)
    verdict.pop("name", None)
    assert run.figures == without_times(verdict)
    assert run.supervision == supervision


def compare_trace(table, path):
    expected = pq.read_table(path)
    assert table.columns == expected.column_names and len(table) == expected.num_rows
    for heading in table.columns:
        column = expected[heading].to_numpy(zero_copy_only=False)
        assert np.array_equal(table[heading], column), heading


def module(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def test_a_scene_gives_the_figures_and_the_trace_of_the_program(scenes, host, tmp_path):
    path = scenes / "overload_then_release.toml"
    verdict = json.loads(host("run", path, "--out", tmp_path, "--json", "--set", "run.duration_s=0.1", "--seed", 7))
    runs = ambwhirl.run_scene(path, values={"run.duration_s": 0.1}, seed=7)
    assert list(runs) == ["passive", "radial", "levitation", "supervisor"] and set(runs) == set(verdict["policies"])
    for policy, run in runs.items():
        compare(run, verdict["policies"][policy])
        compare_trace(run.trace, tmp_path / f"trace_{policy}.parquet")
    assert runs["supervisor"].record == (tmp_path / "record_supervisor.bin").read_bytes()
    assert runs["passive"].record is None and runs["passive"].figures["impacts"] > 0


def test_a_whole_rotor_gives_the_figures_of_the_program(scenes, host, tmp_path):
    path = scenes / "machines" / "impact_at_one_end.toml"
    verdict = json.loads(host("run", path, "--out", tmp_path, "--json", "--set", "run.duration_s=0.03", "--set", 'run.policies=["supervisor"]'))
    runs = ambwhirl.run_scene(path, values={"run.duration_s": 0.03}, policy="supervisor")
    run, expected = runs["supervisor"], verdict["policies"]["supervisor"]
    planes = expected["planes"]
    compare(run, expected)
    assert list(run.planes) == [plane["name"] for plane in planes] and len(planes) == 2
    for plane in planes:
        name = plane["name"]
        compare(run.planes[name], plane)
        file = "".join(c if c.isalnum() else "_" for c in name.lower())
        compare_trace(run.planes[name].trace, tmp_path / f"trace_supervisor_{file}.parquet")
    compare_trace(run.axis, tmp_path / "axis_supervisor.parquet")


def test_a_controller_in_this_process_is_the_one_in_a_file(scenes, host, tmp_path):
    """The same class: called here, and by the program in a process of its own."""
    path = scenes / "controllers" / "pid_in_python.toml"
    verdict = json.loads(host("run", path, "--out", tmp_path, "--json"))
    runs = ambwhirl.run_scene(path, controller=module(scenes / "controllers" / "pid.py").Pid)
    for policy, run in runs.items():
        compare(run, verdict["policies"][policy])
        compare_trace(run.trace, tmp_path / f"trace_{policy}.parquet")
    assert runs["supervisor"].figures["impacts"] > 0


def test_it_stands_in_the_place_of_gains(scenes):
    """A scene with [levitation] and the PID with its gains: the same bits."""
    path = scenes / "overload_then_release.toml"
    pid = module(scenes / "controllers" / "pid.py").Pid

    def make(setup):
        assert setup.parameters == [] and setup.magnets == setup.sensors == 1
        assert setup.magnet_plane == [0] and setup.force_max_n == [1000.0] and setup.period_s == 5e-5

        class WithGains:
            parameters = [5e5, 0.0, 1500.0, 1e-4]
            period_s, force_max_n = setup.period_s, setup.force_max_n

        return pid(WithGains)

    both = ["levitation", "supervisor"]
    own = ambwhirl.run_scene(path, controller=make, policy=both)
    gains = ambwhirl.run_scene(path, policy=both)
    for policy in both:
        assert own[policy].figures == gains[policy].figures
        assert np.array_equal(own[policy].trace["rotor_x_m"], gains[policy].trace["rotor_x_m"])


def test_each_run_has_a_controller_of_its_own_and_closes_it(plain):
    made, closed = [], []

    class Own:
        def __init__(self, setup):
            made.append(self)
            self.samples = []

        def step(self, sample):
            self.samples.append((sample.t_s, sample.sequence, sample.hold, sample.spin_rad_s))
            return [-5e5 * x for x in sample.position_m]

        def close(self):
            closed.append(len(self.samples))

    scene = ambwhirl.Scene.parse(plain)
    runs = ambwhirl.run_scene(scene, controller=Own, policy=["passive", "levitation", "supervisor"], trace=False)
    assert len(made) == 2 and closed == [400, 400]
    assert made[0].samples[3] == (pytest.approx(3 / 20000), [3], False, pytest.approx(150 * 2 * math.pi))
    assert runs["levitation"].trace is None


def test_a_whole_rotor_has_one_controller(scenes):
    asked = []

    def make(setup):
        assert setup.sensors == setup.magnets == 2 and setup.magnet_plane == [0, 1]

        def step(sample):
            asked.append(len(sample.position_m))
            return np.clip(-2e6 * np.array(sample.position_m), -50.0, 50.0)

        return step

    path = scenes / "machines" / "impact_at_one_end.toml"
    values = {"run.duration_s": 0.021}
    runs = ambwhirl.run_scene(path, controller=make, policy="levitation", values=values)
    assert asked == [4] * 420
    assert any(np.any(plane.trace["commanded_x_n"] != 0) for plane in runs["levitation"].planes.values())


def test_what_it_raises_comes_through(plain):
    class Mine(Exception):
        pass

    def make(setup):
        def step(sample):
            if sample.t_s >= 0.01:
                raise Mine("enough")
            return [0.0, 0.0]

        return step

    scene = ambwhirl.Scene.parse(plain)
    with pytest.raises(Mine) as raised:
        ambwhirl.run_scene(scene, controller=make)
    assert str(raised.value) == "enough"
    if hasattr(raised.value, "__notes__"):
        assert raised.value.__notes__ == ["policy levitation: controller make at 0.01 s: raised an exception"]
    assert raised.traceback[-1].name == "step"
    with pytest.raises(ZeroDivisionError):
        ambwhirl.run_scene(scene, controller=lambda setup: 1 / 0)
    with pytest.raises(KeyboardInterrupt):
        ambwhirl.run_scene(scene, controller=lambda setup: (_ for _ in ()).throw(KeyboardInterrupt))

    class Ends:
        def __init__(self, setup): ...
        def step(self, sample):
            return (0.0, 0.0)

        def close(self):
            raise Mine("at the end")

    with pytest.raises(Mine, match="at the end"):
        ambwhirl.run_scene(scene, controller=Ends)


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        ([0.0], "step returned 1 forces, expected 2"),
        (np.zeros(3), "step returned 3 forces, expected 2"),
        (np.zeros((2, 2)), "expected a list of 2 forces"),
        ([0.0, math.nan], "its force in y of plane 1 is NaN"),
        (np.array([math.inf, 0.0]), "its force in x of plane 1 is inf"),
        (None, "step returned None, expected a list of 2 forces"),
        (["a", "b"], r"step returned \['a', 'b'\], expected a list of 2 forces"),
    ],
)
def test_answers_that_are_none_are_named(plain, answer, says):
    scene = ambwhirl.Scene.parse(plain)
    with pytest.raises(ambwhirl.ControllerError, match=f"(?s)^policy levitation: controller <lambda> at 0 s: .*{says}"):
        ambwhirl.run_scene(scene, controller=lambda setup: lambda sample: answer)


def test_controllers_that_are_none_are_named(plain):
    scene = ambwhirl.Scene.parse(plain)
    with pytest.raises(TypeError, match="^controller: 5 is not callable"):
        ambwhirl.run_scene(scene, controller=5)
    with pytest.raises(TypeError, match="^controller: it returned 5, which has no method step"):
        ambwhirl.run_scene(scene, controller=lambda setup: 5)


def test_a_run_that_cannot_be_trusted_is_named(plain):
    scene = ambwhirl.Scene.parse(plain, {"rotor.stiffness_n_m": -1e9, "verdict.whirl_speed_m_s": 1.0})
    with pytest.raises(ambwhirl.RunError, match="^policy passive: at t = .*far beyond its stator"):
        ambwhirl.run_scene(scene, policy="passive")


def test_others_run_meanwhile(scenes):
    """Two runs in two threads give the same as one."""
    from concurrent.futures import ThreadPoolExecutor

    path = scenes / "controllers" / "pid_in_python.toml"
    pid = module(scenes / "controllers" / "pid.py").Pid

    def run(_):
        return ambwhirl.run_scene(path, controller=pid, policy="supervisor", values={"run.duration_s": 0.03}, trace=False)

    alone = run(0)["supervisor"].figures
    with ThreadPoolExecutor(2) as pool:
        assert [runs["supervisor"].figures for runs in pool.map(run, range(2))] == [alone] * 2
