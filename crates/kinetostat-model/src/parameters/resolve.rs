//! Resolves paths to places in the walk over a document.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use crate::parameters::list::{Parameter, list, walk};
use crate::parameters::walk::Visit;
use crate::problem::{ModelError, Problem};
use crate::schema::{ChainTable, Deviation, Document, Element, Placement, Spring6};

/// A document, and where some of its numbers stand.
#[derive(Clone, Debug)]
pub(crate) struct Resolved {
    /// Document with copies for single limbs and with deviations of zero.
    document: Document,
    copies: Vec<OwnCopies>,
    pub(crate) parameters: Vec<Parameter>,
    /// Place of a number in the walk, and which parameter it is; by place.
    targets: Vec<(usize, usize)>,
}

impl Resolved {
    pub(crate) fn new(document: &Document, paths: &[&str], file: &str) -> Result<Self, ModelError> {
        if let Some((i, path)) = paths
            .iter()
            .enumerate()
            .find(|(i, p)| paths[..*i].contains(p))
        {
            let first = paths.iter().position(|p| p == path).unwrap_or(0);
            return Err(refused(
                file,
                format!(
                    "the parameter '{path}' is given twice, as number {} and {}",
                    first + 1,
                    i + 1
                ),
                "keep one of them",
            ));
        }
        let mut document = document.clone();
        for path in paths {
            new_deviation(&mut document, path);
        }
        let shared = list(&mut document);
        let exists = |path: &str| shared.iter().any(|p| p.path == path);
        let limbs: Vec<String> = document.limb.iter().map(|l| l.name.clone()).collect();
        let single = limbs.iter().filter(|limb| {
            let own = format!("limb.{limb}.");
            paths.iter().any(|p| p.starts_with(&own) && !exists(p))
        });
        let copies: Vec<OwnCopies> = single
            .filter_map(|limb| own_copies(&mut document, limb))
            .collect();
        let listed: Vec<(Parameter, Vec<String>)> = list(&mut document)
            .into_iter()
            .map(|p| (names(&p.path, &copies), p))
            .map(|(names, p)| (p, names))
            .collect();
        let mut parameters = Vec::new();
        // The owner of a number is the one whose name of it comes last: the limb's own before the chain's.
        let mut targets: Vec<Option<(usize, usize)>> = vec![None; listed.len()];
        for (index, path) in paths.iter().enumerate() {
            let mut first = None;
            for (place, (found, names)) in listed.iter().enumerate() {
                let Some(rank) = names.iter().position(|n| n == path) else {
                    continue;
                };
                first.get_or_insert(found);
                if targets[place].is_none_or(|(other, _)| other < rank) {
                    targets[place] = Some((rank, index));
                }
            }
            let Some(found) = first else {
                return Err(unknown(file, path, &listed));
            };
            parameters.push(Parameter {
                path: (*path).to_owned(),
                ..found.clone()
            });
        }
        let targets = targets.into_iter().enumerate();
        Ok(Self {
            document,
            copies,
            parameters,
            targets: targets
                .filter_map(|(place, t)| Some((place, t?.1)))
                .collect(),
        })
    }

    /// The document with these values.
    pub(crate) fn set(&self, values: &[f64], file: &str) -> Result<Document, ModelError> {
        if values.len() != self.parameters.len() {
            return Err(refused(
                file,
                format!(
                    "{} values are needed, {} are given",
                    self.parameters.len(),
                    values.len()
                ),
                "give one value for every parameter, in their order",
            ));
        }
        let mut document = self.document.clone();
        let mut setter = Setter {
            place: 0,
            targets: self.targets.as_slice(),
            values,
        };
        walk(&mut document, &mut setter);
        Ok(document)
    }

    /// Takes out what nothing uses since limbs have their own copies.
    pub(crate) fn tidy(&self, document: &mut Document) {
        without_unused(document, &self.copies);
    }
}

struct Setter<'a> {
    place: usize,
    targets: &'a [(usize, usize)],
    values: &'a [f64],
}

impl Visit for Setter<'_> {
    fn enter(&mut self, _: &str) {}

    fn leave(&mut self) {}

    fn number(&mut self, value: &mut f64, _: bool) {
        if let Some((&(place, index), rest)) = self.targets.split_first()
            && place == self.place
        {
            *value = self.values[index];
            self.targets = rest;
        }
        self.place += 1;
    }
}

/// Names accepted for a number: by its table; for a copy of one limb, by its original and, last, by the limb.
fn names(path: &str, copies: &[OwnCopies]) -> Vec<String> {
    for copy in copies {
        let (new, old) = &copy.chain;
        if let Some(rest) = path.strip_prefix(&format!("chain.{new}.")) {
            return vec![
                format!("chain.{old}.{rest}"),
                format!("limb.{}.{rest}", copy.limb),
            ];
        }
        for (table, copied) in [
            ("section", &copy.sections),
            ("stiffness", &copy.stiffnesses),
        ] {
            for (new, old) in copied {
                if let Some(rest) = path.strip_prefix(&format!("{table}.{new}.")) {
                    return vec![
                        format!("{table}.{old}.{rest}"),
                        format!("limb.{}.{table}.{old}.{rest}", copy.limb),
                    ];
                }
            }
        }
    }
    vec![path.to_owned()]
}

/// Adds the deviation of zero that a path speaks of, where the document has none there.
fn new_deviation(document: &mut Document, path: &str) {
    let Some((limb, at, key)) = split_deviation(document, path) else {
        return;
    };
    let same = |d: &&mut Deviation| d.limb == limb && d.at == at;
    let known = document.deviation.iter_mut().find(same);
    let zero = Some([0.0; 3]);
    let mut written = known
        .as_ref()
        .map(|d| (**d).clone())
        .unwrap_or_else(|| Deviation {
            limb: limb.clone(),
            at: at.clone(),
            ..Deviation::default()
        });
    let is_new = known.is_none();
    let motion: &mut Placement = match (key.as_str(), &mut written) {
        ("longer_by_mm", w) if is_new => {
            w.longer_by_mm = Some(0.0);
            document.deviation.push(written);
            return;
        }
        ("longer_by_mm", _) => return,
        (_, w) if w.longer_by_mm.is_some() || w.tilted_by_deg.is_some() => return,
        (_, w) => w.moved_by.get_or_insert_default(),
    };
    let m = motion.clone();
    if key == "translation_mm"
        && [
            m.translation_mm,
            m.translation_m,
            m.position_mm,
            m.position_m,
        ] == [None; 4]
    {
        motion.translation_mm = zero;
    } else if key == "rotation_vector_deg"
        && (Placement {
            translation_mm: None,
            translation_m: None,
            position_mm: None,
            position_m: None,
            ..m
        }) == Placement::default()
    {
        motion.rotation_vector_deg = zero;
    }
    match known {
        Some(known) => *known = written,
        None => document.deviation.push(written),
    }
}

/// Limb, place and key of `deviation.LIMB.PLACE.KEY`, where limb and place exist.
fn split_deviation(document: &Document, path: &str) -> Option<(String, String, String)> {
    let rest = path.strip_prefix("deviation.")?;
    document.limb.iter().find_map(|limb| {
        let rest = rest.strip_prefix(&limb.name)?.strip_prefix('.')?;
        let chain = document.chain.get(&limb.chain)?;
        let names = chain.elements.iter().filter_map(|e| e.name());
        names.chain(["start", "end"]).find_map(|at| {
            let rest = rest.strip_prefix(at)?.strip_prefix('.')?;
            let key = match rest.split_once('.') {
                None if rest == "longer_by_mm" => rest,
                Some((key @ ("translation_mm" | "rotation_vector_deg"), "x" | "y" | "z")) => key,
                _ => return None,
            };
            Some((limb.name.clone(), at.to_owned(), key.to_owned()))
        })
    })
}

fn refused(file: &str, message: String, help: &str) -> ModelError {
    ModelError::new(vec![Problem::without_text(file, message, help.into())])
}

/// Error for a missing parameter, with the nearest ones.
fn unknown(file: &str, path: &str, listed: &[(Parameter, Vec<String>)]) -> ModelError {
    let lower = path.to_lowercase();
    let known = listed.iter().flat_map(|(_, names)| names);
    // Orders by the number of equal leading steps, then by the distance in spelling.
    let mut near: Vec<(Reverse<usize>, usize, &str)> = known
        .map(|name| {
            let steps = path.split('.').zip(name.split('.'));
            let shared = steps.take_while(|(a, b)| a == b).count();
            let apart = strsim::damerau_levenshtein(&lower, &name.to_lowercase());
            (Reverse(shared), apart, name.as_str())
        })
        .collect();
    near.sort_unstable();
    near.dedup();
    let names: Vec<String> = near
        .iter()
        .take(3)
        .map(|(_, _, n)| format!("'{n}'"))
        .collect();
    let help = format!("nearest are {}", names.join(", "));
    refused(file, format!("there is no parameter '{path}'"), &help)
}

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
fn own_copies(document: &mut Document, limb: &str) -> Option<OwnCopies> {
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
fn without_unused(document: &mut Document, copies: &[OwnCopies]) {
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
