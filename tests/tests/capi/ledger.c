/* A rig's landings in a ledger that is kept in two places: what it says at the end, byte by byte. */
#include "mps2.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

static amb_supervisor plane;
static rig machine;

/* The board's start-up names it; here nothing interrupts. */
void control_interrupt(void) {
}

int main(void) {
    /* Memory that keeps what it holds without power, blank before a bearing is fitted. */
    static uint8_t places[2][AMB_LEDGER_BYTES];
    float values[AMB_PARAMETERS];
    amb_ledger ledger;
    uint32_t left, writes = 0;
    size_t i;
    if (amb_ledger_newer(places[0], places[1], AMB_LEDGER_BYTES, &ledger) != AMB_ERROR_LEDGER_BLANK) return 1;
    if (amb_ledger_new(7, 20.0f, &ledger) != AMB_OK) return 2;
    for (i = 0; i < 2; i++) {
        if (amb_ledger_write(&ledger, places[i], AMB_LEDGER_BYTES) != AMB_OK) return 3;
    }
    /* At boot. */
    if (amb_ledger_newer(places[0], places[1], AMB_LEDGER_BYTES, &ledger) != AMB_OK) return 4;
    if (amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS) != AMB_OK) return 5;
    rig_start(&machine);
    while (machine.tick < RIG_TICKS) {
        amb_sample sample;
        amb_command command;
        if (rig_reconfigures(&machine, values) && amb_reconfigure(&plane, values, AMB_PARAMETERS) != AMB_OK) return 6;
        rig_sample(&machine, &sample);
        if (amb_tick(&plane, &sample, &command) != AMB_OK) return 7;
        rig_actuate(&machine, &command);
        /* In the background. */
        if ((command.events & AMB_EVENT_RECORD_FROZEN) == 0) continue;
        if (amb_ledger_take_in(&ledger, &plane) == AMB_OK) {
            writes++;
            if (amb_ledger_write(&ledger, places[ledger.updates & 1], AMB_LEDGER_BYTES) != AMB_OK) return 8;
        }
        /* Once more: nothing is new. */
        if (amb_ledger_take_in(&ledger, &plane) != AMB_NOTHING) return 9;
        if (amb_rearm(&plane) != AMB_OK) return 10;
    }
    if (amb_ledger_newer(places[0], places[1], AMB_LEDGER_BYTES, &ledger) != AMB_OK) return 11;
    for (i = 0; i < AMB_LEDGER_BYTES; i++) printf("%02x", places[ledger.updates & 1][i]);
    if (amb_ledger_landings_left(&ledger, ledger.worst_severity, &left) != AMB_OK) return 12;
    printf(" %u written, %u landings, %u left\n", (unsigned)writes, (unsigned)ledger.landings, (unsigned)left);
    return 0;
}
