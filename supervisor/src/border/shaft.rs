//! A rigid rotor as a data sheet has it, and what its planes are by it.

use crate::border::config::{Config, ConfigError};

/// Where a plane has what, along the axis from the centre of mass \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanePositions {
    /// Retainer bearing.
    pub retainer_m: f32,
    /// Sensor.
    pub sensor_m: f32,
    /// Magnet.
    pub magnet_m: f32,
}

/// A rigid rotor, as a data sheet has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// Mass \[kg\], > 0.
    pub mass_kg: f32,
    /// Transverse moment of inertia I_t about the centre of mass \[kg m²\], > 0.
    pub transverse_inertia_kg_m2: f32,
    /// Polar moment of inertia I_p \[kg m²\], 0 to 2·I_t.
    pub polar_inertia_kg_m2: f32,
    /// Its two ends.
    pub places: [PlanePositions; 2],
}

/// Why there is no supervisor for a rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShaftError {
    /// A parameter of a plane, 0 or 1, is outside its range.
    Plane(usize, ConfigError),
    /// Mass or inertias are not what a body can have.
    Inertia,
    /// A position is no number, both retainer bearings stand at one place, or so far from each other or from the magnets that
    /// the ends move each other a thousand times as far as themselves.
    Places,
}

impl core::fmt::Display for ShaftError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Plane(plane, error) => write!(f, "plane {plane}: {error}"),
            Self::Inertia => f.write_str(
                "mass and transverse inertia are to be above 0, the polar one from 0 to twice the transverse one",
            ),
            Self::Places => f.write_str(
                "positions are to be numbers, those of the two retainer bearings to differ, and no other so far out",
            ),
        }
    }
}

impl core::error::Error for ShaftError {}

impl Shaft {
    /// Velocity at one place by an impulse at another, 1/m + z_i·z_j/I_t \[1/kg\].
    pub const fn mobility(&self, at_m: f32, of_m: f32) -> f32 {
        1.0 / self.mass_kg + at_m * of_m / self.transverse_inertia_kg_m2
    }

    /// A plane's configuration with the mass that an impact there moves, and the ratios in which its sensor and its magnet
    /// move with it; 0 or 1, and for anything else the second.
    pub const fn plane(&self, end: usize, config: &Config) -> Config {
        let [first, second] = self.places;
        let place = if end == 0 { first } else { second };
        let own = self.mobility(place.retainer_m, place.retainer_m);
        Config {
            mass_kg: 1.0 / own,
            retainer_plane_ratio: own / self.mobility(place.sensor_m, place.retainer_m),
            magnet_plane_ratio: self.mobility(place.magnet_m, place.retainer_m) / own,
            ..*config
        }
    }

    /// Mass, inertias, and the places of each plane in the order of their fields.
    pub fn values(&self) -> [f32; 9] {
        let [a, b] = self.places;
        [
            self.mass_kg,
            self.transverse_inertia_kg_m2,
            self.polar_inertia_kg_m2,
            a.retainer_m,
            a.sensor_m,
            a.magnet_m,
            b.retainer_m,
            b.sensor_m,
            b.magnet_m,
        ]
    }

    /// From [`Self::values`].
    pub fn from_values([mass, transverse, polar, a, b, c, d, e, f]: [f32; 9]) -> Self {
        let place = |retainer_m, sensor_m, magnet_m| PlanePositions {
            retainer_m,
            sensor_m,
            magnet_m,
        };
        Self {
            mass_kg: mass,
            transverse_inertia_kg_m2: transverse,
            polar_inertia_kg_m2: polar,
            places: [place(a, b, c), place(d, e, f)],
        }
    }

    pub(crate) fn check(&self) -> Result<(), ShaftError> {
        let (transverse, polar) = (self.transverse_inertia_kg_m2, self.polar_inertia_kg_m2);
        let body = self.mass_kg > 0.0 && transverse > 0.0;
        let finite = self.mass_kg.is_finite() && transverse.is_finite();
        if !(body && finite && polar >= 0.0 && polar <= 2.0 * transverse) {
            return Err(ShaftError::Inertia);
        }
        let [first, second] = self.places;
        let place = |p: PlanePositions| {
            p.retainer_m.is_finite() && p.sensor_m.is_finite() && p.magnet_m.is_finite()
        };
        if place(first) && place(second) && first.retainer_m != second.retainer_m {
            Ok(())
        } else {
            Err(ShaftError::Places)
        }
    }
}
