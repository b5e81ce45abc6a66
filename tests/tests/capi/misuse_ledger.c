/* Every misuse of a ledger that the header names, with the code and the text that it gives. */
#include "check.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

enum { COUNT = AMB_LEDGER_BYTES };
static amb_supervisor plane, not_made;
static amb_rotor rotor;
static const amb_shaft shaft = {20.0f, 0.8f, 0.5f, {-0.2f, 0.22f}, {-0.19f, 0.21f}, {-0.17f, 0.19f}};
static const char *const NULL_TEXT = "ledger is null";
static const char *const ALIGN_TEXT = "ledger is not aligned to 4 bytes";
static const char *const LENGTH_TEXT = "a ledger has AMB_LEDGER_BYTES bytes";
static const char *const NOTHING_TEXT = "there is none";

static void writing(void) {
    amb_ledger ledger, two[2];
    uint8_t bytes[COUNT + 1], before[COUNT + 1];
    EXPECT(amb_ledger_new(7, 20.0f, NULL), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    EXPECT(amb_ledger_new(7, 20.0f, OFF(two)), AMB_ERROR_LEDGER_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_ledger_new(7, -1.0f, &ledger), AMB_OK, "done");
    check(ledger.severity_allowed == 0.0f, "no allowance below 0");
    EXPECT(amb_ledger_new(7, 20.0f, &ledger), AMB_OK, "done");
    memset(bytes, 0x5A, sizeof bytes);
    memcpy(before, bytes, sizeof bytes);
    EXPECT(amb_ledger_write(NULL, bytes, COUNT), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    two[0] = two[1] = ledger;
    EXPECT(amb_ledger_write(OFF(two), bytes, COUNT), AMB_ERROR_LEDGER_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_ledger_write(&ledger, NULL, COUNT), AMB_ERROR_BYTES_NULL, "bytes is null");
    EXPECT(amb_ledger_write(&ledger, bytes, COUNT - 1), AMB_ERROR_LEDGER_LENGTH, LENGTH_TEXT);
    EXPECT(amb_ledger_write(&ledger, bytes, COUNT + 1), AMB_ERROR_LEDGER_LENGTH, LENGTH_TEXT);
    check(memcmp(bytes, before, sizeof bytes) == 0, "nothing is written after an error");
    EXPECT(amb_ledger_write(&ledger, bytes, COUNT), AMB_OK, "done");
    check(bytes[COUNT] == 0x5A, "no more is written than a ledger");
    /* Bytes may lie anywhere. */
    EXPECT(amb_ledger_write(&ledger, bytes + 1, COUNT), AMB_OK, "done");
    EXPECT(amb_ledger_read(bytes + 1, COUNT, &two[0]), AMB_OK, "done");
    check(memcmp(&two[0], &ledger, sizeof ledger) == 0, "it is read as it was written");
}

static void reading(void) {
    amb_ledger ledger, kept, two[2];
    uint8_t bytes[COUNT], other[COUNT], blank[COUNT];
    size_t i;
    amb_ledger_new(7, 20.0f, &kept);
    amb_ledger_write(&kept, bytes, COUNT);
    ledger = kept;
    EXPECT(amb_ledger_read(NULL, COUNT, &ledger), AMB_ERROR_BYTES_NULL, "bytes is null");
    EXPECT(amb_ledger_read(bytes, COUNT - 1, &ledger), AMB_ERROR_LEDGER_LENGTH, LENGTH_TEXT);
    EXPECT(amb_ledger_read(bytes, COUNT, NULL), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    EXPECT(amb_ledger_read(bytes, COUNT, OFF(two)), AMB_ERROR_LEDGER_MISALIGNED, ALIGN_TEXT);
    for (i = 0; i < 2; i++) {
        memset(blank, i == 0 ? 0x00 : 0xFF, COUNT);
        EXPECT(amb_ledger_read(blank, COUNT, &ledger), AMB_ERROR_LEDGER_BLANK,
               "nothing was ever written there: the ledger is lost, or was never made");
    }
    memcpy(other, bytes, COUNT);
    other[0] ^= 1;
    EXPECT(amb_ledger_read(other, COUNT, &ledger), AMB_ERROR_LEDGER_LETTERS, "no ledger begins there");
    for (i = 4; i < COUNT; i++) {
        memcpy(other, bytes, COUNT);
        other[i] ^= 0x10;
        EXPECT(amb_ledger_read(other, COUNT, &ledger), AMB_ERROR_LEDGER_DAMAGED,
               "the ledger is damaged: its checksum is another one");
    }
    {
        /* Version 2, with the checksum that belongs to it. */
        static const uint8_t version_2[COUNT] = {
            'A', 'M', 'B', 'L', 2, 0, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0xA0, 0x41, 0, 0, 0, 0, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x33, 0xC8, 0x0A, 0x93};
        EXPECT(amb_ledger_read(version_2, COUNT, &ledger), AMB_ERROR_LEDGER_VERSION,
               "the ledger is of another version");
    }
    check(memcmp(&ledger, &kept, sizeof kept) == 0, "an error leaves the ledger alone");

    EXPECT(amb_ledger_newer(NULL, bytes, COUNT, &ledger), AMB_ERROR_BYTES_NULL, "bytes is null");
    EXPECT(amb_ledger_newer(bytes, NULL, COUNT, &ledger), AMB_ERROR_BYTES_NULL, "bytes is null");
    EXPECT(amb_ledger_newer(bytes, bytes, 0, &ledger), AMB_ERROR_LEDGER_LENGTH, LENGTH_TEXT);
    EXPECT(amb_ledger_newer(bytes, bytes, COUNT, NULL), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    EXPECT(amb_ledger_newer(blank, blank, COUNT, &ledger), AMB_ERROR_LEDGER_BLANK,
           "nothing was ever written there: the ledger is lost, or was never made");
    kept.bearing = 8;
    amb_ledger_write(&kept, other, COUNT);
    EXPECT(amb_ledger_newer(bytes, other, COUNT, &ledger), AMB_ERROR_LEDGER_BEARINGS,
           "the copies are of two bearings");
    check(ledger.bearing == 7, "an error leaves the ledger alone");
    EXPECT(amb_ledger_newer(blank, other, COUNT, &ledger), AMB_ONE_COPY,
           "one of the two copies is not whole: the last landing may be missing");
    check(ledger.bearing == 8, "the whole one counts");
    kept.updates = 1;
    amb_ledger_write(&kept, bytes, COUNT);
    EXPECT(amb_ledger_newer(bytes, other, COUNT, &ledger), AMB_OK, "done");
    check(ledger.updates == 1, "the newer one counts");
    EXPECT(amb_ledger_newer(other, bytes, COUNT, &ledger), AMB_OK, "done");
    check(ledger.updates == 1, "wherever it is");
}

static void adding(void) {
    amb_ledger ledger, kept, two[2];
    float values[2 * AMB_PARAMETERS];
    uint32_t left[2] = {1234, 1234};
    memcpy(values, rig_config, sizeof rig_config);
    memcpy(values + AMB_PARAMETERS, rig_config, sizeof rig_config);
    amb_ledger_new(7, 20.0f, &ledger);
    kept = two[0] = two[1] = ledger;
    EXPECT(amb_ledger_take_in(&ledger, NULL), AMB_ERROR_SUPERVISOR_NULL, "supervisor is null");
    EXPECT(amb_ledger_take_in(&ledger, &not_made), AMB_ERROR_NOT_INITIALISED,
           "supervisor was not made by amb_init");
    EXPECT(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    EXPECT(amb_ledger_take_in(NULL, &plane), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    EXPECT(amb_ledger_take_in(OFF(two), &plane), AMB_ERROR_LEDGER_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_ledger_take_in(&ledger, &plane), AMB_NOTHING, NOTHING_TEXT);
    EXPECT(amb_rotor_init(&rotor, sizeof rotor, &shaft, values, 2 * AMB_PARAMETERS), AMB_OK, "done");
    EXPECT(amb_ledger_take_in_plane(&ledger, NULL, 0), AMB_ERROR_ROTOR_NULL, "rotor is null");
    EXPECT(amb_ledger_take_in_plane(&ledger, &rotor, 2), AMB_ERROR_PLANE, "plane is neither 0 nor 1");
    EXPECT(amb_ledger_take_in_plane(NULL, &rotor, 1), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    EXPECT(amb_ledger_take_in_plane(&ledger, &rotor, 1), AMB_NOTHING, NOTHING_TEXT);
    check(memcmp(&ledger, &kept, sizeof kept) == 0, "without a record nothing changes");

    EXPECT(amb_ledger_landings_left(NULL, 0.5f, left), AMB_ERROR_LEDGER_NULL, NULL_TEXT);
    EXPECT(amb_ledger_landings_left(OFF(two), 0.5f, left), AMB_ERROR_LEDGER_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_ledger_landings_left(&ledger, 0.5f, NULL), AMB_ERROR_RESULT_NULL, "the pointer to the result is null");
    EXPECT(amb_ledger_landings_left(&ledger, 0.5f, OFF(left)), AMB_ERROR_RESULT_MISALIGNED,
           "the pointer to the result is not aligned as its type");
    EXPECT(amb_ledger_landings_left(&ledger, ledger.worst_severity, left), AMB_NOTHING, NOTHING_TEXT);
    check(left[0] == 1234 && left[1] == 1234, "without a landing there is no figure");
    EXPECT(amb_ledger_landings_left(&ledger, 0.5f, left), AMB_OK, "done");
    check(left[0] == 40, "20 / 0.5");
}

int main(void) {
    writing();
    reading();
    adding();
    printf("%d checks, %d failures\n", checks, failures);
    return failures > 0;
}
