/* The example's firmware, and a reset after its first course: the landings of the bearing go on, those of the supervisor do not. */
#define main course
#include "firmware.c"
#undef main

int main(void) {
    const int code = course();
    fflush(stdout);
    /* Once: after the second course there are twice as many. */
    if (code == 0 && counts && ledger.landings == ledger.run_landings) board_reset();
    return code;
}
