//! Registers of what Embassy has no driver for, and why they are set as they are. Peripherals and pins are taken, so that nobody
//! else gets them.

use crate::clocks::{CORE_HZ, TIMER_HZ};
use embassy_stm32::{Peri, pac, peripherals};

/// Timer 4 triggers converters 1 and 2, which sample x and y at one instant; timer 2 counts the triggers.
pub(crate) mod sampling {
    use super::{CORE_HZ, Peri, TIMER_HZ, pac, peripherals};
    use board_machine::TICK_HZ;
    use pac::adc::Adc;
    use pac::adc::vals::{Boost, Exten, Pcsel, SampleTime};
    use pac::adccommon::vals::{Dual, Presc};
    use pac::timer::vals::{Mms, Sms, Ts};
    use pac::{ADC1, ADC2, ADC12_COMMON, RCC, TIM2, TIM4};

    /// Of a converter: sixteen bits.
    pub(crate) const STEPS: u32 = 1 << 16;
    /// The trigger of injected conversions that is TRGO of timer 4.
    const TIM4_TRGO: u8 = 5;

    /// Converters first, then what counts, then what triggers.
    pub(crate) fn start(
        _converters: (
            Peri<'static, peripherals::ADC1>,
            Peri<'static, peripherals::ADC2>,
        ),
        // Analogue from the reset on.
        _pins: (
            Peri<'static, peripherals::PC0>,
            Peri<'static, peripherals::PC1>,
        ),
        _timers: (
            Peri<'static, peripherals::TIM4>,
            Peri<'static, peripherals::TIM2>,
        ),
    ) {
        RCC.ahb1enr().modify(|w| w.set_adc12en(true));
        RCC.apb1lenr().modify(|w| {
            w.set_tim2en(true);
            w.set_tim4en(true);
        });
        ADC12_COMMON.ccr().modify(|w| {
            // 25 MHz.
            w.set_presc(Presc::DIV2);
            w.set_dual(Dual::DUAL_J);
        });
        // PC0 is input 10 of both, PC1 input 11.
        prepare(ADC1, 10);
        prepare(ADC2, 11);
        // The first converter's trigger is that of both, and so is its start.
        ADC1.jsqr().modify(|w| {
            w.set_jextsel(TIM4_TRGO);
            w.set_jexten(Exten::RISING_EDGE);
        });
        ADC1.ier().write(|w| w.set_jeosie(true));
        ADC1.cr().modify(|w| w.set_jadstart(true));

        // Internal trigger 3 of timer 2 is TRGO of timer 4.
        TIM2.smcr().modify(|w| {
            w.set_ts(Ts::ITR3);
            w.set_sms(Sms::EXT_CLOCK_MODE);
        });
        TIM2.cr1().modify(|w| w.set_cen(true));
        TIM4.arr()
            .write(|w| w.set_arr((TIMER_HZ / TICK_HZ - 1) as u16));
        TIM4.cr2().write(|w| w.set_mms(Mms::UPDATE));
        TIM4.cr1().modify(|w| w.set_cen(true));
    }

    /// Out of power-down, calibrated, on, with one input.
    fn prepare(adc: Adc, input: u8) {
        adc.cr().modify(|w| {
            w.set_deeppwd(false);
            w.set_boost(Boost::LT25);
        });
        adc.cr().modify(|w| w.set_advregen(true));
        // The regulator takes 10 µs.
        cortex_m::asm::delay(CORE_HZ / 1_000_000 * 10);
        // Offset and linearity.
        adc.cr().modify(|w| w.set_adcallin(true));
        adc.cr().modify(|w| w.set_adcal(true));
        while adc.cr().read().adcal() {}
        cortex_m::asm::delay(CORE_HZ / 1_000_000);
        adc.cr().modify(|w| w.set_aden(true));
        while !adc.isr().read().adrdy() {}
        adc.pcsel()
            .modify(|w| w.set_pcsel(usize::from(input), Pcsel::PRESELECTED));
        // 0.34 µs; the conversion takes as long.
        let of_ten = usize::from(input % 10);
        adc.smpr(usize::from(input / 10))
            .modify(|w| w.set_smp(of_ten, SampleTime::CYCLES8_5));
        // One context instead of a queue of them.
        adc.cfgr().modify(|w| w.set_jqdis(true));
        adc.jsqr().write(|w| w.set_jsq(0, input));
    }

    /// Acknowledges the interrupt.
    pub(crate) fn take_over() {
        ADC1.isr().write(|w| {
            w.set_jeoc(true);
            w.set_jeos(true);
        });
    }

    /// Triggers since the start, wrapping: in a tick, the number of its conversion. An interrupt that begins later than the next
    /// trigger, which means that a tick took two periods, reads one too many; the supervisor takes it for a missed tick.
    pub(crate) fn count() -> u32 {
        TIM2.cnt().read()
    }

    /// Of the last conversion, x and y.
    pub(crate) fn readings() -> [u16; 2] {
        [ADC1, ADC2].map(|adc| adc.jdr(0).read().jdata() as u16)
    }
}

/// The digital-to-analogue converter, and the line that lets the amplifiers act.
pub(crate) mod outputs {
    use super::{Peri, pac, peripherals};
    use board_machine::{CURRENT_FULL_SCALE_A, signed_currents_a};
    use embassy_stm32::gpio::{Level, Output, Speed};
    use pac::dac::vals::Mode;
    use pac::{DAC1, GPIOE, RCC};

    /// Of the line that lets the amplifiers act, in port E.
    pub(crate) const LINE: usize = 0;
    /// No current.
    const MIDDLE: u16 = 1 << 11;
    /// The trigger that is TRGO of timer 4.
    const TIM4_TRGO: u8 = 3;

    /// Off, and without current from the first trigger on.
    pub(crate) fn set_up(
        _converter: Peri<'static, peripherals::DAC1>,
        // Analogue from the reset on.
        _pins: (
            Peri<'static, peripherals::PA4>,
            Peri<'static, peripherals::PA5>,
        ),
        line: Peri<'static, peripherals::PE0>,
    ) {
        // For good: at the end of its driver the pin would be given back.
        core::mem::forget(Output::new(line, Level::Low, Speed::Low));
        RCC.apb1lenr().modify(|w| w.set_dac12en(true));
        for channel in 0..2 {
            DAC1.mcr()
                .modify(|w| w.set_mode(channel, Mode::NORMAL_EXT_BUFEN));
            DAC1.dhr12r(channel).write(|w| w.set_dhr(MIDDLE));
            DAC1.cr().modify(|w| {
                w.set_tsel(channel, TIM4_TRGO);
                w.set_ten(channel, true);
            });
            DAC1.cr().modify(|w| w.set_en(channel, true));
        }
    }

    /// The amplifiers act.
    pub(crate) fn switch_on() {
        GPIOE.bsrr().write(|w| w.set_bs(LINE, true));
    }

    /// They do not.
    pub(crate) fn switch_off() {
        GPIOE.bsrr().write(|w| w.set_br(LINE, true));
    }

    /// As the hardware has it.
    pub(crate) fn are_on() -> bool {
        GPIOE.odr().read().odr(LINE).to_bits() == 1
    }

    /// For the next trigger of the converters, which takes both over.
    pub(crate) fn set(force_n: [f32; 2]) {
        let codes = signed_currents_a(force_n).map(|current_a| {
            let code = f32::from(MIDDLE) * (1.0 + current_a / CURRENT_FULL_SCALE_A);
            (code as u16).min(2 * MIDDLE - 1)
        });
        DAC1.dhr12rd().write(|w| {
            w.set_dhr(0, codes[0]);
            w.set_dhr(1, codes[1]);
        });
    }
}

/// Timer 7 runs out unless each tick restarts it. Then DMA writes one word to the port of the line that lets the amplifiers act: no
/// instruction of the core takes part.
pub(crate) mod command_watch {
    use super::{CORE_HZ, Peri, TIMER_HZ, outputs, pac, peripherals};
    use board_machine::{TICK_HZ, TICKS_TO_EXPIRY};
    use pac::dma::vals::{Dir, Pl, Size};
    use pac::timer::vals::Urs;
    use pac::{DMA1, DMAMUX1, GPIOE, RCC, TIM7};

    /// The request of timer 7's update, by the table of the multiplexer.
    const TIM7_UPDATE: u8 = 70;
    /// Of DMA 1, and of the multiplexer.
    const STREAM: usize = 0;
    /// Of the timer: a microsecond.
    const STEP_HZ: u32 = 1_000_000;
    /// From a tick to the expiry of its command.
    const STEPS: u32 = TICKS_TO_EXPIRY * (STEP_HZ / TICK_HZ);

    /// Resets the line: what DMA writes. In flash, where nothing changes it.
    static LINE_LOW: u32 = 1 << (16 + outputs::LINE);

    /// All but the start.
    pub(crate) fn set_up(
        _timer: Peri<'static, peripherals::TIM7>,
        _stream: Peri<'static, peripherals::DMA1_CH0>,
    ) {
        RCC.ahb1enr().modify(|w| w.set_dma1en(true));
        RCC.apb1lenr().modify(|w| w.set_tim7en(true));
        DMAMUX1.ccr(STREAM).write(|w| w.set_dmareq_id(TIM7_UPDATE));
        let stream = DMA1.st(STREAM);
        stream.par().write_value(GPIOE.bsrr().as_ptr() as u32);
        stream.m0ar().write_value(&raw const LINE_LOW as u32);
        TIM7.psc().write_value((TIMER_HZ / STEP_HZ - 1) as u16);
        TIM7.arr().write(|w| w.set_arr((STEPS - 1) as u16));
        TIM7.cr1().write(|w| {
            w.set_opm(true);
            // A restart asks for nothing; running out does.
            w.set_urs(Urs::COUNTER_ONLY);
        });
        TIM7.dier().write(|w| w.set_ude(true));
    }

    /// Before outputs go on: one word to be written, and the time runs.
    pub(crate) fn arm() {
        let stream = DMA1.st(STREAM);
        stream.cr().modify(|w| w.set_en(false));
        while stream.cr().read().en() {}
        // A stream does not start with flags of its last transfer.
        DMA1.ifcr(STREAM / 4).write(|w| {
            w.set_tcif(STREAM, true);
            w.set_htif(STREAM, true);
            w.set_teif(STREAM, true);
            w.set_dmeif(STREAM, true);
            w.set_feif(STREAM, true);
        });
        stream.ndtr().write(|w| w.set_ndt(1));
        stream.cr().write(|w| {
            w.set_dir(Dir::MEMORY_TO_PERIPHERAL);
            w.set_psize(Size::BITS32);
            w.set_msize(Size::BITS32);
            w.set_pl(Pl::VERY_HIGH);
        });
        stream.cr().modify(|w| w.set_en(true));
        restart();
        TIM7.cr1().modify(|w| w.set_cen(true));
    }

    /// In each tick. Of a timer that has run out it starts nothing.
    pub(crate) fn restart() {
        TIM7.egr().write(|w| w.set_ug(true));
    }

    /// At boot, when triggers have come that took a current of zero over: outputs that are on and get no tick go off, and not too
    /// early.
    pub(crate) fn works() -> bool {
        let step = CORE_HZ / STEP_HZ;
        cortex_m::asm::delay(step * STEPS);
        arm();
        outputs::switch_on();
        // May wait for up to twice as long.
        cortex_m::asm::delay(step * STEPS / 4);
        let held = outputs::are_on();
        cortex_m::asm::delay(step * STEPS);
        let ended = !outputs::are_on();
        outputs::switch_off();
        held && ended
    }
}

/// Backup registers: they keep what they hold over resets, and without power where a battery is at VBAT.
pub(crate) mod backup {
    use super::{Peri, pac, peripherals};
    use board_machine::{RETAINED_WORDS, RetainedMemory};
    use pac::{PWR, RCC, RTC};

    pub(crate) struct Registers;

    /// They can be written to from here on.
    pub(crate) fn set_up(_clock: Peri<'static, peripherals::RTC>) -> Registers {
        RCC.apb4enr().modify(|w| w.set_rtcapben(true));
        PWR.cr1().modify(|w| w.set_dbp(true));
        Registers
    }

    impl RetainedMemory for Registers {
        fn word(&self, at: usize) -> u32 {
            RTC.bkpr(at % RETAINED_WORDS).read().bkp()
        }

        fn set_word(&mut self, at: usize, word: u32) {
            RTC.bkpr(at % RETAINED_WORDS).write(|w| w.set_bkp(word));
        }
    }
}
