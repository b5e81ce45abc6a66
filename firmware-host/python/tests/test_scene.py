"""Scenes: keys and values, and the errors of the command line."""

import ambwhirl
import numpy as np
import pytest


def test_values_by_key(plain):
    scene = ambwhirl.Scene.parse(plain)
    assert scene.get("friction.coefficient") == 0.15 and scene.get("run.rtol") == 1e-9
    assert scene.get("levitation") is None and scene.get("start.position_m[0]") == 2e-5
    assert scene.get("run.policies") == ["levitation"]
    other = scene.replace({
        "friction.coefficient": np.float32(0.5),
        "run.seed": np.int64(3),
        "start.position_m": np.array([1e-5, 2e-5]),
        "levitation": {"proportional_n_m": 5e5, "derivative_n_s_m": 1500, "feed_forward_weight": True},
    })
    assert other.get("friction.coefficient") == 0.5 and other.get("run.seed") == 3
    assert other.get("start.position_m") == [1e-5, 2e-5] and other.get("levitation.feed_forward_weight") is True
    assert scene.get("friction.coefficient") == 0.15
    assert isinstance(other.check(), list) and repr(scene) == '<ambwhirl.Scene "Plain">'


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("mass_kg = 10.0", "mass_kg = nan"),
        ("mass_kg = 10.0", "mass_kg = -1"),
        ("mass_kg = 10.0", "mas_kg = 10.0"),
        ("mass_kg = 10.0", 'mass_kg = "10"'),
        ("policies = [", "policies = [1"),
        ("[spin]", "[spin"),
        ('["levitation"]', '["levitation"]  # but no controller'),
    ],
)
def test_errors_are_those_of_the_command_line(plain, host, tmp_path, before, after):
    path = tmp_path / "scene.toml"
    path.write_text(plain.replace(before, after, 1))
    told = host("run", path, "--out", tmp_path / "out", code=2)
    with pytest.raises(ambwhirl.SceneError) as raised:
        ambwhirl.run_scene(path)
    error = raised.value
    assert isinstance(error, ValueError) and error.message.startswith(f"{path}:")
    # The program marks lines after the first of a message.
    plain_told = " ".join(told.replace("│", " ").split())
    assert " ".join(error.message.split()) in plain_told
    if error.help is None:
        assert "help:" not in told and str(error) == error.message
    else:
        assert " ".join(error.help.split()) in plain_told
        assert str(error) == f"{error.message}\nhelp: {error.help}"


def test_warnings_are_pythons(plain):
    scene = ambwhirl.Scene.parse(plain, {"run.sample_rate_hz": 5000})
    with pytest.warns(UserWarning, match="run.sample_rate_hz") as told:
        ambwhirl.run_scene(scene, controller=lambda setup: lambda sample: [0.0, 0.0], policy="supervisor")
    assert told[0].filename == __file__


def test_values_that_are_refused_name_their_key(plain):
    scene = ambwhirl.Scene.parse(plain, name="mine")
    with pytest.raises(ambwhirl.SceneError, match="friction.coefficient.* is NaN, expected"):
        scene.replace({"friction.coefficient": float("nan")}).check()
    with pytest.raises(ambwhirl.SceneError, match="^mine:.*friction.coeff"):
        scene.replace({"friction.coeff": 1.0})
    with pytest.raises(ambwhirl.SceneError, match="start.position_m"):
        scene.replace({"start.position_m": [1.0, 2.0, 3.0]})
    with pytest.raises(ambwhirl.SceneError, match='there is no policy "levitate"'):
        ambwhirl.run_scene(scene, policy="levitate")
    with pytest.raises(TypeError, match="^rotor.mass_kg: "):
        scene.replace({"rotor.mass_kg": object()})
    with pytest.raises(TypeError, match="^scene: expected"):
        ambwhirl.run_scene(5)
    with pytest.raises(ambwhirl.SceneError, match="cannot read scene"):
        ambwhirl.Scene("there_is_none.toml")
