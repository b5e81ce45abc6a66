"""Microseconds of a control sample: with controllers in Python and built in, of a tick of the supervisor, of a step of a plant."""

import importlib.util
import sys
import time
from pathlib import Path

import ambwhirl

SCENES = Path(__file__).resolve().parents[2] / "scenes" / "controllers"
GAINS = dict(proportional_n_m=5e5, integral_n_m_s=1e7, derivative_n_s_m=1500.0, derivative_filter_s=1.5e-4, feed_forward_weight=True)


def best_us(samples, repeats, run):
    took_s = []
    for _ in range(repeats):
        began_s = time.perf_counter()
        run()
        took_s.append(time.perf_counter() - began_s)
    return 1e6 * min(took_s) / samples


def main(duration_s=5.0, repeats=5):
    spec = importlib.util.spec_from_file_location("pid", SCENES / "pid.py")
    pid = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pid)
    own = ambwhirl.Scene(SCENES / "pid_in_python.toml", {"run.duration_s": duration_s, "disturbance": []})
    text = (SCENES / "pid_in_python.toml").read_text()
    without = text[: text.index("[controller]")] + text[text.index("[[disturbance]]") :]
    gains = ambwhirl.Scene.parse(without, {"run.duration_s": duration_s, "disturbance": [], "levitation": GAINS})
    samples = round(duration_s * 20000)

    def closed_loop(scene, controller=None, trace=False):
        return lambda: ambwhirl.run_scene(scene, controller=controller, policy="levitation", trace=trace)

    supervisor, plant = ambwhirl.Supervisor(ambwhirl.Config.example()), ambwhirl.Plant(gains)

    def ticks():
        for _ in range(samples):
            supervisor.tick((1e-5, 2e-5), (1.0, 2.0), spin_rad_s=100.0)

    def steps():
        for _ in range(samples):
            plant.step(-5e5 * plant.position_m - 1500.0 * plant.velocity_m_s)

    for what, run in [
        ("closed loop, gains", closed_loop(gains)),
        ("closed loop, gains, with its trace", closed_loop(gains, trace=True)),
        ("closed loop, PID in Python, in this process", closed_loop(own, pid.Pid)),
        ("closed loop, PID in Python, in a process of its own", closed_loop(own)),
        ("tick of the supervisor", ticks),
        ("step of a plant, PD with NumPy", steps),
    ]:
        print(f"{best_us(samples, repeats, run):6.1f} µs  {what}")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:2]))
