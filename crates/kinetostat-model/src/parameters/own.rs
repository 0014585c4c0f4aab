//! Private copies of the chain, the sections and the stiffnesses that a limb shares with other limbs.

use std::collections::BTreeMap;

use crate::schema::{ChainTable, Document, Element, Spring6};

/// A limb whose chain, sections and stiffnesses are its own.
#[derive(Clone, Debug)]
pub(crate) struct OwnCopies {
    /// Name of the limb.
    pub(crate) limb: String,
    /// Names of the copies, and what they were copied from: chains, sections, stiffnesses.
    pub(crate) chain: (String, String),
    pub(crate) sections: BTreeMap<String, String>,
    pub(crate) stiffnesses: BTreeMap<String, String>,
}

/// Gives a limb its own chain, sections and stiffnesses. `None` where there is no such limb or chain.
pub(crate) fn own_copies(document: &mut Document, limb: &str) -> Option<OwnCopies> {
    let table = document.limb.iter_mut().find(|l| l.name == limb)?;
    let mut chain = document.chain.get(&table.chain)?.clone();
    let free = |taken: &dyn Fn(&str) -> bool, name: &str| {
        (1..)
            .map(|k| match k {
                1 => format!("{name} of {limb}"),
                k => format!("{name} of {limb} {k}"),
            })
            // Names of chains have at most 100 characters.
            .map(|long| match long.char_indices().nth(90) {
                Some((end, _)) => format!("{} {}", long[..end].trim(), long.len()),
                None => long,
            })
            .find(|new| !taken(new))
            .unwrap_or_else(|| name.to_owned())
    };
    let mut stiffnesses = BTreeMap::new();
    let mut sections = BTreeMap::new();
    // Names of sections and of stiffnesses are looked up alike: a link may name either.
    let own = |name: &mut String,
               document: &mut Document,
               sections: &mut BTreeMap<String, String>,
               stiffnesses: &mut BTreeMap<String, String>| {
        let made = sections.iter().chain(stiffnesses.iter());
        if let Some((new, _)) = made.clone().find(|(_, old)| *old == name) {
            *name = new.clone();
            return;
        }
        let (s, t) = (&document.section, &document.stiffness);
        let new = free(&|n| s.contains_key(n) || t.contains_key(n), name);
        let old = std::mem::replace(name, new.clone());
        if let Some(section) = document.section.get(&old).cloned() {
            document.section.insert(new.clone(), section);
            sections.insert(new, old);
        } else if let Some(stiffness) = document.stiffness.get(&old).cloned() {
            document.stiffness.insert(new.clone(), stiffness);
            stiffnesses.insert(new, old);
        }
    };
    let old = table.chain.clone();
    let new = free(&|n| document.chain.contains_key(n), &old);
    table.chain = new.clone();
    for name in referred(&mut chain) {
        own(name, document, &mut sections, &mut stiffnesses);
    }
    let of_sections: Vec<String> = stiffnesses.keys().cloned().collect();
    for key in of_sections {
        let Some(mut stiffness) = document.stiffness.remove(&key) else {
            continue;
        };
        if let Some(section) = &mut stiffness.section {
            own(section, document, &mut sections, &mut stiffnesses);
        }
        document.stiffness.insert(key, stiffness);
    }
    document.chain.insert(new.clone(), chain);
    Some(OwnCopies {
        limb: limb.to_owned(),
        chain: (new, old),
        sections,
        stiffnesses,
    })
}

/// Names of sections and stiffnesses that a chain refers to.
fn referred(chain: &mut ChainTable) -> Vec<&mut String> {
    let mut names = Vec::new();
    for element in &mut chain.elements {
        match element {
            Element::Link(e) => names.push(&mut e.link),
            Element::Parallelogram(e) => names.push(&mut e.parallelogram),
            Element::Spring6(e) => match &mut e.spring6 {
                Spring6::Named(name) => names.push(name),
                Spring6::Inline(stiffness) => names.extend(&mut stiffness.section),
            },
            _ => {}
        }
    }
    names
}

/// Takes out chains, sections and stiffnesses that nothing uses any more although something did before.
pub(crate) fn without_unused(document: &mut Document, copies: &[OwnCopies]) {
    for copy in copies {
        if document.limb.iter().all(|l| l.chain != copy.chain.1) {
            document.chain.remove(&copy.chain.1);
        }
    }
    let used = |document: &mut Document, name: &str| {
        let in_chains = document
            .chain
            .values_mut()
            .any(|c| referred(c).iter().any(|n| *n == name));
        let mut tables = document.stiffness.values();
        in_chains || tables.any(|s| s.section.as_deref() == Some(name))
    };
    for name in copies.iter().flat_map(|c| c.stiffnesses.values()) {
        if !used(document, name) {
            document.stiffness.remove(name);
        }
    }
    for name in copies.iter().flat_map(|c| c.sections.values()) {
        if !used(document, name) {
            document.section.remove(name);
        }
    }
}
