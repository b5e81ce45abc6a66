/* CVODE on the benchmark: one integrator, reinitialised at every change of mode, with its own
 * rootfinding. BDF: Newton with the analytic Jacobian. Adams: fixed-point iteration, as the manual
 * advises for problems that are not stiff. The equations are those of src/problem.rs, written out
 * once more. */

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <string.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

typedef struct {
    double m, k, d, clearance, mu, spin, radius, eccentricity, k_c, d_c;
    double m_s, k_s, d_s; /* stator; m_s = 0: a wall that does not move */
    double start_speed, t_end;
} Problem;

typedef struct {
    double x, y;
    uint64_t changes, evaluations, factorisations;
} Outcome;

typedef enum { FLIGHT, SLIP_POSITIVE, SLIP_NEGATIVE, ROLL } Mode;

typedef struct {
    const Problem *p;
    Mode mode;
    double since;
    long calls, jacobians;
} Segment;

enum { MOST_STATES = 8, MOST_GUARDS = 3, TOO_MANY = 10000, CHATTERS = -1000 };
static const double NO_SPEED = 1e-12; /* m/s */
static const double ARMED = 1e-9;     /* see `ARMED` in src/problem.rs */

typedef struct {
    double distance, n[2], t[2], normal_speed, whirl_speed, normal_force;
} Contact;

static int states(const Problem *p) { return p->m_s > 0 ? 8 : 4; }
static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1]; }
static double mobility(const Problem *p) { return 1 / p->m + (p->m_s > 0 ? 1 / p->m_s : 0); }
static double slip_sign(Mode m) { return m == SLIP_POSITIVE ? 1 : m == SLIP_NEGATIVE ? -1 : 0; }

/* Rotor minus stator. */
static void relative(const Problem *p, const double *y, double *u, double *w) {
    for (int i = 0; i < 2; i++) {
        u[i] = y[i] - (p->m_s > 0 ? y[4 + i] : 0);
        w[i] = y[2 + i] - (p->m_s > 0 ? y[6 + i] : 0);
    }
}

static Contact contact(const Problem *p, const double *y) {
    Contact c;
    double u[2], w[2];
    relative(p, y, u, w);
    c.distance = sqrt(dot(u, u));
    c.n[0] = c.distance > 0 ? u[0] / c.distance : 1;
    c.n[1] = c.distance > 0 ? u[1] / c.distance : 0;
    c.t[0] = -c.n[1];
    c.t[1] = c.n[0];
    c.normal_speed = dot(w, c.n);
    c.whirl_speed = dot(w, c.t);
    c.normal_force = p->k_c * (c.distance - p->clearance) + p->d_c * c.normal_speed;
    return c;
}

static double sliding_speed(const Problem *p, const Contact *c) {
    return p->spin * p->radius + c->whirl_speed;
}

/* Accelerations by springs and dampers to ground. */
static void linear(const Problem *p, const double *y, double *rotor, double *stator) {
    for (int i = 0; i < 2; i++) {
        rotor[i] = -(p->k * y[i] + p->d * y[2 + i]) / p->m;
        stator[i] = p->m_s > 0 ? -(p->k_s * y[4 + i] + p->d_s * y[6 + i]) / p->m_s : 0;
    }
}

/* The same with the unbalance. */
static void free_of_contact(const Problem *p, double t, const double *y, double *rotor,
                            double *stator) {
    linear(p, y, rotor, stator);
    double unbalance = p->eccentricity * p->spin * p->spin;
    rotor[0] += unbalance * cos(p->spin * t);
    rotor[1] += unbalance * sin(p->spin * t);
}

static double rolling_force_from(const Problem *p, const double *rotor, const double *stator,
                                 const Contact *c) {
    double across[2] = {rotor[0] - stator[0], rotor[1] - stator[1]};
    return -(dot(across, c->t) - c->normal_speed * c->whirl_speed / c->distance) / mobility(p);
}

static double rolling_force(const Problem *p, double t, const double *y, const Contact *c) {
    double rotor[2], stator[2];
    free_of_contact(p, t, y, rotor, stator);
    return rolling_force_from(p, rotor, stator, c);
}

static void assemble(const Problem *p, const double *y, const double *rotor, const double *stator,
                     const double *force, double *out) {
    for (int i = 0; i < 2; i++) {
        out[i] = y[2 + i];
        out[2 + i] = rotor[i] + force[i] / p->m;
        if (p->m_s > 0) {
            out[4 + i] = y[6 + i];
            out[6 + i] = stator[i] - force[i] / p->m_s;
        }
    }
}

static int rhs(double t, N_Vector y_vector, N_Vector out, void *data) {
    Segment *s = data;
    const Problem *p = s->p;
    const double *y = N_VGetArrayPointer(y_vector);
    double rotor[2], stator[2], force[2] = {0, 0};
    s->calls++;
    free_of_contact(p, t, y, rotor, stator);
    if (s->mode != FLIGHT) {
        Contact c = contact(p, y);
        double tangential = s->mode == ROLL ? rolling_force_from(p, rotor, stator, &c)
                                            : -slip_sign(s->mode) * p->mu * c.normal_force;
        for (int i = 0; i < 2; i++) force[i] = tangential * c.t[i] - c.normal_force * c.n[i];
    }
    assemble(p, y, rotor, stator, force, N_VGetArrayPointer(out));
    return 0;
}

/* Derivative of the right-hand side along v. */
static void tangent(const Segment *s, double t, const double *y, const double *v, double *out) {
    const Problem *p = s->p;
    double rotor[2], stator[2], force[2] = {0, 0};
    linear(p, v, rotor, stator);
    if (s->mode != FLIGHT) {
        Contact c = contact(p, y);
        double du[2], dw[2];
        relative(p, v, du, dw);
        double stretch = dot(c.n, du), turn = dot(c.t, du) / c.distance;
        double normal_speed = dot(dw, c.n) + c.whirl_speed * turn;
        double whirl_speed = dot(dw, c.t) - c.normal_speed * turn;
        double normal_force = p->k_c * stretch + p->d_c * normal_speed;
        double by_force = -slip_sign(s->mode) * p->mu;
        double f = by_force * c.normal_force, df = by_force * normal_force;
        if (s->mode == ROLL) {
            double a[2], b[2];
            free_of_contact(p, t, y, a, b);
            double across[2] = {a[0] - b[0], a[1] - b[1]};
            double d_across[2] = {rotor[0] - stator[0], rotor[1] - stator[1]};
            double product = normal_speed * c.whirl_speed + c.normal_speed * whirl_speed -
                             c.normal_speed * c.whirl_speed * stretch / c.distance;
            f = rolling_force_from(p, a, b, &c);
            df = -(dot(d_across, c.t) - turn * dot(across, c.n) - product / c.distance) /
                 mobility(p);
        }
        for (int i = 0; i < 2; i++)
            force[i] = (df - c.normal_force * turn) * c.t[i] - (normal_force + f * turn) * c.n[i];
    }
    assemble(p, v, rotor, stator, force, out);
}

static int jacobian(double t, N_Vector y, N_Vector f, SUNMatrix j, void *data, N_Vector t1,
                    N_Vector t2, N_Vector t3) {
    Segment *s = data;
    (void)f, (void)t1, (void)t2, (void)t3;
    s->jacobians++;
    for (int i = 0; i < states(s->p); i++) {
        double unit[MOST_STATES] = {0};
        unit[i] = 1;
        tangent(s, t, N_VGetArrayPointer(y), unit, SUNDenseMatrix_Column(j, i));
    }
    return 0;
}

static int guards(double t, N_Vector y_vector, double *g, void *data) {
    const Segment *s = data;
    const Problem *p = s->p;
    const double *y = N_VGetArrayPointer(y_vector);
    Contact c = contact(p, y);
    double scale = p->k_c * p->clearance, force = c.normal_force / scale;
    g[0] = force;
    g[1] = g[2] = 1;
    if (s->mode == FLIGHT) {
        g[0] = -fmin(force, c.distance / p->clearance - 1);
    } else if (s->mode == ROLL) {
        double needed = rolling_force(p, t, y, &c) / scale;
        g[1] = p->mu * force - needed;
        g[2] = p->mu * force + needed;
    } else {
        g[1] = slip_sign(s->mode) * sliding_speed(p, &c) / (p->spin * p->radius);
    }
    if (t == s->since)
        for (int i = 0; i < MOST_GUARDS; i++) g[i] = fmax(g[i], ARMED);
    return 0;
}

/* The mode after `guard` has fallen; takes out what is left of a sliding speed that stops. */
static Mode next(const Problem *p, Mode mode, int guard, double t, double *y) {
    Contact c = contact(p, y);
    double speed = sliding_speed(p, &c);
    if (mode != FLIGHT && guard == 0) return FLIGHT;
    if (mode == FLIGHT && fabs(speed) > NO_SPEED) return speed > 0 ? SLIP_POSITIVE : SLIP_NEGATIVE;
    double impulse = -speed / mobility(p);
    for (int i = 0; i < 2; i++) {
        y[2 + i] += impulse / p->m * c.t[i];
        if (p->m_s > 0) y[6 + i] -= impulse / p->m_s * c.t[i];
    }
    c = contact(p, y);
    double needed = rolling_force(p, t, y, &c);
    if (mode != ROLL && fabs(needed) <= p->mu * c.normal_force) return ROLL;
    return needed > 0 ? SLIP_NEGATIVE : SLIP_POSITIVE;
}

static void silent(int line, const char *module, const char *function, char *message, void *data) {
    (void)line, (void)module, (void)function, (void)message, (void)data;
}

/* Rides the problem to its end; 0, or a negative flag of CVODE's. */
int cvode_run(const Problem *p, int family, double rtol, Outcome *out) {
    SUNContext context;
    if (SUNContext_Create(NULL, &context)) return CV_MEM_FAIL;
    int n = states(p), flag = 0;
    N_Vector y = N_VNew_Serial(n, context), atol = N_VNew_Serial(n, context);
    double *y_at = N_VGetArrayPointer(y);
    N_VConst(0, y);
    y_at[2] = p->start_speed;
    for (int i = 0; i < n; i++)
        N_VGetArrayPointer(atol)[i] = rtol * (i % 4 < 2 ? p->clearance : p->start_speed);

    Segment s = {.p = p, .mode = FLIGHT};
    void *cvode = CVodeCreate(family, context);
    SUNMatrix matrix = NULL;
    SUNLinearSolver lu = NULL;
    SUNNonlinearSolver fixed_point = NULL;
    CVodeInit(cvode, rhs, 0, y);
    CVodeSetErrHandlerFn(cvode, silent, NULL);
    CVodeSVtolerances(cvode, rtol, atol);
    CVodeSetUserData(cvode, &s);
    CVodeSetMaxNumSteps(cvode, 5000000);
    CVodeSetStopTime(cvode, p->t_end);
    CVodeRootInit(cvode, MOST_GUARDS, guards);
    CVodeSetRootDirection(cvode, (int[MOST_GUARDS]){-1, -1, -1});
    CVodeSetNoInactiveRootWarn(cvode);
    if (family == CV_BDF) {
        matrix = SUNDenseMatrix(n, n, context);
        lu = SUNLinSol_Dense(y, matrix, context);
        CVodeSetLinearSolver(cvode, lu, matrix);
        CVodeSetJacFn(cvode, jacobian);
    } else {
        fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
        CVodeSetNonlinearSolver(cvode, fixed_point);
    }

    memset(out, 0, sizeof *out);
    double t = 0;
    while (t < p->t_end) {
        flag = CVode(cvode, p->t_end, y, &t, CV_NORMAL);
        /* Counted anew after each CVodeReInit. */
        long setups = 0;
        if (family == CV_BDF) CVodeGetNumLinSolvSetups(cvode, &setups);
        out->factorisations += setups;
        if (flag != CV_ROOT_RETURN) break;
        if (++out->changes > TOO_MANY) {
            flag = CHATTERS;
            break;
        }
        int found[MOST_GUARDS], guard = 0;
        CVodeGetRootInfo(cvode, found);
        while (guard < MOST_GUARDS - 1 && !found[guard]) guard++;
        s.mode = next(p, s.mode, guard, t, y_at);
        s.since = t;
        CVodeReInit(cvode, t, y);
        CVodeSetStopTime(cvode, p->t_end);
    }
    out->x = y_at[0];
    out->y = y_at[1];
    out->evaluations = s.calls + s.jacobians;

    CVodeFree(&cvode);
    if (fixed_point) SUNNonlinSolFree(fixed_point);
    if (lu) SUNLinSolFree(lu);
    if (matrix) SUNMatDestroy(matrix);
    N_VDestroy(y);
    N_VDestroy(atol);
    SUNContext_Free(&context);
    return flag < 0 ? flag : 0;
}
