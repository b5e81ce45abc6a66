/* The rig of the example on this machine, with the library's static build for it. */
#include "rig.h"

#include <stdio.h>

static amb_supervisor plane;

int main(int argc, char **argv) {
    static rig r;
    amb_code code = amb_init(&plane, sizeof plane, rig_config, AMB_PARAMETERS);
    if (code != AMB_OK) {
        printf("%s\n", amb_error_text(code));
        return 1;
    }
    rig_start(&r);
    while (r.tick < RIG_TICKS) {
        amb_sample sample;
        amb_command command;
        float values[AMB_PARAMETERS];
        if (rig_reconfigures(&r, values)) {
            code = amb_reconfigure(&plane, values, AMB_PARAMETERS);
            if (code != AMB_OK) {
                printf("%s\n", amb_error_text(code));
                return 1;
            }
        }
        rig_sample(&r, &sample);
        code = amb_tick(&plane, &sample, &command);
        if (code != AMB_OK) {
            printf("%s\n", amb_error_text(code));
            return 1;
        }
        rig_actuate(&r, &command);
        /* With any argument: the course, to look at. */
        if (argc > 1 && argv[1] && (command.events != 0 || r.tick % 100 == 0)) {
            printf("%u %s %.3f %.3f  %.1f %.1f  events %x limits %x sev %.2f\n", (unsigned)r.tick,
                   amb_mode_name(command.mode), (double)sample.position_m[0] / 2e-4,
                   (double)sample.position_m[1] / 2e-4, (double)command.force_n[0],
                   (double)command.force_n[1], (unsigned)command.events, (unsigned)command.limits,
                   (double)command.severity);
        }
    }
    printf("ticks %u modes 0x%02x events 0x%04x hash 0x%08x\n", (unsigned)r.tick, (unsigned)r.modes,
           (unsigned)r.events, (unsigned)r.hash);
    return 0;
}
