/* Start-up for Arm's MPS2 board with a Cortex-M4 (QEMU: -M mps2-an386). Text goes to the debugger. */
#include "mps2.h"

#include <stdio.h>
#include <unistd.h>

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define SYSTICK_CONTROL REGISTER(0xE000E010u)
#define SYSTICK_RELOAD REGISTER(0xE000E014u)
#define SYSTICK_VALUE REGISTER(0xE000E018u)
#define COPROCESSOR_ACCESS REGISTER(0xE000ED88u)
#define RESET_CONTROL REGISTER(0xE000ED0Cu)

static const uint32_t CLOCK_HZ = 25000000u;

extern uint32_t ram_top, data_start, data_end, data_load, bss_start, bss_end;
extern void initialise_monitor_handles(void); /* newlib's: opens the debugger's console */
int main(void);

static void reset(void) {
    uint32_t *from = &data_load, *to;
    COPROCESSOR_ACCESS |= 0xFu << 20; /* the FPU, before the first float */
    __asm volatile("dsb\n isb" ::: "memory");
    for (to = &data_start; to < &data_end; to++) *to = *from++;
    for (to = &bss_start; to < &bss_end; to++) *to = 0;
    initialise_monitor_handles();
    const int code = main();
    fflush(stdout);
    _exit(code);
}

/* Any fault ends the program as failed, instead of hanging. */
static void fault(void) {
    _exit(2);
}

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    &ram_top,     (void *)reset, (void *)fault, (void *)fault, (void *)fault, (void *)fault,
    (void *)fault, 0,            0,             0,             0,             (void *)fault,
    (void *)fault, 0,            (void *)fault, (void *)control_interrupt,
};

void board_reset(void) {
    RESET_CONTROL = 0x05FA0004u;
    for (;;) __asm volatile("dsb" ::: "memory");
}

void control_start(uint32_t rate_hz) {
    SYSTICK_RELOAD = CLOCK_HZ / rate_hz - 1;
    SYSTICK_VALUE = 0;
    SYSTICK_CONTROL = 7; /* on, with interrupt, from the core's clock */
}
