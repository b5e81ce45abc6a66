/* Every misuse of a rotor that the header names, with the code and the text that it gives. */
#include "check.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

enum { COUNT = 2 * AMB_PARAMETERS };
static amb_rotor rotor, zero, three[3];
static float values[COUNT + 1];
static const amb_shaft good = {20.0f, 0.8f, 0.5f, {-0.2f, 0.22f}, {-0.19f, 0.21f}, {-0.17f, 0.19f}};
static const char *const NULL_TEXT = "rotor is null";
static const char *const ALIGN_TEXT = "rotor is not aligned to AMB_SUPERVISOR_ALIGN bytes";
static const char *const NOT_MADE_TEXT = "rotor was not made by amb_rotor_init";
static const char *const COUNT_TEXT = "values has not AMB_PARAMETERS elements for each plane";
static const char *const INERTIA_TEXT =
    "mass and transverse inertia must be above 0, the polar one from 0 to twice the transverse one";
static const char *const PLACES_TEXT =
    "positions must be numbers, those of the retainer bearings must differ, and none be far beyond them";

static void making(void) {
    const size_t size = sizeof rotor;
    amb_shaft shafts[2], wrong = good;
    shafts[0] = good;
    EXPECT(amb_rotor_init(NULL, size, &good, values, COUNT), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
    EXPECT(amb_rotor_init(OFF(three), size, &good, values, COUNT), AMB_ERROR_ROTOR_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_rotor_init(&rotor, size - 1, &good, values, COUNT), AMB_ERROR_ROTOR_TOO_SMALL,
           "rotor has fewer than AMB_ROTOR_BYTES bytes");
    EXPECT(amb_rotor_init(&rotor, size, NULL, values, COUNT), AMB_ERROR_SHAFT_NULL, "shaft is null");
    EXPECT(amb_rotor_init(&rotor, size, OFF(shafts), values, COUNT), AMB_ERROR_SHAFT_MISALIGNED,
           "shaft is not aligned as a float");
    EXPECT(amb_rotor_init(&rotor, size, &good, NULL, COUNT), AMB_ERROR_VALUES_NULL, "values is null");
    EXPECT(amb_rotor_init(&rotor, size, &good, OFF(values), COUNT), AMB_ERROR_VALUES_MISALIGNED,
           "values is not aligned as a float");
    EXPECT(amb_rotor_init(&rotor, size, &good, values, AMB_PARAMETERS), AMB_ERROR_VALUES_COUNT, COUNT_TEXT);
    EXPECT(amb_rotor_init(&rotor, size, &good, values, COUNT + 1), AMB_ERROR_VALUES_COUNT, COUNT_TEXT);
    wrong.mass_kg = 0.0f;
    EXPECT(amb_rotor_init(&rotor, size, &wrong, values, COUNT), AMB_ERROR_SHAFT_INERTIA, INERTIA_TEXT);
    wrong = good;
    wrong.polar_inertia_kg_m2 = 1.7f;
    EXPECT(amb_rotor_init(&rotor, size, &wrong, values, COUNT), AMB_ERROR_SHAFT_INERTIA, INERTIA_TEXT);
    wrong = good;
    wrong.retainer_m[0] = good.retainer_m[1];
    EXPECT(amb_rotor_init(&rotor, size, &wrong, values, COUNT), AMB_ERROR_SHAFT_PLACES, PLACES_TEXT);
    /* A magnet beyond the centre of percussion pushes the bearing the other way. */
    wrong = good;
    wrong.magnet_m[1] = -0.4f;
    EXPECT(amb_rotor_init(&rotor, size, &wrong, values, COUNT),
           AMB_ERROR_PARAMETER(AMB_PARAMETERS + AMB_P_MAGNET_PLANE_RATIO), "magnet_plane_ratio is outside 0.2 to 5");
    /* Of which plane is in the code. */
    values[AMB_P_FORCE_MAX_N] = -1.0f;
    EXPECT(amb_rotor_init(&rotor, size, &good, values, COUNT), AMB_ERROR_PARAMETER(AMB_P_FORCE_MAX_N),
           "force_max_n is outside 0.001 to 1e7 N");
    values[AMB_P_FORCE_MAX_N] = 1000.0f;
    values[AMB_PARAMETERS + AMB_P_FORCE_MAX_N] = -1.0f;
    EXPECT(amb_rotor_init(&rotor, size, &good, values, COUNT),
           AMB_ERROR_PARAMETER(AMB_PARAMETERS + AMB_P_FORCE_MAX_N), "force_max_n is outside 0.001 to 1e7 N");
    values[AMB_PARAMETERS + AMB_P_FORCE_MAX_N] = 1000.0f;
    EXPECT(amb_rotor_rearm(&rotor), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_rotor_init(&rotor, size, &good, values, COUNT), AMB_OK, "done");
    EXPECT(amb_rotor_rearm(&rotor), AMB_OK, "done");
}

/* Configurations from the shaft and nine numbers for each plane. */
static void bearings(void) {
    static const amb_bearing plane = {50e-6f, -1.0f, 0.0f, 2e-4f, 1000.0f, 0.0f, 0.15f, 2e8f, 1e-8f};
    amb_bearing two[3];
    amb_shaft shafts[2], wrong = good;
    float made[COUNT + 1];
    made[0] = 77.0f;
    two[0] = two[1] = two[2] = plane;
    shafts[0] = shafts[1] = good;
    EXPECT(amb_config_for_rotor(NULL, two, made, COUNT), AMB_ERROR_SHAFT_NULL, "shaft is null");
    EXPECT(amb_config_for_rotor(OFF(shafts), two, made, COUNT), AMB_ERROR_SHAFT_MISALIGNED, "shaft is not aligned as a float");
    EXPECT(amb_config_for_rotor(&good, NULL, made, COUNT), AMB_ERROR_BEARING_NULL, "bearing is null");
    EXPECT(amb_config_for_rotor(&good, OFF(two), made, COUNT), AMB_ERROR_BEARING_MISALIGNED,
           "bearing is not aligned as a float");
    EXPECT(amb_config_for_rotor(&good, two, NULL, COUNT), AMB_ERROR_VALUES_NULL, "values is null");
    EXPECT(amb_config_for_rotor(&good, two, OFF(made), COUNT), AMB_ERROR_VALUES_MISALIGNED,
           "values is not aligned as a float");
    EXPECT(amb_config_for_rotor(&good, two, made, AMB_PARAMETERS), AMB_ERROR_VALUES_COUNT, COUNT_TEXT);
    wrong.mass_kg = 0.0f;
    EXPECT(amb_config_for_rotor(&wrong, two, made, COUNT), AMB_ERROR_SHAFT_INERTIA, INERTIA_TEXT);
    two[1].friction_coefficient = -1.0f;
    EXPECT(amb_config_for_rotor(&good, two, made, COUNT),
           AMB_ERROR_PARAMETER(AMB_PARAMETERS + AMB_P_FRICTION_COEFFICIENT), "friction_coefficient is outside 0 to 2");
    check(made[0] == 77.0f, "values are untouched after an error");
    two[1] = plane;
    EXPECT(amb_config_for_rotor(&good, two, made, COUNT), AMB_OK, "done");
    /* A blow at an end moves less than the whole. */
    check(made[AMB_P_MASS_KG] > 0.0f && made[AMB_P_MASS_KG] < 20.0f, "the mass follows from the shaft");
    EXPECT(amb_rotor_init(&rotor, sizeof rotor, &good, made, COUNT), AMB_OK, "done");
    memset(&rotor, 0, sizeof rotor);
}

/* After an error both commands are zero force. */
static void no_force(const char *what, amb_rotor_command *command) {
    int plane;
    for (plane = 0; plane < 2; plane++) {
        const amb_command *c = &command->planes[plane];
        check(c->force_n[0] == 0.0f && c->force_n[1] == 0.0f && c->mode == AMB_MODE_SENSOR_FAULT, what);
        check(c->own_n[0] == 0.0f && c->own_n[1] == 0.0f && c->events == 0, what);
    }
    memset(command, 0x55, sizeof *command);
}

static void ticking(void) {
    amb_sample samples[3];
    amb_rotor_command command[2];
    memset(samples, 0, sizeof samples);
    memset(command, 0x55, sizeof command);
    EXPECT(amb_rotor_tick(NULL, samples, command), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
    no_force("rotor null", command);
    EXPECT(amb_rotor_tick(OFF(three), samples, command), AMB_ERROR_ROTOR_MISALIGNED, ALIGN_TEXT);
    no_force("rotor misaligned", command);
    EXPECT(amb_rotor_tick(&zero, samples, command), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);
    no_force("not initialised", command);
    EXPECT(amb_rotor_tick_first(NULL, samples, command->planes), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
    EXPECT(amb_rotor_tick_second(NULL, samples, command), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
    no_force("half of none", command);
    EXPECT(amb_rotor_tick_first(&rotor, NULL, command->planes), AMB_ERROR_SAMPLE_NULL, "sample is null");
    EXPECT(amb_rotor_tick_first(&rotor, samples, NULL), AMB_ERROR_COMMAND_NULL, "command is null");
    EXPECT(amb_rotor_tick_second(&rotor, NULL, command), AMB_ERROR_SAMPLE_NULL, "sample is null");
    no_force("second half without a sample", command);
    EXPECT(amb_rotor_tick_second(&rotor, samples, NULL), AMB_ERROR_COMMAND_NULL, "command is null");
    EXPECT(amb_rotor_tick_second(&rotor, samples, command), AMB_ERROR_ROTOR_HALF,
           "the first plane has not had its half of the tick");
    no_force("second half first", command);
    EXPECT(amb_rotor_tick(&rotor, NULL, command), AMB_ERROR_SAMPLE_NULL, "sample is null");
    no_force("sample null", command);
    EXPECT(amb_rotor_tick(&rotor, OFF(samples), command), AMB_ERROR_SAMPLE_MISALIGNED,
           "sample is not aligned to 4 bytes");
    no_force("sample misaligned", command);
    EXPECT(amb_rotor_tick(&rotor, samples, NULL), AMB_ERROR_COMMAND_NULL, "command is null");
    EXPECT(amb_rotor_tick(&rotor, samples, OFF(command)), AMB_ERROR_COMMAND_MISALIGNED,
           "command is not aligned to 4 bytes");
    samples[1].levitation_n[1] = -12.5f;
    samples[1].status = AMB_STATUS_BEARING_ON;
    EXPECT(amb_rotor_tick(&rotor, samples, command), AMB_OK, "done");
    check(command->planes[1].force_n[1] == -12.5f && command->planes[1].mode == AMB_MODE_LEVITATED, "transparent");
    check(command->other_engaged[0] == 0 && command->other_engaged[1] == 0 && command->coast_down == 0, "calm");
    {
        /* In two halves: the first one twice begins anew, the second one comes once. */
        amb_command first;
        samples[0] = samples[1];
        samples[0].levitation_n[0] = 7.5f;
        samples[0].sequence = samples[1].sequence = 1;
        EXPECT(amb_rotor_tick_first(&rotor, samples, &first), AMB_OK, "done");
        EXPECT(amb_rotor_tick_first(&rotor, samples, &first), AMB_OK, "done");
        check(first.force_n[0] == 7.5f && first.mode == AMB_MODE_LEVITATED, "first half is transparent");
        EXPECT(amb_rotor_tick_second(&rotor, samples + 1, command), AMB_OK, "done");
        check(command->planes[0].force_n[0] == 7.5f && command->planes[1].force_n[1] == -12.5f, "halves are transparent");
        EXPECT(amb_rotor_tick_second(&rotor, samples + 1, command), AMB_ERROR_ROTOR_HALF,
               "the first plane has not had its half of the tick");
        no_force("second half twice", command);
        /* What has happened by that is not of what follows. */
        {
            amb_event event;
            int plane;
            for (plane = 0; plane < 2; plane++) {
                while (amb_rotor_next_event(&rotor, (uint32_t)plane, &event) == AMB_OK) {
                }
            }
        }
    }
    {
        /* A supervisor does not pass for a rotor, nor the other way round. */
        static amb_supervisor plane;
        check(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS) == AMB_OK, "one plane");
        EXPECT(amb_rotor_rearm((amb_rotor *)(void *)&plane), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);
        EXPECT(amb_rearm((amb_supervisor *)(void *)&rotor), AMB_ERROR_NOT_INITIALISED,
               "supervisor was not made by amb_init");
        /* A copy is none either. */
        memcpy(&zero, &rotor, sizeof rotor);
        EXPECT(amb_rotor_rearm(&zero), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);
        /* As a call finds it that interrupts a tick: the first word says so. What reads does not mind. */
        {
            const uint8_t ready = rotor.bytes[0];
            amb_report report;
            rotor.bytes[0] = 0xB5;
            EXPECT(amb_rotor_tick(&rotor, samples, command), AMB_ERROR_ROTOR_BUSY,
                   "rotor is in use by a call that this one interrupted");
            no_force("busy", command);
            EXPECT(amb_rotor_rearm(&rotor), AMB_OK, "done");
            EXPECT(amb_rotor_report_now(&rotor, 0, &report), AMB_OK, "done");
            rotor.bytes[0] = ready;
        }
        memset(&zero, 0, sizeof zero);
    }
}

static void asking(void) {
    amb_report report[2];
    amb_event event[2];
    static amb_section section[2];
    static const amb_stamp stamp;
#define REFUSALS(call_with, result)                                                                          \
    EXPECT(call_with(NULL, 0, result), AMB_ERROR_ROTOR_NULL, NULL_TEXT);                                     \
    EXPECT(call_with(&zero, 0, result), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);                     \
    EXPECT(call_with(&rotor, 2, result), AMB_ERROR_PLANE, "plane is neither 0 nor 1");                       \
    EXPECT(call_with(&rotor, UINT32_MAX, result), AMB_ERROR_PLANE, "plane is neither 0 nor 1");              \
    EXPECT(call_with(&rotor, 0, NULL), AMB_ERROR_RESULT_NULL, "the pointer to the result is null");          \
    EXPECT(call_with(&rotor, 1, OFF(result)), AMB_ERROR_RESULT_MISALIGNED,                                   \
           "the pointer to the result is not aligned as its type")
#define SECTION_0(rotor, plane, result) amb_rotor_record_section(rotor, plane, 0, &stamp, result)
    REFUSALS(amb_rotor_report_now, report);
    REFUSALS(amb_rotor_next_event, event);
    REFUSALS(SECTION_0, section);
    EXPECT(amb_rotor_next_event(&rotor, 0, event), AMB_NOTHING, "there is none");
    EXPECT(SECTION_0(&rotor, 1, section), AMB_NOTHING, "there is none");
    EXPECT(amb_rotor_record_section(&rotor, 0, 0, NULL, section), AMB_ERROR_STAMP_NULL, "stamp is null");
    EXPECT(amb_rotor_rearm(NULL), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
}

/* Both ends on the rig's first blow: each has its events, and both records are read before either is discarded. */
static void events_and_records(void) {
    static rig ends[2];
    static amb_section section;
    static const amb_stamp stamp;
    amb_sample samples[2];
    amb_rotor_command command;
    amb_report report;
    amb_event event;
    uint32_t i, plane;
#define SECTION(plane, index) amb_rotor_record_section(&rotor, plane, index, &stamp, &section)
    rig_start(&ends[0]);
    rig_start(&ends[1]);
    EXPECT(amb_rotor_init(&rotor, sizeof rotor, &good, values, COUNT), AMB_OK, "done");
    while (ends[0].tick < RIG_TICKS && SECTION(0, 0) == AMB_NOTHING) {
        for (i = 0; i < 2; i++) rig_sample(&ends[i], &samples[i]);
        check(amb_rotor_tick(&rotor, samples, &command) == AMB_OK, "tick");
        for (i = 0; i < 2; i++) rig_actuate(&ends[i], &command.planes[i]);
    }
    check(command.other_engaged[0] == 1 && command.other_engaged[1] == 1, "each is told of the other");
    for (plane = 0; plane < 2; plane++) {
        EXPECT(amb_rotor_next_event(&rotor, plane, &event), AMB_OK, "done");
        check(event.events == AMB_EVENT_ENGAGED && event.mode == AMB_MODE_APPROACH, "oldest event");
        EXPECT(amb_rotor_report_now(&rotor, plane, &report), AMB_OK, "done");
        check(report.landings > 0 && report.impacts > 0, "report");
        for (i = 0; SECTION(plane, i) == AMB_OK; i++) {
            if (i == 0) check(memcmp(section.bytes, "AMBR", 4) == 0, "head");
        }
        check(i > AMB_RECORD_ENTRIES / 32 && memcmp(section.bytes, "ENDS", 4) == 0, "record");
    }
    EXPECT(amb_rotor_rearm(&rotor), AMB_OK, "done");
    EXPECT(SECTION(0, 0), AMB_NOTHING, "there is none");
    EXPECT(SECTION(1, 0), AMB_NOTHING, "there is none");
}

static void reconfiguring(void) {
    amb_sample samples[2];
    amb_rotor_command command;
    amb_report report;
    amb_shaft wrong = good;
    memset(samples, 0, sizeof samples);
    EXPECT(amb_rotor_self_test(NULL), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
    EXPECT(amb_rotor_self_test(&zero), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_rotor_self_test(&rotor), AMB_OK, "done");
    EXPECT(amb_rotor_reconfigure(NULL, &good, values, COUNT), AMB_ERROR_ROTOR_NULL, NULL_TEXT);
    EXPECT(amb_rotor_reconfigure(&zero, &good, values, COUNT), AMB_ERROR_ROTOR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_rotor_reconfigure(&rotor, NULL, values, COUNT), AMB_ERROR_SHAFT_NULL, "shaft is null");
    EXPECT(amb_rotor_reconfigure(&rotor, &good, NULL, COUNT), AMB_ERROR_VALUES_NULL, "values is null");
    EXPECT(amb_rotor_reconfigure(&rotor, &good, values, COUNT - 1), AMB_ERROR_VALUES_COUNT, COUNT_TEXT);
    EXPECT(amb_rotor_init(&rotor, sizeof rotor, &good, values, COUNT), AMB_OK, "done");
    wrong.mass_kg = -1.0f;
    values[AMB_PARAMETERS + AMB_P_FORCE_MAX_N] = 500.0f;
    EXPECT(amb_rotor_reconfigure(&rotor, &wrong, values, COUNT), AMB_ERROR_SHAFT_INERTIA, INERTIA_TEXT);
    EXPECT(amb_rotor_tick(&rotor, samples, &command), AMB_OK, "done");
    check((command.planes[1].events & AMB_EVENT_RECONFIGURED) == 0, "a refused shaft is no event");
    EXPECT(amb_rotor_reconfigure(&rotor, &good, values, COUNT), AMB_OK, "done");
    samples[0].sequence = samples[1].sequence = 1;
    EXPECT(amb_rotor_tick(&rotor, samples, &command), AMB_OK, "done");
    check((command.planes[1].events & AMB_EVENT_RECONFIGURED) != 0, "the tick from which it holds says so");
    EXPECT(amb_rotor_report_now(&rotor, 1, &report), AMB_OK, "done");
    check(report.force_cap_n == 500.0f, "it holds");
    EXPECT(amb_rotor_report_now(&rotor, 0, &report), AMB_OK, "done");
    check(report.force_cap_n == 1000.0f, "each plane its own");
}

int main(void) {
    memcpy(values, rig_config, sizeof rig_config);
    memcpy(values + AMB_PARAMETERS, rig_config, sizeof rig_config);
    bearings();
    making();
    ticking();
    asking();
    events_and_records();
    reconfiguring();
    printf("%d checks, %d failures\n", checks, failures);
    return failures > 0;
}
