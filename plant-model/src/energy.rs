//! The energy audit: every joule in, out and stored.

/// Number of accounts in a [`Flows`].
pub(crate) const FLOWS: usize = 10;

/// Energy that went through each door since the start \[J\]; in a rate, power \[W\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Flows {
    /// In: work of the magnet's delivered force.
    pub control: f64,
    /// In: work of the external force.
    pub external: f64,
    /// In: work of the drive on the spin.
    pub drive: f64,
    /// In: work of the unbalance, which eq. (2.7) does not take from the spin.
    pub unbalance: f64,
    /// Out: rotor damping d_r.
    pub rotor_damping: f64,
    /// Out: dampers of the stator's mountings, and the drag of a race.
    pub stator_damping: f64,
    /// Out: contact damping d_c, and the dent left in the wall at lift-off.
    pub contact_damping: f64,
    /// Out: sliding friction μ·f_n·|v_rel|.
    pub sliding_friction: f64,
    /// Out: rolling friction μ_r·f_n·|v_w|.
    pub rolling_friction: f64,
    /// Not an energy: ∫ f_n dt \[N s\], carried along with the same quadrature.
    pub normal_impulse_n_s: f64,
}

impl Flows {
    fn array(&self) -> [f64; FLOWS] {
        [
            self.control,
            self.external,
            self.drive,
            self.unbalance,
            self.rotor_damping,
            self.stator_damping,
            self.contact_damping,
            self.sliding_friction,
            self.rolling_friction,
            self.normal_impulse_n_s,
        ]
    }

    /// `self += factor · other`.
    #[inline]
    pub(crate) fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.control += factor * other.control;
        self.external += factor * other.external;
        self.drive += factor * other.drive;
        self.unbalance += factor * other.unbalance;
        self.rotor_damping += factor * other.rotor_damping;
        self.stator_damping += factor * other.stator_damping;
        self.contact_damping += factor * other.contact_damping;
        self.sliding_friction += factor * other.sliding_friction;
        self.rolling_friction += factor * other.rolling_friction;
        self.normal_impulse_n_s += factor * other.normal_impulse_n_s;
    }

    /// Energy that came in \[J\].
    pub fn supplied(&self) -> f64 {
        self.control + self.external + self.drive + self.unbalance
    }

    /// Energy that was turned to heat \[J\].
    pub fn dissipated(&self) -> f64 {
        self.rotor_damping
            + self.stator_damping
            + self.contact_damping
            + self.sliding_friction
            + self.rolling_friction
    }
}

/// State of the audit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Audit {
    /// Energy through each door so far.
    pub flows: Flows,
    /// Stored energy at the start \[J\].
    pub stored_at_start_j: f64,
    /// Stored energy now \[J\].
    pub stored_j: f64,
    /// Largest stored energy seen, by absolute value, without all but 1e-4 of what spin and race had at the start: it may
    /// never take part \[J\].
    pub stored_peak_j: f64,
}

impl Audit {
    /// Energy that appeared from nowhere \[J\].
    pub fn gap_j(&self) -> f64 {
        self.stored_j - self.stored_at_start_j - self.flows.supplied() + self.flows.dissipated()
    }

    /// Energy turned over \[J\]: everything that moved, and the most that was stored.
    pub fn turnover_j(&self) -> f64 {
        let moved: f64 = self.flows.array()[..FLOWS - 1]
            .iter()
            .map(|x| x.abs())
            .sum();
        moved + self.stored_peak_j
    }

    /// |gap| over turnover; 0 where nothing ever moved.
    pub fn residual(&self) -> f64 {
        let turnover = self.turnover_j();
        if turnover > 0.0 {
            self.gap_j().abs() / turnover
        } else {
            0.0
        }
    }
}
