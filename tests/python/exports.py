"""Exports of a trace, read by other people's programs: python exports.py FOLDER NAME SHA256; what does not hold is an exception."""
import csv
import json
import sys
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd
import pyarrow.parquet as pq
from mcap.reader import make_reader

folder, name, digest = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
native = pd.read_parquet(folder / f"{name}.parquet")
assert len(native) > 1000 and len(native.columns) > 30

# Parquet: units and what the run was of.
about = {key.decode(): value.decode() for key, value in pq.read_schema(folder / f"{name}.parquet").metadata.items()}
units = json.loads(about["units"])
assert units["rotor_x_m"] == "m" and units["contact_force_n"] == "N" and units["spin_rad_s"] == "rad/s"
assert set(units) == {column for column in native.columns if native[column].dtype == float}
assert about["scene_sha256"] == digest and about["policy"] == "supervisor"
assert about["set"] == "friction.coefficient=0.12; run.seed=3"

# CSV, by pandas and by Python's own reader: the same numbers to the last bit.
table = pd.read_csv(folder / f"{name}.csv", keep_default_na=False)
pd.testing.assert_frame_equal(table, native, check_exact=True, check_dtype=False)
with open(folder / f"{name}.csv", newline="") as file:
    rows = list(csv.DictReader(file))
assert [float(row["rotor_x_m"]) for row in rows] == list(native["rotor_x_m"])
beside = json.loads((folder / f"{name}.csv-metadata.json").read_text())
columns = beside["tableSchema"]["columns"]
assert beside["url"] == f"{name}.csv" and [column["name"] for column in columns] == list(native.columns)
assert {c["name"]: c["schema:unitText"] for c in columns if "schema:unitText" in c} == units
assert beside["notes"][0]["scene_sha256"] == digest

# MCAP, by its own reader.
with open(folder / f"{name}.mcap", "rb") as file:
    reader = make_reader(file, validate_crcs=True)
    messages = list(reader.iter_messages())
    records = list(reader.iter_metadata())
assert len(messages) == len(native)
for (schema, channel, message), (_, row) in zip(messages, native.iterrows()):
    assert json.loads(message.data) == dict(row), message.sequence
    assert message.log_time == round(row["t_s"] * 1e9)
schema, channel, _ = messages[0]
assert channel.topic == "/supervisor" and channel.message_encoding == "json" and schema.encoding == "jsonschema"
properties = json.loads(schema.data)["properties"]
assert {n: p["description"] for n, p in properties.items() if "description" in p} == units
assert records[0].metadata["scene_sha256"] == digest
# What PlotJuggler's layout shows is there.
layout = ElementTree.parse(Path(__file__).parents[2] / "firmware-host/scenes/plotjuggler.xml")
curves = {curve.get("name") for curve in layout.iter("curve")}
assert len(curves) > 8 and curves <= set(units), curves - set(units)
assert layout.find(".//default").get("time_axis") == "t_s"

# The example of the page on results, as it stands there.
page = (Path(__file__).parents[2] / "docs/src/host/results.md").read_text()
_, example = page.split("### Reading with pandas")
_, example = example.split("```python\n", 1)
example = example.split("```")[0].replace("runs/impact_at_40_hz/trace_supervisor", str(folder / name))
exec(example)
print(f"{len(native)} rows the same three times")
