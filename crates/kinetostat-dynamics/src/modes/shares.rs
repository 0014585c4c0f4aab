//! Shares of bodies in the kinetic energy and of springs in the elastic energy of a mode.

use nalgebra::DVector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::linear::LinearDynamics;
use crate::modes::mode::Mode;

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
