"""A rotor that is pushed into its retainer bearing, levitated by a controller of one's own: alone, and behind the supervisor."""
import ambwhirl, numpy as np
SCENE = """title = "Overload"
run = {duration_s = 0.1, sample_rate_hz = 20000, policies = ["levitation", "supervisor"]}
rotor = {mass_kg = 10.0, contact_radius_m = 0.03}
spin = {frequency_hz = 150.0}
contact = {clearance_m = 2e-4, stiffness_n_m = 1e8, restitution = 0.6}
friction = {coefficient = 0.15}
magnet = {force_max_n = 1000.0, lag_s = 1.6e-4}
disturbance = [{start_s = 0.02, duration_s = 0.01, force_n = [1300.0, 750.0]}]"""
def pd(setup):
    last_m = np.zeros(2)
    def step(sample):
        now_m = np.array(sample.position_m)
        speed_m_s, last_m[:] = (now_m - last_m) / setup.period_s, now_m
        return -5e5 * now_m - 1500.0 * speed_m_s
    return step
runs = ambwhirl.run_scene(ambwhirl.Scene.parse(SCENE), controller=pd)
print(runs.to_pandas()[["policy", "outcome", "impacts", "contact_time_s"]])
