/**
 * @file rig.h
 * A rotor in a bearing, in place of hardware: what the firmware's converters, amplifiers and levitation
 * controller would be. It computes in integers, and turns them to floats only where these are exact, so
 * that every processor and compiler gives the same bits; tests/tests/capi/rig.rs is the same in Rust.
 *
 * Lengths are in 2^-40 m, times in ticks of 50 us, forces in 1/16 N.
 */
#ifndef RIG_H
#define RIG_H

#include "amb_supervisor.h"

/** Ticks of the whole story. */
#define RIG_TICKS 4400u

/** The configuration of its supervisor at start, all of it; firmware.c makes the same of nine numbers. */
extern const float rig_config[AMB_PARAMETERS];

typedef struct rig {
    uint32_t tick;
    uint32_t sequence;
    int32_t position[2];
    int32_t velocity[2];
    int32_t force[2];     /**< commanded at the last tick; acts during this one */
    int32_t levitation[2];
    uint32_t hash;        /**< FNV-1a over all commands */
    uint32_t modes;       /**< bit i: mode i has been there */
    uint32_t events;      /**< all events so far */
} rig;

/** At the centre, at rest. */
void rig_start(rig *r);

/** Whether another configuration is to hold from this tick on. @param[out] values it, if so. */
int rig_reconfigures(const rig *r, float values[AMB_PARAMETERS]);

/** What the converters and the controller have at this tick. */
void rig_sample(rig *r, amb_sample *sample);

/** Gives the command to the amplifiers and lets a tick pass. */
void rig_actuate(rig *r, const amb_command *command);

#endif
