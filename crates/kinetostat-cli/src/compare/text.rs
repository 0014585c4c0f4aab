//! Two designs side by side for a person.

use crate::compare::answer::{Compared, Figures, Share, Summary};
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{fixed, number, short, triple};
use crate::ui::warnings;

/// Parts shown for a direction.
const SHOWN: usize = 6;

pub(crate) fn answer_text(c: &Compared) -> String {
    let mut out = wrapped(
        &format!("A: {}, B: {}; both unloaded, as drawn", c.a, c.b),
        0,
    );
    for place in &c.places {
        out.push('\n');
        out.push_str(&wrapped(&at(&place.a, &place.b), 0));
        out.push_str(&stiffness(&place.a, &place.b));
        let shares = [
            ("x", &place.a.shares_x, &place.b.shares_x),
            ("y", &place.a.shares_y, &place.b.shares_y),
            ("z", &place.a.shares_z, &place.b.shares_z),
        ];
        for (axis, a, b) in shares {
            out.push_str(&format!(
                "\nShares of the deflection under a force along {axis}, %\n"
            ));
            out.push_str(&shares_text(a, b));
        }
    }
    if let Some(summary) = &c.difference {
        out.push('\n');
        out.push_str(&difference(summary));
    }
    out.push_str(&warnings::warnings(&c.warnings));
    out
}

fn at(a: &Figures, b: &Figures) -> String {
    match a.position_mm == b.position_mm {
        true => format!("At {} mm", triple(a.position_mm, short)),
        false => format!(
            "A at {} mm, B at {} mm",
            triple(a.position_mm, short),
            triple(b.position_mm, short)
        ),
    }
}

fn stiffness(a: &Figures, b: &Figures) -> String {
    let mut rows = vec![
        ["stiffness, N/mm", "A", "B", "B by A"]
            .map(str::to_owned)
            .to_vec(),
    ];
    let shown = |x: Option<f64>| x.map_or_else(|| "none".to_owned(), |x| number(x, 4));
    let mut row = |name: &str, a: Option<f64>, b: Option<f64>| {
        let ratio = a.zip(b).filter(|(a, _)| *a != 0.0).map(|(a, b)| b / a);
        rows.push(vec![name.to_owned(), shown(a), shown(b), shown(ratio)]);
    };
    let finite = |x: f64| Some(x).filter(|x| x.is_finite());
    row(
        "softest direction",
        finite(a.smallest_stiffness_n_per_mm),
        finite(b.smallest_stiffness_n_per_mm),
    );
    for (k, axis) in ["along x", "along y", "along z"].into_iter().enumerate() {
        row(axis, a.stiffness_n_per_mm[k], b.stiffness_n_per_mm[k]);
    }
    columns(&rows, 1)
}

fn shares_text(a: &[Share], b: &[Share]) -> String {
    let cells = |list: &[Share], k: usize| match list.get(k) {
        Some(s) => {
            let limb = s
                .limb
                .as_deref()
                .map(|l| format!("{l}: "))
                .unwrap_or_default();
            [format!("{limb}{}", s.name), fixed(100.0 * s.share, 1)]
        }
        None => [String::new(), String::new()],
    };
    let mut rows = vec![["A", "", "B", ""].map(str::to_owned).to_vec()];
    for k in 0..SHOWN.min(a.len().max(b.len())) {
        rows.push(cells(a, k).into_iter().chain(cells(b, k)).collect());
    }
    columns(&rows, 1)
}

fn difference(s: &Summary) -> String {
    let text = format!(
        "Over the grid of {} places, {} of them reached by both ({} by A alone, {} by B alone): B is the stiffer one in its softest direction at {} %. Its stiffness by that of A is {} on average, from {} at {} mm to {} at {} mm.",
        s.places,
        s.common,
        s.only_a,
        s.only_b,
        fixed(100.0 * s.b_stiffer_share, 1),
        number(s.mean_ratio, 4),
        number(s.least_ratio, 4),
        triple(s.least_at_mm, short),
        number(s.most_ratio, 4),
        triple(s.most_at_mm, short),
    );
    wrapped(&text, 0)
}
