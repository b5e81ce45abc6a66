/* Every misuse of an archive that the header names, with the code and the text that it gives. */
#include "check.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

static amb_supervisor plane, not_made;
static amb_rotor rotor;
static amb_archive archive, second, zero, two[2], moved;
static amb_archive_place places[3], others[2];
static const amb_shaft shaft = {20.0f, 0.8f, 0.5f, {-0.2f, 0.22f}, {-0.19f, 0.21f}, {-0.17f, 0.19f}};
static const char *const NULL_TEXT = "archive is null";
static const char *const ALIGN_TEXT = "archive is not aligned to AMB_SUPERVISOR_ALIGN bytes";
static const char *const NOT_MADE_TEXT = "archive was not made by amb_archive_init";
static const char *const BUSY_TEXT = "archive is in use by a call that this one interrupted, or is there twice";
static const char *const COUNT_TEXT = "an archive has a place at least, and no more than there can be";
static const char *const NOTHING_TEXT = "there is none";

static void making(void) {
    uint32_t count = 1234;
    EXPECT(amb_archive_init(NULL, places, 2), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_init(OFF(two), places, 2), AMB_ERROR_ARCHIVE_MISALIGNED, ALIGN_TEXT);
    EXPECT(amb_archive_init(&archive, NULL, 2), AMB_ERROR_PLACES_NULL, "places is null");
    EXPECT(amb_archive_init(&archive, OFF(places), 2), AMB_ERROR_PLACES_MISALIGNED,
           "places are not aligned to AMB_SUPERVISOR_ALIGN bytes");
    EXPECT(amb_archive_init(&archive, places, 0), AMB_ERROR_PLACES_COUNT, COUNT_TEXT);
    EXPECT(amb_archive_init(&archive, places, (size_t)-1), AMB_ERROR_PLACES_COUNT, COUNT_TEXT);
    EXPECT(amb_archive_count(&archive, &count), AMB_ERROR_ARCHIVE_NOT_INITIALISED, NOT_MADE_TEXT);
    /* Whatever is in the memory of the places. */
    memset(places, 0xA5, sizeof places);
    EXPECT(amb_archive_init(&archive, places, 2), AMB_OK, "done");
    check(places[2].bytes[0] == 0xA5, "no more places are touched than there are");
    moved = archive;
    EXPECT(amb_archive_count(&moved, &count), AMB_ERROR_ARCHIVE_NOT_INITIALISED, NOT_MADE_TEXT);
    check(count == 1234, "an error leaves the result alone");
    EXPECT(amb_archive_count(&archive, &count), AMB_OK, "done");
    check(count == 0, "it is empty");
    EXPECT(amb_archive_init(&second, others, 2), AMB_OK, "done");
}

static void asking(void) {
    static amb_section section, before, sections[2];
    static amb_stamp stamp, stamps[2];
    uint32_t counts[2] = {1234, 1234};
    EXPECT(amb_archive_count(NULL, counts), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_count(&zero, counts), AMB_ERROR_ARCHIVE_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_archive_count(&archive, NULL), AMB_ERROR_RESULT_NULL, "the pointer to the result is null");
    EXPECT(amb_archive_count(&archive, OFF(counts)), AMB_ERROR_RESULT_MISALIGNED,
           "the pointer to the result is not aligned as its type");
    EXPECT(amb_archive_section(NULL, 0, &stamp, &section), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_section(&archive, 0, NULL, &section), AMB_ERROR_STAMP_NULL, "stamp is null");
    EXPECT(amb_archive_section(&archive, 0, OFF(stamps), &section), AMB_ERROR_STAMP_MISALIGNED,
           "stamp is not aligned to 4 bytes");
    EXPECT(amb_archive_section(&archive, 0, &stamp, NULL), AMB_ERROR_RESULT_NULL, "the pointer to the result is null");
    EXPECT(amb_archive_section(&archive, 0, &stamp, OFF(sections)), AMB_ERROR_RESULT_MISALIGNED,
           "the pointer to the result is not aligned as its type");
    EXPECT(amb_archive_section(&archive, 0, &stamp, &section), AMB_NOTHING, NOTHING_TEXT);
    check(memcmp(&section, &before, sizeof before) == 0, "without a record nothing is written");
    EXPECT(amb_archive_discard(NULL), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_discard(&archive), AMB_NOTHING, NOTHING_TEXT);
}

static void taking(void) {
    float values[2 * AMB_PARAMETERS];
    memcpy(values, rig_config, sizeof rig_config);
    memcpy(values + AMB_PARAMETERS, rig_config, sizeof rig_config);
    EXPECT(amb_archive_take(&archive, NULL), AMB_ERROR_SUPERVISOR_NULL, "supervisor is null");
    EXPECT(amb_archive_take(&archive, &not_made), AMB_ERROR_NOT_INITIALISED, "supervisor was not made by amb_init");
    EXPECT(amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS), AMB_OK, "done");
    EXPECT(amb_archive_take(NULL, &plane), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_take(&zero, &plane), AMB_ERROR_ARCHIVE_NOT_INITIALISED, NOT_MADE_TEXT);
    EXPECT(amb_archive_take(&archive, &plane), AMB_NOTHING, NOTHING_TEXT);
    EXPECT(amb_rotor_init(&rotor, sizeof rotor, &shaft, values, 2 * AMB_PARAMETERS), AMB_OK, "done");
    EXPECT(amb_archive_take_rotor(&archive, &second, NULL), AMB_ERROR_ROTOR_NULL, "rotor is null");
    EXPECT(amb_archive_take_rotor(NULL, &second, &rotor), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_take_rotor(&archive, NULL, &rotor), AMB_ERROR_ARCHIVE_NULL, NULL_TEXT);
    EXPECT(amb_archive_take_rotor(&archive, &archive, &rotor), AMB_ERROR_ARCHIVE_BUSY, BUSY_TEXT);
    EXPECT(amb_archive_take_rotor(&archive, &second, &rotor), AMB_NOTHING, NOTHING_TEXT);
    /* A call that was refused leaves nothing in use. */
    EXPECT(amb_archive_discard(&archive), AMB_NOTHING, NOTHING_TEXT);
    EXPECT(amb_rotor_rearm(&rotor), AMB_OK, "done");
    /* Once more, with other places. */
    EXPECT(amb_archive_init(&archive, places, 1), AMB_OK, "done");
}

int main(void) {
    making();
    asking();
    taking();
    printf("%d checks, %d failures\n", checks, failures);
    return failures > 0;
}
