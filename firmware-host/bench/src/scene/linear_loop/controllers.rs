//! Levitation controllers as linear systems at samples: from the readings of the stations to the forces of their magnets, without
//! caps and with integrators that run.

use super::discrete::Discrete;
use crate::device::biquads::{BiquadsParams, Section};
use crate::device::levitation::LevitationParams;
use crate::device::modal_levitation::{ModalLevitationParams, Weights};
use crate::device::state_space::StateSpaceParams;
use nalgebra::DMatrix;

/// A PID with a filtered derivative on x and y; what it makes of the rate of the one it adds to the other, `cross` times: f_x by
/// that of y, and f_y by minus that of x.
pub(super) fn pid(gains: &LevitationParams, cross: f64, period_s: f64) -> Discrete {
    let share = period_s / (period_s + gains.derivative_filter_s);
    let (kp, ki, kd) = (
        gains.proportional_n_m,
        gains.integral_n_m_s,
        gains.derivative_n_s_m,
    );
    // States: the last reading over the period, the filtered rate, and the integral, of x and then of y.
    let states = if ki != 0.0 { 3 } else { 2 };
    let mut a = DMatrix::zeros(2 * states, 2 * states);
    let mut b = DMatrix::zeros(2 * states, 2);
    let mut c = DMatrix::zeros(2, 2 * states);
    let mut d = DMatrix::zeros(2, 2);
    for axis in [0, 1] {
        let at = axis * states;
        let (last, rate) = (at, at + 1);
        b[(last, axis)] = 1.0 / period_s;
        a[(rate, last)] = -share;
        a[(rate, rate)] = 1.0 - share;
        b[(rate, axis)] = share / period_s;
        // What a rate does to the forces it does by its new value.
        for (force, gain) in [(axis, -kd), (1 - axis, cross * [-1.0, 1.0][axis])] {
            c[(force, last)] += gain * a[(rate, last)];
            c[(force, rate)] += gain * a[(rate, rate)];
            d[(force, axis)] += gain * b[(rate, axis)];
        }
        d[(axis, axis)] -= kp;
        if states == 3 {
            a[(at + 2, at + 2)] = 1.0;
            b[(at + 2, axis)] = -ki * period_s;
            c[(axis, at + 2)] = 1.0;
        }
    }
    Discrete { a, b, c, d }
}

/// By mode, at a spin as it is reported.
pub(super) fn modal(params: &ModalLevitationParams, spin_rad_s: f64, period_s: f64) -> Discrete {
    let (translation, tilt) = (params.translation, &params.tilt);
    let of_tilt = LevitationParams {
        proportional_n_m: tilt.proportional_n_m_rad,
        integral_n_m_s: tilt.integral_n_m_rad_s,
        derivative_n_s_m: tilt.derivative_n_m_s_rad,
        ..translation
    };
    let modes = pid(&translation, 0.0, period_s).beside(&pid(
        &of_tilt,
        tilt.cross_kg_m2 * spin_rad_s,
        period_s,
    ));
    let weighted = |weights: &Weights| {
        let of = [&weights.translation, &weights.tilt];
        DMatrix::from_fn(4, 2 * weights.tilt.len(), |row, column| {
            match row % 2 == column % 2 {
                true => of[row / 2][column / 2],
                false => 0.0,
            }
        })
    };
    let stations = params.stations.iter();
    let sensors_m: Vec<f64> = stations.clone().map(|s| s.sensor_m).collect();
    let magnets_m: Vec<f64> = (stations.filter_map(|s| s.magnet)).map(|m| m.0).collect();
    let sensors = Discrete::gain(weighted(&Weights::new(&sensors_m)));
    let magnets = Discrete::gain(weighted(&Weights::new(&magnets_m)).transpose());
    sensors.then(&modes).then(&magnets)
}

/// The user's matrices.
pub(super) fn state_space(params: &StateSpaceParams) -> Discrete {
    Discrete {
        a: params.a.clone(),
        b: params.b.clone(),
        c: params.c.clone(),
        d: params.d.clone(),
    }
}

/// The user's filters of a plane.
pub(super) fn biquads(params: &BiquadsParams) -> Discrete {
    let gain = || Discrete::gain(DMatrix::from_element(1, 1, -params.gain_n_m));
    let chain = |sections: &[Section]| {
        (sections.iter()).fold(gain(), |chain, section| chain.then(&of_section(section)))
    };
    let [x, y] = &params.sections;
    chain(x).beside(&chain(y))
}

/// In direct form II transposed.
fn of_section(section: &Section) -> Discrete {
    let Section {
        b: [b0, b1, b2],
        a: [a1, a2],
    } = *section;
    Discrete {
        a: DMatrix::from_row_slice(2, 2, &[-a1, 1.0, -a2, 0.0]),
        b: DMatrix::from_column_slice(2, 1, &[b1 - a1 * b0, b2 - a2 * b0]),
        c: DMatrix::from_row_slice(1, 2, &[1.0, 0.0]),
        d: DMatrix::from_element(1, 1, b0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::biquads::Biquads;
    use crate::device::levitation::Levitation;
    use crate::device::modal_levitation::{ModalLevitation, Station, TiltParams};
    use nalgebra::DVector;
    use plant_model::V2;
    use supervisor::IntegratorHint;

    const PERIOD_S: f64 = 1e-4;

    fn gains() -> LevitationParams {
        LevitationParams {
            proportional_n_m: 3e5,
            integral_n_m_s: 2e7,
            derivative_n_s_m: 150.0,
            derivative_filter_s: 2e-4,
        }
    }

    /// What it answers to readings, one after the other.
    fn answers(system: &Discrete, readings: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut state = DVector::zeros(system.a.nrows());
        let answer = |y: &Vec<f64>| {
            let y = DVector::from_vec(y.clone());
            let force = &system.c * &state + &system.d * &y;
            state = &system.a * &state + &system.b * &y;
            force.as_slice().to_vec()
        };
        readings.iter().map(answer).collect()
    }

    fn readings(stations: usize) -> Vec<Vec<f64>> {
        let at = |k: usize, i: usize| 1e-6 * (((k * (i + 3) + i * i) % 11) as f64 - 5.0);
        // The first is zero: a controller that starts takes no step from nothing.
        (0..40)
            .map(|k| {
                (0..2 * stations)
                    .map(|i| if k == 0 { 0.0 } else { at(k, i) })
                    .collect()
            })
            .collect()
    }

    fn close(linear: &[Vec<f64>], own: &[Vec<V2>]) {
        for (linear, own) in linear.iter().zip(own) {
            let own: Vec<f64> = own.iter().flat_map(|f| [f.x, f.y]).collect();
            assert_eq!(linear.len(), own.len());
            for (a, b) in linear.iter().zip(&own) {
                assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{linear:?} {own:?}");
            }
        }
    }

    fn vectors(readings: &[f64]) -> Vec<V2> {
        readings.chunks(2).map(|y| V2::new(y[0], y[1])).collect()
    }

    /// Each controller as it runs answers as its linear system does.
    #[test]
    fn a_controller_is_its_linear_system() {
        let mut running = Levitation::new(gains(), PERIOD_S, 1e9);
        let one = readings(1);
        let own = |y: &Vec<f64>| vec![running.force_n(vectors(y)[0], IntegratorHint::Run)];
        close(
            &answers(&pid(&gains(), 0.0, PERIOD_S), &one),
            &one.iter().map(own).collect::<Vec<_>>(),
        );

        let params = ModalLevitationParams {
            translation: gains(),
            tilt: TiltParams {
                proportional_n_m_rad: 4e3,
                integral_n_m_rad_s: 1e5,
                derivative_n_m_s_rad: 3.0,
                cross_kg_m2: 0.01,
            },
            stations: [(-0.2, -0.15), (0.3, 0.26)]
                .map(|(sensor_m, magnet_m)| Station {
                    sensor_m,
                    magnet: Some((magnet_m, 1e9)),
                })
                .to_vec(),
        };
        let spin_rad_s = 700.0;
        let mut running = ModalLevitation::new(&params, PERIOD_S);
        let two = readings(2);
        let own = |y: &Vec<f64>| {
            let mut forces_n = vec![V2::zeros(); 2];
            running.forces_n(vectors(y).into_iter(), spin_rad_s, false, &mut forces_n);
            forces_n
        };
        close(
            &answers(&modal(&params, spin_rad_s, PERIOD_S), &two),
            &two.iter().map(own).collect::<Vec<_>>(),
        );

        let section = |b, a| Section { b, a };
        let filters = BiquadsParams {
            gain_n_m: 2e5,
            sections: [
                vec![
                    section([0.5, -0.2, 0.1], [-1.1, 0.3]),
                    section([2.0, 1.0, -0.5], [0.4, 0.05]),
                ],
                vec![],
            ],
            force_max_n: 1e9,
        };
        let mut running = Biquads::new(&[Some(filters.clone())]);
        let own = |y: &Vec<f64>| {
            let mut forces_n = vec![V2::zeros()];
            running.forces_n(vectors(y).into_iter(), &mut forces_n);
            forces_n
        };
        close(
            &answers(&biquads(&filters), &one),
            &one.iter().map(own).collect::<Vec<_>>(),
        );
    }
}
