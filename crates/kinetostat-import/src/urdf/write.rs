//! The model file: our TOML, one line for each element, with comments that say where it came from and
//! what is to be filled in.

use std::fmt::Write as _;

use kinetostat::Pose;
use kinetostat_model::schema::{Placement, Section};
use serde::Serialize;

use crate::urdf::chain::{Line, placement};

/// Parts of the model file.
pub(crate) struct Parts<'a> {
    pub(crate) name: &'a str,
    pub(crate) file: &'a str,
    pub(crate) base: &'a str,
    pub(crate) tip: &'a str,
    pub(crate) gravity: [f64; 3],
    /// Name and pose at home.
    pub(crate) platforms: Vec<(String, Pose)>,
    /// Platform of the tool and frame of the tip link in it, where the frames differ.
    pub(crate) tip_in_tool: Option<(&'a str, &'a Placement)>,
    pub(crate) section: Option<(&'a str, &'a Section)>,
    /// Name, from, to, lines.
    pub(crate) limbs: Vec<(String, String, String, Vec<Line>)>,
    pub(crate) rigid_drives: bool,
    pub(crate) masses: bool,
}

/// A value in TOML, tables in braces.
fn value<T: Serialize + ?Sized>(v: &T) -> Result<String, toml::ser::Error> {
    let mut text = String::new();
    v.serialize(toml::ser::ValueSerializer::new(&mut text))?;
    Ok(text)
}

/// Comment lines; names of a file cannot break out of them.
fn comment(out: &mut String, indent: &str, text: &str) {
    for line in text.lines() {
        let line: String = line
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let _ = writeln!(out, "{indent}# {}", line.trim_end());
    }
}

pub(crate) fn text(parts: &Parts<'_>) -> Result<String, toml::ser::Error> {
    let mut out = String::new();
    let file: String = parts
        .file
        .chars()
        .rev()
        .take_while(|c| !"/\\".contains(*c))
        .collect();
    let file: String = file.chars().rev().collect();
    comment(
        &mut out,
        "",
        &format!(
            "Imported from {file} (URDF): base '{}', tip '{}'. Lengths in m, angles in rad, as there.",
            parts.base, parts.tip
        ),
    );
    comment(
        &mut out,
        "",
        "A URDF says nothing of what bends. The elastic part of this file:",
    );
    comment(
        &mut out,
        "",
        match parts.rigid_drives {
            true => {
                "- drives: those marked FILL IN are rigid until they get a stiffness (or: --joint-stiffness)"
            }
            false => "- drives: stiffnesses as they were given to the import",
        },
    );
    comment(
        &mut out,
        "",
        match parts.section {
            Some(_) => "- links: beams of the section below between the joints",
            None => {
                "- links: rigid; replace { rigid = ... } by { link = \"SECTION\", vector_m = [x, y, z] } with a table [section.SECTION] (or: --link-section)"
            }
        },
    );
    out.push_str("schema = 1\n\n[mechanism]\n");
    let _ = writeln!(out, "name = {}", value(parts.name)?);
    let _ = writeln!(
        out,
        "source = {}",
        value(&format!(
            "URDF {file}, base '{}', tip '{}'",
            parts.base, parts.tip
        ))?
    );
    if !parts.masses {
        comment(
            &mut out,
            "",
            "No link between base and tip has a mass: add { body = ... } elements.",
        );
    }
    let _ = writeln!(out, "gravity_m_per_s2 = {}", value(&parts.gravity)?);
    for (name, home) in &parts.platforms {
        out.push_str("\n[[platform]]\n");
        let _ = writeln!(out, "name = {}", value(name)?);
        let p = placement(home).unwrap_or_default();
        let home = Placement {
            position_m: p.translation_m.or(Some([0.0; 3])),
            translation_m: None,
            ..p
        };
        let _ = writeln!(out, "home = {}", value(&home)?);
    }
    if let Some((name, section)) = parts.section {
        let _ = write!(out, "\n[section]\n{name} = {}\n", value(section)?);
    }
    for (name, _, _, lines) in &parts.limbs {
        let plain = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
        let key = match name.chars().all(plain) {
            true => name.clone(),
            false => value(name)?,
        };
        let _ = write!(out, "\n[chain.{key}]\nelements = [\n");
        for line in lines {
            comment(&mut out, "  ", &line.comment);
            let _ = write!(out, "  {},", value(&line.element)?);
            if !line.remark.is_empty() {
                let _ = write!(out, " # {}", line.remark);
            }
            out.push('\n');
        }
        out.push_str("]\n");
    }
    for (name, from, to, _) in &parts.limbs {
        out.push_str("\n[[limb]]\n");
        let _ = writeln!(out, "name = {}", value(name)?);
        let _ = writeln!(out, "from = {}", value(from)?);
        let _ = writeln!(out, "to = {}", value(to)?);
        let _ = writeln!(out, "chain = {}", value(name)?);
        for (key, platform) in [("start", from), ("end", to)] {
            if let Some((_, turn)) = parts.tip_in_tool.filter(|(tool, _)| tool == platform) {
                let _ = writeln!(out, "{key} = {}", value(turn)?);
            }
        }
    }
    Ok(out)
}
