//! Friction that holds speeds at zero, in one plane or in several at once.

use super::system::{Channel, MAX_HELD, MachineSystem};
use crate::V2;
use crate::vector::perp;
use nalgebra::SMatrix;

/// A channel that holds its speed at zero, and what one newton of it does.
#[derive(Debug, Clone)]
pub(crate) struct Held {
    pub(crate) plane: usize,
    pub(crate) channel: Channel,
    /// Along t̂, along which the speed is measured and the force acts.
    pub(crate) tangent: V2,
    /// Accelerations of the pairs, of the spin and of the plane's race.
    pub(crate) accelerations: Vec<V2>,
    pub(crate) spin: f64,
    pub(crate) race: f64,
}

/// All of them.
#[derive(Debug, Clone)]
pub(crate) struct Holding {
    held: Vec<Held>,
    count: usize,
    /// Forces per rates of the speeds: the inverse of their mobility.
    give: SMatrix<f64, MAX_HELD, MAX_HELD>,
}

impl Holding {
    pub(crate) fn new(pairs: usize) -> Self {
        let held = Held {
            plane: 0,
            channel: Channel::Sliding,
            tangent: V2::zeros(),
            accelerations: vec![V2::zeros(); pairs],
            spin: 0.0,
            race: 0.0,
        };
        Self {
            held: vec![held; MAX_HELD],
            count: 0,
            give: SMatrix::zeros(),
        }
    }

    /// Takes over which channels hold, with the contact normals and the direction of an unbalance.
    pub(crate) fn set(
        &mut self,
        system: &MachineSystem,
        channels: impl Iterator<Item = (usize, Channel)>,
        normal: impl Fn(usize) -> V2,
        direction: V2,
    ) {
        self.count = 0;
        for (plane, channel) in channels.take(MAX_HELD) {
            let held = &mut self.held[self.count];
            (held.plane, held.channel, held.tangent) = (plane, channel, perp(normal(plane)));
            held.accelerations.fill(V2::zeros());
            system.body.contacts[plane].push(&mut held.accelerations, held.tangent);
            (held.spin, held.race) = system.turned_by(plane, channel);
            if let Some(unbalance) = &system.body.unbalance {
                unbalance.push(&mut held.accelerations, -held.spin * perp(direction));
            }
            self.count += 1;
        }
        if self.count == 0 {
            return;
        }
        let held = &self.held[..self.count];
        let mobility = |a: usize, b: usize| {
            let (a, b) = (&held[a], &held[b]);
            let race = if a.plane == b.plane { b.race } else { 0.0 };
            a.tangent
                .dot(&system.body.contacts[a.plane].of(&b.accelerations))
                + system.surface_of(a.plane, a.channel, b.spin, race)
        };
        let channels = held.iter().map(|h| (h.plane, h.channel));
        system.inverse_mobility(&mut self.give, channels, mobility);
    }

    pub(crate) fn held(&self) -> &[Held] {
        &self.held[..self.count]
    }

    /// Forces (or impulses) that take the channels' rates (or speeds) away.
    pub(crate) fn against(&self, speed: impl Fn(&Held) -> f64) -> [f64; MAX_HELD] {
        let mut forces = [0.0; MAX_HELD];
        for (column, held) in self.held().iter().enumerate() {
            let speed = speed(held);
            for (row, force) in forces.iter_mut().enumerate().take(self.count) {
                *force -= self.give[(row, column)] * speed;
            }
        }
        forces
    }
}
