"""Plants that are carried from Python."""

import ambwhirl
import numpy as np
import pytest


def samples(trace):
    return ~trace["mode_change"]


def test_steps_are_those_of_the_closed_loop(scenes):
    """Under the commands of a run that nothing else acts on the plant moves as it did there, bit for bit, through contact."""
    scene = ambwhirl.Scene(scenes / "impact_at_40_hz.toml", {"run.duration_s": 0.05})
    trace = ambwhirl.run_scene(scene, policy="supervisor")["supervisor"].trace
    at = samples(trace)
    commands_n = np.stack([trace["commanded_x_n"][at], trace["commanded_y_n"][at]], axis=1)
    positions_m = np.stack([trace["rotor_x_m"][at], trace["rotor_y_m"][at]], axis=1)
    assert set(trace["mode"]) > {"flight"} and np.abs(commands_n).max() > 100.0
    plant = ambwhirl.Plant(scene)
    assert np.array_equal(plant.position_m, positions_m[:1])
    one_by_one = [plant.step(command_n) for command_n in commands_n[:-1]]
    assert np.array_equal(np.stack(one_by_one)[:, 0], positions_m[1:])
    assert np.array_equal(ambwhirl.Plant(scene).steps(commands_n[:-1])[:, 0], positions_m[1:])
    assert plant.meters()[0]["impacts"] > 0 and plant.energy_residual < 1e-6
    assert plant.t_s == pytest.approx(0.05, rel=1e-12)


def test_a_ball_that_is_pushed(plain):
    """In flight, without weight and shaft, a force that is held gives a parabola."""
    scene = ambwhirl.Scene.parse(plain, {"magnet.lag_s": 0.0, "start.position_m": [0.0, 0.0]})
    plant = ambwhirl.Plant(scene)
    assert plant.advance(1e-3, commands_n=(50.0, 0.0), loads_n=np.array([0.0, 20.0])) == []
    assert plant.position_m[0] == pytest.approx([0.5 * 5.0 * 1e-6, 0.5 * 2.0 * 1e-6], rel=1e-9)
    assert plant.velocity_m_s[0] == pytest.approx([5e-3, 2e-3], rel=1e-9)
    assert plant.modes == ["flight"] and plant.period_s == 1 / 20000
    changes = plant.advance(20e-3, commands_n=[1000.0, 0.0])
    assert changes and changes[0][0] > 1e-3 and changes[0][2] != "flight"
    (read,) = plant.read()
    assert plant.delivered_n.tolist() == [[1000.0, 0.0]] and plant.t_s == 20e-3
    assert read["mode"] == plant.modes[0] and np.array_equal(read["position_m"], plant.position_m[0])


def test_arguments_that_are_none_are_named(plain):
    plant = ambwhirl.Plant(ambwhirl.Scene.parse(plain))
    for call, says in [
        (lambda: plant.step([float("nan"), 0.0]), "^commands_n: is NaN, expected finite numbers"),
        (lambda: plant.step(loads_n=[0.0, float("inf")]), "^loads_n: is inf"),
        (lambda: plant.step([1.0, 2.0, 3.0]), r"^commands_n: has the shape \(3,\), expected \(1, 2\)"),
        (lambda: plant.step([[1.0, 2.0], [0.0, 0.0]]), r"^commands_n: has the shape \(2, 2\)"),
        (lambda: plant.step(1.0), r"^commands_n: has the shape \(\)"),
        (lambda: plant.steps(np.zeros((4, 3))), r"^commands_n: has the shape \(4, 3\), expected \(n, 1, 2\)"),
        (lambda: plant.steps([[0.0, float("nan")]]), "^commands_n: is NaN"),
        (lambda: plant.advance(float("nan")), "^to_s: is NaN"),
        (lambda: plant.advance(-1.0), "^to_s: is -1, expected a time from now on"),
        (lambda: ambwhirl.Plant(ambwhirl.Scene.parse(plain.split("[magnet]")[0], {"verdict.whirl_speed_m_s": 1.0})).step([1, 0]), r"^commands_n: has the shape \(2,\), expected \(0, 2\)"),
    ]:
        with pytest.raises(ValueError, match=says):
            call()
    with pytest.raises(TypeError, match="^commands_n: expected numbers, got 'ab'"):
        plant.step("ab")
    assert plant.t_s == 0.0
    assert plant.steps(np.zeros((0, 2))).shape == (0, 1, 2)


def test_a_plant_that_cannot_be_trusted_stays_so(plain):
    plant = ambwhirl.Plant(ambwhirl.Scene.parse(plain, {"rotor.stiffness_n_m": -1e9, "verdict.whirl_speed_m_s": 1.0}))
    with pytest.raises(ambwhirl.RunError, match="far beyond its stator"):
        plant.advance(1.0)
    with pytest.raises(ambwhirl.RunError, match="far beyond its stator"):
        plant.step()


def test_a_whole_rotor(scenes):
    """As in the closed loop, bit for bit."""
    # Up to the load, which a plant knows nothing of.
    values = {"run.duration_s": 0.0205}
    scene = ambwhirl.Scene(scenes / "machines" / "impact_at_one_end.toml", values)
    run = ambwhirl.run_scene(scene, policy="levitation")["levitation"]
    machine = ambwhirl.Plant(scene)
    traces = [plane.trace for plane in run.planes.values()]
    assert machine.planes == list(run.planes) and machine.magnets == 2
    def columns(x, y):
        return np.stack([np.stack([t[x][samples(t)], t[y][samples(t)]], axis=1) for t in traces], axis=1)

    commands_n, positions_m = columns("commanded_x_n", "commanded_y_n"), columns("rotor_x_m", "rotor_y_m")
    assert machine.loads == 2 and len(commands_n) > 400 and np.abs(commands_n).max() > 0
    for command_n, position_m in zip(commands_n[:399], positions_m[1:400]):
        assert machine.step(command_n).shape == (2, 2)
        assert np.array_equal(machine.position_m, position_m)
    machine.advance(machine.t_s + 2e-3, loads_n=[[0.0, 0.0], [2400.0, 0.0]])
    assert sum(meters["impacts"] for meters in machine.meters()) > 0 and len(machine.normal_force_n) == 2
    assert machine.energy_residual < 1e-6
    with pytest.raises(ValueError, match=r"^commands_n: has the shape \(2,\), expected \(2, 2\)"):
        machine.step([1.0, 2.0])
