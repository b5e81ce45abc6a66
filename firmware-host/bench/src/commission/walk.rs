//! Clearance and centre of the retainer bearing, from a walk round it: the rotor slowly led along the wall.

use crate::commission::machine::noise_m;
use crate::commission::{Commissioned, Found};
use crate::log_file::LogError;
use nalgebra::{Matrix3, Vector3};
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use std::f64::consts::TAU;

/// Sectors of the round; of each where the rotor rested farthest out counts, and so many have to be there.
const SECTORS: usize = 24;
const LEAST_SECTORS: usize = 12;
/// Of the readings of a sector this share is farther out than where a place of rest is sought from.
const BEYOND: f64 = 0.05;
/// A place of rest is so wide, in parts of the noise, and as a share of the radius at least.
const WIDE: (f64, f64) = (2.0, 2.5e-3);
/// Rounds of improvement of the middle; steps towards a place of rest.
const ROUNDS: usize = 4;
const STEPS: usize = 50;
/// What a radius is known to at best, as a share.
const ROUNDED: f64 = 1e-6;

impl Commissioned {
    /// Where there is no walk.
    pub fn without_walk(&mut self) {
        for name in ["clearance_m", "retainer_centre_x_m", "retainer_centre_y_m"] {
            self.miss(
                name,
                "shows at the wall alone: give the log of a walk with --walk",
            );
        }
    }

    /// With what a walk shows.
    ///
    /// # Errors
    /// [`LogError`] where it does not go round.
    pub fn with_walk(&mut self, positions_m: &[[f64; 2]]) -> Result<(), LogError> {
        let noise_m = noise_m(positions_m);
        let mut middle = middle(positions_m);
        let (mut rests, mut radius) = (Vec::new(), 0.0);
        for _ in 0..ROUNDS {
            rests = rests_at(positions_m, middle, noise_m);
            if rests.len() < LEAST_SECTORS {
                return Err(LogError::new(
                    format!(
                        "the walk comes through {} of {SECTORS} sectors, {LEAST_SECTORS} at least are needed",
                        rests.len()
                    ),
                    "lead the rotor slowly along the retainer bearing, all the way round",
                ));
            }
            let [x, y, of_circle] =
                circle(&rests.iter().map(|rest| rest.at_m).collect::<Vec<_>>())?;
            (middle, radius) = ([x, y], of_circle);
        }
        let [x, y] = middle;
        let lifted_m = lifted_m(&rests, noise_m);
        let off: Vec<f64> = (rests.iter())
            .map(|Rest { at_m: [px, py], .. }| (px - x).hypot(py - y) - radius)
            .collect();
        let number = rests.len() as f64;
        let free = number - 3.0;
        let scatter = (off.iter().map(|off| off * off).sum::<f64>() / free).sqrt();
        let times = StudentsT::new(0.0, 1.0, free).map_or(2.0, |t| t.inverse_cdf(0.975));
        // Sectors all round: the radius is a mean, the centre a mean by cosines.
        let from = format!(
            "walk through {} of {SECTORS} sectors, {:.2} µm off a circle, noise of {:.2} µm taken off",
            rests.len(),
            1e6 * scatter,
            1e6 * noise_m
        );
        let of_centre = scatter * (2.0 / number).sqrt();
        for (name, value, spread, lifted) in [
            ("clearance_m", radius, scatter / number.sqrt(), lifted_m),
            ("retainer_centre_x_m", x, of_centre, 0.0),
            ("retainer_centre_y_m", y, of_centre, 0.0),
        ] {
            let spread = times * spread + ROUNDED * radius;
            self.parameters.push(Found {
                name: name.to_owned(),
                unit: "m",
                value,
                low: value - spread,
                // Off the wall it is never outside.
                high: value + spread + lifted,
                from: from.clone(),
            });
        }
        Ok(())
    }
}

/// Where the rotor rested in a sector, noise taken off.
struct Rest {
    at_m: [f64; 2],
    /// Squares of how its radii there are apart, of so many.
    scatter_m2: f64,
    rows: f64,
}

/// Of the outline.
fn middle(positions_m: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let values = || positions_m.iter().map(|p| p[axis]);
        let (low, high) = (
            values().fold(f64::MAX, f64::min),
            values().fold(f64::MIN, f64::max),
        );
        0.5 * (low + high)
    })
}

/// Of each sector the outermost radius round which its readings gather. A quantile would be too large by the noise.
fn rests_at(positions_m: &[[f64; 2]], middle: [f64; 2], noise_m: f64) -> Vec<Rest> {
    let mut sectors: Vec<Vec<(f64, f64)>> = vec![Vec::new(); SECTORS];
    for position in positions_m {
        let [x, y] = [position[0] - middle[0], position[1] - middle[1]];
        let angle = y.atan2(x).rem_euclid(TAU);
        let sector = (angle / TAU * SECTORS as f64) as usize;
        sectors[sector.min(SECTORS - 1)].push((x.hypot(y), angle));
    }
    let farthest = (sectors.iter().flatten())
        .map(|(r, _)| *r)
        .fold(0.0, f64::max);
    (sectors.iter_mut())
        .filter_map(|sector| {
            sector.sort_by(|(a, _), (b, _)| a.total_cmp(b));
            let place = (sector.len() as f64 * (1.0 - BEYOND)) as usize;
            let (mut radius, _) = *sector.get(place.min(sector.len().saturating_sub(1)))?;
            // One that did not come to the wall says nothing.
            if radius <= 0.5 * farthest {
                return None;
            }
            let wide = (WIDE.0 * noise_m).max(WIDE.1 * radius);
            let about = |radius: f64, wide: f64| {
                let near = move |(r, _): &&(f64, f64)| (r - radius).abs() <= wide;
                sector.iter().filter(near)
            };
            let mean = |of: fn(&(f64, f64)) -> f64, radius: f64| {
                let rows = about(radius, wide).count() as f64;
                about(radius, wide).map(of).sum::<f64>() / rows
            };
            for _ in 0..STEPS {
                let next = mean(|(r, _)| *r, radius);
                if !next.is_finite() || next == radius {
                    break;
                }
                radius = next;
            }
            let angle = mean(|(_, angle)| *angle, radius);
            let wider = || about(radius, 2.0 * wide);
            let scatter_m2 = wider().map(|(r, _)| (r - radius).powi(2)).sum();
            let rows = wider().count() as f64;
            // Noise along the wall puts readings farther out, too.
            let radius = radius - 0.5 * noise_m * noise_m / radius;
            let at_m = [
                middle[0] + radius * angle.cos(),
                middle[1] + radius * angle.sin(),
            ];
            at_m[0].is_finite().then_some(Rest {
                at_m,
                scatter_m2,
                rows,
            })
        })
        .collect()
}

/// How far off the wall the rotor was where it rested, by what noise does not explain of how its radii are apart.
fn lifted_m(rests: &[Rest], noise_m: f64) -> f64 {
    let rows: f64 = rests.iter().map(|rest| rest.rows).sum();
    let square = rests.iter().map(|rest| rest.scatter_m2).sum::<f64>() / rows;
    let chance = 3.0 * (4.0 / rows).sqrt();
    match square > noise_m * noise_m * (1.0 + chance) {
        true => (square - noise_m * noise_m).sqrt(),
        false => 0.0,
    }
}

/// Centre and radius: x² + y² is linear in what they make.
fn circle(points: &[[f64; 2]]) -> Result<[f64; 3], LogError> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    let scale = points
        .iter()
        .map(|[x, y]| x.hypot(*y))
        .fold(1e-12, f64::max);
    for [x, y] in points {
        let row = Vector3::new(x / scale, y / scale, 1.0);
        let square = row.x * row.x + row.y * row.y;
        normal += row * row.transpose();
        right += row * square;
    }
    let solved = normal.cholesky().map(|cholesky| cholesky.solve(&right));
    let [a, b, c] = solved.map_or([f64::NAN; 3], |s| [s.x, s.y, s.z]);
    let radius = (c + 0.25 * (a * a + b * b)).sqrt();
    if radius.is_finite() {
        Ok([0.5 * a * scale, 0.5 * b * scale, radius * scale])
    } else {
        Err(LogError::new(
            "the walk is no circle",
            "lead the rotor along the retainer bearing, all the way round",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_distr::StandardNormal;

    /// A walk of a turn and a fifth, somewhat lifted off the wall once in a while.
    fn walked(noise_m: f64, lift_m: f64) -> [[f64; 3]; 3] {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let mut noise = || noise_m * random.sample::<f64, _>(StandardNormal);
        let positions_m: Vec<[f64; 2]> = (0..20_000)
            .map(|tick| {
                let angle = 1.2 * TAU * f64::from(tick) / 20_000.0;
                let radius = 2e-4 - lift_m * (77.0 * angle).sin().max(0.0);
                [
                    1e-5 + radius * angle.cos() + noise(),
                    -2e-5 + radius * angle.sin() + noise(),
                ]
            })
            .collect();
        let mut found = Commissioned::default();
        found.with_walk(&positions_m).unwrap();
        [0, 1, 2].map(|i| {
            let of: &Found = &found.parameters[i];
            [of.low, of.value, of.high]
        })
    }

    #[test]
    fn noise_does_not_move_the_wall() {
        for (noise_m, lift_m) in [
            (0.0, 0.0),
            (1e-6, 0.0),
            (5e-6, 0.0),
            (1e-5, 0.0),
            (0.0, 6e-6),
            (1e-6, 6e-6),
            (5e-6, 6e-6),
        ] {
            let found = walked(noise_m, lift_m);
            for (is, [low, value, high]) in [2e-4, 1e-5, -2e-5].into_iter().zip(found) {
                let case = format!("noise {noise_m}, lift {lift_m}: {low} {value} {high}");
                assert!(low <= is && is <= high, "{is} at {case}");
                assert!(lift_m > 0.0 || high - low < 0.01 * 2e-4, "{case}");
            }
        }
    }
}
