//! State of a KRL run beside its data: modal state, orientation control, roles of frames, and the frames that the caller states.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Isometry3;

use crate::error::excerpt;
use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run;
use crate::interpreter::run::Reason;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::Statement;
use crate::interpreter::value::{Datum, Value};
use crate::model::motion::{FrameUse, Speed};
use crate::model::site::{TurnsOtherwise, not_evenly};
use crate::model::target::PoseTarget;
use crate::options::ReadOptions;
use crate::text::Name;

/// A run of a KRL program.
pub(crate) type Run<'r, 'p> = run::Run<'r, 'p, Krl>;

/// The numbers of tool and base that a FDAT states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointData {
    pub tool: Option<u32>,
    pub base: Option<u32>,
    /// True where the tool stands still and the part is in the hand.
    pub is_external: bool,
}

/// Modal state of motions; unset values are `None`.
#[derive(Debug, Clone, Default)]
pub(crate) struct InForce {
    pub base: Option<FrameUse>,
    pub tool: Option<FrameUse>,
    pub speed: Option<Speed>,
    /// `$APO.CDIS`, mm.
    pub distance_mm: Option<f64>,
    /// `$APO.CPTP`.
    pub joint_percent: Option<f64>,
    /// `$APO.CVEL`.
    pub speed_percent: Option<f64>,
    /// `FDAT_ACT`.
    pub point: Option<PointData>,
    /// The distance of `LDAT_ACT`.
    pub linear_mm: Option<f64>,
    /// The distance of `PDAT_ACT`.
    pub joint: Option<f64>,
    /// `$ORI_TYPE=#CONSTANT`.
    pub keeps_orientation: bool,
}

impl InForce {
    /// Takes back what BAS sets in a way that is not known here.
    pub(crate) fn forget(&mut self) {
        *self = Self {
            point: self.point,
            linear_mm: self.linear_mm,
            joint: self.joint,
            keeps_orientation: self.keeps_orientation,
            ..Self::default()
        };
    }
}

/// State of a KRL run.
pub(crate) struct Krl {
    /// Frames that the caller states, by their names without blanks, in capitals.
    pub stated: BTreeMap<String, Isometry3<f64>>,
    /// Number of assignments to each name.
    pub assigned: BTreeMap<Name, usize>,
    /// Values of elements of the arrays of frames: with which the files begin, and at their first use.
    pub initial: BTreeMap<(Role, u32), Datum>,
    pub used: BTreeMap<(Role, u32), Datum>,
    pub force: InForce,
    /// Modal state before the open spline block.
    pub spline: Option<InForce>,
    /// Reason why the next motion cannot be divided: a statement before it acts somewhere along it.
    pub along_next: Option<&'static str>,
    /// True for each motion whose end has a B beyond 90 degrees, with which the angles of an orientation are ambiguous.
    pub beyond: Vec<bool>,
    /// Opening line of the surrounding fold, by file and line; computed on demand.
    pub folds: Vec<Option<Vec<Option<usize>>>>,
}

impl Krl {
    /// A run that has not begun.
    pub(crate) fn run<'r, 'p>(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
    ) -> Run<'r, 'p> {
        let stated = options.frames.iter();
        let own = Self {
            stated: stated.map(|(name, frame)| (key(name), *frame)).collect(),
            assigned: assigned(files, symbols),
            initial: BTreeMap::new(),
            used: BTreeMap::new(),
            force: InForce::default(),
            spline: None,
            along_next: None,
            beyond: Vec::new(),
            folds: files.iter().map(|_| None).collect(),
        };
        Run::new(files, symbols, options, own)
    }
}

/// A name as the caller may write it: without blanks, in capitals.
pub(crate) fn key(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
}

fn assigned(files: &[TokenFile<'_>], symbols: &Symbols<'_>) -> BTreeMap<Name, usize> {
    let mut found = BTreeMap::new();
    for home in &symbols.routines {
        for statement in &home.routine.body {
            statement.each(&mut |inner| {
                if let Statement::Assignment { tokens, .. } = inner
                    && let Some(name) = files[home.file].name(tokens.start)
                {
                    *found.entry(name).or_default() += 1;
                }
            });
        }
    }
    found
}

// Orientation control of the tool: `$ORI_TYPE=#VAR`, `$CIRC_TYPE=SCIRC_TYP(LCPDAT1)`, `$SINGUL_STRATEGY=0`, and the data of `LDAT_ACT=LCPDAT1`.

/// Motions with constant orientation.
pub(crate) const KEPT: TurnsOtherwise = TurnsOtherwise {
    reason: "$ORI_TYPE=#CONSTANT keeps the orientation with which it begins",
    remedy: "write $ORI_TYPE=#VAR, with the orientations that the tool has",
    evenly: None,
};

/// Reason why the end of such a motion differs from the written one.
pub(crate) fn turned(before: Option<&PoseTarget>, end: Option<&PoseTarget>) -> Option<Reason> {
    let turn_rad = match (before, end?) {
        (Some(before), end) => before.orientation.angle_to(&end.orientation),
        (None, _) => {
            let reason = "$ORI_TYPE=#CONSTANT keeps the orientation with which it begins, and that is not known from the text in these axes";
            return Some((reason.to_owned(), KEPT.remedy));
        }
    };
    Some((not_evenly("the tool turns", turn_rad, KEPT)?, KEPT.remedy))
}

impl Run<'_, '_> {
    /// Refuses what lets the tool turn otherwise than from the orientation of one point to that of the next; `word` is ORI_TYP or CIRC_TYP.
    /// True where the tool keeps the orientation of the first.
    pub(super) fn turns_as_followed(
        &mut self,
        word: &str,
        tokens: &Range<usize>,
        value: &Expression,
    ) -> Result<bool, Reason> {
        let file = self.file();
        let shown = excerpt(file.text(tokens).as_bytes());
        let called = match &value.node {
            Node::Call(name, arguments) if name.is("SORI_TYP") || name.is("SCIRC_TYP") => {
                arguments.first().and_then(|of| of.value.as_ref())
            }
            _ => None,
        };
        let Some(data) = called else {
            let text = file.text(&value.tokens).to_uppercase();
            return is_followed(word, &text, &shown, true);
        };
        let data = self.value(data);
        if let Some(reason) = data.unknown_reason() {
            return Err((reason.to_string(), GIVE_THEM));
        }
        // Data that do not state it have the first of each: #VAR, #BASE.
        let choice = choice_of(&data, word).unwrap_or_else(|| "VAR".to_owned());
        is_followed(word, &choice, &shown, false)
    }

    /// Refuses data of inline forms, which BAS puts in force for the motions behind it, as [`Run::turns_as_followed`] refuses words. True
    /// where they keep the orientation.
    pub(super) fn data_turn_as_followed(
        &mut self,
        tokens: &Range<usize>,
        data: &Datum,
    ) -> Result<bool, Reason> {
        let mut kept = false;
        let shown = excerpt(self.file().text(tokens).as_bytes());
        for word in ["ORI_TYP", "CIRC_TYP"] {
            // Data that are in none of the files say nothing of speed or rounding, either: what needs them says so.
            if let Some(choice) = choice_of(data, word) {
                kept |= is_followed(word, &choice, &shown, false)?;
            }
        }
        Ok(kept)
    }
}

/// A member that is a word of an enumeration, without its `#`, in capitals.
pub(super) fn choice_of(data: &Datum, capitals: &str) -> Option<String> {
    match &data.member(capitals)?.value {
        Value::Text(text) => Some(text.trim_start_matches('#').trim().to_uppercase()),
        _ => None,
    }
}

const GIVE_THEM: &str = "give the .dat file that states these data as well";

fn is_followed(word: &str, choice: &str, shown: &str, here: bool) -> Result<bool, Reason> {
    match word {
        "ORI_TYP" if choice.trim().trim_start_matches('#') == "CONSTANT" => Ok(true),
        "ORI_TYP" if !choice.contains("VAR") => Err((
            format!("`{shown}`: the tool does not turn evenly to the orientation of the point"),
            match here {
                true => "write $ORI_TYPE=#VAR, with the orientations that the tool has",
                false => {
                    "write ORI_TYP #VAR in these data, with the orientations that the tool has"
                }
            },
        )),
        "CIRC_TYP" if choice.contains("PATH") => Err((
            "the tool turns with the circle (#PATH), whatever its points say".to_owned(),
            match here {
                true => "write $CIRC_TYPE=#BASE, with the orientations that the tool has",
                false => {
                    "write CIRC_TYP #BASE in these data, with the orientations that the tool has"
                }
            },
        )),
        _ => Ok(false),
    }
}

/// Refuses `$CIRC_MODE.AUX_PT.ORI=#INTERPOLATE`: the tool passes the orientation of the place on the circle.
/// Either stands in the statement or in the data that it names.
pub(crate) fn auxiliary_turn(statement: &str, of_data: Option<&str>) -> Result<(), Reason> {
    let says = |text: &str| text.to_uppercase().contains("#INTERPOLATE");
    match says(statement) || of_data.is_some_and(says) {
        true => Err((
            format!(
                "`{}`: on a circle the tool passes the orientation of the place on it, which is not followed",
                excerpt(statement.as_bytes())
            ),
            "write #IGNORE, and divide the circle where the tool is to have that orientation",
        )),
        false => Ok(()),
    }
}

/// Refuses `$SINGUL_STRATEGY=1`: on straight lines and circles near singular postures the tool leaves its orientation.
pub(crate) fn keeps_its_orientation(strategy: Option<f64>) -> Result<(), Reason> {
    match strategy {
        Some(0.0) => Ok(()),
        _ => Err((
            "near singular postures the tool leaves its orientation on lines and circles"
                .to_owned(),
            "write $SINGUL_STRATEGY=0, and go round those postures",
        )),
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Tool,
    Base,
}

impl Role {
    /// The array of the numbered ones.
    pub(crate) fn array(self) -> &'static str {
        match self {
            Self::Tool => "TOOL_DATA",
            Self::Base => "BASE_DATA",
        }
    }

    /// The role of an array.
    pub(crate) fn of_array(name: &Name) -> Option<Self> {
        let both = [Self::Tool, Self::Base].into_iter();
        both.into_iter().find(|role| name.is(role.array()))
    }

    /// The one in force.
    pub(crate) fn variable(self) -> &'static str {
        match self {
            Self::Tool => "$TOOL",
            Self::Base => "$BASE",
        }
    }
}
