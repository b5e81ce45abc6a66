//! Radau IIA with five stages as numbers. With A_ij = ∫ over [0, c_i] of the Lagrange polynomial of node j,
//! everything here follows from the nodes; computed with 50 digits.

/// Stages of a step.
pub(super) const STAGES: usize = 5;

/// Collocation points: zeros of P₅ − P₄ (Legendre polynomials on [0, 1]).
#[rustfmt::skip]
pub(super) const NODES: [f64; STAGES] = [0.05710419611451768, 0.2768430136381238, 0.5835904323689168, 0.8602401356562195, 1.0];

/// Quadrature weights.
#[rustfmt::skip]
pub(super) const WEIGHTS: [f64; STAGES] = [0.14371356079122594, 0.28135601514946207, 0.31182652297574126, 0.22310390108357075, 0.04];

/// Real eigenvalue of the inverse of the method's matrix A.
pub(super) const REAL: f64 = 6.2867047517292765;

/// Its complex ones, as real and imaginary part.
#[rustfmt::skip]
pub(super) const PAIRS: [(f64, f64); STAGES / 2] = [(5.70095329867179, 3.2102656003085497), (3.655694325463572, 6.543736899360077)];

/// Eigenvectors in columns: the real one, then real and imaginary part of each other.
#[rustfmt::skip]
pub(super) const T: [[f64; STAGES]; STAGES] = [
    [0.013576867344947943, -0.011478515255229515, 0.01401985889287541, -0.010242047817908826, -0.04767387729029572],
    [0.0016179004017190875, -0.007668830749180163, -0.024708578426518527, 0.05017286451737106, 0.09433181918161143],
    [0.07915785334744721, 0.01939846399882895, -0.08180035370375117, -0.23053953404341795, -0.1027030453801259],
    [0.41225608268046143, 0.40760117128019907, -0.19968242788680252, 0.37789390224886127, -0.46674413033249434],
    [1.0, 1.0, 0.0, 1.0, 0.0],
];
#[rustfmt::skip]
pub(super) const T_INVERSE: [[f64; STAGES]; STAGES] = [
    [27.697693775684087, 12.783337911304406, 3.20848938671343, -0.9514904122489162, 0.7415504960259897],
    [-33.041880213519, -17.376953479063566, -0.17212906325400557, -0.09916977798254265, 0.5312281158383066],
    [8.611443979875292, -9.699991409528808, -1.9147286396968743, -2.41869200608494, 1.0474634879353375],
    [5.344186437834912, 4.593615567759161, -3.0363603234594243, 1.050660190231459, -0.27277861186429625],
    [-3.748059807439805, 3.984965736343885, 1.0444156416080188, -1.1840985681379486, 0.44991777015678036],
];

/// Quadrature with the start as one more node of weight 1/`REAL`, less the method, times A⁻¹.
#[rustfmt::skip]
pub(super) const ERROR: [f64; STAGES] = [-4.418997716796381, 0.57923485225667, -0.199237560953468, 0.09416748369194548, -0.03181316888549383];

/// Powers of θ of the collocation polynomial from the stages: inverse of NODES_i^(k + 1).
#[rustfmt::skip]
pub(super) const POWERS: [[f64; STAGES]; STAGES] = [
    [27.78093394406464, -3.641478498049213, 1.2525477211691187, -0.5920031671845428, 0.2],
    [-208.02785730090133, 77.88337605511782, -29.167414317829696, 14.111895563613205, -4.8],
    [524.1878839694918, -264.89491356822634, 137.90290440413477, -72.39587480540027, 25.2],
    [-543.8283560361325, 317.67586907995275, -202.09087094360743, 123.04335789978718, -44.8],
    [199.88739542347736, -127.022853068795, 92.10283313613321, -64.16737549081559, 25.2],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The quadrature of the error estimate is exact to the power 4, as its weights at the stages and
    /// 1/`REAL` at the start must be.
    #[test]
    fn transforms_are_inverse_and_the_estimate_is_of_order_five() {
        for (i, row) in T.iter().enumerate() {
            for j in 0..STAGES {
                let column = T_INVERSE.map(|row| row[j]);
                let product: f64 = row.iter().zip(column).map(|(a, b)| a * b).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-13);
            }
        }
        // y = θ^p: z_i = NODES_i^p, y' at the start is 0 but for p = 1.
        for p in 1..=5 {
            let sum: f64 = ERROR.iter().zip(NODES).map(|(e, c)| e * c.powi(p)).sum();
            let start = if p == 1 { 1.0 / REAL } else { 0.0 };
            assert!((sum + start).abs() < 1e-14, "power {p}: {}", sum + start);
        }
    }
}
