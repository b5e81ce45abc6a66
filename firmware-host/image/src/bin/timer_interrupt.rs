//! Firmware as it could be, small enough to be read in one go: a timer interrupt ticks the supervisor at
//! 19 kHz, and the background drains its events and picks up its flight record. Each has its half of the supervisor, so that
//! neither locks the other out.
//!
//! The board is made up: `measured_position_m` stands for converter and position sensor, the levitation
//! controller is a spring, and the commanded force is kept where a driver of amplifiers would take it from. The
//! rotor falls onto its retainer bearing, whirls there for a while and comes back. What the bearing has borne is kept over
//! resets. Logs with defmt, and ends when the record has been read.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware {
    use core::cell::Cell;
    use core::sync::atomic::{AtomicU8, Ordering};
    use cortex_m::peripheral::SCB;
    use cortex_m::peripheral::syst::SystClkSource;
    use cortex_m_rt::{entry, exception};
    use critical_section::Mutex;
    use defmt::{error, info, warn};
    use firmware_image::{exit, planted};
    use supervisor::{
        Config, Events, IntegratorHint, LEDGER_BYTES, Ledger, LedgerError, QueuedEvent, Reader,
        Record, Sample, Stamp, Status, Supervisor, Ticker,
    };

    const CORE_HZ: u32 = 25_000_000;
    /// So that at 31 million instructions a second, where a landing is too much, ticks at rest leave some time to the background.
    const TICK_HZ: u32 = 19_000;
    /// Ticks that can be replayed: 6 ms, for a processor with 16 KiB of RAM. The slow track reaches farther.
    const RECORD: usize = 128;

    const CONFIG: Config = Config {
        sample_period_s: 1.0 / TICK_HZ as f32,
        clearance_m: CLEARANCE_M,
        observer_pole_flight: 0.5,
        observer_pole_contact: 0.2,
        position_limit: 4.0,
        whirl_time_s: 2e-3,
        handover_dwell_s: 1e-3,
        speed_max_m_s: 2.0,
        ..Config::example()
    };
    const CLEARANCE_M: f32 = 2e-4;

    /// Two copies of the ledger of landings. RAM that the start-up leaves as it is stands for EEPROM, FRAM or flash, which keep it
    /// without power, too.
    #[unsafe(link_section = ".uninit.LEDGER")]
    static KEPT: [LedgerCopy; 2] = [const { [const { AtomicU8::new(0) }; LEDGER_BYTES] }; 2];
    type LedgerCopy = [AtomicU8; LEDGER_BYTES];

    /// The interrupt's own, on its way there: taken once.
    static HANDED: Mutex<Cell<Option<Control>>> = Mutex::new(Cell::new(None));

    struct Control {
        supervisor: Ticker<'static, RECORD>,
        sequence: u32,
        /// The last command came when the next period had begun.
        late: bool,
        hint: IntegratorHint,
        /// Commands to the amplifiers \[N\].
        force_n: [f32; 2],
    }

    impl Control {
        /// What the interrupt does. Whatever the sensor reads goes in: judging it is the supervisor's task.
        fn tick(&mut self) {
            self.sequence = self.sequence.wrapping_add(1);
            let position_m = measured_position_m(self.sequence);
            let mut status = Status::SPIN_VALID | Status::BEARING_ON;
            status.set(Status::LATE, self.late);
            let command = self.supervisor.tick(&Sample {
                sequence: self.sequence,
                status,
                position_m,
                spin_rad_s: 1000.0,
                levitation_n: levitation_n(position_m, self.hint),
                ..Sample::default()
            });
            // For the controller's next tick.
            self.hint = command.integrator;
            self.force_n = command.force_n;
            // The interrupt pends anew: since this one began, another period has.
            self.late = SCB::is_pendst_pending();
        }
    }

    #[exception]
    fn SysTick() {
        static mut CONTROL: Option<Control> = None;
        if CONTROL.is_none() {
            *CONTROL = critical_section::with(|cs| HANDED.borrow(cs).take());
        }
        if let Some(control) = CONTROL {
            control.tick();
        }
    }

    #[entry]
    fn main() -> ! {
        planted();
        let Some(mut peripherals) = cortex_m::Peripherals::take() else {
            exit::failure()
        };
        // Before the bearing is switched on: a parameter out of range must not get into operation.
        let supervisor = match Supervisor::new(&CONFIG) {
            Ok(supervisor) => supervisor,
            Err(parameter) => {
                error!("{}", parameter);
                exit::failure()
            }
        };
        // In a place of its own, which is no initial data in flash and no stack.
        let Some(supervisor) = cortex_m::singleton!(: Supervisor<RECORD> = supervisor) else {
            exit::failure()
        };
        let (mut ticker, reader) = supervisor.split();
        let ledger = kept_ledger();
        // A processor that computes something else must not drive a magnet.
        if !ticker.self_test().passed {
            error!("the self-test does not pass on this processor");
            exit::failure();
        }
        let control = Control {
            supervisor: ticker,
            sequence: 0,
            late: false,
            hint: IntegratorHint::Run,
            force_n: [0.0; 2],
        };
        critical_section::with(|cs| HANDED.borrow(cs).set(Some(control)));
        let timer = &mut peripherals.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(CORE_HZ / TICK_HZ - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
        background(reader, ledger)
    }

    /// What the retainer bearing had borne when the power was switched on; `None` where nobody can say.
    fn kept_ledger() -> Option<Ledger> {
        let copies = (KEPT.each_ref())
            .map(|place| place.each_ref().map(|byte| byte.load(Ordering::Relaxed)));
        let [first, second] = &copies;
        let (ledger, other) = match Ledger::newer([first, second]) {
            Ok(found) => found,
            // A service tool would do this, when the bearing is fitted.
            Err(LedgerError::Blank) => {
                let fitted = Ledger::new(1, CONFIG.severity_limit);
                KEPT.iter().for_each(|place| write(place, &fitted));
                (fitted, None)
            }
            // Nothing is written over: what is left may still be read by a person.
            Err(why) => {
                error!("ledger of landings: {}", why);
                return None;
            }
        };
        if let Some(why) = other {
            warn!("ledger of landings, the last may be missing: {}", why);
        }
        info!(
            "bearing {}: {} landings so far",
            ledger.bearing, ledger.landings
        );
        Some(ledger)
    }

    fn write(place: &LedgerCopy, ledger: &Ledger) {
        for (byte, value) in place.iter().zip(ledger.to_bytes()) {
            byte.store(value, Ordering::Relaxed);
        }
    }

    /// Adds a record, before it is given back, and writes the older of both copies anew: where power fails meanwhile, the other one
    /// is whole.
    fn keep(ledger: &mut Ledger, record: &Record<'_, f32, RECORD>) {
        if ledger.take_in(record) {
            let [even, odd] = &KEPT;
            let place = if ledger.updates & 1 == 0 { even } else { odd };
            write(place, ledger);
        }
        info!("bearing {}: {} landings", ledger.bearing, ledger.landings);
    }

    /// Everything that has time.
    fn background(mut reader: Reader<'static, f32, RECORD>, mut ledger: Option<Ledger>) -> ! {
        loop {
            while let Some(event) = reader.next_event() {
                log(event);
            }
            if let Some(record) = reader.record() {
                if let Some(ledger) = &mut ledger {
                    keep(ledger, &record);
                }
                pick_up(&record);
                reader.rearm();
                if let Some(report) = reader.published().report() {
                    info!("{}", report);
                }
                exit::success();
            }
            cortex_m::asm::wfi();
        }
    }

    /// Firmware would write it to flash or a bus. Ticks go on meanwhile: the record stays as it is until it is given back.
    fn pick_up(record: &Record<'_, f32, RECORD>) {
        const STAMP: Stamp = Stamp {
            firmware: 1,
            time_us: 0,
            at_sequence: 0,
        };
        let (mut sections, mut bytes) = (0, 0);
        while let Some(mut section) = record.section(sections, &STAMP) {
            bytes += section.seal().len();
            sections += 1;
        }
        info!(
            "record of version {}, {} sections, {} bytes",
            supervisor::RECORD_VERSION,
            sections,
            bytes
        );
    }

    fn log(
        QueuedEvent {
            sequence,
            mode,
            events,
        }: QueuedEvent,
    ) {
        const SERIOUS: Events = Events::ENGAGED
            .union(Events::SENSOR_FAULT)
            .union(Events::COAST_DOWN)
            .union(Events::QUEUE_FULL);
        // The report counts late ticks. To log each of them would make more: nothing interrupts the logger.
        let events = events - Events::LATE;
        if events.is_empty() {
            return;
        }
        if events.intersects(SERIOUS) {
            warn!("tick {}: {}, {}", sequence, events, mode);
        } else {
            info!("tick {}: {}, {}", sequence, events, mode);
        }
    }

    /// A controller of no use but to have one: a spring with an integrator would obey the hint here.
    fn levitation_n([x, y]: [f32; 2], _hint: IntegratorHint) -> [f32; 2] {
        const SPRING_N_M: f32 = 3e6;
        [-SPRING_N_M * x, -SPRING_N_M * y]
    }

    /// Stands for the sensor. In ticks: 200 in the middle, 40 to the wall, 120 of backward whirl on it, back
    /// in 100, and rest.
    fn measured_position_m(tick: u32) -> [f32; 2] {
        const OUT: u32 = 200;
        const WALL: u32 = OUT + 40;
        const BACK: u32 = WALL + 120;
        const REST: u32 = BACK + 100;
        /// A turn by 0.1 rad, backward: 0.4 m/s on the wall.
        const TURN: [f32; 2] = [0.995_004_2, -0.099_833_4];
        let share = |from: u32, ticks: u32| (tick - from) as f32 / ticks as f32;
        let radius = if tick < OUT {
            0.0
        } else if tick < WALL {
            share(OUT, WALL - OUT)
        } else if tick < BACK {
            1.02
        } else if tick < REST {
            1.0 - share(BACK, REST - BACK)
        } else {
            0.0
        };
        let turns = if tick < REST {
            tick.clamp(WALL, BACK) - WALL
        } else {
            0
        };
        let [mut x, mut y] = [radius * CLEARANCE_M, 0.0];
        for _ in 0..turns {
            let [cos, sin] = TURN;
            (x, y) = (cos * x - sin * y, sin * x + cos * y);
        }
        // A converter's last digit.
        let digit_m = 1e-7 * (tick & 1) as f32;
        [x + digit_m, y - digit_m]
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
