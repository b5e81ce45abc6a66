//! The calls as C makes them, for a checker of memory accesses, as in
//! `RUSTFLAGS=-Zsanitizer=address cargo +nightly test -p supervisor-capi --test memory --target …`.
//! What they return is tested from C, by the test `capi`.

use core::mem::MaybeUninit;
use std::ptr::{null, null_mut};
use supervisor::{Config, LEDGER_BYTES, PARAMETERS, Status};
use supervisor_capi::archive::*;
use supervisor_capi::bearing::*;
use supervisor_capi::calls::*;
use supervisor_capi::ledger::*;
use supervisor_capi::rotor::*;
use supervisor_capi::structs::*;
use supervisor_capi::watch::*;
use supervisor_capi::{ArchiveStorage, Code, RECORD, RotorStorage, Shelf, Storage, WatchStorage};

/// Memory as C has it.
#[repr(C, align(8))]
struct Memory([u8; 29184]);

/// Memory of two archives of one event each.
struct Archived {
    archives: Box<[[u64; 8]; 2]>,
    places: Box<[[u64; size_of::<Shelf>() / 8]; 2]>,
}

impl Archived {
    fn new() -> Self {
        Self {
            archives: Box::new([[0; 8]; 2]),
            places: Box::new([[0; size_of::<Shelf>() / 8]; 2]),
        }
    }

    fn pointers(&mut self, of: usize) -> (*mut ArchiveStorage, *mut Shelf) {
        let archive = (&raw mut self.archives[of]).cast();
        (archive, (&raw mut self.places[of]).cast())
    }
}

const VALUES: [f32; PARAMETERS.len()] = Config {
    stiffness_n_m: 0.0,
    amplifier_lag_s: 0.0,
    observer_pole_flight: 0.5,
    observer_pole_contact: 0.2,
    position_limit: 4.0,
    whirl_time_s: 2e-3,
    handover_dwell_s: 1e-3,
    fault_blend_s: 1e-3,
    fault_ticks: 10.0,
    contact_stiffness_n_m: 2e8,
    speed_max_m_s: 2.0,
    sensor_step_m: 1e-8,
    ..Config::example()
}
.values();

const SHAFT: CShaft = CShaft {
    mass_kg: 20.0,
    transverse_inertia_kg_m2: 0.8,
    polar_inertia_kg_m2: 0.5,
    retainer_m: [-0.2, 0.22],
    sensor_m: [-0.19, 0.21],
    magnet_m: [-0.17, 0.19],
};

/// All but its number, of a rotor in the middle.
fn in_the_middle() -> CSample {
    CSample {
        status: (Status::BEARING_ON | Status::SPIN_VALID | Status::LEVITATED_BEFORE).bits(),
        ..CSample::default()
    }
}

#[track_caller]
fn ok(code: Code) {
    assert_eq!(code, Code::OK);
}

/// Takes sections until there are no more.
fn more_than_a_few(take: impl FnMut(u32) -> Code) {
    let sections = (0..).map(take).take_while(|code| *code == Code::OK);
    assert!(sections.count() > RECORD / 32);
}

/// Onto the wall, a while there, and back.
fn way_m(tick: usize) -> f32 {
    let out = (tick as f32 * 5e-5).min(2e-4);
    let back = (tick.saturating_sub(60) as f32 * 2e-6).min(out);
    out - back + 1e-7 * (tick % 3) as f32
}

/// Requirement: SR-37
#[test]
fn calls_touch_only_what_they_were_given() {
    let mut memory = Box::new(Memory([0; 29184]));
    let size = size_of::<Memory>();
    let plane: *mut Storage = (&raw mut *memory).cast();
    let mut command = CCommand::default();
    let mut sample = in_the_middle();
    let mut event = MaybeUninit::<CEvent>::uninit();
    let mut section = MaybeUninit::<CSection>::uninit();
    let stamp = CStamp::default();
    let mut report = MaybeUninit::<CReport>::uninit();
    let mut row = MaybeUninit::<CParameter>::uninit();
    let mut index = 0;
    // SAFETY: every pointer is null, misaligned, or points to what its type says; the memory is zero, and
    // used through these calls alone.
    unsafe {
        let code = amb_tick(plane, &raw const sample, &raw mut command);
        assert_eq!(code, Code::ERROR_NOT_INITIALISED);
        let count = PARAMETERS.len();
        ok(amb_init(plane, size, VALUES.as_ptr(), count));
        // Twice: the first one is replaced.
        ok(amb_init(plane, size, VALUES.as_ptr(), count));
        let code = amb_init(null_mut(), size, null(), count);
        assert_eq!(code, Code::ERROR_SUPERVISOR_NULL);
        let take = |index, section: &mut MaybeUninit<CSection>| {
            let section = section.as_mut_ptr();
            amb_record_section(plane, index, &raw const stamp, section)
        };
        // Outwards at 1 m/s and then in the middle, until a record is frozen.
        let mut ticks = 0;
        while take(0, &mut section) == Code::NOTHING {
            sample.sequence += 1;
            sample.position_m[0] = way_m(ticks);
            ticks += 1;
            ok(amb_tick(plane, &raw const sample, &raw mut command));
            assert!(ticks < 10 * RECORD);
        }
        more_than_a_few(|i| take(i, &mut section));
        ok(amb_next_event(plane, event.as_mut_ptr()));
        ok(amb_report_now(plane, report.as_mut_ptr()));
        assert_eq!(report.assume_init().landings, 1);
        let mut ledger = Box::new(CLedger::default());
        let ledger = &raw mut *ledger;
        let mut bytes = Box::new([0_u8; LEDGER_BYTES]);
        let bytes = bytes.as_mut_ptr();
        ok(amb_ledger_new(7, 20.0, ledger));
        ok(amb_ledger_take_in(ledger, plane));
        assert_eq!(amb_ledger_take_in(ledger, plane), Code::NOTHING);
        ok(amb_ledger_write(ledger, bytes, LEDGER_BYTES));
        ok(amb_ledger_read(bytes, LEDGER_BYTES, ledger));
        ok(amb_ledger_newer(bytes, bytes, LEDGER_BYTES, ledger));
        let mut left = 0;
        ok(amb_ledger_landings_left(ledger, 1.0, &raw mut left));
        assert!(((*ledger).landings, (*ledger).bearing) == (1, 7) && left < 20);
        let mut kept = Archived::new();
        let (archive, places) = kept.pointers(0);
        ok(amb_archive_init(archive, places, 1));
        ok(amb_archive_take(archive, plane));
        assert_eq!(amb_archive_take(archive, plane), Code::NOTHING);
        let mut count = 0;
        ok(amb_archive_count(archive, &raw mut count));
        assert_eq!(count, 1);
        let section = section.as_mut_ptr();
        more_than_a_few(|i| amb_archive_section(archive, i, &raw const stamp, section));
        ok(amb_archive_discard(archive));
        ok(amb_rearm(plane));
        let code = amb_parameter_index(c"sensor_step_m".as_ptr(), &raw mut index);
        ok(code);
        ok(amb_parameter_at(index, row.as_mut_ptr()));
        assert_eq!(row.assume_init().low, 1e-9);
        let count = PARAMETERS.len();
        ok(amb_reconfigure(plane, VALUES.as_ptr(), count));
        ok(amb_self_test(plane));
        let off = (&raw mut command).cast::<u8>().wrapping_add(1).cast();
        let code = amb_tick(plane, &raw const sample, off);
        assert_eq!(code, Code::ERROR_COMMAND_MISALIGNED);
    }
}

/// Requirement: SR-37
#[test]
fn calls_on_a_rotor_touch_only_what_they_were_given() {
    let mut memory = Box::new([Memory([0; 29184]), Memory([0; 29184])]);
    let size = size_of::<[Memory; 2]>();
    let rotor: *mut RotorStorage = (&raw mut *memory).cast();
    let values = Box::new([VALUES; 2]);
    let values: *const f32 = (&raw const *values).cast();
    let count = 2 * PARAMETERS.len();
    let shaft = SHAFT;
    let mut samples = Box::new([in_the_middle(); 2]);
    let mut command = CRotorCommand::default();
    let mut event = MaybeUninit::<CEvent>::uninit();
    let mut section = MaybeUninit::<CSection>::uninit();
    let stamp = CStamp::default();
    let mut report = MaybeUninit::<CReport>::uninit();
    // SAFETY: every pointer points to what its type says; the memory is zero, and used through these calls alone.
    unsafe {
        let tick = |samples: &[CSample; 2], command: &mut CRotorCommand| {
            amb_rotor_tick(rotor, (&raw const *samples).cast(), &raw mut *command)
        };
        let code = tick(&samples, &mut command);
        assert_eq!(code, Code::ERROR_ROTOR_NOT_INITIALISED);
        ok(amb_rotor_init(rotor, size, &raw const shaft, values, count));
        let mut take = |plane, index| {
            let section = section.as_mut_ptr();
            amb_rotor_record_section(rotor, plane, index, &raw const stamp, section)
        };
        let mut ticks = 0;
        while take(0, 0) == Code::NOTHING {
            for sample in samples.iter_mut() {
                sample.sequence += 1;
                sample.position_m[0] = way_m(ticks);
            }
            ticks += 1;
            ok(tick(&samples, &mut command));
            assert!(ticks < 10 * RECORD);
        }
        for plane in [0, 1] {
            more_than_a_few(|i| take(plane, i));
            ok(amb_rotor_next_event(rotor, plane, event.as_mut_ptr()));
            ok(amb_rotor_report_now(rotor, plane, report.as_mut_ptr()));
            assert_eq!(report.assume_init().landings, 1);
            let mut ledger = Box::new(CLedger::default());
            let ledger = &raw mut *ledger;
            ok(amb_ledger_new(plane, 20.0, ledger));
            let code = amb_ledger_take_in_plane(ledger, rotor, plane);
            assert_eq!((code, (*ledger).landings), (Code::OK, 1));
        }
        let mut kept = Archived::new();
        let ((first, places), (second, others)) = (kept.pointers(0), kept.pointers(1));
        ok(amb_archive_init(first, places, 1));
        ok(amb_archive_init(second, others, 1));
        let code = amb_archive_take_rotor(first, first, rotor);
        assert_eq!(code, Code::ERROR_ARCHIVE_BUSY);
        ok(amb_archive_take_rotor(first, second, rotor));
        for archive in [first, second] {
            let stamp = &raw const stamp;
            ok(amb_archive_section(archive, 0, stamp, section.as_mut_ptr()));
        }
        ok(amb_rotor_rearm(rotor));
        ok(amb_rotor_self_test(rotor));
        let code = amb_rotor_reconfigure(rotor, &raw const shaft, values, count);
        ok(code);
    }
}

/// Requirement: SR-21
#[test]
fn a_watch_touches_only_what_it_was_given() {
    let mut memory = Box::new([0_u32; 8]);
    let watch: *mut WatchStorage = memory.as_mut_ptr().cast();
    let mut expired = 0;
    let mut force = Box::new([1.0_f32; 2]);
    // SAFETY: every pointer is null or points to what its type says; the memory is zero, and used through
    // these calls alone.
    unsafe {
        let code = amb_watch_force(watch, force.as_mut_ptr());
        assert_eq!(code, Code::ERROR_WATCH_NOT_INITIALISED);
        assert_eq!(*force, [0.0; 2]);
        ok(amb_watch_init(watch, 1));
        // Twice: the first one is replaced.
        ok(amb_watch_init(watch, 1));
        assert_eq!(amb_watch_init(null_mut(), 1), Code::ERROR_WATCH_NULL);
        ok(amb_watch_renew(watch, [2.0, 3.0].as_ptr()));
        assert_eq!(amb_watch_renew(watch, null()), Code::ERROR_FORCE_NULL);
        ok(amb_watch_force(watch, force.as_mut_ptr()));
        assert_eq!(*force, [2.0, 3.0]);
        ok(amb_watch_force(watch, force.as_mut_ptr()));
        assert_eq!(*force, [0.0; 2]);
        ok(amb_watch_expired(watch, &raw mut expired));
        assert_eq!(expired, 1);
    }
}

#[test]
fn configurations_go_only_where_their_values_are() {
    let bearing = CBearing {
        sample_period_s: 50e-6,
        mass_kg: 10.0,
        clearance_m: 2e-4,
        force_max_n: 1000.0,
        friction_coefficient: 0.15,
        contact_stiffness_n_m: 2e8,
        ..CBearing::default()
    };
    let shaft = SHAFT;
    let bearings = Box::new([bearing; 2]);
    let first: *const CBearing = (&raw const *bearings).cast();
    let mut one = Box::new([0.0_f32; PARAMETERS.len()]);
    let mut both = Box::new([0.0_f32; 2 * PARAMETERS.len()]);
    let to_one: *mut f32 = (&raw mut *one).cast();
    let to_both: *mut f32 = (&raw mut *both).cast();
    // SAFETY: every pointer is null or points to what its type says, and the values to as many floats as is declared.
    unsafe {
        ok(amb_config_for_bearing(first, to_one, one.len()));
        let code = amb_config_for_rotor(&raw const shaft, first, to_both, both.len());
        ok(code);
        let code = amb_config_for_rotor(&raw const shaft, first, to_both, one.len());
        assert_eq!(code, Code::ERROR_VALUES_COUNT);
        let code = amb_config_for_bearing(null(), to_one, one.len());
        assert_eq!(code, Code::ERROR_BEARING_NULL);
    }
    assert_eq!(one[1], 10.0);
    assert_ne!(both[1], both[1 + PARAMETERS.len()]);
    assert_eq!(one[0], both[PARAMETERS.len()]);
}
