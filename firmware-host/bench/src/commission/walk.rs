//! Clearance and centre of the retainer bearing, from a walk round it: the rotor slowly led along the wall.

use crate::commission::{Commissioned, Found, Missing};
use crate::log_file::LogError;
use nalgebra::{Matrix3, Vector3};
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use std::f64::consts::TAU;

/// Sectors of the round; of each what is farthest out counts, and so many have to be there.
const SECTORS: usize = 24;
const LEAST_SECTORS: usize = 12;
/// Of the readings of a sector this share is farther out.
const BEYOND: f64 = 0.05;

impl Commissioned {
    /// Where there is no walk.
    pub fn without_walk(&mut self) {
        for name in ["clearance_m", "retainer_centre_x_m", "retainer_centre_y_m"] {
            self.not_found.push(Missing {
                name,
                reason: "shows at the wall alone: give the log of a walk with --walk".to_owned(),
            });
        }
    }

    /// With what a walk shows.
    ///
    /// # Errors
    /// [`LogError`] where it does not go round.
    pub fn with_walk(&mut self, positions_m: &[[f64; 2]]) -> Result<(), LogError> {
        let outermost = outermost(positions_m);
        if outermost.len() < LEAST_SECTORS {
            return Err(LogError::new(
                format!(
                    "the walk comes through {} of {SECTORS} sectors, {LEAST_SECTORS} at least are needed",
                    outermost.len()
                ),
                "lead the rotor slowly along the retainer bearing, all the way round",
            ));
        }
        let [x, y, radius] = circle(&outermost)?;
        let off: Vec<f64> = outermost
            .iter()
            .map(|[px, py]| (px - x).hypot(py - y) - radius)
            .collect();
        let free = outermost.len() as f64 - 3.0;
        let scatter = (off.iter().map(|off| off * off).sum::<f64>() / free).sqrt();
        let times = StudentsT::new(0.0, 1.0, free).map_or(2.0, |t| t.inverse_cdf(0.975));
        // Sectors all round: the radius is a mean, the centre a mean by cosines.
        let number = outermost.len() as f64;
        let from = format!(
            "walk through {} of {SECTORS} sectors, {:.2} µm off a circle",
            outermost.len(),
            1e6 * scatter
        );
        for (name, value, spread) in [
            ("clearance_m", radius, scatter / number.sqrt()),
            ("retainer_centre_x_m", x, scatter * (2.0 / number).sqrt()),
            ("retainer_centre_y_m", y, scatter * (2.0 / number).sqrt()),
        ] {
            self.parameters.push(Found {
                name,
                unit: "m",
                value,
                low: value - times * spread,
                high: value + times * spread,
                from: from.clone(),
            });
        }
        Ok(())
    }
}

/// Of each sector round the mean of the outline a place on the wall.
fn outermost(positions_m: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let middle = [0, 1].map(|axis| {
        let values = || positions_m.iter().map(|p| p[axis]);
        let (low, high) = (
            values().fold(f64::MAX, f64::min),
            values().fold(f64::MIN, f64::max),
        );
        0.5 * (low + high)
    });
    let mut sectors: Vec<Vec<(f64, [f64; 2])>> = vec![Vec::new(); SECTORS];
    for position in positions_m {
        let [x, y] = [position[0] - middle[0], position[1] - middle[1]];
        let sector = (y.atan2(x).rem_euclid(TAU) / TAU * SECTORS as f64) as usize;
        sectors[sector.min(SECTORS - 1)].push((x.hypot(y), *position));
    }
    let farthest = sectors
        .iter()
        .filter_map(|sector| sector.iter().map(|(r, _)| *r).reduce(f64::max));
    let farthest = farthest.fold(0.0, f64::max);
    (sectors.iter_mut())
        .filter_map(|sector| {
            sector.sort_by(|(a, _), (b, _)| a.total_cmp(b));
            let place = (sector.len() as f64 * (1.0 - BEYOND)) as usize;
            let (radius, position) = sector.get(place.min(sector.len().saturating_sub(1)))?;
            // One that did not come to the wall says nothing.
            (*radius > 0.5 * farthest).then_some(*position)
        })
        .collect()
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
