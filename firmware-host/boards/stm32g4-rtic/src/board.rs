//! Registers: what each part of the chip is set up to, and why.

use crate::clocks::CORE_HZ;
use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{Moder, Ospeedr, Ot, Pupdr};
use stm32_metapac::{GPIOA, GPIOB, GPIOC, RCC};

/// Hands pins to their peripherals. Those of the converters are analogue from the reset on.
pub(crate) fn pins() {
    RCC.ahb2enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
    });
    for (pin, timer_1) in [(8, 6), (9, 6), (10, 6), (11, 11)] {
        alternate(GPIOA, pin, timer_1);
    }
    alternate(GPIOA, 2, 7);
    // An interlock whose wire is broken is open.
    GPIOB.pupdr().modify(|w| w.set_pupdr(12, Pupdr::PULL_DOWN));
    alternate(GPIOB, 12, 6);
    GPIOC.pupdr().modify(|w| w.set_pupdr(13, Pupdr::PULL_DOWN));
    GPIOC.moder().modify(|w| w.set_moder(13, Moder::INPUT));
    GPIOB.moder().modify(|w| w.set_moder(0, Moder::OUTPUT));
}

fn alternate(port: Gpio, pin: usize, function: u8) {
    port.afr(pin / 8).modify(|w| w.set_afr(pin % 8, function));
    port.otyper().modify(|w| w.set_ot(pin, Ot::PUSH_PULL));
    port.ospeedr()
        .modify(|w| w.set_ospeedr(pin, Ospeedr::HIGH_SPEED));
    port.moder().modify(|w| w.set_moder(pin, Moder::ALTERNATE));
}

/// As the pin reads; that it acts on the outputs is the break input's doing.
pub(crate) fn interlock_is_closed() -> bool {
    GPIOB.idr().read().idr(12).to_bits() == 1
}

/// Whether the machine wants the bearing on.
pub(crate) fn request_is_up() -> bool {
    GPIOC.idr().read().idr(13).to_bits() == 1
}

/// Until the next reset.
pub(crate) fn ask_to_coast_down() {
    GPIOB.bsrr().write(|w| w.set_bs(0, true));
}

/// Timer 1: four pulse widths, and the break that ends them.
pub(crate) mod outputs {
    use super::{CORE_HZ, RCC};
    use board_machine::{CURRENT_FULL_SCALE_A, Magnets, TICK_HZ};
    use stm32_metapac::timer::regs::BdtrAdv;
    use stm32_metapac::timer::vals::{Mms, Ocm};
    use stm32_metapac::{SYSCFG, TIM1};

    /// Periods of the pulses in one of the tick: 100 kHz.
    const PULSES: u32 = 5;
    /// Steps of a pulse width.
    const STEPS: u32 = CORE_HZ / (PULSES * TICK_HZ);

    /// What the register says while outputs are off: pins are driven low (OSSI), the break input acts (BKE) and is active low, and
    /// nobody changes that before the next reset (LOCK = 1). In flash, from where DMA fetches it when the command expires.
    pub(crate) static OFF: u32 = OSSI | BKE | LOCK_1;
    const LOCK_1: u32 = 1 << 8;
    const OSSI: u32 = 1 << 10;
    const BKE: u32 = 1 << 12;
    const MAIN_OUTPUT_ENABLE: u32 = 1 << 15;

    /// All but the start.
    pub(crate) fn set_up() {
        RCC.apb2enr().modify(|w| {
            w.set_tim1en(true);
            w.set_syscfgen(true);
        });
        // A core that has locked up is a break, too.
        SYSCFG.cfgr2().modify(|w| w.set_cll(true));
        TIM1.arr().write(|w| w.set_arr((STEPS - 1) as u16));
        // Pulse widths are taken over, and converters triggered, once in so many periods.
        TIM1.rcr().write(|w| w.set_rep((PULSES - 1) as u16));
        TIM1.cr2().write(|w| w.set_mms(Mms::UPDATE));
        for channel in 0..4 {
            TIM1.ccmr_output(channel / 2).modify(|w| {
                w.set_ocm(channel % 2, Ocm::PWM_MODE1);
                w.set_ocpe(channel % 2, true);
            });
            TIM1.ccer().modify(|w| w.set_cce(channel, true));
        }
        TIM1.bdtr().write_value(BdtrAdv(OFF));
        // Period and repetitions hold from an update on.
        TIM1.egr().write(|w| w.set_ug(true));
    }

    /// Without effect while the interlock is open.
    pub(crate) fn switch_on() {
        TIM1.bdtr().write_value(BdtrAdv(OFF | MAIN_OUTPUT_ENABLE));
    }

    /// No current in any magnet, not even the bias.
    pub(crate) fn switch_off() {
        TIM1.bdtr().write_value(BdtrAdv(OFF));
    }

    /// As the hardware has it.
    pub(crate) fn are_on() -> bool {
        TIM1.bdtr().read().moe()
    }

    /// For the next trigger of the converters, which takes it over.
    pub(crate) fn set(force_n: [f32; 2]) {
        for (channel, current_a) in Magnets::currents_a(force_n).into_iter().enumerate() {
            let width = current_a / CURRENT_FULL_SCALE_A * STEPS as f32;
            TIM1.ccr(channel).write(|w| w.set_ccr(width as u16));
        }
    }
}

/// Timer 1 triggers converters 1 and 2, which sample x and y at one instant; timer 2 counts the triggers.
pub(crate) mod sampling {
    use super::{CORE_HZ, RCC};
    use stm32_metapac::adc::Adc;
    use stm32_metapac::adc::vals::{Exten, SampleTime};
    use stm32_metapac::adccommon::vals::{Ckmode, Dual};
    use stm32_metapac::timer::vals::{Sms, Ts};
    use stm32_metapac::{ADC1, ADC2, ADC12_COMMON, TIM1, TIM2};

    /// Of a converter: twelve bits.
    pub(crate) const STEPS: u32 = 1 << 12;

    /// The trigger of injected conversions that is TRGO of timer 1.
    const TIM1_TRGO: u8 = 0;

    /// Converters first, then what counts, then what triggers.
    pub(crate) fn start() {
        RCC.ahb2enr().modify(|w| w.set_adc12en(true));
        RCC.apb1enr1().modify(|w| w.set_tim2en(true));
        ADC12_COMMON.ccr().modify(|w| {
            // From the bus, so that the trigger is at the same clock of each period: 42.5 MHz.
            w.set_ckmode(Ckmode::SYNC_DIV4);
            w.set_dual(Dual::DUAL_J);
        });
        // PA0 is input 1 of both, PA1 input 2.
        prepare(ADC1, 1);
        prepare(ADC2, 2);
        // The first converter's trigger is that of both, and so is its start.
        ADC1.jsqr().modify(|w| {
            w.set_jextsel(TIM1_TRGO);
            w.set_jexten(Exten::RISING_EDGE);
        });
        ADC1.ier().write(|w| w.set_jeosie(true));
        ADC1.cr().modify(|w| w.set_jadstart(true));

        // Internal trigger 0 of timer 2 is TRGO of timer 1.
        TIM2.smcr().modify(|w| {
            w.set_ts(Ts::ITR0);
            w.set_sms(Sms::EXT_CLOCK_MODE);
        });
        TIM2.cr1().modify(|w| w.set_cen(true));
        TIM1.cr1().modify(|w| w.set_cen(true));
    }

    /// Out of power-down, calibrated, on, with one input.
    fn prepare(adc: Adc, input: u8) {
        adc.cr().modify(|w| w.set_deeppwd(false));
        adc.cr().modify(|w| w.set_advregen(true));
        // The regulator takes 20 µs.
        cortex_m::asm::delay(CORE_HZ / 1_000_000 * 20);
        adc.cr().modify(|w| w.set_adcal(true));
        while adc.cr().read().adcal() {}
        // Four clocks of the converter have to pass.
        cortex_m::asm::delay(CORE_HZ / 1_000_000);
        adc.cr().modify(|w| w.set_aden(true));
        while !adc.isr().read().adrdy() {}
        // 0.3 µs; the conversion takes as long.
        adc.smpr()
            .modify(|w| w.set_smp(usize::from(input), SampleTime::CYCLES12_5));
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
        [ADC1, ADC2].map(|adc| adc.jdr(0).read().jdata())
    }
}

/// Timer 7 runs out unless each tick restarts it. Then DMA writes one word over timer 1's main output enable: no instruction of the
/// core takes part.
pub(crate) mod command_watch {
    use super::{CORE_HZ, RCC, outputs};
    use board_machine::{TICK_HZ, TICKS_TO_EXPIRY};
    use stm32_metapac::bdma::vals::{Dir, Pl, Size};
    use stm32_metapac::timer::vals::Urs;
    use stm32_metapac::{DMA1, DMAMUX1, TIM1, TIM7};

    /// The request of timer 7's update, by the table of the multiplexer.
    const TIM7_UPDATE: u8 = 9;
    /// Its first channel goes to channel 1 of DMA 1, which has the number 0 here.
    const CHANNEL: usize = 0;
    /// Of the timer: a microsecond.
    const STEP_HZ: u32 = 1_000_000;
    /// From a tick to the expiry of its command.
    const STEPS: u32 = TICKS_TO_EXPIRY * (STEP_HZ / TICK_HZ);

    /// All but the start.
    pub(crate) fn set_up() {
        RCC.ahb1enr().modify(|w| {
            w.set_dma1en(true);
            w.set_dmamux1en(true);
        });
        RCC.apb1enr1().modify(|w| w.set_tim7en(true));
        DMAMUX1.ccr(CHANNEL).write(|w| w.set_dmareq_id(TIM7_UPDATE));
        let channel = DMA1.ch(CHANNEL);
        channel.par().write_value(TIM1.bdtr().as_ptr() as u32);
        channel.mar().write_value(&raw const outputs::OFF as u32);
        TIM7.psc().write_value((CORE_HZ / STEP_HZ - 1) as u16);
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
        let channel = DMA1.ch(CHANNEL);
        channel.cr().modify(|w| w.set_en(false));
        channel.ndtr().write(|w| w.set_ndt(1));
        channel.cr().write(|w| {
            w.set_dir(Dir::FROM_MEMORY);
            w.set_psize(Size::BITS32);
            w.set_msize(Size::BITS32);
            w.set_pl(Pl::VERY_HIGH);
            w.set_en(true);
        });
        restart();
        TIM7.cr1().modify(|w| w.set_cen(true));
    }

    /// In each tick. Of a timer that has run out it starts nothing.
    pub(crate) fn restart() {
        TIM7.egr().write(|w| w.set_ug(true));
    }

    /// At boot, with pulse widths of zero: outputs that are on and get no tick go off, and not too early.
    pub(crate) fn works() -> bool {
        let step = CORE_HZ / STEP_HZ;
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

/// The independent watchdog, on an oscillator of its own.
pub(crate) mod watchdog {
    use board_machine::WATCHDOG_MS;
    use stm32_metapac::IWDG;
    use stm32_metapac::iwdg::vals::{Key, Pr};

    /// Nothing but a reset ends it.
    pub(crate) fn start() {
        IWDG.kr().write(|w| w.set_key(Key::START));
        IWDG.kr().write(|w| w.set_key(Key::ENABLE));
        // 32 kHz / 32: a millisecond.
        IWDG.pr().write(|w| w.set_pr(Pr::DIVIDE_BY32));
        IWDG.rlr().write(|w| w.set_rl((WATCHDOG_MS - 1) as u16));
        while IWDG.sr().read().0 != 0 {}
        feed();
    }

    /// From the background alone.
    pub(crate) fn feed() {
        IWDG.kr().write(|w| w.set_key(Key::RESET));
    }
}

/// A line to whatever writes records down.
pub(crate) mod serial {
    use super::{CORE_HZ, RCC};
    use stm32_metapac::USART2;

    /// Sending alone.
    pub(crate) fn set_up() {
        const BAUD: u32 = 921_600;
        RCC.apb1enr1().modify(|w| w.set_usart2en(true));
        USART2.brr().write(|w| w.set_brr((CORE_HZ / BAUD) as u16));
        USART2.cr1().write(|w| {
            w.set_ue(true);
            w.set_te(true);
        });
    }

    /// Waits for the line, 11 µs a byte.
    pub(crate) fn send(bytes: &[u8]) {
        for byte in bytes {
            while !USART2.isr().read().txe() {}
            USART2.tdr().write(|w| w.set_dr(u16::from(*byte)));
        }
    }
}

/// Backup registers: they keep what they hold over resets, and without power where a battery is at VBAT.
pub(crate) mod backup {
    use super::RCC;
    use board_machine::{RETAINED_WORDS, RetainedMemory};
    use stm32_metapac::{PWR, TAMP};

    pub(crate) struct Registers;

    /// After the clocks: they can be written to from here on. A reset of the core leaves them and this as they are.
    pub(crate) fn set_up() -> Registers {
        RCC.apb1enr1().modify(|w| w.set_rtcapben(true));
        PWR.cr1().modify(|w| w.set_dbp(true));
        Registers
    }

    impl RetainedMemory for Registers {
        fn word(&self, at: usize) -> u32 {
            TAMP.bkpr(at % RETAINED_WORDS).read().bkp()
        }

        fn set_word(&mut self, at: usize, word: u32) {
            TAMP.bkpr(at % RETAINED_WORDS).write(|w| w.set_bkp(word));
        }
    }
}
