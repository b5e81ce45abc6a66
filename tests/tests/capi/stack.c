/* How deep the calls go on the stack, on the rotor of the example. */
#include "amb_supervisor.h"
#include "mps2.h"
#include "rig.h"

#include <stdio.h>

static amb_supervisor plane;
static rig machine;

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

int main(void) {
    uint32_t *const top = __builtin_frame_address(0);
    unsigned deepest = 0;
    amb_code code;
    paint(top);
    code = amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS);
    if (code != AMB_OK) return 1;
    printf("init %u\n", depth(top));
    paint(top);
    code = amb_reconfigure(&plane, rig_config, AMB_PARAMETERS);
    if (code != AMB_OK) return 1;
    printf("reconfigure %u\n", depth(top));
    paint(top);
    code = amb_self_test();
    if (code != AMB_OK) return 1;
    printf("self-test %u\n", depth(top));
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
    }
    printf("tick %u\n", deepest);
    return 0;
}
