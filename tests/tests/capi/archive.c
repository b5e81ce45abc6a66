/* A rig's landings in an archive of two events, written down at the end of the course: its bytes, as a sum of each record. */
#include "mps2.h"
#include "rig.h"

#include <stdio.h>

static amb_supervisor plane;
static amb_archive archive;
static amb_archive_place places[2];
static rig machine;

/* The board's start-up names it; here nothing interrupts. */
void control_interrupt(void) {
}

/* FNV-1a. */
static uint32_t sum_of(uint32_t sum, const amb_section *section) {
    uint32_t i;
    for (i = 0; i < section->length; i++) sum = (sum ^ section->bytes[i]) * 16777619u;
    return sum;
}

int main(void) {
    static amb_section section;
    static const amb_stamp stamp = {7, 0, {0, 0}};
    float values[AMB_PARAMETERS];
    uint32_t taken = 0, kept = 0;
    if (amb_archive_init(&archive, places, 2) != AMB_OK) return 1;
    if (amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS) != AMB_OK) return 2;
    rig_start(&machine);
    while (machine.tick < RIG_TICKS) {
        amb_sample sample;
        amb_command command;
        if (rig_reconfigures(&machine, values) && amb_reconfigure(&plane, values, AMB_PARAMETERS) != AMB_OK) return 3;
        rig_sample(&machine, &sample);
        if (amb_tick(&plane, &sample, &command) != AMB_OK) return 4;
        rig_actuate(&machine, &command);
        /* In the background. */
        if ((command.events & AMB_EVENT_RECORD_FROZEN) == 0) continue;
        if (amb_archive_take(&archive, &plane) != AMB_OK) return 5;
        if (amb_archive_take(&archive, &plane) != AMB_NOTHING) return 6;
        taken++;
    }
    /* When there is time for it. */
    if (amb_archive_count(&archive, &kept) != AMB_OK) return 7;
    printf("%u taken, %u kept:", (unsigned)taken, (unsigned)kept);
    for (;;) {
        uint32_t index, sum = 2166136261u;
        for (index = 0; amb_archive_section(&archive, index, &stamp, &section) == AMB_OK; index++) sum = sum_of(sum, &section);
        if (index == 0) break;
        printf(" %u sections %08x", (unsigned)index, (unsigned)sum);
        if (amb_archive_discard(&archive) != AMB_OK) return 8;
    }
    printf("\n");
    return amb_archive_discard(&archive) == AMB_NOTHING ? 0 : 9;
}
