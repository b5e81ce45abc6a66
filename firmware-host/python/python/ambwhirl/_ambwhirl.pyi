from os import PathLike
from typing import Any, Callable, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

class SceneError(ValueError):
    """A scene cannot be used. Says file, line, key and what was expected, as the command line does, and what to do."""

    message: str
    help: str | None

class ConfigError(ValueError):
    """A parameter of the supervisor is outside its range."""

class RunError(RuntimeError):
    """A run cannot be trusted any further. There is no half-trusted result."""

class ControllerError(RunError):
    """A levitation controller does not answer as it should."""

class RecordError(ValueError):
    """Bytes are no flight record."""

@final
class Scene:
    """A scene as it is written: its keys are known and of their types. Whether the values make a scene is said where it is
    used, or by check()."""

    def __new__(cls, path: str | PathLike[str], values: dict[str, Any] | None = None) -> Scene: ...
    @staticmethod
    def parse(text: str, values: dict[str, Any] | None = None, *, name: str = "scene.toml") -> Scene:
        """From the text of a file; errors name it so."""
    def replace(self, values: dict[str, Any]) -> Scene:
        """The same with other values of keys, as {"friction.coefficient": 0.2}."""
    def get(self, key: str) -> Any:
        """The value of a key, or its default; None where there is neither."""
    def check(self) -> list[str]:
        """Checks every value. What comes back are warnings: what is allowed and yet unlikely to be meant."""

@final
class Setup:
    """What a controller is told before the first sample."""

    @property
    def period_s(self) -> float:
        """From one sample to the next."""
    @property
    def sensors(self) -> int: ...
    @property
    def magnets(self) -> int: ...
    @property
    def magnet_plane(self) -> list[int]:
        """The plane of each magnet, from 0."""
    @property
    def force_max_n(self) -> list[float]:
        """Cap of each magnet."""
    @property
    def parameters(self) -> list[float]:
        """Of the scene's controller.parameters."""

@final
class Sample:
    """What is known at a control sample."""

    @property
    def t_s(self) -> float: ...
    @property
    def position_m(self) -> list[float]:
        """x and y of each sensor."""
    @property
    def sequence(self) -> list[int]:
        """Number of each sensor's reading; one that did not come has that of the last."""
    @property
    def spin_rad_s(self) -> float:
        """Spin as reported."""
    @property
    def hold(self) -> bool:
        """True while integrators are to stand."""

def run_policies(scene: Scene, controller: Callable[[Setup], Any] | None, trace: bool) -> dict[str, Any]: ...
def decoded(bytes: bytes) -> dict[str, Any]: ...

@final
class Plant:
    """The rotor of a scene from its start. Positions count from the line of the magnets; arrays have a row for each magnet,
    load or plane, and a single row may be given as (x, y). Weight and supports act; loads, sensors and amplifier delay of the
    scene are a closed loop's."""

    def __new__(cls, scene: Scene) -> Plant: ...
    @property
    def period_s(self) -> float:
        """The control period of the scene."""
    @property
    def planes(self) -> list[str]:
        """Names of the planes."""
    @property
    def magnets(self) -> int: ...
    @property
    def loads(self) -> int:
        """Places at which loads act: the centre of mass, then where else disturbances of the scene do."""
    @property
    def t_s(self) -> float: ...
    @property
    def spin_rad_s(self) -> float: ...
    @property
    def modes(self) -> list[str]: ...
    @property
    def sensed_m(self) -> FloatArray:
        """Where the rotor is at the sensors."""
    @property
    def position_m(self) -> FloatArray: ...
    @property
    def velocity_m_s(self) -> FloatArray: ...
    @property
    def delivered_n(self) -> FloatArray:
        """Forces that the magnets deliver."""
    @property
    def normal_force_n(self) -> list[float]: ...
    @property
    def energy_residual(self) -> float:
        """Energy from nowhere over energy turned over."""
    def advance(self, to_s: float, commands_n: ArrayLike | None = None, loads_n: ArrayLike | None = None) -> list[tuple[float, str, str]]:
        """Carries it to a time under forces that are held; changes of mode come back, with the plane. Commands are limited to
        the magnets' caps; loads come on top of the weight."""
    def step(self, commands_n: ArrayLike | None = None, loads_n: ArrayLike | None = None) -> FloatArray:
        """To the end of the control period; the positions at the sensors there."""
    def steps(self, commands_n: ArrayLike, loads_n: ArrayLike | None = None) -> FloatArray:
        """A control period for each block of commands, shape (n, magnets, 2) or of one magnet (n, 2); the positions in the
        planes at their ends, shape (n, planes, 2)."""
    def read(self) -> list[dict[str, Any]]:
        """Everything that can be read off each plane now."""
    def meters(self) -> list[dict[str, Any]]:
        """Extremes and sums of each plane so far."""

@final
class Config:
    """A configuration of the supervisor: every parameter is in its range. Numbers are single precision, as in firmware. Each
    parameter is an attribute; parameters() lists them."""

    def __new__(cls, **keys: float) -> Config:
        """From all parameters."""
    @staticmethod
    def for_bearing(
        *,
        sample_period_s: float,
        mass_kg: float,
        stiffness_n_m: float,
        clearance_m: float,
        force_max_n: float,
        amplifier_lag_s: float,
        friction_coefficient: float,
        contact_stiffness_n_m: float,
        sensor_noise_m: float,
        **keys: float,
    ) -> Config:
        """From nine numbers of a data sheet; more keys replace what is derived."""
    @staticmethod
    def example() -> Config:
        """An example, and no default for any machine."""
    def replace(self, **keys: float) -> Config:
        """The same with other values."""
    def to_dict(self) -> dict[str, float]: ...
    def __getattr__(self, key: str) -> float: ...

def parameters() -> list[dict[str, Any]]:
    """The table of the supervisor's parameters: name, unit, low, high, text, default."""

@final
class Command:
    """What to do until the next tick."""

    @property
    def force_n(self) -> FloatArray: ...
    @property
    def own_n(self) -> FloatArray:
        """What the supervisor would command, which differs under shadow."""
    @property
    def mode(self) -> str: ...
    @property
    def limits(self) -> list[str]:
        """What binds now."""
    @property
    def events(self) -> list[str]:
        """What changed."""
    @property
    def hold(self) -> bool:
        """Whether the levitation controller's integrators are to stand."""
    @property
    def severity(self) -> float: ...

@final
class Supervisor:
    """The supervisor of one bearing plane, as firmware links it, with a flight record of 512 ticks."""

    def __new__(cls, config: Config) -> Supervisor: ...
    def tick(
        self,
        position_m: ArrayLike,
        levitation_n: ArrayLike | None = None,
        *,
        spin_rad_s: float | None = None,
        applied_n: ArrayLike | None = None,
        sequence: int | None = None,
        bearing_on: bool = True,
        axis_x_lost: bool = False,
        axis_y_lost: bool = False,
        late: bool = False,
        shadow: bool = False,
        set_down: bool = False,
        levitated_before: bool = False,
    ) -> Command:
        """One tick. Numbers may be any, NaN too, as from a sensor: the supervisor judges them. Without a sequence number samples
        are counted; without a spin, or the force that the actuator delivers, it does without."""
    @property
    def mode(self) -> str: ...
    def take_events(self) -> list[tuple[int, str, list[str]]]:
        """Events that nobody has taken yet: sequence number, mode, names."""
    def reconfigure(self, config: Config) -> None:
        """Another configuration, from the next tick on."""
    def record(self) -> bytes | None:
        """The flight record as firmware would write it, where one is frozen."""
    def rearm(self) -> None:
        """Discards a frozen record."""
    @property
    def stimulus_n(self) -> FloatArray:
        """What to add to the force of the next tick, so that the machine confirms its configuration."""
    def report(self) -> dict[str, Any]:
        """What has happened since it was made."""
