//! The rigid stator with a bore that is out of round.

use super::{Rigid, Stator};
use crate::V2;
use crate::ellipse::Ellipse;
use crate::quadrature::Nodes;
use crate::series::Series;

/// A stator that does not move, with an elliptic bore.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Elliptic(pub(crate) Ellipse);

impl Stator for Elliptic {
    type State = ();
    type Series = ();
    const OUT_OF_ROUND: bool = true;
    fn ellipse(&self) -> Option<&Ellipse> {
        Some(&self.0)
    }
    fn kick(_state: &mut (), _change_m_s: V2) {}
    fn inverse_mass(&self) -> f64 {
        Rigid.inverse_mass()
    }
    fn rates(&self, _state: &(), _force_n: V2) {}
    fn stored_j(&self, state: &()) -> f64 {
        Rigid.stored_j(state)
    }
    fn damping_w(&self, state: &()) -> f64 {
        Rigid.damping_w(state)
    }
    fn undamped_rate_rad_s(&self) -> f64 {
        Rigid.undamped_rate_rad_s()
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        Rigid.fastest_rate_rad_s()
    }
    fn start_series(_series: &mut (), _state: &()) {}
    fn extend_position(&self, _series: &mut (), _k: usize, _next_s: f64) {}
    fn extend_velocity(&self, _series: &mut (), _k: usize, _next_s: f64, _force_n: V2) {}
    fn inner_acceleration(&self, series: &(), k: usize, force_n: V2) -> V2 {
        Rigid.inner_acceleration(series, k, force_n)
    }
    fn coefficient(_series: &(), _k: usize) {}
    fn damper_speeds<const N: usize>(series: &(), nodes: &Nodes<N>, order: usize) -> [[V2; N]; 2] {
        Rigid::damper_speeds(series, nodes, order)
    }
    fn damper_constants(&self) -> [V2; 2] {
        Rigid.damper_constants()
    }
    fn inner_series(series: &()) -> Option<&Series> {
        Rigid::inner_series(series)
    }
    fn at(_series: &(), _theta: f64, _order: usize) {}
}
