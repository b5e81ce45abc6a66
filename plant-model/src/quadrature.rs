//! Integrals of products of power series over a step, by Gauss–Legendre rules: the series of all
//! factors are evaluated at the nodes once, and every product is then a sum of a few terms.

/// Nodes of a rule over a part of a step, and their weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nodes<const N: usize> {
    pub(crate) theta: [f64; N],
    weight: [f64; N],
}

impl<const N: usize> Nodes<N> {
    /// A rule on [0, 1] stretched to [0, θ].
    pub(crate) fn stretched(rule: &Self, theta: f64) -> Self {
        Self {
            theta: rule.theta.map(|t| t * theta),
            weight: rule.weight.map(|w| w * theta),
        }
    }

    /// ∫ dθ of what is given at each node.
    #[inline(always)]
    pub(crate) fn integral(&self, at: impl Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for (j, w) in self.weight.iter().enumerate() {
            sum += w * at(j);
        }
        sum
    }
}

/// Value at a place of the polynomial that is one at place j and zero at the others.
pub(crate) fn lagrange(places: &[f64], j: usize, at: f64) -> f64 {
    let others = places.iter().enumerate().filter(|(m, _)| *m != j);
    others
        .map(|(_, place)| (at - place) / (places[j] - place))
        .product()
}

/// Exact to the power 11; 9e-8 off for the power 12.
#[rustfmt::skip]
pub(crate) const SIX: Nodes<6> = Nodes {
    theta: [
        0.03376524289842399, 0.16939530676686773, 0.38069040695840156, 0.6193095930415985,
        0.8306046932331322, 0.966234757101576,
    ],
    weight: [
        0.08566224618958518, 0.1803807865240693, 0.23395696728634552, 0.23395696728634552,
        0.1803807865240693, 0.08566224618958518,
    ],
};

/// Exact to the power 15; 4e-10 off for the power 16.
#[rustfmt::skip]
pub(crate) const EIGHT: Nodes<8> = Nodes {
    theta: [
        0.019855071751231884, 0.10166676129318664, 0.2372337950418355, 0.4082826787521751,
        0.591717321247825, 0.7627662049581645, 0.8983332387068134, 0.9801449282487681,
    ],
    weight: [
        0.05061426814518813, 0.11119051722668724, 0.15685332293894363, 0.181341891689181,
        0.181341891689181, 0.15685332293894363, 0.11119051722668724, 0.05061426814518813,
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    fn exact_to<const N: usize>(rule: &Nodes<N>) {
        let nodes = Nodes::stretched(rule, 0.7);
        for power in 0..=2 * N as i32 {
            let sum = nodes.integral(|j| nodes.theta[j].powi(power));
            let exact = 0.7_f64.powi(power + 1) / f64::from(power + 1);
            let off = (sum / exact - 1.0).abs();
            assert_eq!(
                off < 1e-14,
                power < 2 * N as i32,
                "{N} nodes, {power}: {off:e}"
            );
        }
    }

    /// A rule with N nodes is exact up to the power 2N − 1 and not beyond.
    #[test]
    fn rules_are_exact_to_their_power() {
        exact_to(&SIX);
        exact_to(&EIGHT);
    }
}
