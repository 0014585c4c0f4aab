//! Limbs as lines only, for pictures that others draw.

use kinetostat::{Limb, Mechanism, model::Element};
use nalgebra::Vector3;

use crate::drawing::{limb::step, request::Placed};

/// Places nearer than this are one, m.
const SAME_PLACE: f64 = 1e-9;

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
        let mut places = vec![pose.translation.vector];
        for element in elements {
            match element {
                Element::Rigid(offset) => pose *= *offset,
                Element::Motion(motion) => {
                    pose *= step(motion, &self.coordinates[index], &self.commands[index]).1;
                }
                Element::Node(_) => {}
            }
            places.push(pose.translation.vector);
        }
        // A centre of mass is reached by an offset and left by its inverse: the line does not go there. One without an offset
        // lies on the line already.
        let apart = |a: usize, b: usize| match (places.get(a), places.get(b)) {
            (Some(a), Some(b)) => (a - b).norm() > SAME_PLACE,
            _ => true,
        };
        let aside = |node: usize| {
            let mass = matches!(elements.get(node), Some(Element::Node(n)) if chain.bodies().iter().any(|b| b.node == *n));
            mass && node > 0 && !apart(node - 1, node + 2)
        };
        // Place k lies before element k.
        let mut line: Vec<Vector3<f64>> = Vec::new();
        for (k, &here) in places.iter().enumerate() {
            let to_mass = aside(k) || k.checked_sub(1).is_some_and(aside);
            if !to_mass
                && line
                    .last()
                    .is_none_or(|last| (here - last).norm() > SAME_PLACE)
            {
                line.push(here);
            }
        }
        let tip = self.platforms[limb.to].translation.vector;
        if line
            .last()
            .is_none_or(|last| (tip - last).norm() > SAME_PLACE)
        {
            line.push(tip);
        }
        line
    }
}
