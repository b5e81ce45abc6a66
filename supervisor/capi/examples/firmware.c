/* Firmware with the supervisor: an interrupt at 20 kHz samples, ticks and commands; the background drains
 * events, takes flight records away and keeps count of what the retainer bearing has borne. It runs on Arm's MPS2 board or in QEMU (mps2.c), with a rotor of
 * integers (rig.c) in place of converters and amplifiers.
 *
 * How to build and run it is on the page "Linking it into C firmware" of the book. */
#include "amb_supervisor.h"
#include "mps2.h"
#include "rig.h"

#include <stdbool.h>
#include <stdio.h>

/* The bearing in nine numbers: a first configuration needs no more. */
static const amb_bearing bearing = {
    50e-6f,  /* s: period of the tick */
    10.0f,   /* kg: mass of the rotor that this plane carries */
    0.0f,    /* N/m: shaft stiffness plus the magnets' negative stiffness */
    2e-4f,   /* m: radial clearance of the retainer bearing */
    1000.0f, /* N: force cap of the magnet */
    0.0f,    /* s: time constant of the amplifier with the magnet */
    0.15f,   /* coefficient of friction on the retainer bearing */
    2e8f,    /* N/m: stiffness of the contact with it */
    1e-8f,   /* m: noise of the sensor, or its step */
};

/* What is known better than that, or wanted otherwise, of this rig. */
static amb_code configure(float values[AMB_PARAMETERS]) {
    const amb_code code = amb_config_for_bearing(&bearing, values, AMB_PARAMETERS);
    if (code != AMB_OK) return code;
    values[AMB_P_CONTACT_BAND] = 0.02f;
    values[AMB_P_POSITION_LIMIT] = 4.0f; /* the sensor's range */
    values[AMB_P_WHIRL_TIME_S] = 2e-3f;
    values[AMB_P_HANDOVER_DWELL_S] = 1e-3f;
    values[AMB_P_FAULT_BLEND_S] = 1e-3f;
    values[AMB_P_FAULT_TICKS] = 10.0f;
    values[AMB_P_FORCE_SLEW_N_S] = 1e7f; /* slew limit and budget of the drive */
    values[AMB_P_CONTINUOUS_FORCE_N] = 400.0f;
    values[AMB_P_SENSOR_STEP_M] = 1e-8f;
    values[AMB_P_CHECK_FIRST] = 0.0f; /* a rig of integers confirms nothing; a machine would */
    return AMB_OK;
}

/* Static, so that they are zero before they are made; 28 kilobytes have no place on a stack. */
static amb_supervisor plane;
static amb_watch watch;
static amb_ledger ledger;
static bool counts; /* there is a ledger */
static rig machine;
static volatile bool finished;
/* A call that failed in the interrupt: to be shown by the background. */
static volatile amb_code failed = AMB_OK;

/* Every 50 us, above everything else that uses the supervisor, which never has to hold it. */
void control_interrupt(void) {
    amb_sample sample;
    amb_command command;
    amb_code code;
    float values[AMB_PARAMETERS];
    if (finished) return;
    if (rig_reconfigures(&machine, values)) {
        code = amb_reconfigure(&plane, values, AMB_PARAMETERS);
        if (code != AMB_OK) failed = code; /* the configuration before still holds */
    }
    rig_sample(&machine, &sample);
    code = amb_tick(&plane, &sample, &command);
    /* The command is usable all the same: after an error it is zero force. */
    if (code != AMB_OK) failed = code;
    code = amb_watch_renew(&watch, command.force_n);
    if (code != AMB_OK) failed = code;
    /* A loop of the amplifier's own would do this in each of its periods: once the control interrupt stays
     * away, the force is zero. Here it has the period of the tick. */
    code = amb_watch_force(&watch, command.force_n);
    if (code != AMB_OK) failed = code;
    rig_actuate(&machine, &command);
    finished = machine.tick == RIG_TICKS;
}

/* To flash, or over a bus. */
static void save(const uint8_t *bytes, uint32_t length) {
    (void)bytes;
    (void)length;
}

/* One of the two places of the ledger. */
static uint8_t *copy_of_ledger(uint32_t place) {
    return &board_kept[place * AMB_LEDGER_BYTES];
}

/* What the bearing had borne when the power was switched on. */
static void load_ledger(void) {
    amb_code code = amb_ledger_newer(copy_of_ledger(0), copy_of_ledger(1), AMB_LEDGER_BYTES, &ledger);
    if (code == AMB_ERROR_LEDGER_BLANK) {
        /* Nobody has ever written there. A service tool would do this, when the bearing is fitted. */
        code = amb_ledger_new(1, 20.0f, &ledger);
        if (code == AMB_OK) code = amb_ledger_write(&ledger, copy_of_ledger(0), AMB_LEDGER_BYTES);
        if (code == AMB_OK) code = amb_ledger_write(&ledger, copy_of_ledger(1), AMB_LEDGER_BYTES);
    }
    /* Of a damaged one nothing is written over: what is left may still be read by a person. */
    counts = code == AMB_OK || code == AMB_ONE_COPY;
    if (code != AMB_OK) printf("ledger: %s\n", amb_error_text(code));
    if (counts) printf("bearing %u: %u landings so far\n", (unsigned)ledger.bearing, (unsigned)ledger.landings);
}

/* Of a frozen record, before it is discarded. The older copy is written: where power fails meanwhile, the other one is whole. */
static void count_landings(void) {
    if (!counts || amb_ledger_take_in(&ledger, &plane) != AMB_OK) return;
    if (amb_ledger_write(&ledger, copy_of_ledger(ledger.updates & 1u), AMB_LEDGER_BYTES) != AMB_OK) counts = false;
}

static void show_events(void) {
    amb_event event;
    while (amb_next_event(&plane, &event) == AMB_OK) {
        printf("tick %u: %s, events 0x%04x\n", (unsigned)event.sequence, amb_mode_name(event.mode),
               (unsigned)event.events);
    }
}

/* Writes a frozen record down, a section at a time, then lets the recorder wait for the next event. Ticks go on meanwhile. */
static void take_record(void) {
    /* A machine's firmware has its build number here, and the time of its clock. */
    static const amb_stamp stamp = {1, 0, {0, 0}};
    static amb_section section;
    uint32_t index = 0, bytes = 0;
    while (amb_record_section(&plane, index, &stamp, &section) == AMB_OK) { /* AMB_NOTHING: there is none, or no more of it */
        save(section.bytes, section.length);
        bytes += section.length;
        index++;
    }
    if (index == 0) return;
    count_landings();
    printf("record of version %u, %u sections, %u bytes\n", AMB_RECORD_VERSION, (unsigned)index, (unsigned)bytes);
    amb_rearm(&plane);
}

int main(void) {
    amb_report report;
    float values[AMB_PARAMETERS];
    amb_code code = configure(values);
    if (code == AMB_OK) code = amb_init(&plane, sizeof plane, values, AMB_PARAMETERS);
    if (code == AMB_OK) code = amb_self_test(&plane); /* does this processor compute what it should? */
    if (code == AMB_OK) code = amb_watch_init(&watch, 2);
    if (code != AMB_OK) {
        printf("supervisor: %s\n", amb_error_text(code)); /* names the parameter */
        return 1;
    }
    load_ledger();
    rig_start(&machine);
    control_start(20000);
    while (!finished) {
        show_events();
        take_record();
    }
    show_events();
    take_record();
    if (failed != AMB_OK) {
        printf("supervisor: %s\n", amb_error_text(failed));
        return 1;
    }
    if (amb_report_now(&plane, &report) != AMB_OK) return 1;
    printf("landings %u, impacts %u, severity index %.2f\n", (unsigned)report.landings,
           (unsigned)report.impacts, (double)report.severity_index);
    if (counts) printf("bearing %u: %u landings\n", (unsigned)ledger.bearing, (unsigned)ledger.landings);
    printf("ticks %u modes 0x%02x events 0x%04x hash 0x%08x\n", (unsigned)machine.tick,
           (unsigned)machine.modes, (unsigned)machine.events, (unsigned)machine.hash);
    return 0;
}
