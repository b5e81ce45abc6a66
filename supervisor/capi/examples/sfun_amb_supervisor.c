/* The supervisor as a block of Simulink: a level 2 S-function around the C library.
 *
 * Compiled against the declarations that it uses and driven by a test; untested in Simulink itself.
 *
 * Parameter: the nine numbers of amb_bearing, or all AMB_PARAMETERS values of a configuration; the block's sample time is the
 * first of them.
 * Inputs: position x, y [m]; spin [rad/s]; levitation force x, y [N]; applied force x, y [N]; status bits.
 * Outputs: force x, y [N]; mode; limits; events; severity; 1 while the levitation controller is to keep its integrators.
 *
 * How to build it is on the page "Linking it into C firmware" of the book. */
#define S_FUNCTION_NAME sfun_amb_supervisor
#define S_FUNCTION_LEVEL 2

#include "amb_supervisor.h"
#include "simstruc.h"

#include <stdbool.h>
#include <string.h>

enum { POSITION, SPIN, LEVITATION, APPLIED, STATUS, INPUTS };
enum { FORCE, MODE, LIMITS, EVENTS, SEVERITY, HOLD, OUTPUTS };
static const int_T input_width[INPUTS] = {2, 1, 2, 2, 1};
static const int_T output_width[OUTPUTS] = {2, 1, 1, 1, 1, 1};

/* What the block keeps: the supervisor, and the number of the next sample. */
enum { SUPERVISOR, SEQUENCE, KEPT };
#define SUPERVISOR_DOUBLES (AMB_SUPERVISOR_BYTES / sizeof(real_T))

/* Nine numbers are a bearing. */
#define BEARING_NUMBERS 9

/* The configuration of the block's parameter. */
static amb_code configuration(SimStruct *S, float values[AMB_PARAMETERS]) {
    const mxArray *given = ssGetSFcnParam(S, 0);
    const size_t count = mxGetNumberOfElements(given);
    const real_T *numbers = mxGetPr(given);
    if (count == AMB_PARAMETERS) {
        for (size_t i = 0; i < count; i++) values[i] = (float)numbers[i];
        return AMB_OK;
    }
    if (count == BEARING_NUMBERS) {
        const amb_bearing bearing = {(float)numbers[0], (float)numbers[1], (float)numbers[2],
                                     (float)numbers[3], (float)numbers[4], (float)numbers[5],
                                     (float)numbers[6], (float)numbers[7], (float)numbers[8]};
        const amb_code code = amb_config_for_bearing(&bearing, values, AMB_PARAMETERS);
        /* A simulated machine has the numbers that it was made of. */
        values[AMB_P_CHECK_FIRST] = 0.0f;
        return code;
    }
    return AMB_ERROR_VALUES_COUNT;
}

/* Ends the simulation with the text of an error. */
static bool failed(SimStruct *S, amb_code code) {
    if (code != AMB_OK) ssSetErrorStatus(S, amb_error_text(code));
    return code != AMB_OK;
}

static void mdlInitializeSizes(SimStruct *S) {
    ssSetNumSFcnParams(S, 1);
    if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) return; /* Simulink says so itself */
    ssSetSFcnParamTunable(S, 0, 0);
    if (!ssSetNumInputPorts(S, INPUTS)) return;
    for (int_T port = 0; port < INPUTS; port++) {
        ssSetInputPortWidth(S, port, input_width[port]);
        ssSetInputPortDirectFeedThrough(S, port, 1);
        ssSetInputPortRequiredContiguous(S, port, 1);
    }
    if (!ssSetNumOutputPorts(S, OUTPUTS)) return;
    for (int_T port = 0; port < OUTPUTS; port++) ssSetOutputPortWidth(S, port, output_width[port]);
    ssSetNumSampleTimes(S, 1);
    ssSetNumDWork(S, KEPT);
    ssSetDWorkWidth(S, SUPERVISOR, (int_T)SUPERVISOR_DOUBLES);
    ssSetDWorkDataType(S, SUPERVISOR, SS_DOUBLE);
    ssSetDWorkWidth(S, SEQUENCE, 1);
    ssSetDWorkDataType(S, SEQUENCE, SS_UINT32);
    ssSetOptions(S, SS_OPTION_EXCEPTION_FREE_CODE);
}

static void mdlInitializeSampleTimes(SimStruct *S) {
    float values[AMB_PARAMETERS];
    if (failed(S, configuration(S, values))) return;
    ssSetSampleTime(S, 0, (real_T)values[AMB_P_SAMPLE_PERIOD_S]);
    ssSetOffsetTime(S, 0, 0.0);
}

#define MDL_START
static void mdlStart(SimStruct *S) {
    amb_supervisor *supervisor = ssGetDWork(S, SUPERVISOR);
    float values[AMB_PARAMETERS];
    if (failed(S, configuration(S, values))) return;
    memset(supervisor, 0, sizeof *supervisor);
    *(uint32_T *)ssGetDWork(S, SEQUENCE) = 0;
    (void)failed(S, amb_init(supervisor, sizeof *supervisor, values, AMB_PARAMETERS));
}

static void mdlOutputs(SimStruct *S, int_T task) {
    const real_T *position_m = ssGetInputPortRealSignal(S, POSITION);
    const real_T *levitation_n = ssGetInputPortRealSignal(S, LEVITATION);
    const real_T *applied_n = ssGetInputPortRealSignal(S, APPLIED);
    uint32_T *sequence = ssGetDWork(S, SEQUENCE);
    amb_command command;
    amb_sample sample;
    (void)task;
    sample.sequence = (*sequence)++;
    sample.status = (uint32_t)*ssGetInputPortRealSignal(S, STATUS);
    sample.spin_rad_s = (float)*ssGetInputPortRealSignal(S, SPIN);
    for (int i = 0; i < 2; i++) {
        sample.position_m[i] = (float)position_m[i];
        sample.levitation_n[i] = (float)levitation_n[i];
        sample.applied_n[i] = (float)applied_n[i];
    }
    /* After an error the command is zero force, and the simulation ends. */
    (void)failed(S, amb_tick(ssGetDWork(S, SUPERVISOR), &sample, &command));
    for (int i = 0; i < 2; i++) ssGetOutputPortRealSignal(S, FORCE)[i] = (real_T)command.force_n[i];
    *ssGetOutputPortRealSignal(S, MODE) = (real_T)command.mode;
    *ssGetOutputPortRealSignal(S, LIMITS) = (real_T)command.limits;
    *ssGetOutputPortRealSignal(S, EVENTS) = (real_T)command.events;
    *ssGetOutputPortRealSignal(S, SEVERITY) = (real_T)command.severity;
    *ssGetOutputPortRealSignal(S, HOLD) = (real_T)(command.integrator == AMB_INTEGRATOR_HOLD);
}

static void mdlTerminate(SimStruct *S) { (void)S; }

#ifdef MATLAB_MEX_FILE
#include "simulink.c"
#else
#include "cg_sfun.h"
#endif
