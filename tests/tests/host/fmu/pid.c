/* The PID of scenes/controllers/pid.c as a co-simulation unit of FMI 2.0 and 3.0: what an importer of one needs, and no more. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

/* Value references: K_p, K_i, K_d, filter, cap; x, y; hold; force in x, y. */
enum { KP, KI, KD, FILTER_S, CAP_N, X_M, Y_M, HOLD, FX_N, FY_N, NUMBERS };

typedef struct {
    double number[NUMBERS];
    double last_m[2], speed_m_s[2], integral_n[2];
    bool begun;
} pid;

static pid *begin(void) {
    pid *p = calloc(1, sizeof *p);
    if (p != NULL) p->number[CAP_N] = 1000.0;
    return p;
}

static void step(pid *p, double period_s) {
    const double *n = p->number, share = period_s / (period_s + n[FILTER_S]);
    double force_n[2], size_n, scale;
    for (int i = 0; i < 2; i++) {
        const double m = n[X_M + i], last_m = p->begun ? p->last_m[i] : m;
        p->speed_m_s[i] += share * ((m - last_m) / period_s - p->speed_m_s[i]);
        force_n[i] = -n[KP] * m - n[KD] * p->speed_m_s[i] + p->integral_n[i];
        p->last_m[i] = m;
    }
    p->begun = true;
    size_n = sqrt(force_n[0] * force_n[0] + force_n[1] * force_n[1]);
    scale = size_n > n[CAP_N] ? n[CAP_N] / size_n : 1.0;
    for (int i = 0; i < 2; i++) {
        if (size_n <= n[CAP_N] && n[HOLD] == 0.0) p->integral_n[i] -= n[KI] * period_s * n[X_M + i];
        p->number[FX_N + i] = force_n[i] * scale;
    }
}

static int set(pid *p, const unsigned r[], size_t count, const double v[]) {
    for (size_t i = 0; i < count; i++) p->number[r[i]] = v[i];
    return 0;
}

static int get(const pid *p, const unsigned r[], size_t count, double v[]) {
    for (size_t i = 0; i < count; i++) v[i] = p->number[r[i]];
    return 0;
}

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                  bool events, bool early, const unsigned *r, size_t count, void *environment, void *log,
                                  void *update) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)r, (void)count;
    (void)environment, (void)log, (void)update;
    return begin();
}
void fmi3FreeInstance(void *p) { free(p); }
int fmi3EnterInitializationMode(void *p, bool t, double tolerance, double from, bool s, double stop) {
    (void)p, (void)t, (void)tolerance, (void)from, (void)s, (void)stop;
    return 0;
}
int fmi3ExitInitializationMode(void *p) { return (void)p, 0; }
int fmi3Terminate(void *p) { return (void)p, 0; }
int fmi3SetFloat64(void *p, const unsigned r[], size_t count, const double v[], size_t n) { return (void)n, set(p, r, count, v); }
int fmi3GetFloat64(void *p, const unsigned r[], size_t count, double v[], size_t n) { return (void)n, get(p, r, count, v); }
int fmi3SetBoolean(void *p, const unsigned r[], size_t count, const bool v[], size_t n) {
    (void)n;
    for (size_t i = 0; i < count; i++) ((pid *)p)->number[r[i]] = v[i];
    return 0;
}
int fmi3DoStep(void *p, double from, double by, bool no, bool *events, bool *ends, bool *early, double *to) {
    (void)no;
    step(p, by);
    *events = *ends = *early = false;
    *to = from + by;
    return 0;
}

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources, const void *callbacks, int visible,
                      int logging) {
    (void)name, (void)kind, (void)guid, (void)resources, (void)callbacks, (void)visible, (void)logging;
    return begin();
}
void fmi2FreeInstance(void *p) { free(p); }
int fmi2SetupExperiment(void *p, int t, double tolerance, double from, int s, double stop) {
    (void)p, (void)t, (void)tolerance, (void)from, (void)s, (void)stop;
    return 0;
}
int fmi2EnterInitializationMode(void *p) { return (void)p, 0; }
int fmi2ExitInitializationMode(void *p) { return (void)p, 0; }
int fmi2Terminate(void *p) { return (void)p, 0; }
int fmi2SetReal(void *p, const unsigned r[], size_t count, const double v[]) { return set(p, r, count, v); }
int fmi2GetReal(void *p, const unsigned r[], size_t count, double v[]) { return get(p, r, count, v); }
int fmi2SetBoolean(void *p, const unsigned r[], size_t count, const int v[]) {
    for (size_t i = 0; i < count; i++) ((pid *)p)->number[r[i]] = v[i];
    return 0;
}
int fmi2DoStep(void *p, double from, double by, int no) { return (void)from, (void)no, step(p, by), 0; }

/* FMPy wants every function of a version to be there; none of these is called. */
#define ABSENT(name) int name(void *p) { return (void)p, 3; }
ABSENT(fmi2SetDebugLogging)
ABSENT(fmi2Reset)
ABSENT(fmi2GetInteger)
ABSENT(fmi2GetBoolean)
ABSENT(fmi2GetString)
ABSENT(fmi2SetInteger)
ABSENT(fmi2SetString)
ABSENT(fmi2GetFMUstate)
ABSENT(fmi2SetFMUstate)
ABSENT(fmi2FreeFMUstate)
ABSENT(fmi2SerializedFMUstateSize)
ABSENT(fmi2SerializeFMUstate)
ABSENT(fmi2DeSerializeFMUstate)
ABSENT(fmi2GetDirectionalDerivative)
ABSENT(fmi2SetRealInputDerivatives)
ABSENT(fmi2GetRealOutputDerivatives)
ABSENT(fmi2CancelStep)
ABSENT(fmi2GetStatus)
ABSENT(fmi2GetRealStatus)
ABSENT(fmi2GetIntegerStatus)
ABSENT(fmi2GetBooleanStatus)
ABSENT(fmi2GetStringStatus)
const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi3GetVersion(void) { return "3.0"; }
ABSENT(fmi3ActivateModelPartition)
ABSENT(fmi3CompletedIntegratorStep)
ABSENT(fmi3DeserializeFMUState)
ABSENT(fmi3EnterConfigurationMode)
ABSENT(fmi3EnterContinuousTimeMode)
ABSENT(fmi3EnterEventMode)
ABSENT(fmi3EnterStepMode)
ABSENT(fmi3EvaluateDiscreteStates)
ABSENT(fmi3ExitConfigurationMode)
ABSENT(fmi3FreeFMUState)
ABSENT(fmi3GetAdjointDerivative)
ABSENT(fmi3GetBinary)
ABSENT(fmi3GetBoolean)
ABSENT(fmi3GetClock)
ABSENT(fmi3GetContinuousStateDerivatives)
ABSENT(fmi3GetContinuousStates)
ABSENT(fmi3GetDirectionalDerivative)
ABSENT(fmi3GetEventIndicators)
ABSENT(fmi3GetFMUState)
ABSENT(fmi3GetFloat32)
ABSENT(fmi3GetInt16)
ABSENT(fmi3GetInt32)
ABSENT(fmi3GetInt64)
ABSENT(fmi3GetInt8)
ABSENT(fmi3GetIntervalDecimal)
ABSENT(fmi3GetIntervalFraction)
ABSENT(fmi3GetNominalsOfContinuousStates)
ABSENT(fmi3GetNumberOfContinuousStates)
ABSENT(fmi3GetNumberOfEventIndicators)
ABSENT(fmi3GetNumberOfVariableDependencies)
ABSENT(fmi3GetOutputDerivatives)
ABSENT(fmi3GetShiftDecimal)
ABSENT(fmi3GetShiftFraction)
ABSENT(fmi3GetString)
ABSENT(fmi3GetUInt16)
ABSENT(fmi3GetUInt32)
ABSENT(fmi3GetUInt64)
ABSENT(fmi3GetUInt8)
ABSENT(fmi3GetVariableDependencies)
ABSENT(fmi3InstantiateModelExchange)
ABSENT(fmi3InstantiateScheduledExecution)
ABSENT(fmi3Reset)
ABSENT(fmi3SerializeFMUState)
ABSENT(fmi3SerializedFMUStateSize)
ABSENT(fmi3SetBinary)
ABSENT(fmi3SetClock)
ABSENT(fmi3SetContinuousStates)
ABSENT(fmi3SetDebugLogging)
ABSENT(fmi3SetFMUState)
ABSENT(fmi3SetFloat32)
ABSENT(fmi3SetInt16)
ABSENT(fmi3SetInt32)
ABSENT(fmi3SetInt64)
ABSENT(fmi3SetInt8)
ABSENT(fmi3SetIntervalDecimal)
ABSENT(fmi3SetIntervalFraction)
ABSENT(fmi3SetShiftDecimal)
ABSENT(fmi3SetShiftFraction)
ABSENT(fmi3SetString)
ABSENT(fmi3SetTime)
ABSENT(fmi3SetUInt16)
ABSENT(fmi3SetUInt32)
ABSENT(fmi3SetUInt64)
ABSENT(fmi3SetUInt8)
ABSENT(fmi3UpdateDiscreteStates)
