/* A rotor in two magnetic bearings with a model that is not ours: how to drive the supervisor of both planes from a
 * simulation of your own, on the machine where it runs. One tick is: sensors, levitation controller, amb_rotor_tick(),
 * amplifiers, and 50 us of the model.
 *
 * The model is a rigid body with four degrees of freedom that spins, magnets with a lag, and retainer bearings with a
 * stiff, damped wall and dry friction. A blow at one end strikes it, with and without the supervisor.
 *
 * How to build and run it is on the page "Linking it into C firmware" of the book. */
#include "amb_supervisor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TICKS = 20000, SUBSTEPS = 50, BLOW_AT = 100 };
static const double TICK_S = 50e-6;
static const double SPIN_RAD_S = 1200.0;
static const double CLEARANCE_M = 2e-4;
static const double CAP_N = 1000.0;
static const double LAG_S = 1.6e-4;
static const double JOURNAL_RADIUS_M = 0.03;
static const double WALL_N_M = 1e8;
static const double WALL_N_S_M = 4000.0;
static const double FRICTION = 0.15;
static const double LEVITATION_N_M = 1e6;
static const double LEVITATION_N_S_M = 3000.0;

/* The same rotor for the model and for the supervisor. */
static const amb_shaft shaft = {
    20.0f,            /* kg */
    0.5f,             /* transverse, kg m^2 */
    0.2f,             /* polar, kg m^2 */
    {-0.20f, 0.22f},  /* retainer bearings, m */
    {-0.19f, 0.21f},  /* sensors, m */
    {-0.17f, 0.19f},  /* magnets, m */
};

/* What both planes have in common: nine numbers, of which the mass follows from the shaft. All else follows from them. */
static const amb_bearing bearing = {
    50e-6f,   /* s, tick */
    0.0f,     /* kg */
    0.0f,     /* N/m, stiffness in flight */
    2e-4f,    /* m, clearance */
    1000.0f,  /* N, cap */
    1.6e-4f,  /* s, lag of the amplifier */
    0.2f,     /* friction, with a margin */
    1e8f,     /* N/m, contact */
    1e-8f,    /* m, step of the sensor */
};

/* Centre of mass and slope of the axis, x and y, with their velocities: a place z of the axis is at r + z * s. */
typedef struct model {
    double r[2], s[2], v[2], w[2];
    double force[2][2]; /* the magnets' [N] */
    int touching[2];
    int touches;
    double hardest_n;
} model;

static void at(const model *m, double z, double position[2], double velocity[2]) {
    int i;
    for (i = 0; i < 2; i++) {
        position[i] = m->r[i] + z * m->s[i];
        velocity[i] = m->v[i] + z * m->w[i];
    }
}

/* Force of a retainer bearing. */
static void wall(model *m, int plane, double force[2]) {
    double p[2], v[2], radius, outwards, along, normal, sliding, tangential;
    force[0] = force[1] = 0.0;
    at(m, (double)shaft.retainer_m[plane], p, v);
    radius = sqrt(p[0] * p[0] + p[1] * p[1]);
    if (radius <= CLEARANCE_M) {
        m->touching[plane] = 0;
        return;
    }
    if (!m->touching[plane]) m->touches++;
    m->touching[plane] = 1;
    outwards = (p[0] * v[0] + p[1] * v[1]) / radius;
    along = (p[0] * v[1] - p[1] * v[0]) / radius;
    normal = WALL_N_M * (radius - CLEARANCE_M) + WALL_N_S_M * outwards;
    if (normal <= 0.0) return; /* it does not pull */
    if (normal > m->hardest_n) m->hardest_n = normal;
    /* The journal's surface slides with the spin; near standstill friction grows with the speed. */
    sliding = along + SPIN_RAD_S * JOURNAL_RADIUS_M;
    tangential = -FRICTION * normal * tanh(sliding / 1e-3);
    force[0] = (-normal * p[0] - tangential * p[1]) / radius;
    force[1] = (-normal * p[1] + tangential * p[0]) / radius;
}

/* A tick of the model with these forces commanded. */
static void advance(model *m, const amb_rotor_command *command) {
    const double h = TICK_S / SUBSTEPS;
    const double nutation = (double)(shaft.polar_inertia_kg_m2 / shaft.transverse_inertia_kg_m2) * SPIN_RAD_S;
    const double c = cos(nutation * h), s = sin(nutation * h);
    int step, plane, i;
    for (step = 0; step < SUBSTEPS; step++) {
        double push[2] = {0.0, 0.0}, tilt[2] = {0.0, 0.0}, turned[2];
        for (plane = 0; plane < 2; plane++) {
            double contact[2];
            wall(m, plane, contact);
            for (i = 0; i < 2; i++) {
                const double commanded = (double)command->planes[plane].force_n[i];
                m->force[plane][i] += h / LAG_S * (commanded - m->force[plane][i]);
                push[i] += m->force[plane][i] + contact[i];
                tilt[i] += (double)shaft.magnet_m[plane] * m->force[plane][i] +
                           (double)shaft.retainer_m[plane] * contact[i];
            }
        }
        /* The spin turns the slope's velocity; velocities first, then positions with them. */
        turned[0] = c * m->w[0] - s * m->w[1];
        turned[1] = s * m->w[0] + c * m->w[1];
        for (i = 0; i < 2; i++) {
            m->v[i] += h * push[i] / (double)shaft.mass_kg;
            m->w[i] = turned[i] + h * tilt[i] / (double)shaft.transverse_inertia_kg_m2;
            m->r[i] += h * m->v[i];
            m->s[i] += h * m->w[i];
        }
    }
}

/* What the converters and the levitation controllers have at this tick. */
static void measure(const model *m, uint32_t sequence, amb_sample samples[2]) {
    int plane, i;
    memset(samples, 0, 2 * sizeof *samples);
    for (plane = 0; plane < 2; plane++) {
        amb_sample *sample = &samples[plane];
        double p[2], v[2], wanted[2], length;
        sample->sequence = sequence;
        /* It levitated until the blow, with which this begins. */
        sample->status = AMB_STATUS_SPIN_VALID | AMB_STATUS_BEARING_ON | AMB_STATUS_LEVITATED_BEFORE;
        sample->spin_rad_s = (float)SPIN_RAD_S;
        at(m, (double)shaft.sensor_m[plane], p, v);
        for (i = 0; i < 2; i++) wanted[i] = -LEVITATION_N_M * p[i] - LEVITATION_N_S_M * v[i];
        length = sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
        for (i = 0; i < 2; i++) {
            if (length > CAP_N) wanted[i] *= CAP_N / length;
            /* A sensor has steps. */
            sample->position_m[i] = (float)(floor(p[i] / 1e-8 + 0.5) * 1e-8);
            sample->levitation_n[i] = (float)wanted[i];
        }
    }
}

/* A second after a blow of so many newton seconds. */
static int run(const char *who, int supervised, double blow_n_s) {
    static amb_rotor rotor; /* zero at start; sizeof(amb_rotor) has no place on a stack */
    model m;
    uint32_t tick, quiet = 0;
    amb_bearing bearings[2];
    float values[2 * AMB_PARAMETERS];
    amb_code code;
    memset(&m, 0, sizeof m);
    bearings[0] = bearings[1] = bearing;
    code = amb_config_for_rotor(&shaft, bearings, values, 2 * AMB_PARAMETERS);
    /* A model has the numbers that it was made of; a machine would confirm them first. */
    values[AMB_P_CHECK_FIRST] = values[AMB_PARAMETERS + AMB_P_CHECK_FIRST] = 0.0f;
    if (code == AMB_OK) code = amb_rotor_init(&rotor, sizeof rotor, &shaft, values, 2 * AMB_PARAMETERS);
    if (code != AMB_OK) {
        fprintf(stderr, "supervisor: %s\n", amb_error_text(code));
        return 1;
    }
    for (tick = 0; tick < TICKS; tick++) {
        amb_sample samples[2];
        amb_rotor_command command;
        int plane;
        if (tick == BLOW_AT) {
            /* At the end of plane 1, sideways. */
            const double z = (double)shaft.retainer_m[1];
            m.v[0] += blow_n_s / (double)shaft.mass_kg;
            m.w[0] += z * blow_n_s / (double)shaft.transverse_inertia_kg_m2;
        }
        measure(&m, tick, samples);
        code = amb_rotor_tick(&rotor, samples, &command);
        if (code != AMB_OK) {
            fprintf(stderr, "supervisor: %s\n", amb_error_text(code));
            return 1;
        }
        if (!supervised) {
            for (plane = 0; plane < 2; plane++) {
                memcpy(command.planes[plane].force_n, samples[plane].levitation_n, sizeof samples[plane].levitation_n);
            }
        }
        advance(&m, &command);
        quiet = m.touching[0] || m.touching[1] ? 0 : quiet + 1;
    }
    printf("%s: %d touches, hardest %.0f N, %s\n", who, m.touches, m.hardest_n,
           quiet > TICKS / 5 ? "recovered" : "not recovered");
    return 0;
}

int main(int argc, char **argv) {
    const double blow_n_s = argc > 1 ? atof(argv[1]) : 7.0;
    return run("levitation alone", 0, blow_n_s) || run("with the supervisor", 1, blow_n_s);
}
