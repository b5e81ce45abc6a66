//! The supervisor on an STM32G474 with RTIC: four magnets, whose currents are set by pulse widths.
//!
//! Timer 1 triggers both converters 20 000 times a second. The end of their conversion is the interrupt of the highest priority, in
//! which the supervisor ticks; idle time drains events and sends flight records away. `docs/src/supervisor/boards.md` says what both
//! examples have in common, and what a board has to do.
//!
//! | pin | use |
//! |---|---|
//! | PA0, PA1 | position x, y: 0 V to the reference voltage |
//! | PA8, PA9, PA10, PA11 | current of the magnets +x, −x, +y, −y: pulse widths at 100 kHz |
//! | PB12 | interlock: outputs act while it is high |
//! | PC13 | request: a rising edge switches the bearing on, low switches it off |
//! | PB0 | coast down: high asks the machine for it |
//! | PA2 | flight records, 921 600 baud |
#![no_std]
#![no_main]

mod board;
mod clocks;

use core::panic::PanicInfo;

/// Nothing here panics on purpose. What does so all the same switches the outputs off, and the watchdog resets the chip.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    board::outputs::switch_off();
    loop {
        cortex_m::asm::nop();
    }
}

#[rtic::app(device = stm32_metapac, peripherals = false)]
mod app {
    use crate::board::{self, backup, command_watch, outputs, sampling, serial, watchdog};
    use crate::clocks;
    use board_machine::{
        CONFIG, Control, Landings, Liveness, RECORD, Request, Switch, TICK_HZ, position_m,
    };
    use supervisor::{Events, Reader, Record, Stamp, Supervisor};

    static LIVENESS: Liveness = Liveness::new();

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        control: Control,
        switch: Switch,
        reader: Reader<'static, f32, RECORD>,
        landings: Option<Landings<backup::Registers>>,
    }

    #[init]
    fn init(_: init::Context) -> (Shared, Local) {
        clocks::to_170_mhz();
        board::pins();
        outputs::set_up();
        command_watch::set_up();
        serial::set_up();
        // Before the bearing is switched on: a parameter out of range must not get into operation, and a processor that computes
        // something else must not drive a magnet.
        let Ok(supervisor) = Supervisor::new(&CONFIG) else {
            stay_off("a parameter is out of its range\n");
        };
        // In a place of its own, which is no initial data in flash and no stack.
        let Some(supervisor) = cortex_m::singleton!(: Supervisor<RECORD> = supervisor) else {
            stay_off("started twice\n");
        };
        let (mut ticker, reader) = supervisor.split();
        if !ticker.self_test().passed {
            stay_off("the self-test does not pass on this processor\n");
        }
        let landings = landings();
        // With an open interlock nothing can be tried, and nothing can be switched on.
        while !board::interlock_is_closed() {}
        if !command_watch::works() {
            stay_off("the watch on the command does not switch off\n");
        }
        watchdog::start();
        sampling::start();
        let local = Local {
            control: Control::new(ticker),
            switch: Switch::default(),
            reader,
            landings,
        };
        (Shared {}, local)
    }

    /// Both coordinates are there. Sixteen is the highest priority: nothing interrupts it, and no lock of RTIC holds it.
    #[task(binds = ADC1_2, priority = 16, local = [control, switch])]
    fn tick(cx: tick::Context) {
        let tick::LocalResources {
            control, switch, ..
        } = cx.local;
        sampling::take_over();
        // By a counter that goes on when this interrupt does not.
        let sequence = sampling::count();
        let position_m = position_m(sampling::readings(), sampling::STEPS);
        match switch.request(board::request_is_up()) {
            Request::On => {
                command_watch::arm();
                outputs::switch_on();
            }
            Request::Off => outputs::switch_off(),
            Request::Nothing => {}
        }
        // As the hardware has it: the interlock and the watch on the command switch off by themselves.
        let force_n = control.tick(sequence, position_m, outputs::are_on());
        outputs::set(force_n);
        // The trigger that takes these pulse widths over is the next one; was it there already?
        control.handed_over(sampling::count() != sequence);
        command_watch::restart();
        LIVENESS.ticked();
    }

    /// Everything that has time.
    #[idle(local = [reader, landings])]
    fn idle(cx: idle::Context) -> ! {
        let idle::LocalResources {
            reader, landings, ..
        } = cx.local;
        let mut fed_at = 0;
        loop {
            feed(&mut fed_at);
            while let Some(event) = reader.next_event() {
                // Firmware would log the others.
                if event.events.contains(Events::COAST_DOWN) {
                    board::ask_to_coast_down();
                }
            }
            if let Some(record) = reader.record() {
                // First of all: sending takes its time.
                if let Some(landings) = landings {
                    landings.take_in(&record);
                }
                send(&record, &mut fed_at);
                reader.rearm();
            }
            // The next tick wakes it.
            cortex_m::asm::wfi();
        }
    }

    /// What the retainer bearing had borne at the last reset; `None` where nobody can say.
    fn landings() -> Option<Landings<backup::Registers>> {
        match Landings::at_boot(backup::set_up()) {
            Ok((landings, reported)) => {
                if reported.is_some() {
                    serial::send(board_machine::LANDINGS_MISSING);
                }
                Some(landings)
            }
            Err(_) => {
                serial::send(board_machine::LANDINGS_NOT_COUNTED);
                None
            }
        }
    }

    /// Tick and background are both alive: the one has counted, and the other is here.
    fn feed(fed_at: &mut u32) {
        if LIVENESS.may_feed(fed_at) {
            watchdog::feed();
        }
    }

    /// A section takes 8 ms on the line, a record of 512 entries about 0.3 s. Ticks go on, and leave it as it is.
    fn send(record: &Record<'_, f32, RECORD>, fed_at: &mut u32) {
        let at_sequence = sampling::count();
        let stamp = Stamp {
            firmware: 1,
            time_us: u64::from(at_sequence) * u64::from(1_000_000 / TICK_HZ),
            at_sequence,
        };
        for mut section in (0..).map_while(|index| record.section(index, &stamp)) {
            serial::send(section.seal());
            feed(fed_at);
        }
    }

    /// Outputs have never been on, and are not going to be.
    fn stay_off(why: &str) -> ! {
        serial::send(why.as_bytes());
        loop {
            cortex_m::asm::wfi();
        }
    }
}
