//! Principal directions of a stiffness: their figures, their words, and the joints that move with them.

use kinetostat::{Direction, DirectionKind, Mechanism, MotionKind, model::Role};
use kinetostat_machining::{Warning, WarningCode};
use schemars::JsonSchema;
use serde::Serialize;

use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, number, triple};

/// One principal direction.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Principal {
    pub(crate) kind: DirectionKind,
    /// Absent if it is rigid (infinite).
    pub(crate) stiffness_n_per_mm: Option<f64>,
    pub(crate) translation_share: [f64; 3],
    pub(crate) rotation_deg_per_mm: [f64; 3],
    /// The motion and what lets it happen: `turns about z by arm: q`.
    pub(crate) in_words: String,
    /// Joints and springs that move with it, the most first.
    #[serde(rename = "behind")]
    pub(crate) participation: Vec<Participation>,
}

/// A joint or spring that moves while the tool moves in a direction.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Participation {
    pub(crate) name: String,
    pub(crate) role: Role,
    /// Motion per mm of the direction's longest part.
    pub(crate) motion_per_mm: f64,
    pub(crate) unit: &'static str,
    /// Share of all squares, rotations at the machine's natural length: 0 to 1.
    pub(crate) share: f64,
}

/// The warnings of stiffnesses that lie so far apart that digits of the small ones are lost: in the machine's
/// principal directions, and in springs.
pub(crate) fn uneven(
    mechanism: &Mechanism,
    directions: &[Direction],
) -> impl Iterator<Item = Warning> {
    let said = kinetostat::chain::uneven_stiffness(directions).into_iter();
    let of_springs = kinetostat::chain::uneven_springs(mechanism);
    said.chain(of_springs)
        .map(|said| Warning::new(WarningCode::UnevenStiffness, said))
}

pub(crate) fn principal(d: &Direction) -> Principal {
    // Per millimetre of the longest part.
    let turn = d.twist.angular().map(|x| 1e-3 * x.to_degrees());
    Principal {
        kind: d.kind,
        stiffness_n_per_mm: d
            .stiffness_n_per_m
            .is_finite()
            .then_some(1e-3 * d.stiffness_n_per_m),
        translation_share: d.twist.linear().into(),
        rotation_deg_per_mm: turn.into(),
        in_words: motion_description(d),
        participation: d
            .participation
            .iter()
            .map(|s| {
                let (factor, unit) = match s.kind {
                    MotionKind::Prismatic => (1.0, "mm"),
                    MotionKind::Revolute => (1e-3 * 1_f64.to_degrees(), "deg"),
                };
                Participation {
                    name: s.name.clone(),
                    role: s.role,
                    motion_per_mm: factor * s.motion,
                    unit,
                    share: s.share,
                }
            })
            .collect(),
    }
}

/// `turns about z by arm: q`, with no more names than a line holds.
pub(crate) fn motion_description(d: &Direction) -> String {
    const NAMES: usize = 3;
    let mut short = d.clone();
    short.participation.truncate(NAMES);
    let text = short.description();
    let motion = text.split_once(": ").map_or(text.as_str(), |(_, m)| m);
    match d.participation.len().saturating_sub(NAMES) {
        0 => motion.to_owned(),
        more => format!("{motion} and {more} more"),
    }
}

/// Principal directions as a table.
pub(crate) fn principals(list: &[Principal]) -> String {
    let mut rows = vec![
        ["kind", "N/mm", "moves along (x, y, z)", "turns, deg per mm"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for p in list {
        rows.push(vec![
            kind_description(p.kind).to_owned(),
            p.stiffness_n_per_mm
                .map_or_else(|| "infinite".to_owned(), |s| number(s, 4)),
            triple(p.translation_share, |x| fixed(x, 3)),
            triple(p.rotation_deg_per_mm, |x| fixed(x, 4)),
        ]);
    }
    let mut out = columns(&rows, 2);
    out.push_str(&wrapped(
        "Rotations count at the machine's natural length, so that N/mm compares them: the smallest here is another figure than the smallest stiffness against a force.",
        2,
    ));
    out
}

fn kind_description(kind: DirectionKind) -> &'static str {
    match kind {
        DirectionKind::Free => "free",
        DirectionKind::Finite => "stiff",
        DirectionKind::Negative => "NEGATIVE",
        DirectionKind::Rigid => "rigid",
    }
}

/// A direction with the participation of joints and springs in it.
pub(crate) fn what_moves(p: &Principal) -> String {
    let stiffness = match (p.kind, p.stiffness_n_per_mm) {
        (DirectionKind::Finite | DirectionKind::Negative, Some(s)) => {
            format!(", {} N/mm", number(s, 4))
        }
        _ => String::new(),
    };
    item(&format!(
        "{}{stiffness}: {}",
        kind_description(p.kind),
        p.in_words
    ))
}
