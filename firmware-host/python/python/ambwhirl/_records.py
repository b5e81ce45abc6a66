"""Flight records."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from ._ambwhirl import Config, decoded
from ._table import Table


@dataclass(frozen=True, repr=False)
class PlaneRecord:
    """What was recorded of one bearing plane."""

    plane: int
    config: Config | None
    """The configuration that the supervisor had."""
    ticks: Table
    """A row for each tick, in the columns of ``firmware-host review --csv``."""
    stretches: list[dict[str, Any]]
    """Modes in their order."""
    missing: int
    """Sequence numbers that are missing between two ticks."""
    firmware: int
    """Number that the firmware has."""
    time_us: int
    """Its clock at ``at_sequence``."""
    at_sequence: int
    dropped: int
    """Events before this one that found a record frozen, and are in none."""

    def __repr__(self) -> str:
        return f"<ambwhirl.PlaneRecord {self.plane}: {len(self.ticks)} ticks>"


@dataclass(frozen=True, repr=False)
class Event:
    """An event: what came of it, and the record of each plane."""

    summary: dict[str, Any] | None
    """The outcome in numbers; none where that is not whole in the file."""
    text: str | None
    """The same in words."""
    replay: dict[str, Any] | None
    """How many ticks the supervisor of this build computes as they are recorded."""
    no_replay: str | None
    """Why it computes none."""
    identified: dict[str, Any] | None
    """What the event tells of the machine."""
    contacts: list[dict[str, Any]]
    """Contacts that were found, times in ticks from the sequence number ``contacts_from`` on."""
    contacts_from: int | None
    planes: list[PlaneRecord]

    def __repr__(self) -> str:
        return f"<ambwhirl.Event: {self.text}>"


@dataclass(frozen=True, repr=False)
class Record:
    """A file of flight records. What is damaged is left out; what is here was written so."""

    intact: bool
    """Whether all is as it was written."""
    damage: list[str]
    """What is not, in words."""
    events: list[Event]

    def __repr__(self) -> str:
        return f"<ambwhirl.Record of {len(self.events)} events{'' if self.intact else ', damaged'}>"


def read_record(source: str | PathLike[str] | bytes | bytearray | memoryview) -> Record:
    """Reads flight records from the path of a file or from bytes.

    Raises RecordError where nothing of a record is in it, OSError where a file cannot be read. Of a damaged file what is whole
    is given back: look at ``intact``.
    """
    data = bytes(source) if isinstance(source, (bytes, bytearray, memoryview)) else Path(source).read_bytes()
    parts = decoded(data)
    return Record(parts["intact"], parts["damage"], [_event(event) for event in parts["events"]])


def _event(parts: dict[str, Any]) -> Event:
    planes = [PlaneRecord(**{**plane, "ticks": Table(plane["ticks"])}) for plane in parts.pop("planes")]
    return Event(planes=planes, **parts)
