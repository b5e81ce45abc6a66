"""Rotors on active magnetic bearings that touch their retainer bearings.

The plant, the supervisor that firmware links, closed loops on scenes with a levitation controller of one's own, and flight
records: the bench of the program ``firmware-host``, with the same figures to the last bit. Units are SI and in the names.
"""

from importlib.metadata import version

from ._ambwhirl import (
    Command,
    Config,
    ConfigError,
    ControllerError,
    Plant,
    RecordError,
    RunError,
    Sample,
    Scene,
    SceneError,
    Setup,
    Supervisor,
    parameters,
)
from ._records import Event, PlaneRecord, Record, read_record
from ._runs import Run, Runs, run_scene
from ._table import Table

__version__ = version("ambwhirl")

__all__ = [
    "Command",
    "Config",
    "ConfigError",
    "ControllerError",
    "Event",
    "PlaneRecord",
    "Plant",
    "Record",
    "RecordError",
    "Run",
    "RunError",
    "Runs",
    "Sample",
    "Scene",
    "SceneError",
    "Setup",
    "Supervisor",
    "Table",
    "parameters",
    "read_record",
    "run_scene",
]
