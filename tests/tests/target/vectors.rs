//! Samples and commands as text: what a port reads there is enough to give every bit of every command.

use supervisor::{Config, Core, CoreSample, PARAMETERS, Prepared, Q, Sample, Status, Supervisor};
use system_tests::host;

/// What stands between two commas, behind the number of the piece, and that number.
fn words(row: &str) -> (usize, Vec<u32>) {
    let (piece, words) = row.split_once(',').unwrap();
    let words = words
        .split(',')
        .map(|word| u32::from_str_radix(word, 16).unwrap());
    (piece.parse().unwrap(), words.collect())
}

/// A supervisor under test, from bits to bits: those of a sample behind sequence and status, and those of a command.
type Port = Box<dyn FnMut(u32, Status, [u32; 7]) -> [u32; 9]>;

/// The columns of a command.
fn answer([f_x, f_y, o_x, o_y, severity]: [u32; 5], flags: [u32; 4]) -> [u32; 9] {
    let [mode, limits, events, integrator] = flags;
    [
        f_x, f_y, o_x, o_y, severity, mode, limits, events, integrator,
    ]
}

fn float(config: &Config) -> Port {
    let mut supervisor = Box::new(Supervisor::<16>::new(config).unwrap());
    Box::new(move |sequence, status, bits| {
        let [x, y, spin_rad_s, l_x, l_y, a_x, a_y] = bits.map(f32::from_bits);
        let command = supervisor.tick(&Sample {
            sequence,
            status,
            position_m: [x, y],
            spin_rad_s,
            levitation_n: [l_x, l_y],
            applied_n: [a_x, a_y],
        });
        let ([f_x, f_y], [o_x, o_y]) = (command.force_n, command.own_n);
        let numbers = [f_x, f_y, o_x, o_y, command.severity].map(f32::to_bits);
        let flags = [
            command.mode as u32,
            command.limits.bits(),
            command.events.bits(),
            command.integrator as u32,
        ];
        answer(numbers, flags)
    })
}

fn fixed(config: &Config) -> Port {
    let mut core = Box::new(Core::<Q, 16>::new(&Prepared::new(config).unwrap()));
    Box::new(move |sequence, status, bits| {
        let [x, y, spin, l_x, l_y, a_x, a_y] = bits.map(|word| Q::from_bits(word as i32));
        let command = core.tick(&CoreSample {
            sequence,
            status,
            position: [x, y],
            spin,
            levitation: [l_x, l_y],
            applied: [a_x, a_y],
        });
        let ([f_x, f_y], [o_x, o_y]) = (command.force, command.own);
        let numbers = [f_x, f_y, o_x, o_y, command.severity].map(|q| q.to_bits() as u32);
        let flags = [
            command.mode as u32,
            command.limits.bits(),
            command.events.bits(),
            command.integrator as u32,
        ];
        answer(numbers, flags)
    })
}

/// Ticks of a number's files that are right, and all.
fn right(folder: &std::path::Path, number: &str, port: fn(&Config) -> Port) -> (usize, usize) {
    let read =
        |what: &str| std::fs::read_to_string(folder.join(format!("{what}_{number}.csv"))).unwrap();
    let (configurations, ticks) = (read("configurations"), read("ticks"));
    let mut configurations = configurations.lines();
    let names: Vec<_> = PARAMETERS.iter().map(|p| p.name).collect();
    assert_eq!(
        configurations.next(),
        Some(format!("piece,ticks,{}", names.join(",")).as_str())
    );
    let mut ticks = ticks.lines();
    assert_eq!(ticks.next().map(|names| names.split(',').count()), Some(19));
    let (mut right, mut all) = (0, 0);
    for (i, (piece, words_of)) in configurations.map(words).enumerate() {
        assert_eq!(piece, i);
        let values: [u32; PARAMETERS.len()] = words_of[1..].try_into().unwrap();
        let mut tick = port(&Config::from_values(values.map(f32::from_bits)));
        for (piece, row) in ticks.by_ref().take(words_of[0] as usize).map(words) {
            assert_eq!(piece, i);
            // A record of another length freezes at another tick.
            let inputs = row[2..9].try_into().unwrap();
            let mut commanded = tick(row[0], Status::from_bits_retain(row[1]), inputs);
            let mut expected: [u32; 9] = row[9..].try_into().unwrap();
            for events in [&mut commanded[7], &mut expected[7]] {
                *events &= !supervisor::Events::RECORD_FROZEN.bits();
            }
            right += usize::from(commanded == expected);
            all += 1;
        }
    }
    assert_eq!(ticks.next(), None);
    (right, all)
}

/// Requirement: SR-34
#[test]
fn a_port_has_every_bit_from_the_text() {
    let folder = tempfile::tempdir().unwrap();
    let output = host()
        .args(["vectors", "--out"])
        .arg(folder.path())
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success() && text.contains("45 of 45 ways"),
        "{text}"
    );
    for (number, port) in [("f32", float as fn(&Config) -> Port), ("q", fixed)] {
        let (right, all) = right(folder.path(), number, port);
        assert_eq!(right, all, "{number}");
        assert!(all >= 100_000, "{all}");
    }
}
