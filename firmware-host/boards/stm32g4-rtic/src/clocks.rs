//! 170 MHz from a crystal of 24 MHz. Where the crystal fails later, the break of timer 1 switches the outputs off by hardware, and the
//! core waits in the handler of the NMI for the watchdog.

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::rcc::vals::{Hpre, Pllm, Plln, Pllr, Pllsrc, Sw};
use stm32_metapac::{FLASH, PWR, RCC};

/// Of the core, the buses and the timers \[Hz\].
pub(crate) const CORE_HZ: u32 = 170_000_000;

/// Does not come back without a crystal; outputs are off then.
pub(crate) fn to_170_mhz() {
    RCC.apb1enr1().modify(|w| w.set_pwren(true));
    // Above 150 MHz: boost mode of the regulator.
    PWR.cr5().modify(|w| w.set_r1mode(false));
    FLASH.acr().modify(|w| {
        w.set_latency(Latency::WS4);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    RCC.cr().modify(|w| w.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    // 24 MHz / 6 · 85 / 2.
    RCC.pllcfgr().write(|w| {
        w.set_pllsrc(Pllsrc::HSE);
        w.set_pllm(Pllm::DIV6);
        w.set_plln(Plln::MUL85);
        w.set_pllr(Pllr::DIV2);
        w.set_pllren(true);
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    while !RCC.cr().read().pllrdy() {}
    // By way of half the frequency for a microsecond at least.
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV2));
    RCC.cfgr().modify(|w| w.set_sw(Sw::PLL1_R));
    while RCC.cfgr().read().sws() != Sw::PLL1_R {}
    cortex_m::asm::delay(CORE_HZ / 1_000_000);
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV1));
    RCC.cr().modify(|w| w.set_csson(true));
}
