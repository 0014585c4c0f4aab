//! Figures that are possible but unlikely: usually a unit or a decimal point is wrong.
//!
//! Takes a document and the machine that it describes; gives warnings, each at the number that it is about. Nothing here
//! refuses a model.

pub(crate) mod at_home;
pub(crate) mod drives;
pub(crate) mod home;
pub(crate) mod link_matrix;
pub(crate) mod masses;
pub(crate) mod numbers;
pub(crate) mod springs;

use kinetostat::Mechanism;

use crate::problem::KeyPath;
use crate::schema::{Document, Element};

/// One limb of a machine.
pub(crate) struct LimbCheck<'a> {
    pub(crate) document: &'a Document,
    pub(crate) mechanism: &'a Mechanism,
    pub(crate) limb: usize,
    /// Size of the machine, m.
    pub(crate) size: f64,
}

impl LimbCheck<'_> {
    /// An element of the limb's chain and its place in the file, by its name.
    pub(crate) fn element(&self, name: &str) -> Option<(&Element, KeyPath)> {
        let chain = &self.document.limb[self.limb].chain;
        let elements = &self.document.chain.get(chain)?.elements;
        let own = |e: &Element, i: usize| match e.name() {
            Some(given) => given == name,
            None => format!("{} {}", e.word(), i + 1) == name,
        };
        let index = (0..elements.len()).find(|&i| own(&elements[i], i))?;
        let place = KeyPath::root().key("chain").key(chain);
        Some((&elements[index], place.key("elements").index(index)))
    }

    pub(crate) fn place(&self, name: &str, keys: &[&str]) -> KeyPath {
        match self.element(name) {
            Some((element, place)) => {
                let written = serde_json::to_value(element).unwrap_or_default();
                let has = |key: &&&str| written.get(**key).is_some_and(|v| !v.is_null());
                keys.iter()
                    .find(has)
                    .map_or(place.clone(), |k| place.key(k))
            }
            None => KeyPath::root().key("limb").index(self.limb),
        }
    }
}
