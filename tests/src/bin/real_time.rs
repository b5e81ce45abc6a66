//! Closed loop against real time: every policy of a scene on one core, best and median of many runs.
//!
//! `cargo run --release -p system-tests --bin real_time [SCENE [RUNS]]`

use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use system_tests::scene_path;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .map_or_else(|| scene_path("overload_then_release"), PathBuf::from);
    let runs: usize = std::env::args().nth(2).map_or(Ok(60), |n| n.parse())?;
    let scene = Scene::load(&path)?;
    println!("{}, {} Hz, {runs} runs", scene.title, scene.sample_rate_hz);
    println!("| policy | trace | best ratio | median ratio |\n|---|---|--:|--:|");
    for keep in [Keep::Verdict, Keep::Trace] {
        // In turns, so that other work on the machine meets all alike.
        let mut seconds = vec![Vec::with_capacity(runs); scene.policies.len()];
        for _ in 0..runs {
            for (policy, seconds) in scene.policies.iter().zip(&mut seconds) {
                let begun = Instant::now();
                run(&scene, *policy, keep, &mut |_| {})?;
                seconds.push(begun.elapsed().as_secs_f64());
            }
        }
        for (policy, seconds) in scene.policies.iter().zip(&mut seconds) {
            seconds.sort_by(f64::total_cmp);
            let ratio = |s: f64| scene.duration_s / s;
            println!(
                "| {} | {} | {:.0} | {:.0} |",
                policy.name(),
                if keep == Keep::Trace { "kept" } else { "no" },
                ratio(seconds[0]),
                ratio(seconds[runs / 2])
            );
        }
    }
    Ok(())
}
