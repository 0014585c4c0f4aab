//! Ends that keep of before what they do not state (`LIN {Z 20}`), and steps from where the tool is (`LIN_REL {X 10}`): where what was
//! before becomes another, or they themselves, they state it.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::krl::ends::ONLY_SOME;
use crate::krl::position::{PLACE, kept_angles};
use crate::krl::reader::read_krl;
use crate::krl::table::motion_row;
use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::model::site::{PartialText, PoseText, TargetSite};
use crate::model::target::PoseTarget;
use crate::options::{ExternalAxes, ReadOptions, UnknownTargets};
use crate::text::Name;
use crate::text::source::{Edits, SourceFile};
use crate::writing::piece::Piece;

/// Places nearer than this are one, mm.
const SAME_MM: f64 = 1e-9;

/// Orientations nearer than this are one, rad.
const SAME_RAD: f64 = 1e-9;

/// Reason of an end that keeps other numbers in each of its runs.
const EACH_TIME: &str = "it keeps numbers of before, and needs another correction each time";

/// The program with all ends stated that corrections change; none where it is as it must be.
pub(super) fn with_stated_ends(
    program: &RobotProgram,
    pieces: &[Piece],
) -> Result<Option<RobotProgram>, WriteError> {
    let mut of_motion: BTreeMap<usize, Vec<&Piece>> = BTreeMap::new();
    for piece in pieces {
        of_motion.entry(piece.motion).or_default().push(piece);
    }
    let mut stating = Stating {
        program,
        of_motion,
        edits: program.files.iter().map(|_| Edits::default()).collect(),
        first: None,
        open: None,
        stated: BTreeMap::new(),
    };
    for index in 0..program.motions.len() {
        stating.motion(index);
    }
    (program.motions.iter()).for_each(|motion| stating.runs_alike(motion));
    let refused = |motion: &Motion, reason: &str| WriteError::Motion {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason: reason.to_owned(),
        remedy: "write all of X, Y, Z, A, B and C as numbers".to_owned(),
    };
    if let Some((motion, reason)) = stating.open {
        return Err(refused(motion, reason));
    }
    let Some(first) = stating.first else {
        return Ok(None);
    };
    let files = program.files.iter().zip(stating.edits);
    let files: Option<Vec<SourceFile>> = files
        .map(|(file, edits)| {
            let bytes = edits.applied_to(file.bytes())?;
            Some(SourceFile::new(file.name(), bytes))
        })
        .collect();
    let reading = ReadOptions {
        unknown_targets: UnknownTargets::LeftAsWritten,
        external_axes: ExternalAxes::Carried,
        values: program.values.clone(),
        ..ReadOptions::default()
    };
    let again = files.and_then(|files| read_krl(files, &reading).ok());
    let again = again.filter(|again| again.motions.len() == program.motions.len());
    again
        .map(Some)
        .ok_or_else(|| refused(first, "what its end keeps of before could not be stated"))
}

struct Stating<'a> {
    program: &'a RobotProgram,
    of_motion: BTreeMap<usize, Vec<&'a Piece>>,
    edits: Vec<Edits>,
    /// The first motion with an end that is stated.
    first: Option<&'a Motion>,
    /// The first motion whose end keeps numbers of before that become others, and why it cannot state them.
    open: Option<(&'a Motion, &'static str)>,
    /// Numbers that are stated further, by the file and the place of the end.
    stated: BTreeMap<(usize, usize), [Option<String>; 6]>,
}

/// An end and what is stated of it.
struct Open<'a> {
    text: PartialText,
    pose: &'a PoseTarget,
}

impl<'a> Stating<'a> {
    fn of(&self, motion: usize) -> &[&'a Piece] {
        self.of_motion.get(&motion).map_or(&[], Vec::as_slice)
    }

    /// True if a piece turns the tool away from the end orientation of its motion.
    fn turns(&self, motion: usize) -> bool {
        let end = self.program.motions.get(motion);
        let end = end.and_then(|motion| motion.target.pose());
        end.is_some_and(|end| {
            let turned = |piece: &&Piece| {
                let to = piece.orientation;
                to.is_some_and(|to| to.angle_to(&end.orientation) > SAME_RAD)
            };
            self.of(motion).iter().any(turned)
        })
    }

    fn motion(&mut self, index: usize) {
        let motion = &self.program.motions[index];
        let own = !self.of(index).is_empty();
        let from = motion.follows.filter(|from| !self.of(*from).is_empty());
        if !own && from.is_none() {
            return;
        }
        if let (Some(straight), Some(pose)) = (step_of(self.program, motion), motion.target.pose())
        {
            state_step(self.program, motion, straight, pose, &mut self.edits);
            self.first.get_or_insert(motion);
            return;
        }
        let via = motion.site.via.iter().map(|(_, site)| site);
        let mut ends = via.chain([&motion.site.target]);
        if from.is_some() && ends.any(|site| *site == TargetSite::Fixed(ONLY_SOME)) {
            self.open.get_or_insert((motion, ONLY_SOME));
        }
        let turned = self.turns(index) || from.is_some_and(|from| self.turns(from));
        // Orientation on a circle follows from the ends, not from the auxiliary point.
        for (open, turned) in open_ends(self.program, motion).zip([turned, false]) {
            if let Some(open) = open {
                self.state(index, &open, own, turned);
            }
        }
    }

    /// Refuses a run that keeps other numbers than its statement states now for another run.
    fn runs_alike(&mut self, motion: &'a Motion) {
        for open in open_ends(self.program, motion).flatten() {
            let Some(added) = self.stated.get(&(motion.file, open.text.place.start)) else {
                continue;
            };
            let own = self.kept_numbers(motion, open.pose);
            let differs = |(own, added): (&String, &Option<String>)| {
                added.as_ref().is_some_and(|added| added != own)
            };
            if own.iter().zip(added).any(differs) {
                self.open.get_or_insert((motion, EACH_TIME));
            }
        }
    }

    /// The numbers of an end as they are written where it does not state them.
    fn kept_numbers(&self, motion: &Motion, pose: &PoseTarget) -> [String; 6] {
        let before = (motion.follows).and_then(|from| self.program.motions.get(from));
        let before = before.and_then(|before| before.target.pose());
        let angles = kept_angles(&before.unwrap_or(pose).orientation);
        std::array::from_fn(|member| {
            trimmed(match member < 3 {
                true => format!("{:.6}", pose.position_mm[member]),
                false => format!("{:.8}", angles[member - 3]),
            })
        })
    }

    /// Writes those members of an end that are not stated and must be.
    fn state(&mut self, index: usize, open: &Open<'_>, own: bool, turned: bool) {
        let motion = &self.program.motions[index];
        let stated = open.text.numbers.each_ref().map(Option::is_some);
        let numbers = self.kept_numbers(motion, open.pose);
        let kept = self.place_before(motion).unwrap_or(open.pose.position_mm);
        // A corrected end has all numbers of its place; of its angles all or none.
        let some_angles = stated[3..].contains(&true);
        let needed = |member: usize| match (member < 3, own) {
            (true, true) => true,
            (true, false) => {
                let away = kept[member] - open.pose.position_mm[member];
                away.is_nan() || away.abs() > SAME_MM
            }
            (false, _) => turned || own && some_angles,
        };
        let mut member = 0..6;
        let added = numbers.map(|number| {
            (member.next()).and_then(|at| (!stated[at] && needed(at)).then_some(number))
        });
        if added.iter().all(Option::is_none) {
            return;
        }
        // A statement that runs again states its end once.
        let statement = (motion.file, open.text.place.start);
        match self.stated.insert(statement, added.clone()) {
            Some(before) if before == added => return,
            Some(_) => {
                self.open.get_or_insert((motion, EACH_TIME));
                return;
            }
            None => {}
        }
        let home = &self.program.files[open.text.file];
        let own_edits = insertions(home, &open.text, &added);
        let edits = &mut self.edits[motion.file];
        match open.text.place == open.text.whole && open.text.file == motion.file {
            true => edits.append(own_edits),
            // A position that is declared elsewhere is written into the statement: other motions may take over different values from it.
            false => {
                let literal = own_edits.applied_to_part(home.bytes(), &open.text.whole);
                edits.replace(open.text.place.clone(), literal.unwrap_or_default());
            }
        }
        self.first.get_or_insert(motion);
    }

    /// Corrected end of the previous motion, mm.
    fn place_before(&self, motion: &Motion) -> Option<Vector3<f64>> {
        let from = motion.follows?;
        let corrected = self.of(from).last().map(|piece| piece.position_mm);
        let written = self.program.motions.get(from)?.target.pose();
        corrected.or_else(|| written.map(|pose| pose.position_mm))
    }
}

/// The end of a motion and the auxiliary point of a circle, where they keep numbers of before.
fn open_ends<'p>(
    program: &'p RobotProgram,
    motion: &'p Motion,
) -> impl Iterator<Item = Option<Open<'p>>> + use<'p> {
    let via = match (&motion.kind, &motion.site.via) {
        (MotionKind::Circular { via }, Some((_, site))) => Some((via, site)),
        _ => None,
    };
    let ends = [Some((&motion.target, &motion.site.target)), via];
    ends.into_iter().map(move |end| {
        let (target, site) = end?;
        let (pose, text) = (target.pose()?, open_text(program, motion, site)?);
        Some(Open { text, pose })
    })
}

/// Text of a partial end; `None` if it is complete, or not in the statement.
fn open_text(program: &RobotProgram, motion: &Motion, site: &TargetSite) -> Option<PartialText> {
    let of = |text: &PoseText, place: &Range<usize>| {
        let [x, y, z] = text.position.clone();
        text.orientation.is_empty().then(|| PartialText {
            file: text.file,
            whole: text.whole.clone(),
            place: place.clone(),
            numbers: [Some(x), Some(y), Some(z), None, None, None],
        })
    };
    match site {
        TargetSite::Literal(text) if text.file == motion.file => of(text, &text.whole),
        TargetSite::Declared { declaration, name } => {
            of(&program.declarations.get(*declaration)?.text, name)
        }
        TargetSite::Partial(text) => Some((**text).clone()),
        _ => None,
    }
}

/// The missing members where they belong by their order.
fn insertions(home: &SourceFile, text: &PartialText, added: &[Option<String>; 6]) -> Edits {
    let mut edits = Edits::default();
    let stated = |range: Range<usize>| text.numbers[range].iter().flatten();
    for (member, value) in added.iter().enumerate() {
        let Some(value) = value else {
            continue;
        };
        let name = PLACE[member];
        if let Some(before) = stated(0..member).next_back() {
            let at = before.span.end;
            edits.replace(at..at, format!(",{name} {value}"));
        } else if let Some(behind) = stated(member..6).next() {
            // Before the letter of that member and the blanks behind it.
            let upto = &home.bytes()[..behind.span.start];
            let at = upto.trim_ascii_end().len().saturating_sub(1);
            edits.replace(at..at, format!("{name} {value},"));
        }
    }
    edits
}

/// Absolute motion word that replaces that of a step (`LIN` for `LIN_REL`).
pub(super) fn step_of(program: &RobotProgram, motion: &Motion) -> Option<&'static str> {
    let word = program.files[motion.file].part(&motion.site.keyword);
    let row = motion_row(&Name::of(word)?)?;
    row.name
        .strip_suffix("_REL")
        .filter(|_| row.ends.are_steps())
}

/// Writes the end of a step in place of the step.
pub(super) fn state_step(
    program: &RobotProgram,
    motion: &Motion,
    straight: &'static str,
    pose: &PoseTarget,
    edits: &mut [Edits],
) {
    let place = pose.position_mm.iter().map(|value| format!("{value:.6}"));
    let angles = kept_angles(&pose.orientation);
    let values = place.chain(angles.iter().map(|value| format!("{value:.8}")));
    let members: Vec<String> = (PLACE.iter().zip(values))
        .map(|(name, value)| format!("{name} {}", trimmed(value)))
        .collect();
    let edits = &mut edits[motion.file];
    edits.replace(motion.site.keyword.clone(), straight);
    let file = &program.files[motion.file];
    let span = motion.site.target_span.clone();
    let behind = span.end..motion.span.end;
    if let Some(word) = axes_word(file.part(&behind)) {
        edits.replace(span.end + word.start..span.end + word.end, "");
    }
    edits.replace(span, format!("{{{}}}", members.join(",")));
}

/// Position of the word that selects the axes of a step, after its end, with the blanks before it.
fn axes_word(behind: &[u8]) -> Option<Range<usize>> {
    let sign = behind.iter().position(|byte| *byte == b'#')?;
    let before = behind[..sign].trim_ascii_end();
    // The text after WITH holds settings.
    let settings = before
        .windows("WITH".len())
        .any(|word| word.eq_ignore_ascii_case(b"WITH"));
    let word = behind[sign + 1..].trim_ascii_start();
    let length = behind.len() - word.len() + "BASE".len();
    (!settings && length <= behind.len()).then_some(before.len()..length)
}

/// A number without zeros that say nothing.
pub(super) fn trimmed(number: String) -> String {
    let short = number.trim_end_matches('0').trim_end_matches('.');
    match short {
        "-0" => "0".to_owned(),
        _ => short.to_owned(),
    }
}
