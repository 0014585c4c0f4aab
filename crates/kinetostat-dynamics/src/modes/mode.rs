//! A mode: its kind, the motions in it for drawings, and shares of bodies and springs in its energy.

use nalgebra::{DVector, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::linear::LinearDynamics;

/// Kind of a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ModeKind {
    /// Vibration about the equilibrium.
    Vibration,
    /// Nothing holds it: mass without stiffness. Its frequency is zero within rounding.
    Free,
    /// Negative stiffness: the motion diverges. Its frequency is written with a minus sign.
    Unstable,
}

/// A mode of vibration.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Mode {
    /// `w^2`, (rad/s)^2; negative where the equilibrium is unstable. Zero exactly for a free direction.
    pub squared: f64,
    /// Kind of the mode.
    pub kind: ModeKind,
    /// Shape by the independent coordinates, normalised by mass: `phi^T M phi = 1`.
    pub shape: DVector<f64>,
    /// Motion of the tool in it, base axes at the tool's origin: m and rad, in units of `1 / sqrt(kg)`.
    pub tool: Vector6<f64>,
}

impl Mode {
    /// Frequency, Hz; `-sqrt(-w^2) / 2 pi` of an unstable one.
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.squared.abs().sqrt().copysign(self.squared) / std::f64::consts::TAU
    }
}

impl LinearDynamics {
    /// Motion of every block of coordinates in a mode: of each limb its own coordinates (m, rad; followed by the six of the
    /// platform that it stands on, where that is not the base), then of each platform besides the base its twist at its
    /// origin, base axes. Of a chain there is the one block. Units: those divided by `sqrt(kg)`, as the shape has them.
    #[must_use]
    pub fn block_motions(&self, mode: &Mode) -> Vec<DVector<f64>> {
        let all = self.all(&mode.shape);
        (0..self.blocks.len())
            .map(|block| self.of_block(block, &all))
            .collect()
    }
}

/// A part's share of the energy of a mode.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct EnergyShare {
    /// Name of the body, link, platform, joint or spring.
    pub name: String,
    /// Share of the whole; all shares add to one.
    pub share: f64,
}

/// Adds what has the same name, and divides by the sum.
fn shares(parts: impl Iterator<Item = (String, f64)>) -> Vec<EnergyShare> {
    let mut list: Vec<EnergyShare> = Vec::new();
    for (name, share) in parts {
        match list.iter_mut().find(|own| own.name == name) {
            Some(own) => own.share += share,
            None => list.push(EnergyShare { name, share }),
        }
    }
    let sum: f64 = list.iter().map(|own| own.share).sum();
    if sum != 0.0 {
        list.iter_mut().for_each(|own| own.share /= sum);
    }
    list.sort_by(|a, b| b.share.total_cmp(&a.share));
    list
}

impl LinearDynamics {
    /// Kinetic energy of a mode by bodies, links and platforms, the largest first. They add to one.
    #[must_use]
    pub fn kinetic_shares(&self, mode: &Mode) -> Vec<EnergyShare> {
        self.kinetic_of(&[&mode.shape])
    }

    /// Elastic energy of a mode by springs: joints, drives, and links with all their segments together. The largest first;
    /// they add to one, and are all zero where no spring is strained.
    #[must_use]
    pub fn elastic_shares(&self, mode: &Mode) -> Vec<EnergyShare> {
        self.elastic_of(&[&mode.shape])
    }

    /// Kinetic energy of several shapes together.
    pub(crate) fn kinetic_of(&self, shapes: &[&DVector<f64>]) -> Vec<EnergyShare> {
        shares(shapes.iter().flat_map(|shape| {
            let all = self.all(shape);
            self.masses.iter().map(move |part| {
                (
                    part.name.clone(),
                    part.kinetic(&self.of_block(part.block, &all)),
                )
            })
        }))
    }

    /// Elastic energy of several shapes together.
    pub(crate) fn elastic_of(&self, shapes: &[&DVector<f64>]) -> Vec<EnergyShare> {
        shares(shapes.iter().flat_map(|shape| {
            let all = self.all(shape);
            self.springs.iter().map(move |part| {
                let own = self.of_block(part.block, &all);
                let own = own.rows(part.first, part.material.nrows());
                let name = part.link.as_ref().unwrap_or(&part.name).clone();
                (name, 0.5 * own.dot(&(&part.material * own)))
            })
        }))
    }
}
