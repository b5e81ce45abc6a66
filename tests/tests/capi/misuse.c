/* Every misuse that the header names, with the code and the text that it gives. */
#define _XOPEN_SOURCE 600
#include "amb_supervisor.h"
#include "check.h"
#include "rig.h"

#include <fenv.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>

static amb_supervisor plane, zero, three[3];
static amb_watch watch, zero_watch, three_watches[3];
static const char *const NULL_TEXT = "supervisor is null";
static const char *const ALIGN_TEXT = "supervisor is not aligned to AMB_SUPERVISOR_ALIGN bytes";
static const char *const NOT_MADE_TEXT = "supervisor was not made by amb_init";
static const char *const RESULT_NULL_TEXT = "the pointer to the result is null";
static const char *const RESULT_ALIGN_TEXT = "the pointer to the result is not aligned as its type";

static void making(void) {
    float values[AMB_PARAMETERS + 1];
    const size_t size = sizeof plane;
    uint32_t i;
    memcpy(values, rig_config, sizeof rig_config);
    EXPECT(amb_init(NULL, size, values, AMB_PARAMETERS), AMB_ERROR_SUPERVISOR_NULL, NULL_TEXT);
    EXPECT(amb_init(OFF(three), size, values, AMB_PARAMETERS), AMB_ERROR_SUPERVISOR_MISALIGNED, ALIGN_TEXT);
    /* Enough for the fields, and not what the header promises. */
    EXPECT(amb_init((amb_supervisor *)((char *)three + 4), size, values, AMB_PARAMETERS),
           AMB_ERROR_SUPERVISOR_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_init(&plane, size - 1, values, AMB_PARAMETERS), AMB_ERROR_SUPERVISOR_TOO_SMALL,
           "supervisor has fewer than AMB_SUPERVISOR_BYTES bytes");
    EXPECT(amb_init(&plane, sizeof(void *), values, AMB_PARAMETERS), AMB_ERROR_SUPERVISOR_TOO_SMALL,
           "supervisor has fewer than AMB_SUPERVISOR_BYTES bytes");
    EXPECT(amb_init(&plane, size, NULL, AMB_PARAMETERS), AMB_ERROR_VALUES_NULL, "values is null");
    EXPECT(amb_init(&plane, size, OFF(values), AMB_PARAMETERS), AMB_ERROR_VALUES_MISALIGNED,
           "values is not aligned as a float");
    EXPECT(amb_init(&plane, size, values, AMB_PARAMETERS - 1), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");
    EXPECT(amb_init(&plane, size, values, AMB_PARAMETERS + 1), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");
    EXPECT(amb_init(&plane, size, values, 0), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");

    values[AMB_P_MASS_KG] = -1.0f;
    EXPECT(amb_init(&plane, size, values, AMB_PARAMETERS), AMB_ERROR_PARAMETER(AMB_P_MASS_KG),
           "mass_kg is outside 1e-4 to 1e6 kg");
    /* Every parameter, below and above its range, names itself. */
    for (i = 0; i < AMB_PARAMETERS; i++) {
        amb_parameter row;
        char start[80];
        int above;
        check(amb_parameter_at(i, &row) == AMB_OK, "a row of the table");
        sprintf(start, "%.60s is outside ", row.name);
        for (above = 0; above < 2; above++) {
            amb_code code;
            memcpy(values, rig_config, sizeof rig_config);
            values[i] = above ? row.high * 2.0f + 1.0f : row.low - 1.0f;
            if (!above && values[i] >= row.low) values[i] = row.low * 2.0f;
            code = amb_init(&plane, size, values, AMB_PARAMETERS);
            check(code == AMB_ERROR_PARAMETER(i), row.name);
            check(strncmp(amb_error_text(code), start, strlen(start)) == 0, amb_error_text(code));
        }
    }
    {
        /* All zero: what a forgotten configuration looks like. */
        static const float nothing[AMB_PARAMETERS] = {0.0f};
        EXPECT(amb_init(&plane, size, nothing, AMB_PARAMETERS), AMB_ERROR_PARAMETER(0),
               "sample_period_s is outside 1e-6 to 0.01 s");
    }
    {
        /* Nothing of all this has made a supervisor. */
        uint32_t mode = 77;
        EXPECT(amb_mode(&plane, &mode), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
        check(mode == 77, "a result is untouched after an error");
    }
    EXPECT(amb_init(&plane, size, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    /* One that is there survives a refused configuration. */
    memcpy(values, rig_config, sizeof rig_config);
    values[AMB_P_MASS_KG] = -1.0f;
    EXPECT(amb_init(&plane, size, values, AMB_PARAMETERS), AMB_ERROR_PARAMETER(AMB_P_MASS_KG),
           "mass_kg is outside 1e-4 to 1e6 kg");
    EXPECT(amb_mode(&plane, &i), AMB_OK, "done");
}

/* A configuration from nine numbers. */
static void bearings(void) {
    static const amb_bearing good = {50e-6f, 10.0f, 0.0f, 2e-4f, 1000.0f, 0.0f, 0.15f, 2e8f, 1e-8f};
    amb_bearing wrong[2];
    float values[AMB_PARAMETERS + 1];
    float *const number = (float *)&wrong[0];
    /* The parameter of each number, in its order. */
    static const uint32_t parameter[9] = {
        AMB_P_SAMPLE_PERIOD_S, AMB_P_MASS_KG, AMB_P_STIFFNESS_N_M, AMB_P_CLEARANCE_M, AMB_P_FORCE_MAX_N,
        AMB_P_AMPLIFIER_LAG_S, AMB_P_FRICTION_COEFFICIENT, AMB_P_CONTACT_STIFFNESS_N_M, AMB_P_SENSOR_STEP_M,
    };
    uint32_t i;
    wrong[0] = wrong[1] = good;
    values[0] = 77.0f;
    EXPECT(amb_config_for_bearing(NULL, values, AMB_PARAMETERS), AMB_ERROR_BEARING_NULL, "bearing is null");
    EXPECT(amb_config_for_bearing(OFF(wrong), values, AMB_PARAMETERS), AMB_ERROR_BEARING_MISALIGNED,
           "bearing is not aligned as a float");
    EXPECT(amb_config_for_bearing(&good, NULL, AMB_PARAMETERS), AMB_ERROR_VALUES_NULL, "values is null");
    EXPECT(amb_config_for_bearing(&good, OFF(values), AMB_PARAMETERS), AMB_ERROR_VALUES_MISALIGNED,
           "values is not aligned as a float");
    EXPECT(amb_config_for_bearing(&good, values, AMB_PARAMETERS - 1), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");
    EXPECT(amb_config_for_bearing(&good, values, 2 * AMB_PARAMETERS), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");
    for (i = 0; i < 9; i++) {
        wrong[0] = good;
        number[i] = i == 2 ? -2e10f : -1.0f;
        check(amb_config_for_bearing(wrong, values, AMB_PARAMETERS) == AMB_ERROR_PARAMETER(parameter[i]), "a wrong number");
    }
    /* More noise than a touch can be told from. */
    wrong[0] = good;
    wrong[0].sensor_noise_m = 5e-5f;
    EXPECT(amb_config_for_bearing(wrong, values, AMB_PARAMETERS), AMB_ERROR_PARAMETER(AMB_P_CONTACT_BAND),
           "contact_band is outside 0.001 to 0.3 clearance");
    check(values[0] == 77.0f, "values are untouched after an error");
    EXPECT(amb_config_for_bearing(&good, values, AMB_PARAMETERS), AMB_OK, "done");
    check(values[AMB_P_MASS_KG] == 10.0f && values[AMB_P_RESTITUTION] == 0.7f, "given, and derived");
}

/* After an error a command is zero force. */
static void no_force(const char *what, amb_command *command) {
    check(command->force_n[0] == 0.0f && command->force_n[1] == 0.0f && command->severity == 0.0f, what);
    check(command->own_n[0] == 0.0f && command->own_n[1] == 0.0f, what);
    check(command->mode == AMB_MODE_SENSOR_FAULT && command->events == 0 && command->limits == 0, what);
    memset(command, 0x55, sizeof *command);
}

static void ticking(void) {
    amb_sample sample[2];
    amb_command command[2];
    memset(sample, 0, sizeof sample);
    memset(command, 0x55, sizeof command);
    EXPECT(amb_tick(NULL, sample, command), AMB_ERROR_SUPERVISOR_NULL, NULL_TEXT);
    no_force("supervisor null", command);
    EXPECT(amb_tick(OFF(three), sample, command), AMB_ERROR_SUPERVISOR_MISALIGNED, ALIGN_TEXT);
    no_force("supervisor misaligned", command);
    EXPECT(amb_tick(&zero, sample, command), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
    no_force("not initialised", command);
    EXPECT(amb_tick(&plane, NULL, command), AMB_ERROR_SAMPLE_NULL, "sample is null");
    no_force("sample null", command);
    EXPECT(amb_tick(&plane, OFF(sample), command), AMB_ERROR_SAMPLE_MISALIGNED,
           "sample is not aligned to 4 bytes");
    no_force("sample misaligned", command);
    EXPECT(amb_tick(&plane, sample, NULL), AMB_ERROR_COMMAND_NULL, "command is null");
    EXPECT(amb_tick(&plane, sample, OFF(command)), AMB_ERROR_COMMAND_MISALIGNED,
           "command is not aligned to 4 bytes");
    check(((unsigned char *)command)[7] == 0x55, "a misaligned command is untouched");
    EXPECT(amb_tick(NULL, NULL, NULL), AMB_ERROR_COMMAND_NULL, "command is null");

    sample->levitation_n[0] = -12.5f;
    sample->status = 0xFFFFFF83u; /* with bits that mean nothing; no axis lost, not late, no shadow */
    sample->status &= ~AMB_STATUS_APPLIED_VALID;
    EXPECT(amb_tick(&plane, sample, command), AMB_OK, "done");
    check(command->force_n[0] == -12.5f && command->mode == AMB_MODE_LEVITATED, "transparent");
    check(command->own_n[0] == -12.5f, "its own force is the same but in shadow");
    {
        /* The same memory for both. */
        union {
            amb_sample sample;
            amb_command command;
        } both;
        both.sample = *sample;
        both.sample.sequence++;
        EXPECT(amb_tick(&plane, &both.sample, &both.command), AMB_OK, "done");
        check(both.command.force_n[0] == -12.5f, "sample and command in the same memory");
    }
}

static void asking(void) {
    uint32_t numbers[2] = {77, 77};
    amb_report report[2];
    amb_event event[2];
    static amb_section section[2];
    static const amb_stamp stamp[2] = {{1, 2, {3, 4}}, {1, 2, {3, 4}}};
#define REFUSALS(call_with, result)                                                                          \
    EXPECT(call_with(NULL, result), AMB_ERROR_SUPERVISOR_NULL, NULL_TEXT);                                   \
    EXPECT(call_with(OFF(three), result), AMB_ERROR_SUPERVISOR_MISALIGNED, ALIGN_TEXT);                      \
    EXPECT(call_with(&zero, result), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);                              \
    EXPECT(call_with(&plane, NULL), AMB_ERROR_RESULT_NULL, RESULT_NULL_TEXT);                                \
    EXPECT(call_with(&plane, OFF(result)), AMB_ERROR_RESULT_MISALIGNED, RESULT_ALIGN_TEXT)
#define SECTION_0(supervisor, result) amb_record_section(supervisor, 0, stamp, result)
    REFUSALS(amb_mode, numbers);
    REFUSALS(amb_report_now, report);
    REFUSALS(amb_next_event, event);
    REFUSALS(SECTION_0, section);
    EXPECT(amb_rearm(NULL), AMB_ERROR_SUPERVISOR_NULL, NULL_TEXT);
    EXPECT(amb_rearm(OFF(three)), AMB_ERROR_SUPERVISOR_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_rearm(&zero), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_rearm(&plane), AMB_OK, "done");
    EXPECT(amb_next_event(&plane, event), AMB_NOTHING, "there is none");
    EXPECT(SECTION_0(&plane, section), AMB_NOTHING, "there is none");

    EXPECT(amb_record_section(&plane, 0, NULL, section), AMB_ERROR_STAMP_NULL, "stamp is null");
    EXPECT(amb_record_section(&plane, 0, OFF(stamp), section), AMB_ERROR_STAMP_MISALIGNED,
           "stamp is not aligned to 4 bytes");
    check(numbers[0] == 77, "results are untouched after errors");
}

static void table(void) {
    amb_parameter row[2];
    uint32_t i, index[2];
    for (i = 0; i < AMB_PARAMETERS; i++) {
        check(amb_parameter_at(i, row) == AMB_OK, "row");
        check(amb_parameter_index(row->name, index) == AMB_OK && *index == i, row->name);
        check(row->low < row->high && strlen(row->unit) > 0 && strlen(row->text) > 10, row->name);
    }
    check(amb_parameter_index("mass_kg", index) == AMB_OK && *index == AMB_P_MASS_KG, "mass_kg");
    EXPECT(amb_parameter_at(AMB_PARAMETERS, row), AMB_ERROR_INDEX, "index is beyond the end");
    EXPECT(amb_parameter_at(UINT32_MAX, row), AMB_ERROR_INDEX, "index is beyond the end");
    EXPECT(amb_parameter_at(0, NULL), AMB_ERROR_RESULT_NULL, RESULT_NULL_TEXT);
    EXPECT(amb_parameter_at(0, OFF(row)), AMB_ERROR_RESULT_MISALIGNED, RESULT_ALIGN_TEXT);
    *index = 77;
    EXPECT(amb_parameter_index(NULL, index), AMB_ERROR_NAME_NULL, "name is null");
    EXPECT(amb_parameter_index("mass_k", index), AMB_ERROR_NAME_UNKNOWN, "no parameter has this name");
    EXPECT(amb_parameter_index("mass_kgs", index), AMB_ERROR_NAME_UNKNOWN, "no parameter has this name");
    EXPECT(amb_parameter_index("Mass_kg", index), AMB_ERROR_NAME_UNKNOWN, "no parameter has this name");
    EXPECT(amb_parameter_index("", index), AMB_ERROR_NAME_UNKNOWN, "no parameter has this name");
    check(*index == 77, "an index is untouched after an error");
    EXPECT(amb_parameter_index("mass_kg", NULL), AMB_ERROR_RESULT_NULL, RESULT_NULL_TEXT);
    EXPECT(amb_parameter_index("mass_kg", OFF(index)), AMB_ERROR_RESULT_MISALIGNED, RESULT_ALIGN_TEXT);
}

static void texts(void) {
    check(strcmp(amb_error_text(3), "unknown code") == 0, "code 3");
    check(strcmp(amb_error_text(-999), "unknown code") == 0, "code -999");
    check(strcmp(amb_error_text(AMB_ERROR_PARAMETER(2 * AMB_PARAMETERS)), "unknown code") == 0, "beyond");
    check(strcmp(amb_error_text(INT32_MIN), "unknown code") == 0, "smallest code");
    check(strcmp(amb_error_text(INT32_MAX), "unknown code") == 0, "largest code");
    check(strcmp(amb_mode_name(AMB_MODE_BACKWARD_WHIRL), "backward whirl") == 0, "name of a mode");
    check(strcmp(amb_mode_name(8), "unknown mode") == 0, "mode 8");
    check(strcmp(amb_mode_name(UINT32_MAX), "unknown mode") == 0, "largest mode");
    check(amb_abi_version() == AMB_ABI, "version");
}

static volatile sig_atomic_t busy_seen = 0, watch_busy_seen = 0, other_seen = 0;

static void interrupting(int signal_number) {
    amb_sample sample;
    amb_command command;
    amb_code code;
    (void)signal_number;
    memset(&sample, 0, sizeof sample);
    code = amb_tick(&plane, &sample, &command);
    if (code == AMB_ERROR_BUSY) {
        busy_seen = 1;
        if (command.force_n[0] != 0.0f || command.mode != AMB_MODE_SENSOR_FAULT) other_seen = 1;
    } else if (code != AMB_OK) {
        other_seen = 1;
    }
    {
        float force[2] = {77.0f, 77.0f};
        code = amb_watch_force(&watch, force);
        if (code == AMB_ERROR_WATCH_BUSY) {
            watch_busy_seen = 1;
            if (force[0] != 0.0f || force[1] != 0.0f) other_seen = 1;
        } else if (code != AMB_OK || force[0] != 5.0f) {
            other_seen = 1;
        }
    }
}

/* A signal takes the place of an interrupt that comes while the background is inside a call. */
static void interrupted(void) {
    struct sigaction action;
    struct itimerval timer;
    amb_sample sample;
    amb_command command;
    const float force[2] = {5.0f, 0.0f};
    const time_t start = time(NULL);
    memset(&sample, 0, sizeof sample);
    memset(&action, 0, sizeof action);
    memset(&timer, 0, sizeof timer);
    action.sa_handler = interrupting;
    timer.it_interval.tv_usec = 50;
    timer.it_value.tv_usec = 50;
    if (amb_watch_init(&watch, UINT32_MAX) != AMB_OK) other_seen = 1;
    if (amb_watch_renew(&watch, force) != AMB_OK) other_seen = 1;
    sigaction(SIGALRM, &action, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
    while (!(busy_seen && watch_busy_seen) && time(NULL) - start < 30) {
        int i;
        for (i = 0; i < 1000 && !busy_seen; i++) {
            if (amb_tick(&plane, &sample, &command) != AMB_OK) other_seen = 1;
        }
        for (i = 0; i < 1000; i++) {
            if (amb_watch_renew(&watch, force) != AMB_OK) other_seen = 1;
        }
    }
    timer.it_value.tv_usec = timer.it_interval.tv_usec = 0;
    setitimer(ITIMER_REAL, &timer, NULL);
    check(busy_seen, "a call that interrupts another is refused");
    check(watch_busy_seen, "also on a watch");
    check(!other_seen, "and the interrupted one goes on undisturbed");
    expect("interrupting amb_watch_renew", AMB_ERROR_WATCH_BUSY, AMB_ERROR_WATCH_BUSY,
           "watch is in use by a call that this one interrupted");
    expect("interrupting amb_tick", AMB_ERROR_BUSY, AMB_ERROR_BUSY,
           "supervisor is in use by a call that this one interrupted");
}

/* A supervisor is one in its place alone. */
static void moved(void) {
    uint32_t mode;
    EXPECT(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    memcpy(&three[0], &plane, sizeof plane);
    EXPECT(amb_mode(&three[0], &mode), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_rearm(&three[0]), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_init(&three[0], sizeof three[0], rig_config, AMB_PARAMETERS), AMB_OK, "done");
    EXPECT(amb_mode(&three[0], &mode), AMB_OK, "done");
    memset(three, 0, sizeof three);
}

static void rig_until(rig *r, uint32_t end) {
    while (r->tick < end) {
        amb_sample sample;
        amb_command command;
        rig_sample(r, &sample);
        if (amb_tick(&plane, &sample, &command) != AMB_OK) check(0, "tick");
        rig_actuate(r, &command);
    }
}

/* A word of a section. */
static uint32_t word_at(const amb_section *section, uint32_t word) {
    const uint8_t *b = section->bytes + 4 * word;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* CRC-32 as everybody knows it, a bit at a time. */
static uint32_t crc_of(const uint8_t *bytes, uint32_t length) {
    uint32_t crc = 0xFFFFFFFFu, i, bit;
    for (i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    return ~crc;
}

/* Ticks of the rig from the interrupt's side, and what went wrong with them. */
static rig ticked;
static volatile sig_atomic_t ticks_refused = 0;
static volatile sig_atomic_t ticks_done = 0;

static void ticking_interrupt(int signal_number) {
    amb_sample sample;
    amb_command command;
    (void)signal_number;
    if (ticked.tick == RIG_TICKS) rig_start(&ticked);
    rig_sample(&ticked, &sample);
    sample.sequence = (uint32_t)ticks_done;
    if (amb_tick(&plane, &sample, &command) != AMB_OK) ticks_refused = 1;
    rig_actuate(&ticked, &command);
    ticks_done++;
}

/* Two priorities without a lock: whatever the background calls, no tick is refused, and what it gets is whole. */
static void two_priorities(void) {
    static amb_section section;
    static const amb_stamp stamp = {7, 9, {5, 0}};
    struct sigaction action;
    struct itimerval timer;
    const time_t start = time(NULL);
    uint32_t records = 0, events = 0, last = 0, index, mode;
    int whole = 1, in_order = 1, reports = 1;
    EXPECT(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    rig_start(&ticked);
    memset(&action, 0, sizeof action);
    memset(&timer, 0, sizeof timer);
    action.sa_handler = ticking_interrupt;
    timer.it_interval.tv_usec = timer.it_value.tv_usec = 50;
    sigaction(SIGALRM, &action, NULL);
    setitimer(ITIMER_REAL, &timer, NULL);
    while ((records < 2 || ticks_done < 9000) && time(NULL) - start < 60) {
        amb_event event;
        amb_report report;
        const amb_code code = amb_report_now(&plane, &report);
        if (code != AMB_OK && code != AMB_ERROR_BUSY) reports = 0;
        if (code == AMB_OK && !(report.force_cap_n >= 400.0f && report.force_cap_n <= 1000.0f)) reports = 0;
        if (amb_mode(&plane, &mode) != AMB_OK || mode > AMB_MODE_HANDED_BACK) reports = 0;
        if (amb_next_event(&plane, &event) == AMB_OK) {
            if (events > 0 && event.sequence < last) in_order = 0;
            last = event.sequence;
            events++;
        }
        for (index = 0; amb_record_section(&plane, index, &stamp, &section) == AMB_OK; index++) {
            const uint32_t words = section.length / 4;
            if (crc_of(section.bytes, section.length - 4) != word_at(&section, words - 1)) whole = 0;
        }
        if (index > 0) {
            if (memcmp(section.bytes, "ENDS", 4) != 0) whole = 0;
            records++;
            if (amb_rearm(&plane) != AMB_OK) whole = 0;
        }
    }
    timer.it_value.tv_usec = timer.it_interval.tv_usec = 0;
    setitimer(ITIMER_REAL, &timer, NULL);
    check(ticks_done >= 9000 && !ticks_refused, "no tick is refused");
    check(records >= 2 && whole, "records are whole");
    check(events > 10 && in_order, "events come in order");
    check(reports, "reports and modes are of a tick");
}

/* An event, a report and a record, from the first blow of the rig. */
static void record(void) {
    static rig r;
    static amb_section section;
    static const amb_stamp stamp = {7, 9, {5, 0}};
    amb_event event;
    amb_report report;
    uint32_t i, engaged, ticks = 0, triggered = 0;
    int ended = 0;
    EXPECT(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    rig_start(&r);
    rig_until(&r, 1900);
    EXPECT(amb_next_event(&plane, &event), AMB_OK, "done");
    check(event.events == AMB_EVENT_ENGAGED && event.mode == AMB_MODE_APPROACH, "oldest event");
    engaged = event.sequence;
    for (i = 1; amb_next_event(&plane, &event) == AMB_OK; i++) {
    }
    check(i > 5 && i <= 16, "events");
    EXPECT(amb_report_now(&plane, &report), AMB_OK, "done");
    check(report.landings == 1 && report.impacts >= 2 && report.force_cap_n == 1000.0f, "report");
    check(report.impact_speed_max_m_s > 0.1f && report.severity_index > 0.0f, "report of the impact");
    check(report.fault == AMB_REFUSAL_NONE && report.coast_down == 0, "report without faults");
    check(report.missed_ticks == 0 && report.repeated_ticks == 0, "report without lost ticks");
    check(report.late_ticks == 1, "report of the late command");
#define SECTION(index) amb_record_section(&plane, index, &stamp, &section)
    while (r.tick < RIG_TICKS && SECTION(0) == AMB_NOTHING) rig_until(&r, r.tick + 1);
    EXPECT(SECTION(0), AMB_OK, "done");
    check(memcmp(section.bytes, "AMBR", 4) == 0 && word_at(&section, 3) == AMB_RECORD_VERSION, "head");
    for (i = 0; SECTION(i) == AMB_OK; i++) {
        const uint32_t words = section.length / 4;
        check(section.length % 4 == 0 && word_at(&section, 2) >> 16 == words - 4, "length of a section");
        check(crc_of(section.bytes, section.length - 4) == word_at(&section, words - 1), "checksum of a section");
        ended = memcmp(section.bytes, "ENDS", 4) == 0;
        if (memcmp(section.bytes, "TICK", 4) == 0) {
            const uint32_t here = (words - 4) / 12, trigger = AMB_RECORD_ENTRIES / 4 - 1;
            if (trigger >= ticks && trigger < ticks + here) {
                const uint32_t entry = 3 + 12 * (trigger - ticks);
                check(word_at(&section, entry) == engaged, "a quarter before the trigger");
                triggered = word_at(&section, entry + 10) >> 16 & AMB_EVENT_ENGAGED;
            }
            ticks += here;
        }
    }
    check(ended && ticks == AMB_RECORD_ENTRIES && triggered, "record");
    EXPECT(SECTION(i), AMB_NOTHING, "there is none");
    EXPECT(amb_rearm(&plane), AMB_OK, "done");
    EXPECT(SECTION(0), AMB_NOTHING, "there is none");
}

static void reconfiguring(void) {
    float values[AMB_PARAMETERS + 1];
    amb_sample sample;
    amb_command command;
    amb_report before, after;
    memcpy(values, rig_config, sizeof rig_config);
    EXPECT(amb_reconfigure(NULL, values, AMB_PARAMETERS), AMB_ERROR_SUPERVISOR_NULL, NULL_TEXT);
    EXPECT(amb_reconfigure(OFF(three), values, AMB_PARAMETERS), AMB_ERROR_SUPERVISOR_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_reconfigure(&zero, values, AMB_PARAMETERS), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_reconfigure(&plane, NULL, AMB_PARAMETERS), AMB_ERROR_VALUES_NULL, "values is null");
    EXPECT(amb_reconfigure(&plane, OFF(values), AMB_PARAMETERS), AMB_ERROR_VALUES_MISALIGNED,
           "values is not aligned as a float");
    EXPECT(amb_reconfigure(&plane, values, AMB_PARAMETERS - 1), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");
    EXPECT(amb_reconfigure(&plane, values, AMB_PARAMETERS + 1), AMB_ERROR_VALUES_COUNT,
           "values has not AMB_PARAMETERS elements for each plane");
    memset(&sample, 0, sizeof sample);
    EXPECT(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    EXPECT(amb_tick(&plane, &sample, &command), AMB_OK, "done");
    EXPECT(amb_report_now(&plane, &before), AMB_OK, "done");
    /* Refused as a whole: not even the values before the wrong one hold. */
    values[AMB_P_FORCE_MAX_N] = 500.0f;
    values[AMB_P_SENSOR_STEP_M] = 0.0f / values[AMB_P_STIFFNESS_N_M];
    EXPECT(amb_reconfigure(&plane, values, AMB_PARAMETERS), AMB_ERROR_PARAMETER(AMB_P_SENSOR_STEP_M),
           "sensor_step_m is outside 1e-9 to 0.001 m");
    sample.sequence++;
    EXPECT(amb_tick(&plane, &sample, &command), AMB_OK, "done");
    EXPECT(amb_report_now(&plane, &after), AMB_OK, "done");
    check((command.events & AMB_EVENT_RECONFIGURED) == 0, "a refused configuration is no event");
    check(after.force_cap_n == before.force_cap_n, "and changes nothing");
    values[AMB_P_SENSOR_STEP_M] = rig_config[AMB_P_SENSOR_STEP_M];
    EXPECT(amb_reconfigure(&plane, values, AMB_PARAMETERS), AMB_OK, "done");
    sample.sequence++;
    EXPECT(amb_tick(&plane, &sample, &command), AMB_OK, "done");
    EXPECT(amb_report_now(&plane, &after), AMB_OK, "done");
    check((command.events & AMB_EVENT_RECONFIGURED) != 0, "the tick from which it holds says so");
    check(after.force_cap_n == 500.0f, "it holds");
}

/* A processor that computes otherwise: here by its rounding. */
static void self_testing(void) {
    const int usual = fegetround();
    amb_code code;
    static amb_supervisor zero_plane;
    EXPECT(amb_self_test(NULL), AMB_ERROR_SUPERVISOR_NULL, "supervisor is null");
    EXPECT(amb_self_test(&zero_plane), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_self_test(&plane), AMB_OK, "done");
    check(fesetround(FE_UPWARD) == 0, "another rounding");
    code = amb_self_test(&plane);
    check(fesetround(usual) == 0, "the usual rounding");
    expect("self-test with another rounding", code, AMB_ERROR_SELF_TEST,
           "this processor, compiler or memory computes something else");
    EXPECT(amb_self_test(&plane), AMB_OK, "done");
}

static void watching(void) {
    const float wanted[3] = {5.0f, -6.0f, 7.0f};
    float force[3];
    uint32_t expired[2] = {77, 77};
    const char *const null_text = "watch is null";
    const char *const align_text = "watch is not aligned to AMB_WATCH_ALIGN bytes";
    const char *const not_made_text = "watch was not made by amb_watch_init";
#define WATCH_REFUSALS(call_with, argument)                                                                  \
    EXPECT(call_with(NULL, argument), AMB_ERROR_WATCH_NULL, null_text);                                      \
    EXPECT(call_with(OFF(three_watches), argument), AMB_ERROR_WATCH_MISALIGNED, align_text);                 \
    EXPECT(call_with(&zero_watch, argument), AMB_ERROR_WATCH_NOT_INITIALISED, not_made_text)
    EXPECT(amb_watch_init(NULL, 2), AMB_ERROR_WATCH_NULL, null_text);
    EXPECT(amb_watch_init(OFF(three_watches), 2), AMB_ERROR_WATCH_MISALIGNED, align_text);
    WATCH_REFUSALS(amb_watch_renew, wanted);
    WATCH_REFUSALS(amb_watch_expired, expired);
    check(expired[0] == 77, "results are untouched after errors");
    force[0] = force[1] = 77.0f;
    WATCH_REFUSALS(amb_watch_force, force);
    check(force[0] == 0.0f && force[1] == 0.0f, "no force after an error");

    EXPECT(amb_watch_init(&watch, 2), AMB_OK, "done");
    EXPECT(amb_watch_expired(&watch, NULL), AMB_ERROR_RESULT_NULL, RESULT_NULL_TEXT);
    EXPECT(amb_watch_expired(&watch, OFF(expired)), AMB_ERROR_RESULT_MISALIGNED, RESULT_ALIGN_TEXT);
    EXPECT(amb_watch_force(&watch, force), AMB_OK, "done");
    check(force[0] == 0.0f && force[1] == 0.0f, "before the first command there is none");
    EXPECT(amb_watch_renew(&watch, wanted), AMB_OK, "done");
    EXPECT(amb_watch_renew(&watch, NULL), AMB_ERROR_FORCE_NULL, "force is null");
    EXPECT(amb_watch_renew(&watch, OFF(wanted)), AMB_ERROR_FORCE_MISALIGNED,
           "force is not aligned as a float");
    EXPECT(amb_watch_force(&watch, NULL), AMB_ERROR_FORCE_NULL, "force is null");
    EXPECT(amb_watch_force(&watch, OFF(force)), AMB_ERROR_FORCE_MISALIGNED,
           "force is not aligned as a float");
    EXPECT(amb_watch_expired(&watch, expired), AMB_OK, "done");
    check(expired[0] == 0, "there is a command, and refused calls take no period of it");
    EXPECT(amb_watch_force(&watch, force), AMB_OK, "done");
    check(force[0] == 5.0f && force[1] == -6.0f, "first period");
    EXPECT(amb_watch_force(&watch, force), AMB_OK, "done");
    check(force[0] == 5.0f && force[1] == -6.0f, "second period");
    EXPECT(amb_watch_expired(&watch, expired), AMB_OK, "done");
    check(expired[0] == 1, "expired");
    EXPECT(amb_watch_force(&watch, force), AMB_OK, "done");
    check(force[0] == 0.0f && force[1] == 0.0f, "and no longer");
    EXPECT(amb_watch_renew(&watch, wanted), AMB_OK, "done");
    EXPECT(amb_watch_force(&watch, force), AMB_OK, "done");
    check(force[0] == 5.0f, "renewed");
    EXPECT(amb_watch_init(&watch, 0), AMB_OK, "done");
    EXPECT(amb_watch_renew(&watch, wanted), AMB_OK, "done");
    EXPECT(amb_watch_force(&watch, force), AMB_OK, "done");
    check(force[0] == 0.0f && force[1] == 0.0f, "no periods let nothing through");
    {
        /* One does not pass for the other. */
        static amb_supervisor no_watch;
        memcpy(&no_watch, &watch, sizeof watch);
        EXPECT(amb_rearm(&no_watch), AMB_ERROR_NOT_INITIALISED, NOT_MADE_TEXT);
        EXPECT(amb_watch_renew((amb_watch *)(void *)&plane, wanted), AMB_ERROR_WATCH_NOT_INITIALISED,
               not_made_text);
    }
}

int main(void) {
    making();
    bearings();
    ticking();
    asking();
    table();
    texts();
    record();
    reconfiguring();
    self_testing();
    watching();
    interrupted();
    two_priorities();
    moved();
    printf("%d checks, %d failures\n", checks, failures);
    return failures > 0;
}
