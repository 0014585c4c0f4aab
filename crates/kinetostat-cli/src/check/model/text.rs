//! Findings about a model in words, readable at 80 columns.

use kinetostat_model::Model;
use serde_json::Value;

use crate::check::model::assumptions;
use crate::check::model::findings::Findings;
use crate::check::model::home_text::home_text;
use crate::check::model::limbs::{LimbFinding, limb_text, load_description};
use crate::ui::layout::{item, wrapped};
use crate::ui::numbers::{number, short, triple};

pub(crate) fn answer_text(f: &Findings, model: &Model, force_given: bool) -> String {
    let mut out = wrapped(&format!("{} ({})", f.model, f.model_source), 0);
    if let Some(text) = &f.description {
        out.push_str(&wrapped(text, 0));
    }
    if let Some((low, high)) = model.workspace() {
        out.push_str(&wrapped(
            &format!(
                "workspace from {} to {} mm",
                triple((low * 1e3).into(), short),
                triple((high * 1e3).into(), short)
            ),
            0,
        ));
    }
    out.push_str("\nPlatforms\n");
    for p in &f.platforms {
        let mut text = format!(
            "'{}' at home at {} mm, {}",
            p.name,
            triple(p.home_position_mm, short),
            turned(p.home_rotation_vector_deg)
        );
        if p.mass_kg > 0.0 {
            text.push_str(&format!(", {} kg", number(p.mass_kg, 4)));
        }
        if p.carries_the_tool {
            text.push_str("; carries the tool");
        }
        out.push_str(&item(&text));
    }
    out.push_str(&crate::check::model::frames::frames_text(&f.frames));
    for group in alike(&f.limbs) {
        let [first, rest @ ..] = group.as_slice() else {
            continue;
        };
        let heading = if rest.is_empty() {
            format!(
                "Limb '{}', from '{}' to '{}'",
                first.name, first.from, first.to
            )
        } else {
            let names: Vec<String> = group.iter().map(|l| format!("'{}'", l.name)).collect();
            format!(
                "{} limbs alike, from '{}' to '{}': {}",
                group.len(),
                first.from,
                first.to,
                names.join(", ")
            )
        };
        out.push_str(&format!("\n{}", wrapped(&heading, 0)));
        out.push_str(&limb_text(first));
    }
    if !f.loads.is_empty() {
        out.push_str("\nOn platforms\n");
        for load in &f.loads {
            out.push_str(&wrapped(&load_description(load), 2));
        }
    }
    if f.mass_kg > 0.0 {
        out.push('\n');
        out.push_str(&wrapped(
            &format!(
                "Moving mass {} kg, gravity {} m/s^2.",
                number(f.mass_kg, 5),
                triple(f.gravity_m_per_s2, short)
            ),
            0,
        ));
    } else {
        out.push_str("\nNo masses in the model: weight is left out.\n");
    }
    if let Some(home) = &f.home {
        out.push_str(&home_text(f, home));
    }
    if let Some(assumptions) = &f.assumptions {
        out.push_str(&assumptions::assumptions_text(assumptions, force_given));
    }
    if let Some(problem) = &f.home_problem {
        out.push_str("\nAt home\n");
        out.push_str(&item(&format!("nothing can be solved: {problem}")));
    }
    out.push_str(&crate::ui::warnings::warnings(&f.warnings));
    if f.warnings.is_empty() {
        out.push_str("\nNothing looks wrong in the file.\n");
    }
    if let Some(home) = &f.home {
        out.push_str(&next(&f.model_source, home.stiffness_rank < 6));
    }
    out
}

fn turned(v: [f64; 3]) -> String {
    if v.iter().all(|x| x.abs() < 1e-9) {
        "parallel to the base".to_owned()
    } else {
        format!("turned by the rotation vector {} deg", triple(v, short))
    }
}

/// Limbs in groups of those that differ in nothing but their names, in the file's order.
fn alike(limbs: &[LimbFinding]) -> Vec<Vec<&LimbFinding>> {
    let mut groups: Vec<(Option<Value>, Vec<&LimbFinding>)> = Vec::new();
    for limb in limbs {
        let own = serde_json::to_value(limb).ok().map(plain);
        match groups
            .iter_mut()
            .find(|(of, _)| own.is_some() && *of == own)
        {
            Some((_, group)) => group.push(limb),
            None => groups.push((own, vec![limb])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// Removes the limb's name, and rounds numbers as they are shown.
fn plain(mut value: Value) -> Value {
    if let Value::Object(map) = &mut value {
        map.remove("name");
    }
    rounded(value)
}

fn rounded(value: Value) -> Value {
    match value {
        Value::Number(n) => n
            .as_f64()
            .map_or(Value::Null, |x| Value::String(number(x, 6))),
        Value::Array(list) => Value::Array(list.into_iter().map(rounded).collect()),
        Value::Object(map) => map.into_iter().map(|(k, v)| (k, rounded(v))).collect(),
        other => other,
    }
}

/// Suggests drawings of a model, at the end of the output of `check`.
pub(crate) fn next(source: &str, free: bool) -> String {
    let model = source.strip_prefix("preset ").unwrap_or(source);
    let mut out = format!(
        "\nNext\n  kinetostat model draw {model} --out drawing.svg\n      what it looks like\n"
    );
    if free {
        out.push_str(&format!(
            "  kinetostat model draw {model} --motion --out free.svg\n      how it moves freely\n"
        ));
    }
    out
}
