//! Conversion losses: curves approximated by lines, events reduced to notes, omitted axes, accelerations and speeds that no made program states.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat_program::{Knowledge, Path};

use crate::making::events::EventKind;
use crate::making::limits::MakeLanguage;
use crate::making::pieces::Followed;
use crate::making::rapid::OTHER_SPEEDS;
use crate::making::routines::words_of;
use crate::making::{MakeError, MakeFinding};
use crate::model::Language;
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::program::RobotProgram;
use crate::path::of_program::RobotPath;
use crate::program_language::SPEED_REMEDY_OF_BLOCKS;
use crate::text::number::in_words;

/// Optional stops are named up to so many.
const MOST_SHOWN: usize = 20;

/// Counts of the conversion losses.
#[derive(Default)]
pub(crate) struct Otherwise {
    /// Approximated arcs by reason: their count, the source line of the first, and the number of straight segments.
    followed: BTreeMap<Followed, (usize, usize, usize)>,
    /// Events reduced to notes, by kind: their count, with the first of them.
    lost: BTreeMap<EventKind, (usize, String)>,
    /// Lines of optional stops that always stop.
    always: Vec<usize>,
    /// The first block with a speed of the spindle that the statements of the template do not take.
    pub(crate) dropped_speed: Option<String>,
}

impl Otherwise {
    /// An arc of a line of the source is followed by so many lines.
    pub(crate) fn follow(&mut self, why: Followed, line: usize, lines: usize) {
        let entry = self.followed.entry(why).or_insert((0, line, 0));
        entry.0 += 1;
        entry.2 += lines;
    }

    /// An event is a note alone.
    pub(crate) fn lose(&mut self, kind: EventKind, note: String) {
        self.lost.entry(kind).or_insert((0, note)).0 += 1;
    }

    /// An optional stop is one without a condition.
    pub(crate) fn stop_always(&mut self, line: usize) {
        self.always.push(line);
    }

    /// All of it in words.
    pub(crate) fn findings(&self, language: MakeLanguage, tolerance_mm: f64) -> Vec<MakeFinding> {
        let followed = self.followed.iter().map(|(why, (arcs, line, lines))| {
            let reason = match why {
                Followed::Helix => "circles of robots are flat, and this climbs",
                Followed::Language => match language {
                    MakeLanguage::Gcode => "it does not lie about the z axis",
                    _ => "there is no arc here that all readers take alike",
                },
                Followed::Small => "it is too small for a circle of the controller",
                Followed::Spiral => "its radius is another one at the end than at the start",
            };
            let arcs = match arcs {
                1 => "the arc is".to_owned(),
                n => format!("{n} arcs, here first, are"),
            };
            let message =
                format!("{arcs} followed by {lines} lines within {tolerance_mm} mm: {reason}");
            MakeFinding::of(*line, message)
        });
        let lost = self.lost.iter().map(|(kind, (count, first))| {
            let lines = match count {
                1 => "1 line is a note now, and does nothing there".to_owned(),
                n => format!("{n} lines are notes now, and do nothing there"),
            };
            MakeFinding::of(None, format!("{}: {lines} ({first})", kind.words()))
        });
        let always = self.always.first().map(|first| {
            // Each for itself: of an expanded program it is said from where it came.
            let shown = self.always.iter().take(MOST_SHOWN);
            let shown: Vec<String> = shown.map(|line| format!("line {line}")).collect();
            let more = match self.always.len().saturating_sub(MOST_SHOWN) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let message = format!(
                "an optional stop, which a switch of the machine decides on, always stops here ({}{more})",
                shown.join(", ")
            );
            MakeFinding::of(*first, message)
        });
        let dropped = self.dropped_speed.iter().map(|first| {
            let message = format!("spindle: the speed of the program is left out ({first}): the template's statements have no {{rpm}}, and the spindle turns as they say");
            MakeFinding::of(None, message)
        });
        followed.chain(lost).chain(dropped).chain(always).collect()
    }
}

/// Axes that the source moves beside X, Y and Z.
pub(crate) fn further_axes(path: &Path) -> Option<MakeFinding> {
    let motion = path.moves.iter().find(|motion| !motion.extra.is_empty())?;
    let letters: BTreeSet<char> = (path.moves.iter())
        .flat_map(|motion| motion.extra.iter().map(|extra| extra.letter))
        .collect();
    let letters: Vec<String> = letters.iter().map(char::to_string).collect();
    let message = format!("the words of the axes {} are left out", letters.join(", "));
    Some(MakeFinding::of(motion.line, message))
}

/// Names the lines of the file with the motions that state such a thing.
pub(crate) fn dynamics(program: &RobotProgram, file: usize) -> Option<MakeFinding> {
    let source = program.files.get(file)?;
    let states = |line: &usize| {
        let words = words_of(program.language, source, *line);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        program.language.states_dynamics(&words)
    };
    let lines: Vec<usize> = (1..=source.line_count()).filter(states).collect();
    Some(MakeFinding::of(
        *lines.first()?,
        format!(
            "accelerations, overrides, and speeds of turning and of joint motions, are not those of the source ({}): joint_speed_percent and acceleration_m_per_s2 of the template state what is written",
            in_words(&lines)
        ),
    ))
}

/// Speeds of turning and of external axes in the data of a RAPID speed, where they are not those of the speeds with names.
fn own_speeds(motion: &Motion) -> Option<&str> {
    let others = motion.site.other_speeds.as_deref()?;
    (others != OTHER_SPEEDS).then_some(others)
}

/// True if a made program states them.
fn has_them(program: &RobotProgram, language: MakeLanguage) -> bool {
    (program.language, language) == (Language::Rapid, MakeLanguage::Rapid)
}

/// Other speeds of every move of a path, if the made program can state them.
pub(crate) fn other_speeds(
    program: &RobotProgram,
    robot: &RobotPath,
    language: MakeLanguage,
) -> Vec<Option<Box<str>>> {
    if !has_them(program, language) {
        return Vec::new();
    }
    let motions = robot.motions.iter();
    let own = motions.map(|index| Some(own_speeds(program.motions.get(*index)?)?.into()));
    own.collect()
}

/// The lines where they are lost.
pub(crate) fn turning_speeds(program: &RobotProgram, language: MakeLanguage) -> Vec<MakeFinding> {
    if program.language != Language::Rapid {
        return Vec::new();
    }
    let with = |is_one: &dyn Fn(&Motion) -> bool| {
        let feeds = (program.motions.iter()).filter(|motion| motion.kind != MotionKind::Joint);
        let mut lines: Vec<usize> = feeds
            .filter(|motion| is_one(motion))
            .map(|motion| motion.line)
            .collect();
        lines.sort_unstable();
        lines.dedup();
        lines
    };
    let is_lost = |motion: &Motion| !has_them(program, language) && own_speeds(motion).is_some();
    let (lost, unknown) = (
        with(&is_lost),
        with(&|motion| motion.site.other_speeds.is_none()),
    );
    let first = program.motions.iter().find(|motion| is_lost(motion));
    let stated = first.and_then(own_speeds).unwrap_or_default();
    let said = [
        (
            lost,
            format!("the speeds of turning and of external axes that the source states ({stated}; "),
        ),
        (
            unknown,
            "the speeds of turning and of external axes of the source are not known: its data of the speed are declared elsewhere, or change (".to_owned(),
        ),
    ];
    let named = said.into_iter().filter_map(|(lines, what)| {
        let first = *lines.first()?;
        Some(MakeFinding::of(
            first,
            format!(
                "{what}{}) are not kept: where the tool turns, check how fast it does",
                in_words(&lines)
            ),
        ))
    });
    named.collect()
}

/// Motions that do not run exactly once.
pub(crate) fn not_once(program: &RobotProgram) -> Vec<MakeError> {
    let others = program
        .motions
        .iter()
        .filter(|motion| motion.runs != Runs::Once);
    let mut faults: Vec<MakeError> = others
        .map(|motion| {
            let reason = match motion.runs {
                Runs::OnCondition => "the motion is in a branch, or behind what may end the program or its routine before: whether it runs is not known",
                Runs::Elsewhere => "nothing in these files leads to this motion: it never runs (its routine is not called, a jump leaves it out, or the program ends before)",
                _ => "the motion is in a loop, or in a routine that is called more than once",
            };
            MakeError::at(
                motion.line,
                reason,
                "write its motions one after another, or take them out",
            )
        })
        .collect();
    faults.sort_by_key(|fault| fault.line);
    // A statement that runs several times gives several motions.
    faults.dedup();
    faults
}

/// Arcs whose way is not known: it depends on where they begin.
pub(crate) fn arcs_from_elsewhere(program: &RobotProgram, robot: &RobotPath) -> Vec<MakeError> {
    let moves = robot.path.moves.iter().zip(&robot.motions);
    let known = moves.filter(|(own, _)| own.known != Knowledge::Nothing);
    // To the first place the arm goes from wherever it is.
    let arcs = known.skip(1).filter(|(own, motion)| {
        let is_arc = program.motions.get(**motion).is_some_and(|motion| {
            matches!(
                motion.kind,
                MotionKind::Circular { .. } | MotionKind::Arc { .. }
            )
        });
        own.known == Knowledge::End && is_arc
    });
    arcs.map(|(own, _)| {
        MakeError::at(
            own.line,
            "where this arc begins, or the place on it, is not known: behind a routine that is not in these files, or a place that only the run knows",
            "write a motion to a stated place before the arc, or give the routine with the program",
        )
    })
    .collect()
}

/// Remedy of an unknown speed of a motion at feed.
pub(crate) fn speed_remedy(language: Option<Language>) -> &'static str {
    language.map_or(SPEED_REMEDY_OF_BLOCKS, |language| language.speed_remedy())
}
