/* Drives the block as Simulink would, beside the library itself: the same samples give the same commands. */
#include "sfun_amb_supervisor.c"

#include <math.h>
#include <stdio.h>

static amb_supervisor directly;

static void begin(SimStruct *S, const mxArray *parameter) {
    memset(S, 0, sizeof *S);
    S->parameter = parameter;
    mdlInitializeSizes(S);
    mdlInitializeSampleTimes(S);
    for (int_T i = 0; i < S->kept; i++) {
        const size_t each = S->kept_type[i] == SS_DOUBLE ? sizeof(real_T) : sizeof(uint32_T);
        S->memory[i] = malloc((size_t)S->kept_width[i] * each);
        /* Whatever was there before. */
        memset(S->memory[i], 0xA5, (size_t)S->kept_width[i] * each);
    }
    if (S->error == NULL) mdlStart(S);
}

static void end(SimStruct *S) {
    mdlTerminate(S);
    for (int_T i = 0; i < S->kept; i++) free(S->memory[i]);
}

static int differs(const SimStruct *S, const amb_command *c) {
    return S->out[FORCE][0] != (real_T)c->force_n[0] || S->out[FORCE][1] != (real_T)c->force_n[1] ||
           S->out[MODE][0] != (real_T)c->mode || S->out[LIMITS][0] != (real_T)c->limits ||
           S->out[EVENTS][0] != (real_T)c->events || S->out[SEVERITY][0] != (real_T)c->severity ||
           S->out[HOLD][0] != (real_T)(c->integrator == AMB_INTEGRATOR_HOLD);
}

int main(void) {
    /* As in firmware.c, with an amplifier. */
    static const double nine[BEARING_NUMBERS] = {50e-6, 10.0, 0.0, 2e-4, 1000.0, 1e-4, 0.15, 2e8, 1e-8};
    static const double few[2] = {50e-6, 10.0};
    const mxArray bearing = {BEARING_NUMBERS, nine}, wrong = {2, few};
    float values[AMB_PARAMETERS];
    double wide[AMB_PARAMETERS];
    unsigned modes = 0, engaged = 0;
    SimStruct S, all, bad;
    mxArray configured = {AMB_PARAMETERS, wide};
    begin(&bad, &wrong);
    if (bad.error == NULL) return printf("two numbers were taken\n"), 1;
    end(&bad);
    begin(&S, &bearing);
    if (S.error != NULL) return printf("%s\n", S.error), 1;
    if (S.inputs != INPUTS || S.outputs != OUTPUTS || S.period_s != (real_T)50e-6f) return printf("ports or period\n"), 1;
    if (amb_config_for_bearing((const amb_bearing *)&(amb_bearing){50e-6f, 10.0f, 0.0f, 2e-4f, 1000.0f, 1e-4f, 0.15f, 2e8f, 1e-8f},
                               values, AMB_PARAMETERS) != AMB_OK)
        return printf("nine numbers\n"), 1;
    values[AMB_P_CHECK_FIRST] = 0.0f;
    if (amb_init(&directly, sizeof directly, values, AMB_PARAMETERS) != AMB_OK)
        return printf("the library itself\n"), 1;
    for (int i = 0; i < AMB_PARAMETERS; i++) wide[i] = values[i];
    begin(&all, &configured);
    if (all.error != NULL) return printf("%s\n", all.error), 1;
    /* A rotor that flies to the wall, bounces along it backward, and comes back. */
    for (uint32_t tick = 0; tick < 4000; tick++) {
        const double t_s = tick * 50e-6, angle = -150.0 * t_s;
        const double radius_m = tick < 2500 ? 2.02e-4 * fabs(sin(600.0 * t_s)) : 1e-5;
        amb_sample sample = {tick, AMB_STATUS_SPIN_VALID | AMB_STATUS_BEARING_ON | AMB_STATUS_LEVITATED_BEFORE, {0}, 1000.0f, {0}, {0}};
        amb_command command;
        SimStruct *blocks[2] = {&S, &all};
        for (int i = 0; i < 2; i++) {
            const double m = i == 0 ? radius_m * cos(angle) : radius_m * sin(angle);
            sample.position_m[i] = (float)m;
            sample.levitation_n[i] = (float)(-1e6 * m);
            for (int b = 0; b < 2; b++) blocks[b]->in[POSITION][i] = m, blocks[b]->in[LEVITATION][i] = -1e6 * m;
        }
        (void)amb_tick(&directly, &sample, &command);
        for (int b = 0; b < 2; b++) {
            blocks[b]->in[SPIN][0] = 1000.0;
            blocks[b]->in[STATUS][0] = AMB_STATUS_SPIN_VALID | AMB_STATUS_BEARING_ON | AMB_STATUS_LEVITATED_BEFORE;
            mdlOutputs(blocks[b], 0);
            if (blocks[b]->error != NULL || differs(blocks[b], &command)) return printf("tick %u\n", (unsigned)tick), 1;
        }
        modes |= 1u << command.mode;
        engaged += command.mode != AMB_MODE_LEVITATED;
    }
    end(&S);
    end(&all);
    printf("4000 ticks the same, %s\n", engaged > 100 && (modes & ~1u) != 0 ? "engaged" : "never engaged");
    return 0;
}
