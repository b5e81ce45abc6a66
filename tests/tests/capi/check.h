/* What programs that try misuse count: calls that gave the code and the text that they should, and others. */
#ifndef CHECK_H
#define CHECK_H

#include "amb_supervisor.h"

#include <stdio.h>
#include <string.h>

static int failures = 0, checks = 0;

static void check(int good, const char *what) {
    checks++;
    if (!good) {
        failures++;
        printf("FAILED: %s\n", what);
    }
}

/* A call gave this code, and the code has this text. */
static void expect(const char *what, amb_code code, amb_code wanted, const char *text) {
    checks++;
    if (code != wanted || strcmp(amb_error_text(code), text) != 0) {
        failures++;
        printf("FAILED: %s: code %d \"%s\", expected %d \"%s\"\n", what, (int)code, amb_error_text(code),
               (int)wanted, text);
    }
}

#define EXPECT(call, wanted, text) expect(#call, call, wanted, text)

/* Any object, one byte on. */
#define OFF(pointer) ((void *)((char *)(pointer) + 1))

#endif
