//! `kinetostat force --list-materials`: what is known, with law, spread and source.

use kinetostat_cutting::{ForceLaw, Law, Material, Materials};

use crate::force::answer::{ListedMaterial, MaterialList};
use crate::ui::layout::{listed, wrapped};
use crate::ui::numbers::{given, number};

/// Chip with which the materials are compared, mm.
const CHIP_MM: f64 = 0.1;

pub(crate) fn list(materials: &Materials) -> MaterialList {
    MaterialList {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        materials: materials.iter().map(ListedMaterial::from).collect(),
    }
}

pub(crate) fn list_text(materials: &Materials) -> String {
    let mut out = wrapped(
        "Materials for --material NAME, by their sources. Spread: how far the force of another batch or tool may lie from the law. k_c: force against the tooth's way per mm2 of a chip of 0.1 mm, N/mm2, before factors; with turning tests milling takes another 1.3 (--process-factor).",
        0,
    );
    let mut sources: Vec<&str> = Vec::new();
    for material in materials.iter() {
        if !sources.contains(&material.source.as_str()) {
            sources.push(&material.source);
        }
    }
    // One width of columns for all sources.
    let head = ["", "law", "spread", "k_c", "measured in"].map(String::from);
    let mut rows = vec![head.to_vec()];
    let mut begins = Vec::new();
    for source in &sources {
        begins.push(rows.len());
        rows.extend(materials.iter().filter(|m| m.source == *source).map(row));
    }
    let text = listed(&rows, 2);
    let mut lines = text.lines();
    let head = lines.next().unwrap_or_default().to_owned();
    for (k, line) in lines.enumerate() {
        if let Some(source) = begins.iter().position(|begin| *begin == k + 1) {
            out.push('\n');
            out.push_str(&wrapped(sources[source], 0));
            out.push_str(&head);
            out.push('\n');
        }
        out.push_str(line);
        out.push('\n');
    }
    out.push('\n');
    out.push_str(&wrapped(
        "Other designations, coefficients and assumptions: --json. A file of your own (--materials FILE.toml) has the form of the library, material/library.toml of kinetostat-cutting.",
        0,
    ));
    out
}

fn row(material: &Material) -> Vec<String> {
    let law = match material.law {
        Law::Linear(_) => "linear",
        Law::Kienzle(_) => "Kienzle",
        Law::Exponential(_) => "exponential",
        Law::Rational(_) => "rational",
    };
    let process = match material.measured_in.process {
        kinetostat_cutting::Process::Turning => "turning",
        kinetostat_cutting::Process::Milling => "milling",
    };
    vec![
        material.name.clone(),
        law.to_owned(),
        format!("{} %", given(100.0 * material.spread)),
        number(material.edge_force(CHIP_MM).tangential / CHIP_MM, 4),
        process.to_owned(),
    ]
}
