//! The supervisor on an STM32H743 with Embassy: two amplifiers of two directions, whose currents are set by voltages.
//!
//! Timer 4 triggers both converters 20 000 times a second. The end of their conversion is the interrupt of the highest priority, in
//! which the supervisor ticks: a plain interrupt and no task, since nothing may come between. The executor of the main thread has
//! the rest: it drains events and sends flight records away. `docs/src/supervisor/boards.md` says what both examples have in
//! common, and what a board has to do.
//!
//! | pin | use |
//! |---|---|
//! | PC0, PC1 | position x, y: 0 V to the reference voltage |
//! | PA4, PA5 | current along x, y: half of the reference voltage is none |
//! | PE0 | amplifiers act while it is high; pulled down on the board, and broken by the interlock |
//! | PC13 | request, by way of the interlock: a rising edge switches the bearing on, low switches it off |
//! | PB0 | coast down: high asks the machine for it |
//! | PD8 | flight records, 921 600 baud |
#![no_std]
#![no_main]

mod board;
mod clocks;

use board::{backup, command_watch, outputs, sampling};
use board_machine::{
    CONFIG, Control, LANDINGS_MISSING, LANDINGS_NOT_COUNTED, Landings, Liveness, RECORD, Request,
    Switch, TICK_HZ, WATCHDOG_MS, position_m,
};
use core::cell::Cell;
use core::panic::PanicInfo;
use critical_section::Mutex;
use embassy_executor::Spawner;
use embassy_stm32::gpio::{Input, Level, Output, Pull, Speed};
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::mode::Async;
use embassy_stm32::peripherals::{DMA1_CH1, IWDG1};
use embassy_stm32::usart::{self, UartTx};
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{bind_interrupts, dma, interrupt};
use embassy_time::{Duration, Ticker};
use supervisor::{Events, Reader, Stamp, Supervisor};

static LIVENESS: Liveness = Liveness::new();
/// The interrupt's own, on its way there: taken once.
static HANDED: Mutex<Cell<Option<Loop>>> = Mutex::new(Cell::new(None));

bind_interrupts!(struct Irqs {
    DMA1_STREAM1 => dma::InterruptHandler<DMA1_CH1>;
});

/// Nothing here panics on purpose. What does so all the same switches the outputs off, and the watchdog resets the chip.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    outputs::switch_off();
    loop {
        cortex_m::asm::nop();
    }
}

/// What the tick owns.
struct Loop {
    control: Control,
    switch: Switch,
    request: Input<'static>,
}

impl Loop {
    fn tick(&mut self) {
        sampling::take_over();
        // By a counter that goes on when this interrupt does not.
        let sequence = sampling::count();
        let position_m = position_m(sampling::readings(), sampling::STEPS);
        match self.switch.request(self.request.is_high()) {
            Request::On => {
                command_watch::arm();
                outputs::switch_on();
            }
            Request::Off => outputs::switch_off(),
            Request::Nothing => {}
        }
        // As the hardware has it: the watch on the command switches off by itself.
        let force_n = self.control.tick(sequence, position_m, outputs::are_on());
        outputs::set(force_n);
        // The trigger that takes these voltages over is the next one; was it there already?
        self.control.handed_over(sampling::count() != sequence);
        command_watch::restart();
        LIVENESS.ticked();
    }
}

/// Both coordinates are there.
#[interrupt]
fn ADC() {
    static mut LOOP: Option<Loop> = None;
    if LOOP.is_none() {
        *LOOP = critical_section::with(|cs| HANDED.borrow(cs).take());
    }
    if let Some(this) = LOOP {
        this.tick();
    }
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let p = embassy_stm32::init(clocks::config());
    // Flash is slow. The data cache stays off: DMA reads what the core has written.
    if let Some(mut core) = cortex_m::Peripherals::take() {
        core.SCB.enable_icache();
    }
    // Embassy's clock, which may wait for the tick as well.
    interrupt::TIM5.set_priority(Priority::P8);
    outputs::set_up(p.DAC1, (p.PA4, p.PA5), p.PE0);
    command_watch::set_up(p.TIM7, p.DMA1_CH0);
    let coast_down = Output::new(p.PB0, Level::Low, Speed::Low);
    let mut settings = usart::Config::default();
    settings.baudrate = 921_600;
    let Ok(mut serial) = UartTx::new(p.USART3, p.PD8, p.DMA1_CH1, Irqs, settings) else {
        return;
    };

    // Before the bearing is switched on: a parameter out of range must not get into operation, and a processor that computes
    // something else must not drive a magnet. To return from here leaves the outputs off.
    let Ok(supervisor) = Supervisor::new(&CONFIG) else {
        return say(&mut serial, b"a parameter is out of its range\n").await;
    };
    // In a place of its own, which is no initial data in flash and no stack.
    let Some(supervisor) = cortex_m::singleton!(: Supervisor<RECORD> = supervisor) else {
        return;
    };
    let (mut ticker, reader) = supervisor.split();
    if !ticker.self_test().passed {
        return say(
            &mut serial,
            b"the self-test does not pass on this processor\n",
        )
        .await;
    }
    let landings = match Landings::at_boot(backup::set_up(p.RTC)) {
        Ok((landings, reported)) => {
            if reported.is_some() {
                say(&mut serial, LANDINGS_MISSING).await;
            }
            Some(landings)
        }
        Err(_) => {
            say(&mut serial, LANDINGS_NOT_COUNTED).await;
            None
        }
    };
    sampling::start((p.ADC1, p.ADC2), (p.PC0, p.PC1), (p.TIM4, p.TIM2));
    if !command_watch::works() {
        return say(
            &mut serial,
            b"the watch on the command does not switch off\n",
        )
        .await;
    }
    let mut watchdog = IndependentWatchdog::new(p.IWDG1, 1000 * WATCHDOG_MS);
    watchdog.unleash();

    let control = Loop {
        control: Control::new(ticker),
        switch: Switch::default(),
        request: Input::new(p.PC13, Pull::Down),
    };
    critical_section::with(|cs| HANDED.borrow(cs).set(Some(control)));
    interrupt::ADC.set_priority(Priority::P0);
    // SAFETY: no critical section is open here, and what the interrupt takes over is there.
    unsafe { interrupt::ADC.enable() };
    background((reader, landings), watchdog, coast_down, serial).await
}

/// Everything that has time. Other tasks of the firmware run beside it; one that does not let go starves the watchdog.
async fn background(
    (mut reader, mut landings): (
        Reader<'static, f32, RECORD>,
        Option<Landings<backup::Registers>>,
    ),
    mut watchdog: IndependentWatchdog<'static, IWDG1>,
    mut coast_down: Output<'static>,
    mut serial: UartTx<'static, Async>,
) {
    let mut fed_at = 0;
    // Tick and background are both alive: the one has counted, and the other is here.
    let mut feed = || {
        if LIVENESS.may_feed(&mut fed_at) {
            watchdog.pet();
        }
    };
    let mut each_millisecond = Ticker::every(Duration::from_millis(1));
    loop {
        feed();
        while let Some(event) = reader.next_event() {
            // Firmware would log the others.
            if event.events.contains(Events::COAST_DOWN) {
                coast_down.set_high();
            }
        }
        if let Some(record) = reader.record() {
            // First of all: sending takes its time.
            if let Some(landings) = &mut landings {
                landings.take_in(&record);
            }
            let at_sequence = sampling::count();
            let stamp = Stamp {
                firmware: 1,
                time_us: u64::from(at_sequence) * u64::from(1_000_000 / TICK_HZ),
                at_sequence,
            };
            // A section takes 8 ms on the line, a record of 512 entries about 0.3 s. Ticks go on, and leave it as it is.
            for mut section in (0..).map_while(|index| record.section(index, &stamp)) {
                say(&mut serial, section.seal()).await;
                feed();
            }
            reader.rearm();
        }
        each_millisecond.next().await;
    }
}

/// What cannot be sent is lost; nobody waits for it.
async fn say(serial: &mut UartTx<'static, Async>, bytes: &[u8]) {
    let _: Result<(), usart::Error> = serial.write(bytes).await;
}
