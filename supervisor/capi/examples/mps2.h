/**
 * @file mps2.h
 * What the example needs of its board: a timer interrupt, and a way to hold it.
 */
#ifndef MPS2_H
#define MPS2_H

#include <stdint.h>

/** Called by the timer; the firmware defines it. */
void control_interrupt(void);

/** Starts the timer. @param rate_hz calls of control_interrupt() in a second. */
void control_start(uint32_t rate_hz);

/* The compiler must not move memory accesses across these. */
static inline void interrupts_hold(void) {
    __asm volatile("cpsid i" ::: "memory");
}

static inline void interrupts_release(void) {
    __asm volatile("cpsie i" ::: "memory");
}

#endif
