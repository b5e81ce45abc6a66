/* Two rigs of the example as the ends of one rotor, on this machine or in the emulator. What one end does to the other is
 * not in them: it is what the supervisor computes that is compared. */
#include "mps2.h"
#include "rig.h"

#include <stdio.h>
#include <string.h>

static amb_rotor rotor;
static rig ends[2];
static const amb_shaft shaft = {20.0f, 0.8f, 0.5f, {-0.2f, 0.22f}, {-0.19f, 0.21f}, {-0.17f, 0.19f}};

/* The board's start-up names it; here nothing interrupts. */
void control_interrupt(void) {
}

static int failed(amb_code code) {
    if (code == AMB_OK) return 0;
    printf("%s\n", amb_error_text(code));
    return 1;
}

int main(void) {
    static float values[2][AMB_PARAMETERS];
    amb_sample samples[2];
    amb_rotor_command command;
    uint32_t others = 0, asked = 0;
    int end;
    for (end = 0; end < 2; end++) {
        memcpy(values[end], rig_config, sizeof rig_config);
        rig_start(&ends[end]);
    }
    if (failed(amb_rotor_init(&rotor, sizeof rotor, &shaft, values[0], 2 * AMB_PARAMETERS))) return 1;
    while (ends[0].tick < RIG_TICKS) {
        if (rig_reconfigures(&ends[0], values[0])) {
            rig_reconfigures(&ends[1], values[1]);
            if (failed(amb_rotor_reconfigure(&rotor, &shaft, values[0], 2 * AMB_PARAMETERS))) return 1;
        }
        for (end = 0; end < 2; end++) rig_sample(&ends[end], &samples[end]);
        /* Every third time in two halves, which is the same. */
        if (ends[0].tick % 3 == 0) {
            amb_command first;
            if (failed(amb_rotor_tick_first(&rotor, &samples[0], &first))) return 1;
            if (failed(amb_rotor_tick_second(&rotor, &samples[1], &command))) return 1;
            if (memcmp(first.force_n, command.planes[0].force_n, sizeof first.force_n) != 0) return 1;
        } else if (failed(amb_rotor_tick(&rotor, samples, &command))) {
            return 1;
        }
        for (end = 0; end < 2; end++) {
            rig_actuate(&ends[end], &command.planes[end]);
            others += command.other_engaged[end];
        }
        asked += command.coast_down;
    }
    printf("ticks %u engaged %u coast-down %u hashes 0x%08x 0x%08x\n", (unsigned)ends[0].tick, (unsigned)others,
           (unsigned)asked, (unsigned)ends[0].hash, (unsigned)ends[1].hash);
    return 0;
}
