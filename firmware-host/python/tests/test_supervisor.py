"""The supervisor, tick by tick."""

import csv
import struct

import ambwhirl
import numpy as np
import pytest

BEARING = dict(
    sample_period_s=50e-6,
    mass_kg=10.0,
    stiffness_n_m=-2e5,
    clearance_m=2e-4,
    force_max_n=1000.0,
    amplifier_lag_s=1.6e-4,
    friction_coefficient=0.15,
    contact_stiffness_n_m=1e9,
    sensor_noise_m=1e-6,
)


def single(bits):
    return struct.unpack("<f", struct.pack("<I", int(bits, 16)))[0]


def test_it_is_the_one_that_firmware_links(host, tmp_path):
    """The vectors for ports: the first ticks of each piece, force for force."""
    host("vectors", "--out", tmp_path)
    with open(tmp_path / "configurations_f32.csv", newline="") as file:
        rows = csv.reader(file)
        names = next(rows)[2:]
        configs = {row[0]: dict(zip(names, map(single, row[2:]))) for row in rows}
    assert names == [row["name"] for row in ambwhirl.parameters()] and len(configs) > 20
    ticks, modes, supervisors = 0, set(), {}
    with open(tmp_path / "ticks_f32.csv", newline="") as file:
        for row in csv.DictReader(file):
            piece = row["piece"]
            if piece not in supervisors:
                supervisors[piece] = ambwhirl.Supervisor(ambwhirl.Config(**configs[piece]))
            status = int(row["status"], 16)
            command = supervisors[piece].tick(
                [single(row["position_x"]), single(row["position_y"])],
                [single(row["levitation_x"]), single(row["levitation_y"])],
                sequence=int(row["sequence"], 16),
                spin_rad_s=single(row["spin"]) if status & 1 else None,
                bearing_on=bool(status & 2),
                applied_n=[single(row["applied_x"]), single(row["applied_y"])] if status & 4 else None,
                axis_x_lost=bool(status & 8),
                axis_y_lost=bool(status & 16),
                late=bool(status & 32),
                shadow=bool(status & 64),
                set_down=bool(status & 128),
                levitated_before=bool(status & 256),
            )
            expected = [single(row["force_x"]), single(row["force_y"])]
            assert np.array_equal(command.force_n, expected), (piece, ticks)
            modes.add(command.mode)
            ticks += 1
            if ticks == 20000:
                break
    assert len(modes) >= 6, modes


def test_a_configuration_by_nine_numbers_and_by_keys():
    config = ambwhirl.Config.for_bearing(**BEARING)
    assert config.mass_kg == 10.0 and config.restitution == pytest.approx(0.7, rel=1e-7)
    other = ambwhirl.Config.for_bearing(**BEARING, restitution=0.5)
    assert other == config.replace(restitution=0.5) != config and other.restitution == 0.5
    assert ambwhirl.Config(**config.to_dict()) == config
    assert set(config.to_dict()) == {row["name"] for row in ambwhirl.parameters()}
    assert repr(config).startswith("Config(sample_period_s=5e-5, mass_kg=10.0")
    for call, kind, says in [
        (lambda: config.replace(mass_kg=float("nan")), ambwhirl.ConfigError, "^mass_kg = NaN: expected"),
        (lambda: ambwhirl.Config.for_bearing(**{**BEARING, "clearance_m": 5.0}), ambwhirl.ConfigError, "^clearance_m = 5: expected"),
        (lambda: config.replace(mass=1.0), TypeError, "^mass: is no parameter"),
        (lambda: config.replace(mass_kg="x"), TypeError, "^mass_kg: expected a number, got 'x'"),
        (lambda: ambwhirl.Config(mass_kg=1.0), TypeError, "^sample_period_s: is missing"),
        (lambda: ambwhirl.Config.for_bearing(mass_kg=1.0), TypeError, "sample_period_s"),
        (lambda: config.mass, AttributeError, "^mass: is no parameter"),
    ]:
        with pytest.raises(kind, match=says):
            call()


def test_an_approach():
    config = ambwhirl.Config.example()
    supervisor = ambwhirl.Supervisor(config)
    command = supervisor.tick([1e-5, -2e-5], [-12.5, 25.0], spin_rad_s=1000.0, levitated_before=True)
    assert command.force_n.tolist() == [-12.5, 25.0] and command.mode == "levitated" and not command.hold
    x_m = 1e-5
    events = []
    for _ in range(9):
        x_m += 0.4 * config.sample_period_s
        command = supervisor.tick(np.array([x_m, -2e-5]), spin_rad_s=1000.0)
        events += command.events
    assert supervisor.mode == command.mode == "approach" and "ENGAGED" in events and command.hold
    assert command.severity > 0 and supervisor.report()["landings"] == 0
    assert [name for _, _, names in supervisor.take_events() for name in names][0] == "ENGAGED"
    assert supervisor.take_events() == [] and supervisor.record() is None
    supervisor.reconfigure(config.replace(hold_share=0.5))


def test_a_reading_that_is_no_number_is_for_the_supervisor():
    supervisor = ambwhirl.Supervisor(ambwhirl.Config.example())
    supervisor.tick([0.0, 0.0])
    command = supervisor.tick([float("nan"), 0.0], [5.0, 0.0])
    assert "SAMPLE_REFUSED" in command.limits and np.all(np.isfinite(command.force_n))
    assert supervisor.report()["refusal"] == "NotFinite"
    with pytest.raises(ValueError, match=r"^position_m: has the shape \(3,\), expected \(2,\)"):
        supervisor.tick([0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="^levitation_n: has the shape"):
        supervisor.tick([0.0, 0.0], 1.0)
