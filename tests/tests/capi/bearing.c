/* Configurations of bearings, bit by bit. */
#include "mps2.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

/* The board's start-up names it; here nothing interrupts. */
void control_interrupt(void) {
}

static int show(const float *values, size_t count) {
    size_t i;
    for (i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf("%08x\n", (unsigned)bits);
    }
    return 0;
}

int main(void) {
    static const amb_bearing bearings[] = {
        {50e-6f, 10.0f, -2e5f, 2e-4f, 1000.0f, 1.6e-4f, 0.15f, 1e9f, 1e-6f},
        {1e-4f, 3.3f, 1e4f, 3.1e-4f, 77.0f, 0.0f, 0.3f, 3e6f, 7.7e-6f},
        {2e-5f, 512.5f, 0.0f, 5e-4f, 9e3f, 3e-4f, 0.11f, 7e9f, 0.0f},
    };
    static const amb_shaft shaft = {20.0f, 0.8f, 0.5f, {-0.2f, 0.22f}, {-0.19f, 0.21f}, {-0.17f, 0.19f}};
    float values[2 * AMB_PARAMETERS];
    size_t i;
    for (i = 0; i < sizeof bearings / sizeof bearings[0]; i++) {
        if (amb_config_for_bearing(&bearings[i], values, AMB_PARAMETERS) != AMB_OK) return 1;
        show(values, AMB_PARAMETERS);
    }
    if (amb_config_for_rotor(&shaft, bearings, values, 2 * AMB_PARAMETERS) != AMB_OK) return 1;
    return show(values, 2 * AMB_PARAMETERS);
}
