//! The comparison for a person.

use crate::check::poses::comparison::PoseComparison;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, short, triple};

/// Explanations shown where several fit.
const SHOWN: usize = 6;

pub(crate) fn answer_text(a: &PoseComparison) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}) against {} ({} {}), joint values {}",
            a.model,
            a.model_source,
            a.poses_file,
            a.poses.len(),
            if a.poses.len() == 1 { "pose" } else { "poses" },
            a.joints_are
        ),
        0,
    );
    out.push('\n');
    out.push_str(&table(a));
    out.push('\n');
    out.push_str(&result_text(a));
    out
}

fn table(a: &PoseComparison) -> String {
    let mut rows = vec![
        [
            "pose",
            "measured at, mm",
            "computed at, mm",
            "apart, mm",
            "deg",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for p in &a.poses {
        rows.push(vec![
            p.name.clone(),
            triple(p.measured_position_mm, |x| fixed(x, 2)),
            triple(p.computed_position_mm, |x| fixed(x, 2)),
            fixed(p.difference_mm, 3),
            p.difference_deg
                .map_or_else(|| "-".to_owned(), |x| fixed(x, 3)),
        ]);
    }
    columns(&rows, 2)
}

/// States whether the model agrees, and the explanation if not.
fn result_text(a: &PoseComparison) -> String {
    let within = format!(
        "{} mm and {} deg",
        short(a.tolerance_mm),
        short(a.tolerance_deg)
    );
    if a.agrees {
        return wrapped(
            &format!("The model agrees with all of them within {within}."),
            0,
        );
    }
    let mut out = String::new();
    match a.explanations.as_slice() {
        [] => {
            out.push_str(&wrapped(
                &format!(
                    "The model does not agree, and no reversed sign, quarter turn, single offset, coupling or frame explains the differences within {within}."
                ),
                0,
            ));
            if let Some(n) = &a.nearest {
                out.push_str(&item(&format!(
                    "nearest: {}; then up to {} mm{} are left",
                    n.in_words,
                    short(n.difference_mm),
                    n.difference_deg
                        .map_or_else(String::new, |d| format!(" and {} deg", short(d)))
                )));
            }
            out.push_str(&wrapped(
                "Lengths of the links may differ; compare a data sheet's figures with the model's.",
                0,
            ));
        }
        [only] => {
            out.push_str(&wrapped(
                &format!(
                    "The differences are systematic. This explains all of them within {within}:"
                ),
                0,
            ));
            out.push_str(&item(only));
            if a.poses.len() < 3 {
                out.push_str(&wrapped(
                    "That is few poses: jog a third one, with every joint elsewhere, to be sure.",
                    0,
                ));
            }
        }
        several => {
            out.push_str(&wrapped(
                &format!(
                    "The differences are systematic, but these poses do not decide: {} explanations are equally simple and explain all within {within}:",
                    several.len()
                ),
                0,
            ));
            for text in several.iter().take(SHOWN) {
                out.push_str(&item(text));
            }
            if several.len() > SHOWN {
                out.push_str(&item(&format!("and {} more", several.len() - SHOWN)));
            }
            out.push_str(&wrapped(
                "Jog one more pose with every joint away from zero and from the other poses. Some always look alike: an offset of the first joint and a turned base, an offset of the last one and a turned tool.",
                0,
            ));
        }
    }
    out
}
