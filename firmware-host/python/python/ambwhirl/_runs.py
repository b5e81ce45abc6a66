"""Closed loops on scenes."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any, Callable, Iterable

from ._ambwhirl import Scene, Setup, run_policies
from ._table import Table

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa


@dataclass(frozen=True, repr=False)
class Run:
    """What came of a policy, or of one plane under it."""

    policy: str
    figures: dict[str, Any]
    """The figures of ``verdict.json``, but for the time that the run took."""
    supervision: dict[str, Any] | None = None
    """What the supervisor did, where one ran."""
    trace: Table | None = None
    """A row for each control sample and change of mode, in the columns of the trace files; of several planes each has its own."""
    record: bytes | None = None
    """The flight record, where the supervisor froze one."""
    planes: dict[str, Run] = field(default_factory=dict)
    """A Run for each plane, by its name; that of an only plane may be empty."""
    axis: Table | None = None
    """Of a rotor that tilts: its axis at each control sample."""

    def __repr__(self) -> str:
        return f"<ambwhirl.Run {self.policy}: {self.figures['outcome']}>"


class Runs(dict[str, Run]):
    """Runs by the names of their policies, in the scene's order."""

    def rows(self) -> list[dict[str, Any]]:
        """A dictionary for each policy: every figure, keys of what has parts joined by points."""
        return [
            {"policy": policy, **_flat("", run.figures), **_flat("supervision", run.supervision or {})}
            for policy, run in self.items()
        ]

    def to_arrow(self) -> pa.Table:
        """A pyarrow.Table with a row for each policy."""
        import pyarrow as pa

        return pa.table(self._columns())

    def to_pandas(self) -> pd.DataFrame:
        """A pandas.DataFrame with a row for each policy."""
        import pandas as pd

        return pd.DataFrame(self._columns())

    def _columns(self) -> dict[str, list[Any]]:
        rows = self.rows()
        headings = dict.fromkeys(heading for row in rows for heading in row)
        return {heading: [row.get(heading) for row in rows] for heading in headings}


def _flat(name: str, of: dict[str, Any]) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in of.items():
        heading = f"{name}.{key}" if name else key
        flat.update(_flat(heading, value) if isinstance(value, dict) else {heading: value})
    return flat


def _run(policy: str, parts: dict[str, Any]) -> Run:
    tables = {name: None if parts[name] is None else Table(parts[name]) for name in ("trace", "axis")}
    planes = {name: _run(policy, plane) for name, plane in parts["planes"].items()}
    return Run(policy=policy, **{**parts, **tables, "planes": planes})


def run_scene(
    scene: Scene | str | PathLike[str],
    *,
    controller: Callable[[Setup], Any] | None = None,
    policy: str | Iterable[str] | None = None,
    values: dict[str, Any] | None = None,
    seed: int | None = None,
    trace: bool = True,
) -> Runs:
    """Runs a scene in closed loop, each policy from its start, and returns the runs by their policies.

    scene
        A Scene, or the path of a scene file.
    controller
        A levitation controller in the place of the scene's: a function of a Setup, or a class, that returns an object with
        a method ``step(sample)``, or a function of a Sample. It is called once a run. What it raises comes through.
    policy
        One policy or several in the place of the scene's: "passive", "radial", "damping", "levitation", "supervisor".
    values
        Other values of keys, as {"friction.coefficient": 0.2}.
    seed
        The same as the key "run.seed".
    trace
        Whether rows are kept.

    What the scene warns of comes as warnings. Raises SceneError for a scene that cannot be used, RunError for a run that cannot be trusted, ControllerError for a
    controller that does not answer as it should.
    """
    if isinstance(scene, (str, PathLike)):
        scene = Scene(scene)
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: expected an ambwhirl.Scene or a path, got {scene!r}")
    changed = dict(values or {})
    if policy is not None:
        changed["run.policies"] = [policy] if isinstance(policy, str) else list(policy)
    if seed is not None:
        changed["run.seed"] = seed
    if changed:
        scene = scene.replace(changed)
    runs = run_policies(scene, controller, trace)
    return Runs({policy: _run(policy, parts) for policy, parts in runs.items()})
