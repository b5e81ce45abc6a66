//! The command `sweep` against the bare loop: the same runs by the library call on as many threads, nothing written.
//!
//! `cargo run --release -p system-tests --bin sweep_rate -- SWEEP.toml [ROUNDS]`

use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use firmware_bench::sweep::plan::Plan;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::error::Error;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(std::env::args().nth(1).ok_or("give a sweep file")?);
    let rounds: usize = std::env::args().nth(2).map_or(Ok(5), |n| n.parse())?;
    let plan = Plan::load(&path)?;
    let scenes = (0..plan.runs())
        .map(|run| plan.spec(&plan.point(run))?.resolve())
        .collect::<Result<Vec<Scene>, _>>()?;
    let runs = plan.runs() as f64;
    let host = std::env::current_exe()?.with_file_name("firmware-host");
    println!("| round | bare loop [runs/s] | sweep [runs/s] | share |\n|--:|--:|--:|--:|");
    // In turns, so that other work on the machine meets both alike.
    for round in 1..=rounds {
        let begun = Instant::now();
        scenes.par_iter().try_for_each(|scene| {
            (plan.policies().iter())
                .try_for_each(|policy| run(scene, *policy, Keep::Verdict, &mut |_| {}).map(drop))
        })?;
        let bare = runs / begun.elapsed().as_secs_f64();
        let folder = tempfile::TempDir::new()?;
        let mut sweep = Command::new(&host);
        sweep.arg("sweep").arg(&path).arg("--json");
        let begun = Instant::now();
        let output = sweep.arg("--out").arg(folder.path()).output()?;
        // With all that the command does before and behind its runs.
        let swept = runs / begun.elapsed().as_secs_f64();
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into());
        }
        println!("| {round} | {bare:.1} | {swept:.1} | {:.2} |", swept / bare);
    }
    Ok(())
}
