"""The PID of [levitation] for one plane; parameters: K_p, K_i, K_d and the time constant of the derivative's filter."""
import math


class Pid:
    def __init__(self, scene):
        self.kp, self.ki, self.kd, filter_s = scene.parameters
        self.period_s, (self.cap_n,) = scene.period_s, scene.force_max_n
        self.share = self.period_s / (self.period_s + filter_s)
        self.last_m, self.speed_m_s, self.integral_n = None, [0.0, 0.0], [0.0, 0.0]

    def step(self, now):
        force_n, last_m = [0.0, 0.0], self.last_m or now.position_m
        for i, m in enumerate(now.position_m):
            self.speed_m_s[i] += self.share * ((m - last_m[i]) / self.period_s - self.speed_m_s[i])
            force_n[i] = -self.kp * m - self.kd * self.speed_m_s[i] + self.integral_n[i]
        self.last_m, size_n = now.position_m, math.sqrt(force_n[0] * force_n[0] + force_n[1] * force_n[1])
        if size_n <= self.cap_n and not now.hold:
            self.integral_n = [n - self.ki * self.period_s * m for n, m in zip(self.integral_n, now.position_m)]
        return [f * min(1.0, self.cap_n / size_n) if size_n else f for f in force_n]


make = Pid
