/* How deep the calls go on the stack, on the rotor of the example. */
#include "amb_supervisor.h"
#include "mps2.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

static amb_supervisor plane;
static amb_rotor rotor;
static amb_archive archive;
static amb_archive_place places[2];
static rig machine;
static const amb_bearing bearings[2] = {
    {50e-6f, 10.0f, -2e5f, 2e-4f, 1000.0f, 1.6e-4f, 0.15f, 1e9f, 1e-6f},
    {50e-6f, 10.0f, -2e5f, 2e-4f, 1000.0f, 1.6e-4f, 0.15f, 1e9f, 3e-6f},
};

void control_interrupt(void) {
}

enum { WORDS = 16384, CLEAR = 32 };
static const uint32_t PAINT = 0xA5A5A5A5u;

/* Paints what is below the caller's frame, but for a little that painting itself uses. */
__attribute__((noinline)) static void paint(uint32_t *top) {
    volatile uint32_t *word;
    for (word = top - WORDS; word < top - CLEAR; word++) *word = PAINT;
}

/* Bytes below `top` that have been written to. */
__attribute__((noinline)) static unsigned depth(uint32_t *top) {
    const volatile uint32_t *word = top - WORDS;
    while (word < top - CLEAR && *word == PAINT) word++;
    return (unsigned)((const volatile char *)top - (const volatile char *)word);
}

/* The same of a rotor, both of its ends on the rig. */
static int of_rotor(void) {
    static const amb_shaft shaft = {20.0f, 0.8f, 0.5f, {-0.2f, 0.22f}, {-0.19f, 0.21f}, {-0.17f, 0.19f}};
    static float values[2 * AMB_PARAMETERS];
    uint32_t *const top = __builtin_frame_address(0);
    unsigned deepest = 0;
    paint(top);
    if (amb_config_for_rotor(&shaft, bearings, values, 2 * AMB_PARAMETERS) != AMB_OK) return 1;
    printf("config-for-rotor %u\n", depth(top));
    memcpy(values, rig_config, sizeof rig_config);
    memcpy(values + AMB_PARAMETERS, rig_config, sizeof rig_config);
    paint(top);
    if (amb_rotor_init(&rotor, sizeof rotor, &shaft, values, 2 * AMB_PARAMETERS) != AMB_OK) return 1;
    printf("rotor-init %u\n", depth(top));
    paint(top);
    if (amb_rotor_reconfigure(&rotor, &shaft, values, 2 * AMB_PARAMETERS) != AMB_OK) return 1;
    printf("rotor-reconfigure %u\n", depth(top));
    rig_start(&machine);
    while (machine.tick < RIG_TICKS) {
        amb_sample samples[2];
        amb_rotor_command command;
        unsigned now;
        rig_sample(&machine, &samples[0]);
        samples[1] = samples[0];
        paint(top);
        if (amb_rotor_tick(&rotor, samples, &command) != AMB_OK) return 1;
        now = depth(top);
        if (now > deepest) deepest = now;
        rig_actuate(&machine, &command.planes[0]);
    }
    printf("rotor-tick %u\n", deepest);
    return 0;
}

/* What the background does with a record that has frozen. */
static int of_archive(unsigned *take, unsigned *section) {
    static const amb_stamp stamp = {0, 0, {0, 0}};
    static amb_section written;
    uint32_t *const top = __builtin_frame_address(0);
    uint32_t index;
    paint(top);
    if (amb_archive_take(&archive, &plane) != AMB_OK) return 1;
    if (depth(top) > *take) *take = depth(top);
    paint(top);
    for (index = 0; amb_archive_section(&archive, index, &stamp, &written) == AMB_OK; index++) {}
    if (depth(top) > *section) *section = depth(top);
    return 0;
}

int main(void) {
    uint32_t *const top = __builtin_frame_address(0);
    unsigned deepest = 0, take = 0, section = 0;
    static float values[AMB_PARAMETERS];
    amb_code code;
    paint(top);
    code = amb_config_for_bearing(bearings, values, AMB_PARAMETERS);
    if (code != AMB_OK) return 1;
    printf("config-for-bearing %u\n", depth(top));
    paint(top);
    code = amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS);
    if (code != AMB_OK) return 1;
    printf("init %u\n", depth(top));
    paint(top);
    code = amb_reconfigure(&plane, rig_config, AMB_PARAMETERS);
    if (code != AMB_OK) return 1;
    printf("reconfigure %u\n", depth(top));
    paint(top);
    code = amb_self_test(&plane);
    if (code != AMB_OK) return 1;
    printf("self-test %u\n", depth(top));
    paint(top);
    code = amb_archive_init(&archive, places, 2);
    if (code != AMB_OK) return 1;
    printf("archive-init %u\n", depth(top));
    rig_start(&machine);
    while (machine.tick < RIG_TICKS) {
        amb_sample sample;
        amb_command command;
        unsigned now;
        rig_sample(&machine, &sample);
        paint(top);
        if (amb_tick(&plane, &sample, &command) != AMB_OK) return 1;
        now = depth(top);
        if (now > deepest) deepest = now;
        rig_actuate(&machine, &command);
        if ((command.events & AMB_EVENT_RECORD_FROZEN) != 0 && of_archive(&take, &section) != 0) return 1;
    }
    printf("archive-take %u\narchive-section %u\n", take, section);
    printf("tick %u\n", deepest);
    return of_rotor();
}
