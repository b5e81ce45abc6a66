"""What is shown works: the example, the page of the documentation, the notebook. Stubs name what there is."""

import ast
import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import ambwhirl
import numpy
import pytest
import scipy.io
from conftest import ROOT

HERE = Path(__file__).parent


def test_the_example_is_short_and_runs(tmp_path):
    path = HERE.parent / "examples" / "own_controller.py"
    assert len(path.read_text().splitlines()) < 20
    done = subprocess.run([sys.executable, path], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search(r"levitation +recovered", done.stdout) and re.search(r"supervisor +recovered", done.stdout), done.stdout


def test_what_measures_runs():
    path = HERE.parent / "examples" / "measure.py"
    done = subprocess.run([sys.executable, path, "0.01"], capture_output=True, text=True)
    assert done.returncode == 0 and len(re.findall(r"^ *\d+\.\d µs  ", done.stdout, re.MULTILINE)) == 6, done


def test_a_loop_is_designed_on_an_exported_plant(host, scenes, tmp_path):
    """Out to python-control and back: the poles of the design are those of the host's loop, and the rotor is held."""
    scene = scenes / "one_machine" / "flexible.toml"
    for kind in ["npz", "mat"]:
        host("export", scene, "--plant", "--to", kind, "--out", tmp_path)
    plant = numpy.load(tmp_path / "flexible_plant.npz")
    names = json.loads(plant["names.json"])
    assert names["inputs_n"] == names["outputs_m"] == ["far end x", "far end y", "coupling end x", "coupling end y"]
    other = scipy.io.loadmat(tmp_path / "flexible_plant.mat")
    assert all((other[name] == plant[name]).all() for name in ["A", "B", "C", "D", "Ad", "Bd", "Cd", "Dd"])
    assert [name.item() for name in other["states"][:, 0]] == names["states"]

    path = HERE.parent / "examples" / "design_loop.py"
    done = subprocess.run(
        [sys.executable, path, tmp_path / "flexible_plant.npz", tmp_path / "controller.npz"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    design = json.loads(done.stdout)
    gains = scene.read_text()
    before, after = gains.split("[levitation]")
    own = tmp_path / "own.toml"
    own.write_text(before + '[state_space]\nfile = "controller.npz"\n' + after[after.index("\n[[plane]]") :])
    found = json.loads(host("modes", own, "--levitated", "--points", 2, "--json"))
    assert found["stable"] and design["growth_1_s"] < 0
    poles = [complex(*rate) for rate in design["rates_1_s"]]
    assert len(found["loop_modes"]) > 15
    for mode in found["loop_modes"]:
        rate = complex(mode["growth_1_s"], 2 * math.pi * mode["frequency_hz"])
        assert min(abs(rate - pole) for pole in poles) < 1e-6 * abs(rate)
    assert all(axis["zone"] == "A" for axis in found["sensitivity"])
    told = json.loads(host("run", own, "--json", "--out", tmp_path / "run"))
    assert all(policy["free_at_end"] for policy in told["policies"].values()), told


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder in which the project's scenes are where a reader of the documentation has them."""
    os.symlink(ROOT / "firmware-host", tmp_path / "firmware-host")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")


def test_the_page_runs_from_its_top_to_its_end(project):
    page = (ROOT / "docs" / "src" / "host" / "python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert len(blocks) >= 5
    names = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"python.md, block {number + 1}", "exec"), names)


def test_the_notebook_runs_from_its_top_to_its_end(project):
    """Its cells are plain Python, so that no kernel is needed: one would bring thirty packages for the same."""
    notebook = json.loads((ROOT / "docs" / "notebooks" / "own_controller.ipynb").read_text())
    assert notebook["nbformat"] == 4
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 5
    names = {}
    for number, cell in enumerate(cells):
        exec(compile(cell, f"own_controller.ipynb, cell {number + 1}", "exec"), names)


def members(of):
    return {name for name in vars(of) if not name.startswith("_") and name not in ("message", "help")}


def test_stubs_name_what_there_is():
    """Every class and function of the module, and every member, both ways."""
    from ambwhirl import _ambwhirl

    folder = Path(ambwhirl.__file__).parent
    assert (folder / "py.typed").exists()
    stub = ast.parse((folder / "_ambwhirl.pyi").read_text())
    named = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(named) == members(_ambwhirl)
    for name, node in named.items():
        if isinstance(node, ast.ClassDef):
            defined = {below.name for below in node.body if isinstance(below, ast.FunctionDef)}
            assert {name for name in defined if not name.startswith("_")} == members(getattr(_ambwhirl, name)), name
    assert set(ambwhirl.__all__) == {name for name in vars(ambwhirl) if name[0].isupper()} | {"parameters", "read_record", "run_scene"}
