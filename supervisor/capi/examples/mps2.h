/**
 * @file mps2.h
 * What the example needs of its board: a timer interrupt.
 */
#ifndef MPS2_H
#define MPS2_H

#include <stdint.h>

/** Called by the timer; the firmware defines it. */
void control_interrupt(void);

/** Starts the timer. @param rate_hz calls of control_interrupt() in a second. */
void control_start(uint32_t rate_hz);

#endif
