//! Limbs as lines only, for pictures that others draw.

use kinetostat::{Limb, Mechanism, model::Element};
use nalgebra::Vector3;

use crate::drawing::{limb::step, request::Placed};

impl Placed {
    /// Each limb as a line through its joints and the ends of its links, from one platform to the other; base axes, m.
    #[must_use]
    pub fn limb_lines(&self, mechanism: &Mechanism) -> Vec<Vec<Vector3<f64>>> {
        let limbs = mechanism.limbs().iter().enumerate();
        limbs.map(|(i, limb)| self.line(i, limb)).collect()
    }

    fn line(&self, index: usize, limb: &Limb) -> Vec<Vector3<f64>> {
        let chain = self.chain(limb);
        let elements = chain.elements();
        let mut pose = self.platforms[limb.from];
        let mut line = vec![pose.translation.vector];
        // A centre of mass is reached by an offset and left by its inverse.
        let to_mass = |i: usize| matches!(elements.get(i + 1), Some(Element::Node(n)) if chain.bodies().iter().any(|b| b.node == *n));
        for (i, element) in elements.iter().enumerate() {
            match element {
                Element::Rigid(offset) => pose *= *offset,
                Element::Motion(motion) => {
                    pose *= step(motion, &self.coordinates[index], &self.commands[index]).1;
                }
                Element::Node(_) => {}
            }
            let here = pose.translation.vector;
            if !to_mass(i) && line.last().is_none_or(|last| (here - last).norm() > 1e-9) {
                line.push(here);
            }
        }
        let tip = self.platforms[limb.to].translation.vector;
        if line.last().is_none_or(|last| (tip - last).norm() > 1e-9) {
            line.push(tip);
        }
        line
    }
}
