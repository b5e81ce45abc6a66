//! Where the supervisor knows little: after long gaps, from one sample, of late commands in a row, without a bearing.

use supervisor::{Command, Config, Events, Limits, Mode, RejectReason, Sample, Status, Supervisor};
use system_tests::bench::{Bench, WHIRL_STEP};
use system_tests::rig::{RADIUS_M, config, length, on_circle, sample};

/// After a gap that cannot be made up for a sample that cannot be leaves nothing to go by: that is a fault at once, in which
/// the force fades, and no law acts on a position that nobody knows.
#[test]
fn without_any_sample_no_law_acts() {
    for bad in [[f32::NAN; 2], [1.0, 1.0]] {
        let (mut bench, angle) = Bench::whirl(&config());
        let before = bench.tick(on_circle(RADIUS_M, angle + WHIRL_STEP)).force_n;
        bench.sequence += 6;
        let mut last = before;
        for i in 0..8 {
            let command = bench.tick(bad);
            assert_eq!(command.mode, Mode::SensorFault);
            assert_eq!(command.events.contains(Events::SENSOR_FAULT), i == 0);
            // Along each axis it keeps its sign and falls.
            for (now, last) in command.force_n.into_iter().zip(last) {
                assert!(
                    now * last >= 0.0 && now.abs() <= last.abs(),
                    "{command:?} after {last:?}"
                );
            }
            last = command.force_n;
        }
        assert!(length(last) < 0.7 * length(before));
    }
}

/// Two long gaps with usual samples in between are not two in a row, whichever way those are judged.
#[test]
fn gaps_far_apart_are_not_in_a_row() {
    let (mut bench, mut angle) = Bench::whirl(&config());
    for (gap, refused) in [(6, false), (0, false), (6, false), (6, true)] {
        bench.sequence += gap;
        let ticks = if gap == 0 { 50 } else { 1 };
        for _ in 0..ticks {
            angle += WHIRL_STEP;
            let command = bench.tick(on_circle(RADIUS_M, angle));
            assert_eq!(command.limits.contains(Limits::SAMPLE_REFUSED), refused);
        }
    }
    assert_eq!(bench.supervisor.report().refusal, RejectReason::Dropout);
}

/// In a hand-over, too, what the controller makes of a sample that cannot be does not go through.
#[test]
fn in_a_hand_over_the_answer_to_such_a_sample_does_not_go_through() {
    let with = Config {
        handover_blend_s: 0.01,
        ..config()
    };
    for bad in [[f32::NAN, 0.0], [7e-4, 0.0]] {
        let (mut bench, angle) = Bench::whirl(&with);
        let mut radius_m = RADIUS_M;
        let (mut wild, mut last_n) = (0, [0.0; 2]);
        for i in 0..400 {
            radius_m = (radius_m - 1e-5).max(1e-6 * (1.0 + (i % 5) as f32));
            let refused = bench.supervisor.mode() == Mode::Handover && i % 10 == 9;
            let [x, y] = on_circle(radius_m, angle);
            bench.sequence += 1;
            let mut now = sample(bench.sequence, if refused { bad } else { [x, y] });
            if refused {
                now.levitation_n = [-1e4, 0.0];
            }
            let command = bench.supervisor.tick(&now);
            if refused {
                assert_eq!(command.mode, Mode::Handover);
                let off = [0, 1].map(|k| command.force_n[k] - last_n[k]);
                assert!(length(off) < 1e-3, "{command:?} after {last_n:?}");
                wild += 1;
            }
            last_n = command.force_n;
        }
        assert!(wild > 5, "{wild} in hand-over");
        assert_eq!(bench.supervisor.mode(), Mode::Levitated);
    }
}

/// Commands that all come a tick late, and are said to: a measured force that follows them is that of a drive that obeys.
#[test]
fn late_commands_in_a_row_are_a_line_that_is_a_tick_longer() {
    let run = |told: bool| {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        let left = (-50e-6_f32 / 1.6e-4).exp();
        // Delay of a tick; from 200 on another one.
        let (mut line, mut delivered, mut lost) = (vec![[0.0_f32; 2]; 1], [0.0_f32; 2], 0);
        for i in 0..600_u32 {
            let mut now = sample(i, on_circle(RADIUS_M, WHIRL_STEP * i as f32));
            now.status |= Status::APPLIED_VALID;
            if told && i > 200 {
                now.status |= Status::LATE;
            }
            let command = supervisor.tick(&Sample {
                applied_n: delivered,
                ..now
            });
            lost += u32::from(command.events.contains(Events::AXIS_LOST));
            line.push(command.force_n);
            if i == 200 {
                line.insert(0, line[0]);
            }
            let due = line.remove(0);
            for (delivered, due) in delivered.iter_mut().zip(due) {
                *delivered = due + (*delivered - due) * left;
            }
        }
        (lost, supervisor.report().late_ticks)
    };
    assert_eq!(run(true), (0, 399));
    assert_eq!(run(false), (0, 0));
}

/// The first velocity is a difference between two samples that follow each other, whatever was missed or refused before.
#[test]
fn the_first_velocity_is_of_two_samples_in_a_row() {
    let true_m_s = f64::from(RADIUS_M * WHIRL_STEP) / 50e-6;
    for missed in 0..5 {
        for refused in 0..3 {
            let mut bench = Bench::new(&config());
            let mut angle = 0.3;
            bench.tick(on_circle(RADIUS_M, angle));
            for i in 0..40 {
                angle += WHIRL_STEP;
                if i < refused {
                    bench.tick([f32::NAN; 2]);
                } else if i < refused + missed {
                    bench.sequence += 1;
                } else {
                    bench.tick(on_circle(RADIUS_M, angle));
                }
            }
            let most = f64::from(bench.supervisor.report().backward_speed_max_m_s);
            assert!(
                (0.95..1.1).contains(&(most / true_m_s)),
                "{missed}, {refused}: {most}"
            );
        }
    }
}

/// A coordinate that was no number until the tick before is not good because the other one is none now.
#[test]
fn a_coordinate_is_good_after_samples_of_its_own() {
    let (mut bench, mut angle) = Bench::whirl(&config());
    let [stays_m, _] = on_circle(RADIUS_M, angle);
    let mut tick = |bad: [bool; 2], again: bool| -> Command {
        angle += WHIRL_STEP;
        let [_, y] = on_circle(RADIUS_M, angle);
        // Near to where x was last seen.
        let x = stays_m + 1e-6 * angle.sin();
        let position = [
            if bad[0] { f32::NAN } else { x },
            if bad[1] { f32::NAN } else { y },
        ];
        bench.sequence += u32::from(!again);
        let mut now = sample(bench.sequence, position);
        now.levitation_n = [700.0, 0.0];
        bench.supervisor.tick(&now)
    };
    for _ in 0..12 {
        tick([true, false], false);
    }
    tick([true, false], true);
    for _ in 0..9 {
        tick([true, false], false);
    }
    // The tenth of x alone would free y; of y alone this is the first.
    for i in 0..14 {
        let command = tick([false, true], false);
        assert_eq!(command.mode, Mode::SensorFault);
        assert_eq!(command.force_n[0] > 300.0, i >= 9, "{i}: {command:?}");
    }
}

/// What nobody saw was no contact: a rotor that had just touched when the sensor failed is not whirling because of that.
#[test]
fn unseen_time_is_no_time_in_contact() {
    let with = Config {
        fault_ticks: 4.0,
        ..config()
    };
    let mut bench = Bench::new(&with);
    for i in 0..60 {
        bench.tick(on_circle(1.8e-4, 0.09 * i as f32));
    }
    bench.tick(on_circle(RADIUS_M, 5.4));
    for _ in 0..200 {
        bench.tick([f32::NAN; 2]);
    }
    let mut events = Events::empty();
    for i in 0..40 {
        let radius_m = if i == 6 { RADIUS_M } else { 1.85e-4 };
        let position = on_circle(radius_m, 0.09 * i as f32);
        events |= bench.tick(position).events;
    }
    assert!(events.contains(Events::SENSOR_OK | Events::TOUCHED));
    assert!(!events.contains(Events::WHIRL), "{events:?}");
}

/// A bearing that is off is not heated by what the controller asks for.
/// Requirement: SR-08
#[test]
fn a_bearing_that_is_off_stays_cold() {
    let with = Config {
        continuous_force_n: 400.0,
        thermal_time_s: 0.1,
        ..config()
    };
    for (status, warm) in [(Status::empty(), false), (Status::BEARING_ON, true)] {
        let mut supervisor = Supervisor::<64>::new(&with).unwrap();
        for i in 0..2000 {
            let mut now = sample(i, [1e-8 * (i % 7) as f32, 1e-8 * (i % 5) as f32]);
            now.status = status;
            now.levitation_n = [900.0, 0.0];
            supervisor.tick(&now);
        }
        let state = supervisor.report().thermal_state;
        assert_eq!(state > 0.5, warm, "{state}");
        assert!(warm || state == 0.0);
    }
}
