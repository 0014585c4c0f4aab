//! Reads materials from TOML.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use serde::Deserialize;
use serde_spanned::Spanned;

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::law::Law;
use crate::material::corrected::{Group, Material, MeasuredIn};
use crate::source::{Source, Subject, bare};

const MOST_BYTES: usize = 10_000_000;
const MOST_MATERIALS: usize = 10_000;

const MATERIALS: Subject = Subject {
    entry: "material",
    whole: "file of materials",
    form: "keys and values as in library.toml: name, group, law, spread_percent, source, measured_in",
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    material: Vec<Entry>,
}

/// A material as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Spanned<String>,
    #[serde(default)]
    aliases: Vec<Spanned<String>>,
    group: Group,
    law: Spanned<Law>,
    spread_percent: Spanned<f64>,
    source: Spanned<String>,
    #[serde(default)]
    assumptions: Vec<String>,
    measured_in: Spanned<MeasuredIn>,
    #[serde(default)]
    chip_mm: Option<Spanned<[f64; 2]>>,
    #[serde(default)]
    speed_m_per_min: Option<Spanned<[f64; 2]>>,
}

impl Source<'_> {
    fn pair(
        &self,
        name: &str,
        value: Option<Spanned<[f64; 2]>>,
        bounds: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<Option<(f64, f64)>> {
        let Some(value) = value else { return Ok(None) };
        let [from, to] = *value.get_ref();
        for number in [from, to] {
            within(CutErrorKind::Material, name, number, bounds.clone(), unit)
                .map_err(self.placed(&value))?;
        }
        match from < to {
            true => Ok(Some((from, to))),
            false => Err(self.error(
                value.span().start,
                name,
                format!("from {from} to {to} {unit}"),
                "a range that begins below its end".to_owned(),
            )),
        }
    }

    fn material(&self, entry: Entry) -> Result<Material> {
        let text = |name: &str, value: &Spanned<String>| match bare(value.get_ref()).is_empty() {
            true => Err(self.error(
                value.span().start,
                name,
                format!("`{}`", value.get_ref()),
                "letters or digits".to_owned(),
            )),
            false => Ok(()),
        };
        text("name", &entry.name)?;
        text("source", &entry.source)?;
        for alias in &entry.aliases {
            text("alias", alias)?;
        }
        let law = entry
            .law
            .get_ref()
            .checked()
            .map_err(self.placed(&entry.law))?;
        let kind = CutErrorKind::Material;
        let percent = *entry.spread_percent.get_ref();
        within(kind, "spread", percent, 0.0..=100.0, "%")
            .map_err(self.placed(&entry.spread_percent))?;
        let measured_in = *entry.measured_in.get_ref();
        let at = self.placed(&entry.measured_in);
        if let Some(rake) = measured_in.rake_deg {
            within(kind, "rake angle", rake, -30.0..=40.0, "deg").map_err(&at)?;
        }
        if let Some(speed) = measured_in.speed_m_per_min {
            within(kind, "cutting speed", speed, 1.0..=1e4, "m/min").map_err(&at)?;
        }
        Ok(Material {
            chip_mm: self.pair("thickness of chip", entry.chip_mm, 1e-6..=100.0, "mm")?,
            speed_m_per_min: self.pair(
                "cutting speed",
                entry.speed_m_per_min,
                1e-3..=1e5,
                "m/min",
            )?,
            name: entry.name.into_inner(),
            aliases: entry.aliases.into_iter().map(Spanned::into_inner).collect(),
            group: entry.group,
            law,
            spread: percent / 100.0,
            source: entry.source.into_inner(),
            assumptions: entry.assumptions,
            measured_in,
        })
    }
}

/// All materials of a text.
pub(crate) fn read(file: &str, text: &str) -> Result<Vec<Material>> {
    let source = Source { file, text };
    let most = |quantity: &str, count: usize, most: usize, unit: &str| match count <= most {
        true => Ok(()),
        false => {
            let found = format!("{count} {unit}");
            let expected = format!("at most {most} {unit}");
            Err(CutError::new(CutErrorKind::File, quantity, found, expected).at(file, None))
        }
    };
    most("file of materials", text.len(), MOST_BYTES, "bytes")?;
    let read: File = toml::from_str(text).map_err(|error| source.toml_fault(&error, &MATERIALS))?;
    most(
        "materials",
        read.material.len(),
        MOST_MATERIALS,
        "materials",
    )?;
    // Spelling without signs, and which material it means.
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    let mut list = Vec::with_capacity(read.material.len());
    for (index, entry) in read.material.into_iter().enumerate() {
        for name in std::iter::once(&entry.name).chain(&entry.aliases) {
            let before = taken.insert(bare(name.get_ref()), index);
            if before.is_some_and(|other| other != index) {
                return Err(source.error(
                    name.span().start,
                    "name of a material",
                    format!("`{}` names two materials of this file", name.get_ref()),
                    "a name of its own for each".to_owned(),
                ));
            }
        }
        list.push(source.material(entry)?);
    }
    Ok(list)
}
