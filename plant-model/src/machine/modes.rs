//! Modes of a whole rotor off its walls at a spin, and how its planes feel each other.

use super::body::LinearBody;
use super::params::{MachineError, MachineParams};
use nalgebra::{Complex, DMatrix, DVector};

/// Which way a mode goes round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// With a positive spin: counter-clockwise.
    Forward,
    /// Clockwise.
    Backward,
    /// To and fro, or both ways alike: as of a rotor that does not spin, whose pairs of modes are any mixture.
    Planar,
}

/// A mode of the linear rotor: supports and rings included, magnets without command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineMode {
    /// Damped frequency \[rad/s\], ≥ 0.
    pub frequency_rad_s: f64,
    /// Rate of growth \[1/s\]; below zero it decays.
    pub growth_s: f64,
    /// −growth over the length of the eigenvalue, from −1 to 1; 0 for a rigid motion that nothing holds.
    pub damping_ratio: f64,
    /// By where the rotor moves most in the planes.
    pub direction: Direction,
}

/// Share of the larger amplitude by which forward and backward must differ to be told apart.
const TOLD_APART: f64 = 1e-6;

/// Modes at a spin that is held \[rad/s\], slowest first; a pair of eigenvalues counts once. The more modes bend, the longer
/// it takes: the third power of their number.
///
/// # Errors
/// The first value that is out of range.
pub fn modes(params: &MachineParams, spin_rad_s: f64) -> Result<Vec<MachineMode>, MachineError> {
    let body = LinearBody::new(params)?;
    let rate = body.undamped_rate_rad_s().max(1.0);
    let a = body.generator(rate, spin_rad_s);
    let values = a.complex_eigenvalues();
    let complex = a.map(|x| Complex::new(x, 0.0));
    let mut modes: Vec<MachineMode> = (values.iter())
        // Of two that are conjugate the one that turns forward in time; real ones as they are.
        .filter(|value| value.im >= 0.0)
        .map(|value| MachineMode {
            frequency_rad_s: value.im,
            growth_s: value.re,
            damping_ratio: match value.norm() {
                0.0 => 0.0,
                size => -value.re / size,
            },
            direction: match value.im {
                0.0 => Direction::Planar,
                _ => direction(&body, &complex, *value, rate),
            },
        })
        .collect();
    modes.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
    Ok(modes)
}

/// Which way the eigenvector goes round, from inverse iteration.
fn direction(
    body: &LinearBody,
    a: &DMatrix<Complex<f64>>,
    value: Complex<f64>,
    rate: f64,
) -> Direction {
    let n = body.n;
    let near = value + Complex::new(1e-9, 1e-9) * rate;
    let shifted = a - DMatrix::from_diagonal_element(2 * n, 2 * n, near);
    // No mode is orthogonal to this by construction.
    let mut vector = DVector::from_fn(2 * n, |i, _| {
        Complex::new(1.0 + 0.37 * (i as f64).sin(), 0.41 * (i as f64).cos())
    });
    let factors = shifted.lu();
    for _ in 0..3 {
        let Some(next) = factors.solve(&vector) else {
            return Direction::Planar;
        };
        let size = next.norm();
        vector = next / Complex::new(size, 0.0);
    }
    let part = |of: fn(&Complex<f64>) -> f64| vector.iter().take(n).map(of).collect::<Vec<f64>>();
    let (real, imaginary) = (part(|z| z.re), part(|z| z.im));
    let (mut forward, mut backward) = (0.0, 0.0);
    for port in body.at_planes.iter().chain(&body.contacts) {
        let (re, im) = (port.of(&real), port.of(&imaginary));
        // x = Re(X·e^iωt) and y likewise: X + i·Y and X − i·Y are the two senses.
        let x = Complex::new(re.x, im.x);
        let turned = Complex::new(-im.y, re.y);
        forward = f64::max(forward, (x + turned).norm());
        backward = f64::max(backward, (x - turned).norm());
    }
    match (forward - backward) / forward.max(backward) {
        d if d > TOLD_APART => Direction::Forward,
        d if d < -TOLD_APART => Direction::Backward,
        _ => Direction::Planar,
    }
}

/// Mobility of the rotor between its planes \[1/kg\], row by row: velocity of one by an impulse on another, eq. (6.4). One
/// over a number of the diagonal is the mass that a plane feels at an impact.
///
/// # Errors
/// The first value that is out of range.
pub fn mobility_of_planes(params: &MachineParams) -> Result<Vec<Vec<f64>>, MachineError> {
    let body = LinearBody::new(params)?;
    let ports = &body.at_planes;
    Ok(ports
        .iter()
        .map(|a| ports.iter().map(|b| a.mobility_with(b)).collect())
        .collect())
}
