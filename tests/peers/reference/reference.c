/* Where the runs of the benchmark end, in 128-bit arithmetic and with a method that no solver in the
 * comparison uses: extrapolated midpoint steps (Gragg, Bulirsch and Stoer) of fixed length for each
 * mode, each event met by the length of the step.
 *
 *     cc -O2 reference.c -lquadmath -o reference && ./reference
 */

#include <quadmath.h>
#include <stdio.h>
#include <string.h>

typedef __float128 real;
typedef enum { FLIGHT, SLIP_POSITIVE, SLIP_NEGATIVE, ROLL } Mode;
enum { COLUMNS = 9, MOST = 8 };

static const real M = 10, K = 4e5Q, D = 200, CLEARANCE = 3e-4Q, MU = 0.3Q, SPIN = 400,
                  RADIUS = 2.5e-3Q, ECCENTRICITY = 1e-5Q, K_S = 2e7Q, D_S = 3000;
static real k_c, d_c, m_s, t_end;
static int states;

/* Fills the rates of a mode and its guards, positive while it holds; `sliding` and `needed` are the
 * sliding speed and the force that would hold it. */
static void field(Mode mode, real t, const real *y, real *rates, real *guards, real *sliding,
                  real *needed, real *cone) {
    real ux = y[0], uy = y[1], wx = y[2], wy = y[3], bx = 0, by = 0, mobility = 1 / M;
    real ax = -(K * y[0] + D * y[2]) / M + ECCENTRICITY * SPIN * SPIN * cosq(SPIN * t);
    real ay = -(K * y[1] + D * y[3]) / M + ECCENTRICITY * SPIN * SPIN * sinq(SPIN * t);
    if (states == 8) {
        ux -= y[4], uy -= y[5], wx -= y[6], wy -= y[7];
        bx = -(K_S * y[4] + D_S * y[6]) / m_s, by = -(K_S * y[5] + D_S * y[7]) / m_s;
        mobility += 1 / m_s;
    }
    real r = sqrtq(ux * ux + uy * uy);
    real nx = r > 0 ? ux / r : 1, ny = r > 0 ? uy / r : 0;
    real vn = wx * nx + wy * ny, vt = wy * nx - wx * ny;
    real force = k_c * (r - CLEARANCE) + d_c * vn;
    *sliding = vt + SPIN * RADIUS;
    *needed = r > 0 ? -((ay - by) * nx - (ax - bx) * ny - vn * vt / r) / mobility : 0;
    *cone = MU * force;
    guards[0] = force, guards[1] = guards[2] = 1;
    real sign = mode == SLIP_POSITIVE ? 1 : -1, tangential = -sign * MU * force;
    if (mode == FLIGHT) {
        real gap = k_c * (CLEARANCE - r);
        guards[0] = -force > gap ? -force : gap;
        force = tangential = 0;
    } else if (mode == ROLL) {
        tangential = *needed;
        guards[1] = *cone - *needed, guards[2] = *cone + *needed;
    } else {
        guards[1] = sign * *sliding;
    }
    real fx = -force * nx - tangential * ny, fy = -force * ny + tangential * nx;
    rates[0] = y[2], rates[1] = y[3], rates[2] = ax + fx / M, rates[3] = ay + fy / M;
    if (states == 8)
        rates[4] = y[6], rates[5] = y[7], rates[6] = bx - fx / m_s, rates[7] = by - fy / m_s;
}

static real guard_at(Mode mode, real t, const real *y, int guard) {
    real rates[MOST], guards[3], s, n, c;
    field(mode, t, y, rates, guards, &s, &n, &c);
    return guards[guard];
}

/* One extrapolated step of order 18. */
static void step(Mode mode, real t, const real *y, real h, real *end) {
    real table[COLUMNS][MOST], rates[MOST], g[3], s, n, c;
    for (int row = 0; row < COLUMNS; row++) {
        int parts = 2 * (row + 1);
        real before[MOST], now[MOST], dt = h / parts;
        field(mode, t, y, rates, g, &s, &n, &c);
        for (int i = 0; i < states; i++) before[i] = y[i], now[i] = y[i] + dt * rates[i];
        for (int part = 1; part < parts; part++) {
            field(mode, t + part * dt, now, rates, g, &s, &n, &c);
            for (int i = 0; i < states; i++) {
                real after = before[i] + 2 * dt * rates[i];
                before[i] = now[i], now[i] = after;
            }
        }
        for (int i = 0; i < states; i++) {
            /* Neville's scheme in the square of the part. */
            real value = now[i], upper;
            for (int k = 1; k <= row; k++) {
                real ratio = (real)(row + 1) / (row + 1 - k);
                upper = table[k - 1][i];
                table[k - 1][i] = value;
                value += (value - upper) / (ratio * ratio - 1);
            }
            table[row][i] = value;
        }
    }
    memcpy(end, table[COLUMNS - 1], states * sizeof *end);
}

static void ride(const char *name, real stiffness, real damping, real stator, real until) {
    k_c = stiffness, d_c = damping, m_s = stator, t_end = until;
    states = m_s > 0 ? 8 : 4;
    real mobility = 1 / M + (m_s > 0 ? 1 / m_s : 0);
    real slow = 1 / (m_s > 0 ? sqrtq(K_S / m_s) : SPIN) / 8;
    real fast = 1 / (sqrtq(k_c * mobility) + d_c * mobility) / 4;
    real y[MOST] = {0, 0, 0.3Q}, end[MOST], rates[MOST], g[3], t = 0, s, n, c;
    Mode mode = FLIGHT;
    int changes = 0, fresh = 0;
    while (t < t_end) {
        real h = mode == FLIGHT ? slow : fast;
        /* Short first steps: a mode may last for a moment only. */
        if (fresh < 12) h *= powq(2, fresh++ - 12);
        if (t + h > t_end) h = t_end - t;
        step(mode, t, y, h, end);
        field(mode, t + h, end, rates, g, &s, &n, &c);
        int guard = -1;
        real first = h;
        for (int i = 0; i < 3; i++) {
            if (g[i] >= 0 || (mode == FLIGHT && fresh <= 1)) continue;
            real low = 0, high = h;
            for (int k = 0; k < 110; k++) {
                real middle = (low + high) / 2;
                step(mode, t, y, middle, end);
                if (guard_at(mode, t + middle, end, i) < 0) high = middle;
                else low = middle;
            }
            if (high <= first) first = high, guard = i;
        }
        step(mode, t, y, first, end);
        memcpy(y, end, sizeof y);
        t += first;
        if (guard < 0) continue;
        changes++, fresh = 0;
        field(mode, t, y, rates, g, &s, &n, &c);
        if (mode == FLIGHT) mode = s > 0 ? SLIP_POSITIVE : SLIP_NEGATIVE;
        else if (guard == 0) mode = FLIGHT;
        else if (mode != ROLL && fabsq(n) <= c) mode = ROLL;
        else mode = n > 0 ? SLIP_NEGATIVE : SLIP_POSITIVE;
    }
    printf("%s: %.18e, %.18e, changes %d\n", name, (double)y[0], (double)y[1], changes);
    fflush(stdout);
}

int main(void) {
    ride("B1", 1e8Q, 0.1Q * sqrtq(1e9Q), 0, 0.2Q);
    ride("B2", 1e10Q, 0.1Q * sqrtq(1e11Q), 0, 0.2Q);
    ride("B3a", 1e10Q, 2e4Q, 1, 0.02Q);
    ride("B3b", 1e10Q, 2e6Q, 1, 0.02Q);
    ride("B3c", 1e10Q, 2e6Q, 0.1Q, 0.02Q);
}
