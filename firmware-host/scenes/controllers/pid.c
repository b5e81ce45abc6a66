/* The PID of [levitation] for one plane; parameters: K_p, K_i, K_d and the time constant of the derivative's filter. */
#include "amb_controller.h"
#include <math.h>
#include <stdlib.h>

AMB_CONTROLLER_DEFINE_ABI

typedef struct {
    double kp, ki, kd, period_s, share, cap_n, last_m[2], speed_m_s[2], integral_n[2];
    int started;
} pid;

void *amb_controller_init(const amb_controller_setup *setup) {
    pid *p = setup->magnets == 1 && setup->parameters == 4 ? calloc(1, sizeof *p) : NULL;
    if (p == NULL) return NULL;
    p->kp = setup->parameter[0], p->ki = setup->parameter[1], p->kd = setup->parameter[2];
    p->period_s = setup->period_s, p->cap_n = setup->force_max_n[0];
    p->share = p->period_s / (p->period_s + setup->parameter[3]);
    return p;
}

int amb_controller_step(void *controller, const amb_controller_sample *now, double *force_n) {
    pid *p = controller;
    for (int i = 0; i < 2; i++) {
        double m = now->position_m[i], rate = p->started ? (m - p->last_m[i]) / p->period_s : 0.0;
        p->speed_m_s[i] += p->share * (rate - p->speed_m_s[i]);
        p->last_m[i] = m;
        force_n[i] = -p->kp * m - p->kd * p->speed_m_s[i] + p->integral_n[i];
    }
    p->started = 1;
    double size_n = sqrt(force_n[0] * force_n[0] + force_n[1] * force_n[1]);
    for (int i = 0; i < 2; i++) {
        if (size_n > p->cap_n) force_n[i] *= p->cap_n / size_n;
        else if (now->integrator == AMB_CONTROLLER_RUN) p->integral_n[i] -= p->ki * p->period_s * now->position_m[i];
    }
    return 0;
}

void amb_controller_close(void *controller) { free(controller); }
