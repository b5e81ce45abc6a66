/* What sfun_amb_supervisor.c uses of Simulink's simstruc.h, by the names and types of its documentation, over a struct of the
 * test's own. Not Simulink's header, and no replacement for it. */
#ifndef SIMSTRUC_H
#define SIMSTRUC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

typedef double real_T;
typedef int int_T;
typedef uint32_t uint32_T;

typedef struct {
    size_t count;
    const double *numbers;
} mxArray;

#define PORTS 8

typedef struct {
    const mxArray *parameter;
    int_T parameters, inputs, outputs, kept, sample_times, options;
    int_T input_width[PORTS], output_width[PORTS], direct[PORTS], contiguous[PORTS], kept_width[PORTS], kept_type[PORTS];
    real_T in[PORTS][2], out[PORTS][2], period_s, offset_s;
    void *memory[PORTS];
    const char *error;
} SimStruct;

enum { SS_DOUBLE = 0, SS_UINT32 = 7 };
#define SS_OPTION_EXCEPTION_FREE_CODE 1

#define mxGetNumberOfElements(array) ((array)->count)
#define mxGetPr(array) ((array)->numbers)
#define ssSetNumSFcnParams(S, n) ((S)->parameters = (n))
#define ssGetNumSFcnParams(S) ((S)->parameters)
#define ssGetSFcnParamsCount(S) 1
#define ssGetSFcnParam(S, i) ((S)->parameter + (i))
#define ssSetSFcnParamTunable(S, i, is) ((void)(S), (void)(i), (void)(is))
#define ssSetNumInputPorts(S, n) ((S)->inputs = (n), (n) <= PORTS)
#define ssSetInputPortWidth(S, i, n) ((S)->input_width[i] = (n))
#define ssSetInputPortDirectFeedThrough(S, i, is) ((S)->direct[i] = (is))
#define ssSetInputPortRequiredContiguous(S, i, is) ((S)->contiguous[i] = (is))
#define ssGetInputPortRealSignal(S, i) ((const real_T *)(S)->in[i])
#define ssSetNumOutputPorts(S, n) ((S)->outputs = (n), (n) <= PORTS)
#define ssSetOutputPortWidth(S, i, n) ((S)->output_width[i] = (n))
#define ssGetOutputPortRealSignal(S, i) ((real_T *)(S)->out[i])
#define ssSetNumSampleTimes(S, n) ((S)->sample_times = (n))
#define ssSetSampleTime(S, i, s) ((void)(i), (S)->period_s = (s))
#define ssSetOffsetTime(S, i, s) ((void)(i), (S)->offset_s = (s))
#define ssSetNumDWork(S, n) ((S)->kept = (n))
#define ssSetDWorkWidth(S, i, n) ((S)->kept_width[i] = (n))
#define ssSetDWorkDataType(S, i, type) ((S)->kept_type[i] = (type))
#define ssGetDWork(S, i) ((S)->memory[i])
#define ssSetOptions(S, bits) ((S)->options = (bits))
#define ssSetErrorStatus(S, text) ((S)->error = (text))

#endif
