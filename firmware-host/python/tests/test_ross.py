"""Rotors of ROSS as scenes. ROSS brings a hundred packages, so that here what is read of it stands in; tests/ross has ROSS itself."""

import json
import math
import re
import shlex
import subprocess
import sys
from types import ModuleType, SimpleNamespace

import ambwhirl
import pytest
from ambwhirl.ross import to_scene
from conftest import ROOT

MU_0 = 4e-7 * math.pi


def shaft_element(L, idl, odl, material, **other):
    effects = dict(shear_effects=True, rotary_inertia=True, gyroscopic=True, alpha=0, beta=0, axial_force=0, torque=0)
    return SimpleNamespace(L=L, idl=idl, odl=odl, idr=idl, odr=odl, material=material, **{**effects, **other})


def bearing(n, kxx, **other):
    zero = dict.fromkeys(["kyy", "cxx", "cyy", "kxy", "kyx", "cxy", "cyx", "kzz"], [0.0])
    return SimpleNamespace(n=n, kxx=kxx, **{**zero, "n_link": None, **other})


def magnetic_bearing(n, g0, i0, ag, nw, kp_pid, kd_pid, ki_pid=0, n_f=1e4, alpha=math.pi / 8, **other):
    ki = MU_0 * nw**2 * ag * i0 * math.cos(alpha) / g0**2
    given = dict(controller_transfer_function_num=None, k_amp=1, k_sense=1, sensors_axis_rotation=math.pi / 4, n_link=None)
    own = dict(n=n, g0=g0, i0=i0, ki=ki, ks=-ki * i0 / g0, kp_pid=kp_pid, kd_pid=kd_pid, ki_pid=ki_pid, n_f=n_f)
    return SimpleNamespace(**own, **{**given, **other})


def rotor(shaft, discs, bearings):
    nodes_pos = [0.0]
    for n, element in enumerate(shaft):
        element.n = n
        nodes_pos.append(nodes_pos[-1] + element.L)
    return SimpleNamespace(
        shaft_elements=shaft, disk_elements=discs, bearing_elements=bearings, point_mass_elements=[], nodes_pos=nodes_pos
    )


@pytest.fixture
def ross(monkeypatch):
    module = ModuleType("ross")
    module.Material = module.DiskElement = SimpleNamespace
    module.ShaftElement, module.MagneticBearingElement, module.Rotor = shaft_element, magnetic_bearing, rotor
    monkeypatch.setitem(sys.modules, "ross", module)


def test_the_page_runs_from_its_top_to_its_end(ross, host, tmp_path, monkeypatch):
    """Of 500 drops, eight."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "firmware-host").symlink_to(ROOT / "firmware-host")
    page = (ROOT / "docs" / "src" / "start" / "two-bearings.md").read_text()
    names, printed = {}, {}
    for language, block in re.findall(r"```(\w+)\n(.*?)```", page, re.DOTALL):
        if language == "python":
            exec(compile(block, "two-bearings.md", "exec"), names)
        elif language == "toml":
            assert "runs = 500" in block
            (tmp_path / "drops.toml").write_text(block.replace("runs = 500", "runs = 8"))
        elif language == "csv":
            (tmp_path / "steps.csv").write_text(block)
        else:
            assert language == "sh"
            for line in block.replace("\\\n", " ").splitlines():
                words = shlex.split(line.removeprefix("cargo run --release -- "))
                if words[0] == "python3":
                    subprocess.run([sys.executable, *words[1:]], check=True, capture_output=True)
                else:
                    printed[" ".join(words[:2])] = host(*words, cwd=tmp_path)
    assert "The loop is stable" in printed["modes own.toml"] and "NOT stable" in printed["modes from_ross.toml"]
    assert re.search(r"outcome +recovered +recovered", printed["run own.toml"])
    assert "static const amb_shaft shaft" in printed["advise own.toml"]
    assert "8 runs" in printed["sweep drops.toml"] and (tmp_path / "runs" / "drops" / "report.html").is_file()


def made(*bearings, **changes):
    steel = SimpleNamespace(rho=7850.0, E=2.1e11, Poisson=0.3)
    shaft = [shaft_element(0.1, 0.0, 0.05, steel, **changes) for _ in range(8)]
    return rotor(shaft, [SimpleNamespace(n=4, m=3.0, Id=0.004, Ip=0.007)], list(bearings))


COILS = dict(g0=5e-4, i0=3, ag=7.2e-4, nw=100, kp_pid=12e3, kd_pid=21, ki_pid=5e3)


def test_a_magnetic_bearing_is_a_magnet_with_its_controller():
    one, other = magnetic_bearing(1, **COILS), magnetic_bearing(7, **COILS, k_sense=1.5)
    scene = ambwhirl.Scene.parse(to_scene(made(one, other)))
    assert scene.get("plane[0].position_m") == pytest.approx(0.1) and scene.get("contact.clearance_m") == 2.5e-4
    magnet = {key: scene.get(f"plane[1].magnet.{key}") for key in ["force_max_n", "negative_stiffness_n_m", "axes_deg"]}
    assert magnet == pytest.approx({"force_max_n": 3 * one.ki, "negative_stiffness_n_m": -one.ks, "axes_deg": 45.0})
    for plane, newtons in [(0, one.ki), (1, 1.5 * one.ki)]:
        gains = ["proportional_n_m", "integral_n_m_s", "derivative_n_s_m", "derivative_filter_s"]
        found = [scene.get(f"plane[{plane}].levitation.{key}") for key in gains]
        assert found == pytest.approx([12e3 * newtons, 5e3 * newtons, 21 * newtons, 1e-4])
    less = ambwhirl.Scene.parse(to_scene(made(one, other), current_max_a=2))
    assert less.get("plane[0].magnet.force_max_n") == pytest.approx(2 * one.ki)


def test_a_transfer_function_is_sampled_as_the_same_controller(host, tmp_path):
    """PID with a filter of the derivative, by its gains and as a fraction: the loops have the same modes."""
    newtons, rates = dict(COILS, ki_pid=0), []
    fraction = dict(controller_transfer_function_num=[21.0 + 12e3 * 1e-4, 12e3], controller_transfer_function_den=[1e-4, 1.0])
    for given in [{}, fraction]:
        magnets = [magnetic_bearing(n, **newtons, **given) for n in (1, 7)]
        text = to_scene(made(*magnets), sample_rate_hz=1e5)
        assert ("[plane.biquads]" in text) == bool(given)
        (tmp_path / "scene.toml").write_text(text)
        found = json.loads(host("modes", tmp_path / "scene.toml", "--levitated", "--points", 2, "--json"))
        rates.append([m["frequency_hz"] for m in found["loop_modes"] if m["frequency_hz"] < 1000.0])
    assert len(rates[0]) >= 6 and rates[0] == pytest.approx(rates[1], rel=1e-2)


def test_what_is_lost_is_named_and_the_rest_refused():
    steady = bearing(1, [1e6]), bearing(7, [1e6], cxy=[2.0], kyx=[-3.0])
    text = to_scene(made(*steady))
    assert "Not as in ROSS" not in text and "cross_damping_n_s_m = [2.0, 0.0]" in text and "[0.0, -3.0]" in text
    assert ambwhirl.Scene.parse(text).get("support[1].stiffness_n_m") == [1e6, 0.0]
    text = to_scene(made(bearing(1, [1e6, 2e6]), bearing(7, [1e6], mxx=[3.0]), beta=1e-5))
    for named in ["without internal damping", "node 1: kxx at the lowest speed", "node 7: without mxx"]:
        assert named in text
    assert "internal damping" not in to_scene(made(*steady, beta=1e-5), matrices_file="rotor.npz")
    uneven = magnetic_bearing(1, **COILS)
    uneven.ki = [1.0, 2.0]
    double = made(*steady)
    double.shaft_elements[1].n = 0
    for refused, why in [
        (made(bearing(1, [1e6], n_link=9)), "linked to node 9"),
        (made(uneven), "ki differs between the axes"),
        (double, "two shaft elements at node 0"),
    ]:
        with pytest.raises(ValueError, match=why):
            to_scene(refused)
