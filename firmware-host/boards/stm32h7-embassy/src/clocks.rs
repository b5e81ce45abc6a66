//! 400 MHz from the 8 MHz that a Nucleo board's debugger gives. Other boards have a crystal: `HseMode::Oscillator`.

use embassy_stm32::Config;
use embassy_stm32::interrupt::Priority;
use embassy_stm32::rcc::mux::Adcsel;
use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, LsConfig, Pll, PllDiv, PllMul, PllPreDiv, PllSource,
    Sysclk, VoltageScale,
};
use embassy_stm32::time::Hertz;

/// Of the core \[Hz\].
pub(crate) const CORE_HZ: u32 = 400_000_000;
/// Of the timers: twice the clock of their bus \[Hz\].
pub(crate) const TIMER_HZ: u32 = 200_000_000;

/// Clocks, and priorities of what the crate sets up by itself.
pub(crate) fn config() -> Config {
    let mut config = Config::default();
    // Embassy's own interrupts would have the highest priority, which is the tick's.
    config.dma_interrupt_priority = Priority::P8;
    config.bdma_interrupt_priority = Priority::P8;
    let rcc = &mut config.rcc;
    // No clock of the calendar. To change to another one would reset the backup registers, and the ledger with them.
    rcc.ls = LsConfig::off();
    rcc.hse = Some(Hse {
        freq: Hertz(8_000_000),
        mode: HseMode::Bypass,
    });
    let pll = Pll {
        source: PllSource::HSE,
        prediv: PllPreDiv::DIV2,
        mul: PllMul::MUL200,
        fracn: None,
        divp: Some(PllDiv::DIV2),
        divq: None,
        divr: None,
    };
    rcc.pll1 = Some(pll);
    // Of the converters: 50 MHz.
    rcc.pll2 = Some(Pll {
        mul: PllMul::MUL100,
        divp: Some(PllDiv::DIV8),
        ..pll
    });
    rcc.mux.adcsel = Adcsel::PLL2_P;
    rcc.sys = Sysclk::PLL1_P;
    rcc.ahb_pre = AHBPrescaler::DIV2;
    rcc.apb1_pre = APBPrescaler::DIV2;
    rcc.apb2_pre = APBPrescaler::DIV2;
    rcc.apb3_pre = APBPrescaler::DIV2;
    rcc.apb4_pre = APBPrescaler::DIV2;
    rcc.voltage_scale = VoltageScale::Scale1;
    config
}
