"""Tables for pandas and Arrow, and flight records."""

import io

import ambwhirl
import numpy as np
import pandas as pd
import pyarrow as pa
import pytest


@pytest.fixture(scope="module")
def runs(scenes):
    return ambwhirl.run_scene(scenes / "overload_then_release.toml", policy=["passive", "supervisor"])


def test_a_trace_goes_to_pandas_and_arrow(runs):
    trace = runs["supervisor"].trace
    frame, arrow = trace.to_pandas(), trace.to_arrow()
    assert list(frame.columns) == arrow.column_names == trace.columns and len(frame) == len(trace) > 4000
    assert frame["rotor_x_m"].dtype == np.float64 and frame["mode_change"].dtype == bool
    assert str(frame["mode"].dtype) == "category" and list(frame["mode"]) == list(trace["mode"])
    assert pa.types.is_dictionary(arrow.schema.field("mode").type)
    assert {"approach", "bounce"} <= set(frame["supervisor_mode"])
    assert "t_s" in trace and "t" not in trace and repr(trace).startswith("<ambwhirl.Table of ")
    # By the interface that Polars, DuckDB and pandas 3 read.
    assert pa.table(trace).equals(arrow)
    assert pd.DataFrame.from_arrow(trace)["rotor_x_m"].equals(frame["rotor_x_m"])


def test_numbers_are_not_copied(runs):
    trace = runs["supervisor"].trace
    for heading in ("t_s", "rotor_x_m", "commanded_y_n"):
        address = trace.to_arrow()[heading].chunk(0).buffers()[1].address
        assert address == trace[heading].ctypes.data, heading


def test_figures_have_a_row_for_each_policy(runs):
    frame = runs.to_pandas()
    assert list(frame["policy"]) == ["passive", "supervisor"]
    for row in runs.rows():
        figures = runs[row["policy"]].figures
        assert all(row[key] == value for key, value in figures.items() if not isinstance(value, dict))
    assert frame["supervision.engagements"].tolist()[1] == runs["supervisor"].supervision["engagements"]
    assert np.isnan(frame["supervision.engagements"].tolist()[0])
    assert runs.to_arrow().num_rows == 2 and repr(runs["passive"]).startswith("<ambwhirl.Run passive: ")


def test_a_record_is_decoded(runs, host, tmp_path):
    data = runs["supervisor"].record
    path = tmp_path / "record.bin"
    path.write_bytes(data)
    record = ambwhirl.read_record(path)
    assert record.intact and record.damage == [] and len(record.events) == 1
    event = record.events[0]
    assert event.replay["differing"] == 0 and event.no_replay is None and event.text.endswith(".")
    (plane,) = event.planes
    assert plane.config.clearance_m == pytest.approx(2e-4, rel=1e-6) and event.summary["touches"] > 0
    expected = pd.read_csv(io.StringIO(host("review", path, "--csv")), keep_default_na=False)
    assert list(plane.ticks.columns) == list(expected.columns)[2:] and len(plane.ticks) == len(expected) == 512
    for heading in plane.ticks.columns:
        column = expected[heading].to_numpy()
        column = column if column.dtype.kind == "i" else column.astype(plane.ticks[heading].dtype)
        assert np.array_equal(plane.ticks[heading], column), heading
    assert ambwhirl.read_record(data).events[0].summary == event.summary


def test_what_is_damaged_is_named(runs):
    data = bytearray(runs["supervisor"].record)
    data[len(data) // 2] ^= 1
    record = ambwhirl.read_record(data)
    assert not record.intact and any("missing" in text for text in record.damage) and len(record.events) == 1
    with pytest.raises(ambwhirl.RecordError, match="no section of a flight record"):
        ambwhirl.read_record(b"nothing of a record")
    with pytest.raises(OSError):
        ambwhirl.read_record("there_is_none.bin")
