/* See rig.h. The story: levitated; a blow throws the rotor onto its retainer bearing, it bounces, begins to
 * whirl and is caught, with a command that comes too late; the position sensor fails for a while; the cap is
 * lowered; ticks are lost, and another blow comes while the drive has lost an axis and measures what it
 * delivers; at a third blow the supervisor is in shadow at first. */
#include "rig.h"

#include <string.h>

const float rig_config[AMB_PARAMETERS] = {
    [AMB_P_SAMPLE_PERIOD_S] = 50e-6f,
    [AMB_P_MASS_KG] = 10.0f,
    [AMB_P_STIFFNESS_N_M] = 0.0f,
    [AMB_P_DAMPING_N_S_M] = 0.0f,
    [AMB_P_CLEARANCE_M] = 2e-4f,
    [AMB_P_FORCE_MAX_N] = 1000.0f,
    [AMB_P_AMPLIFIER_LAG_S] = 0.0f,
    [AMB_P_DELAY_SAMPLES] = 1.0f,
    [AMB_P_FRICTION_COEFFICIENT] = 0.15f,
    [AMB_P_RESTITUTION] = 0.7f,
    [AMB_P_OBSERVER_POLE_FLIGHT] = 0.5f,
    [AMB_P_OBSERVER_POLE_CONTACT] = 0.2f,
    [AMB_P_CONTACT_BAND] = 0.02f,
    [AMB_P_POSITION_LIMIT] = 4.0f,
    [AMB_P_WHIRL_TIME_S] = 2e-3f,
    [AMB_P_HOLD_SHARE] = 0.8f,
    [AMB_P_HANDOVER_DWELL_S] = 1e-3f,
    [AMB_P_HANDOVER_BLEND_S] = 2e-3f,
    [AMB_P_FAULT_BLEND_S] = 1e-3f,
    [AMB_P_FAULT_TICKS] = 10.0f,
    [AMB_P_AXIS_FORCE_MAX_N] = 1000.0f,
    [AMB_P_FORCE_SLEW_N_S] = 1e7f,
    [AMB_P_CONTINUOUS_FORCE_N] = 400.0f,
    [AMB_P_THERMAL_TIME_S] = 5.0f,
    [AMB_P_CONTACT_STIFFNESS_N_M] = 2e8f,
    [AMB_P_COAST_DOWN_S] = 5e-3f,
    [AMB_P_SEVERITY_LIMIT] = 20.0f,
    [AMB_P_RETAINER_PLANE_RATIO] = 1.0f,
    [AMB_P_MAGNET_PLANE_RATIO] = 1.0f,
    [AMB_P_SPEED_MAX_M_S] = 2.0f,
    [AMB_P_SENSOR_STEP_M] = 1e-8f,
    [AMB_P_ACTS_IN_FLIGHT] = 1.0f,
};

/* The converter's step: 2^12 lengths, which is 2^-28 m. */
enum { STEP = 4096 };
static const float STEP_M = 1.0f / 268435456.0f;
/* 2e-4 m in steps of the converter. */
enum { CLEARANCE = 53687 };
/* 1/16 N on 10 kg (10.1 kg, to be exact) changes the speed by this much in a tick. */
enum { ACCELERATION = 17 };

void rig_start(rig *r) {
    memset(r, 0, sizeof *r);
    r->hash = 2166136261u;
}

int rig_reconfigures(const rig *r, float values[AMB_PARAMETERS]) {
    if (r->tick != 2600) return 0;
    memcpy(values, rig_config, sizeof rig_config);
    values[AMB_P_FORCE_MAX_N] = 900.0f;
    values[AMB_P_HANDOVER_DWELL_S] = 5e-4f;
    return 1;
}

static int between(uint32_t tick, uint32_t from, uint32_t to) {
    return tick >= from && tick < to;
}

void rig_sample(rig *r, amb_sample *sample) {
    int axis;
    const uint32_t tick = r->tick;
    memset(sample, 0, sizeof *sample);
    /* At 3000 no new sample is there, at 3010 three were lost. */
    r->sequence += tick == 3000 ? 0 : tick == 3010 ? 4 : 1;
    sample->sequence = r->sequence;
    if (tick >= 50) sample->status |= AMB_STATUS_BEARING_ON;
    if (tick >= 100) sample->status |= AMB_STATUS_SPIN_VALID;
    if (tick >= 3020) sample->status |= AMB_STATUS_APPLIED_VALID;
    if (between(tick, 3040, 3300)) sample->status |= AMB_STATUS_AXIS_Y_LOST;
    if (tick == 320) sample->status |= AMB_STATUS_LATE;
    if (between(tick, 3590, 3640)) sample->status |= AMB_STATUS_SHADOW;
    sample->spin_rad_s = 1000.0f;
    for (axis = 0; axis < 2; axis++) {
        /* 2e6 N/m and 6.2e3 N s/m. */
        r->levitation[axis] = -r->position[axis] / 34360 - r->velocity[axis] / 549;
        sample->levitation_n[axis] = (float)r->levitation[axis] / 16.0f;
        sample->applied_n[axis] = (float)r->force[axis] / 16.0f;
        sample->position_m[axis] = (float)(r->position[axis] / STEP) * STEP_M;
    }
    /* The sensor's cable breaks: a metre off. */
    if (between(tick, 2000, 2030)) sample->position_m[0] = 1.0f;
}

static void hash_word(rig *r, uint32_t word) {
    int i;
    for (i = 0; i < 4; i++) {
        r->hash = (r->hash ^ ((word >> (8 * i)) & 255u)) * 16777619u;
    }
}

static uint32_t bits(float value) {
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

static int64_t root(int64_t square) {
    int64_t r = 0, bit = (int64_t)1 << 30;
    for (; bit > 0; bit >>= 1) {
        if ((r + bit) * (r + bit) <= square) r += bit;
    }
    return r;
}

/* Force of the retainer bearing, where the rotor touches it. */
static void contact(const rig *r, int32_t force[2]) {
    const int64_t x = r->position[0] / STEP, y = r->position[1] / STEP;
    const int64_t radius = root(x * x + y * y);
    int64_t normal, friction;
    if (radius <= CLEARANCE) return;
    /* 2e8 N/m; half of it on the way back, which is a restitution of 0.7. */
    normal = (radius - CLEARANCE) * 12;
    if (x * r->velocity[0] + y * r->velocity[1] < 0) normal /= 2;
    /* The spin slides counter-clockwise, faster than any whirl: friction pushes clockwise. */
    friction = normal * 3 / 20;
    force[0] += (int32_t)((-normal * x + friction * y) / radius);
    force[1] += (int32_t)((-normal * y - friction * x) / radius);
}

void rig_actuate(rig *r, const amb_command *command) {
    int axis;
    int32_t force[2] = {r->force[0], r->force[1]};
    hash_word(r, bits(command->force_n[0]));
    hash_word(r, bits(command->force_n[1]));
    hash_word(r, bits(command->own_n[0]));
    hash_word(r, bits(command->own_n[1]));
    hash_word(r, bits(command->severity));
    hash_word(r, command->mode);
    hash_word(r, command->limits);
    /* When a record is frozen depends on when the background has taken the one before. */
    hash_word(r, command->events & ~AMB_EVENT_RECORD_FROZEN);
    hash_word(r, command->integrator);
    r->modes |= 1u << command->mode;
    r->events |= command->events;

    contact(r, force);
    if (r->tick == 200) {
        r->velocity[0] += 32000000; /* 0.58 m/s */
        r->velocity[1] -= 34000000;
    }
    if (r->tick == 3100) {
        r->velocity[0] -= 12000000;
        r->velocity[1] += 16000000;
    }
    if (r->tick == 3600) {
        r->velocity[0] += 20000000;
        r->velocity[1] += 20000000;
    }
    for (axis = 0; axis < 2; axis++) {
        r->velocity[axis] += ACCELERATION * force[axis];
        r->position[axis] += r->velocity[axis];
        r->force[axis] = (int32_t)(command->force_n[axis] * 16.0f);
    }
    r->tick++;
}
