/* Firmware that makes the call which the feature `planted-panic` adds to the library. */
#include "mps2.h"

uint8_t amb_planted_panic(uint32_t index);

void control_interrupt(void) {
}

int main(void) {
    return amb_planted_panic(board_kept[0]);
}
