/**
 * @file mps2.h
 * What the example needs of its board: a timer interrupt, and memory that stays over a reset.
 */
#ifndef MPS2_H
#define MPS2_H

#include <stdint.h>

/** Called by the timer; the firmware defines it. */
void control_interrupt(void);

/** Starts the timer. @param rate_hz calls of control_interrupt() in a second. */
void control_start(uint32_t rate_hz);

/** Memory that no start-up touches: RAM, which here stands for EEPROM, FRAM or flash. */
extern uint8_t board_kept[];

/** Begins anew, as after a watchdog. */
void board_reset(void);

#endif
