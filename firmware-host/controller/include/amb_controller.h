/*
 * A levitation controller of one's own for scenes of firmware-host, as a shared library:
 *
 *     cc -O2 -shared -fPIC -I firmware-host/controller/include -o my_controller.so my_controller.c
 *
 * The library has the three functions below and, once, the line AMB_CONTROLLER_DEFINE_ABI. It runs in a process of its own, one for
 * each run, and is called by one thread. What it prints goes to the host's standard error. Numbers are in SI units.
 * Included into C++, the declarations below give the functions their C linkage.
 */
#ifndef AMB_CONTROLLER_H
#define AMB_CONTROLLER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this interface. */
#define AMB_CONTROLLER_ABI 1u

/* What holds for the whole run. Pointers are valid during amb_controller_init only. */
typedef struct {
    double period_s;              /* from one control sample to the next [s] */
    uint32_t sensors;             /* position sensors, one a bearing plane */
    uint32_t magnets;             /* magnets; a plane may have none */
    uint32_t parameters;          /* numbers of controller.parameters in the scene */
    uint32_t reserved;            /* 0 */
    const uint32_t *magnet_plane; /* [magnets]: the sensor in whose plane each magnet is */
    const double *force_max_n;    /* [magnets]: cap on the length of its force vector [N] */
    const double *parameter;      /* [parameters] */
} amb_controller_setup;

/* Whether integrators may run. */
#define AMB_CONTROLLER_RUN 0u
#define AMB_CONTROLLER_HOLD 1u /* the supervisor has the bearing: keep integrators as they are */

/* A control sample. Pointers are valid during amb_controller_step only. */
typedef struct {
    double t_s;               /* time of the sample [s] */
    double spin_rad_s;        /* spin as reported [rad/s] */
    uint32_t integrator;      /* AMB_CONTROLLER_RUN or AMB_CONTROLLER_HOLD */
    uint32_t reserved;        /* 0 */
    const uint32_t *sequence; /* [sensors]: number of the reading; one that did not come has that of the last */
    const double *position_m; /* [2 * sensors]: x and y of each sensor [m]; finite, a reading that is no number is the last */
} amb_controller_sample;

/* Sets a controller up at rest. Returns what the other functions are given, or NULL if it cannot control this machine. */
void *amb_controller_init(const amb_controller_setup *setup);

/* Answers a sample: writes force_n[2 * magnets], x and y of each magnet [N], finite. Returns 0, or another number to end the run. */
int amb_controller_step(void *controller, const amb_controller_sample *sample, double *force_n);

/* Ends it. */
void amb_controller_close(void *controller);

/* The version that the library was compiled for. */
uint32_t amb_controller_abi(void);
#define AMB_CONTROLLER_DEFINE_ABI \
    uint32_t amb_controller_abi(void) { return AMB_CONTROLLER_ABI; }

#ifdef __cplusplus
}
#endif
#endif
