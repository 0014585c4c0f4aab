//! Facts and acts of APT that files outside this folder ask for, and the adapter of the writer.

use std::collections::BTreeMap;

use kinetostat_program::SpindleChange;
use nalgebra::{UnitQuaternion, Vector3};

use crate::apt::flat::expand::expand_apt;
use crate::apt::lines::statements_of;
use crate::apt::reader::{parse_apt, read_apt};
use crate::apt::state::{spindle_changes, unit_of};
use crate::apt::table::APT_STATEMENTS;
use crate::error::WriteError;
use crate::flat_run::RefusedRun;
use crate::model::motion::Motion;
use crate::model::orientation::OrientationText;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::options::{ReadOptions, WriteOptions};
use crate::program_language::{ProgramLanguage, WrittenFile, of_run};
use crate::table::StatementRow;
use crate::text::source::{Edits, FlatText, SourceFile};
use crate::writing::motions::write_with;
use crate::writing::piece::Piece;
use crate::writing::syntax::{PieceLiterals, Syntax};

/// APT and CLDATA.
pub(crate) struct AptLanguage;

impl ProgramLanguage for AptLanguage {
    fn word(&self) -> &'static str {
        "apt"
    }

    fn name(&self) -> &'static str {
        "APT"
    }

    fn title(&self) -> &'static str {
        "APT and CLDATA of SolidWorks CAM, NX, CATIA and others"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["apt", "cls", "cl", "aptsource", "apt_source", "cldata"]
    }

    fn comment(&self) -> &'static str {
        "$$"
    }

    fn statements(&self) -> &'static [StatementRow] {
        APT_STATEMENTS
    }

    fn written(&self) -> &'static str {
        "Written: numbers of GOTO in place, further places as GOTO before it; circles that are corrected become straight motions."
    }

    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
        parse_apt(files, options)
    }

    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        write_apt(program, pieces, options)
    }

    fn expand(
        &self,
        files: &[SourceFile],
        _options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        of_run(expand_apt(files))
    }

    fn rapids_are_straight(&self) -> bool {
        true
    }

    fn held_word(&self) -> Option<&'static str> {
        Some("GOTO")
    }

    fn is_of_robot(&self) -> bool {
        false
    }

    fn is_loaded(&self) -> bool {
        false
    }

    fn states_turn(&self) -> bool {
        false
    }

    /// A `;` begins no comment.
    fn takes_origin(&self, _line: &[u8]) -> bool {
        false
    }

    fn has_rapid_word(&self) -> bool {
        true
    }

    fn is_rapid(&self, speed: &str) -> bool {
        speed.to_ascii_uppercase().starts_with("RAPID")
    }

    fn spindle_is_in_path(&self) -> bool {
        true
    }

    fn spindle_changes(&self, file: &SourceFile) -> Vec<SpindleChange> {
        spindle_changes(file)
    }

    fn code_of<'t>(&self, line: &'t str) -> &'t str {
        line.split("$$").next().unwrap_or_default()
    }

    fn order_words(&self) -> &'static [&'static str] {
        &[
            "GOTO", "RAPID", "FEDRAT", "UNITS", "UNIT", "MULTAX", "TLAXIS", "PARTNO", "TRNTYP",
            "FINI", "END",
        ]
    }

    fn speed_remedy(&self) -> &'static str {
        "state FEDRAT as a number (and SPINDL, where it is by turns), or state unstated_feed_mm_per_s in the template"
    }

    fn keeps_direction(&self) -> bool {
        true
    }

    fn comment_behind_statement(&self) -> Option<&'static str> {
        Some("$$")
    }

    fn jumps(&self) -> &'static [&'static str] {
        &["JUMPTO", "LOOPST"]
    }
}

// A piece of a motion is a `GOTO` before it, with a `RAPID` behind where the motion has one: RAPID holds for the next
// `GOTO` alone. A divided arc loses its `CIRCLE`. A `GODLTA` whose end or start changes becomes a `GOTO`. A `GOTO` without an
// axis gets one where that is corrected, or the one before it is.

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_apt(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    if pieces.is_empty() {
        return write_with(program, pieces, options, &AptSyntax);
    }
    let own = with_own_axes(program, pieces);
    let program = own.as_ref().unwrap_or(program);
    let units: Vec<f64> = program
        .files
        .iter()
        .map(|file| unit_of(file, &statements_of(file.bytes())).0.unwrap_or(1.0))
        .collect();
    let mut ends: BTreeMap<usize, &Piece> = BTreeMap::new();
    for piece in pieces {
        ends.insert(piece.motion, piece);
    }
    let mut all = pieces.to_vec();
    for (index, motion) in program.motions.iter().enumerate() {
        let starts_elsewhere = motion.follows.is_some_and(|from| {
            let before = program.motions.get(from).and_then(|m| m.target.pose());
            let (Some(piece), Some(before)) = (ends.get(&from), before) else {
                return false;
            };
            (piece.position_mm - before.position_mm).norm() > SAME_MM
        });
        if ends.contains_key(&index) || !starts_elsewhere {
            continue;
        }
        if motion.site.via.is_some() {
            return Err(refused(
                program,
                motion,
                "the arc begins at a place that changes, and is then none about its written centre",
                "divide it into straight pieces, too, or keep its start",
            ));
        }
        if let (true, Some(end)) = (is_step(program, motion), motion.target.pose()) {
            all.push(Piece::to(index, end.position_mm));
        }
    }
    axes(program, &ends)?;
    for piece in &mut all {
        if let Some(motion) = program.motions.get(piece.motion) {
            piece.position_mm /= units[motion.file];
        }
    }
    let mut options = options.clone();
    if units.contains(&25.4) {
        // Equal resolution in inches.
        options.position_decimals += 2;
    }
    write_with(program, &all, &options, &AptSyntax)
}

fn refused(program: &RobotProgram, motion: &Motion, reason: &str, remedy: &str) -> WriteError {
    WriteError::Motion {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason: reason.to_owned(),
        remedy: remedy.to_owned(),
    }
}

/// True for `GODLTA`.
fn is_step(program: &RobotProgram, motion: &Motion) -> bool {
    let word = program.files[motion.file].part(&motion.site.keyword);
    word.eq_ignore_ascii_case(b"GODLTA")
}

/// Threshold of a change of position, mm.
const SAME_MM: f64 = 1e-6;

/// Threshold of a written change of the axis, rad.
const SAME_RAD: f64 = 1e-9;

/// The program with the axis in force written into each GOTO that needs one of its own; none where no GOTO does.
fn with_own_axes(program: &RobotProgram, pieces: &[Piece]) -> Option<RobotProgram> {
    let wanted: BTreeMap<usize, Option<UnitQuaternion<f64>>> = (pieces.iter())
        .map(|piece| (piece.motion, piece.orientation))
        .collect();
    let z = Vector3::z();
    let mut edits: Vec<Edits> = program.files.iter().map(|_| Edits::default()).collect();
    let mut needed = false;
    // The axis behind the last motion, as written, and whether that is the text's own.
    let mut turned = false;
    for (index, motion) in program.motions.iter().enumerate() {
        let (Some(pose), TargetSite::Literal(text)) = (motion.target.pose(), &motion.site.target)
        else {
            continue;
        };
        let own = pose.orientation * z;
        let to = wanted.get(&index).copied().flatten();
        let turns = to.is_some_and(|to| (to * z).angle(&own) > SAME_RAD);
        let states = text.convention == OrientationText::Axis;
        let word = program.files[motion.file].part(&motion.site.keyword);
        if !states && (turns || turned) && word.eq_ignore_ascii_case(b"GOTO") {
            let axis = format!(",{:.7},{:.7},{:.7}", own.x, own.y, own.z);
            edits[motion.file].replace(text.whole.end..text.whole.end, axis);
            needed = true;
        }
        turned = turns;
    }
    if !needed {
        return None;
    }
    let files = program.files.iter().zip(edits).map(|(file, edits)| {
        let bytes = edits.applied_to(file.bytes())?;
        Some(SourceFile::new(file.name(), bytes))
    });
    let reading = ReadOptions::default().as_written();
    let again = read_apt(files.collect::<Option<Vec<_>>>()?, &reading).ok()?;
    (again.motions.len() == program.motions.len()).then_some(again)
}

/// Checks that no GOTO without an axis of its own gets another: the axis holds until the next one.
fn axes(program: &RobotProgram, ends: &BTreeMap<usize, &Piece>) -> Result<(), WriteError> {
    let mut turned: Option<usize> = None;
    for (index, motion) in program.motions.iter().enumerate() {
        let own = match &motion.site.target {
            TargetSite::Literal(text) => text.convention == OrientationText::Axis,
            _ => false,
        };
        if own || turned.is_some_and(|file| file != motion.file) {
            turned = None;
        } else if turned.is_some() {
            return Err(refused(
                program,
                motion,
                "its axis is that of a GOTO before it, which changes",
                "let the CAM system write the axis into every GOTO, or correct places alone",
            ));
        }
        let wanted = ends.get(&index).and_then(|piece| piece.orientation);
        let (Some(wanted), Some(pose)) = (wanted, motion.target.pose()) else {
            continue;
        };
        let z = Vector3::z_axis();
        let differs = (wanted * z).angle(&(pose.orientation * z)) > SAME_RAD;
        match (differs, own) {
            (true, true) => turned = Some(motion.file),
            (true, false) => {
                return Err(refused(
                    program,
                    motion,
                    "it states no axis that could be turned",
                    "let the CAM system write the axis into every GOTO, or correct places alone",
                ));
            }
            (false, _) => {}
        }
    }
    Ok(())
}

/// APT.
struct AptSyntax;

impl Syntax for AptSyntax {
    fn moved(&self, program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        if is_step(program, motion) {
            edits.replace(motion.site.keyword.clone(), "GOTO");
        }
    }

    fn piece(
        &self,
        program: &RobotProgram,
        motion: &Motion,
        literals: &PieceLiterals,
        _speed: Option<&[u8]>,
    ) -> Option<Vec<u8>> {
        let file = program.files.get(motion.file)?;
        let site = &motion.site;
        let mut edits = Edits::default();
        // GODLTA and GOHOME, too, go to the end by a GOTO.
        if !file.part(&site.keyword).eq_ignore_ascii_case(b"GOTO") {
            edits.replace(site.keyword.clone(), "GOTO");
        }
        edits.replace(site.target_span.clone(), literals.end.clone());
        let mut text = edits.applied_to_part(file.bytes(), &motion.span)?;
        let rapid = motion.speed.text.as_bytes();
        if rapid.len() >= 5 && rapid[..5].eq_ignore_ascii_case(b"RAPID") {
            text.extend_from_slice(file.line_ending());
            text.extend_from_slice(rapid);
        }
        Some(text)
    }

    fn straighten(&self, _program: &RobotProgram, motion: &Motion, edits: &mut Edits) {
        if let Some((lines, _)) = &motion.site.via {
            edits.replace(lines.clone(), "");
        }
    }
}
