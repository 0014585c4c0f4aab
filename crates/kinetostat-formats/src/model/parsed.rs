//! A program with what is refused in it, and findings on its motions.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::ProgramError;
use crate::model::Language;
use crate::model::external::moving_axis;
use crate::model::motion::{Frame, Motion, MotionKind};
use crate::model::program::{
    OutsideCall, RanStatement, RobotProgram, StatedAxes, outside_calls as named_calls,
    stated_to_move,
};
use crate::model::site::Declaration;
use crate::model::stated_value::SlashBlocks;
use crate::model::target::Target;
use crate::text::number::in_words;
use crate::text::source::{Finding, SourceFile};

/// A program as far as it could be read, and what is refused: with a fault it must not be corrected.
pub struct Parsed {
    /// All but the motions that are refused.
    pub program: RobotProgram,
    /// Faults in order of files and lines.
    pub faults: Vec<ProgramError>,
}

/// Result of a robot language's reader.
pub(crate) struct Read<'o> {
    pub motions: Vec<Motion>,
    pub declarations: Vec<Declaration>,
    pub findings: Vec<Finding>,
    /// Calls that no file defines.
    pub outside_calls: Vec<OutsideCall>,
    /// Statements beside the motions, in the order in which they ran.
    pub ran: Vec<RanStatement>,
    pub faults: Vec<ProgramError>,
    /// Otherwise a motion of one is a fault.
    pub external_axes_may_move: bool,
    /// Names of calls that move the tool.
    pub moving_calls: &'o BTreeSet<String>,
}

impl Parsed {
    /// Result of files that cannot be read at all.
    pub(crate) fn refused(language: Language, faults: Vec<ProgramError>) -> Self {
        Self::of(language, Vec::new(), Vec::new(), Vec::new(), faults)
    }

    /// Sorted result of files, with findings and faults in the order of files and lines.
    pub(crate) fn of(
        language: Language,
        files: Vec<SourceFile>,
        motions: Vec<Motion>,
        mut findings: Vec<Finding>,
        mut faults: Vec<ProgramError>,
    ) -> Self {
        sort_faults(&mut faults, &files);
        findings.sort_by_key(|finding| (finding.file, finding.line));
        let program = RobotProgram {
            language,
            files,
            motions,
            findings,
            declarations: Vec::new(),
            values: BTreeMap::new(),
            outside_calls: Vec::new(),
            unjudged_feed_on: None,
            ran: Vec::new(),
            slash_blocks: SlashBlocks::default(),
            rotary: StatedAxes::default(),
        };
        Self { program, faults }
    }

    /// Result of a robot language's reader: adds the findings that all languages share, and sorts findings and faults by files and lines.
    pub(crate) fn of_robot(language: Language, files: Vec<SourceFile>, read: Read<'_>) -> Self {
        let Read {
            motions,
            declarations,
            mut findings,
            outside_calls,
            ran,
            mut faults,
            external_axes_may_move,
            moving_calls,
        } = read;
        if !external_axes_may_move {
            faults.extend(moving_axis(&files, &motions, language));
        }
        findings.extend(unknown_frames(&motions));
        findings.extend(left_as_written(&motions));
        let parsed = Self::of(language, files, motions, findings, faults);
        let mut parsed = parsed.with_calls(outside_calls, moving_calls);
        parsed.faults.dedup();
        parsed.program.declarations = declarations;
        parsed.program.ran = ran;
        parsed
    }

    /// With the calls of what is in none of its files: what is assumed of them, and those that the caller says move the tool.
    pub(crate) fn with_calls(
        mut self,
        calls: Vec<OutsideCall>,
        moving_calls: &BTreeSet<String>,
    ) -> Self {
        let program = &mut self.program;
        let stated = stated_to_move(&program.files, &calls, moving_calls);
        program.findings.extend(stated.findings);
        (program.findings).extend(named_calls(program.language, &calls));
        (program.findings).sort_by_key(|finding| (finding.file, finding.line));
        self.faults.extend(stated.faults);
        sort_faults(&mut self.faults, &program.files);
        program.outside_calls = calls;
        self
    }

    /// The program, if nothing is refused.
    pub(crate) fn without_faults(self) -> Result<RobotProgram, Vec<ProgramError>> {
        match self.faults.is_empty() {
            true => Ok(self.program),
            false => Err(self.faults),
        }
    }
}

/// Brings faults into the order of files and lines.
fn sort_faults(faults: &mut [ProgramError], files: &[SourceFile]) {
    let place = |fault: &ProgramError| {
        let file = files.iter().position(|file| file.name() == fault.file);
        (file, fault.span.start, fault.line)
    };
    faults.sort_by_cached_key(place);
}

/// Motions that stay as they are written because their ends are not known, each reason once.
pub(crate) fn left_as_written(motions: &[Motion]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for motion in motions {
        let via = match &motion.kind {
            MotionKind::Circular { via } => Some(via),
            MotionKind::Joint | MotionKind::Linear | MotionKind::Arc { .. } => None,
        };
        let reasons = via
            .into_iter()
            .chain([&motion.target])
            .map(|end| match end {
                Target::Unknown { reason } => Some(reason),
                Target::Pose(_) | Target::Joints { .. } => None,
            });
        let mut reasons: Vec<&String> = reasons.flatten().collect();
        reasons.dedup();
        findings.extend(reasons.into_iter().map(|reason| Finding {
            file: motion.file,
            line: motion.line,
            message: format!("it stays as it is written: {reason}"),
        }));
    }
    findings
}

/// Names of frames that are not known, each once.
pub(crate) fn unknown_frames(motions: &[Motion]) -> Vec<Finding> {
    let mut named = BTreeSet::new();
    let mut findings = Vec::new();
    for motion in motions {
        for frame in [&motion.tool, &motion.work_object] {
            if let Frame::Unknown { reason } = &frame.frame
                && named.insert(frame.name.clone())
            {
                let message = format!("where `{}` is, is not known: {reason}", frame.name);
                findings.push(Finding {
                    file: motion.file,
                    line: motion.line,
                    message,
                });
            }
        }
    }
    findings
}

/// Message on a cycle that stays a call over its hole.
pub(crate) fn stays_as_written(cycle: &str) -> String {
    format!(
        "{cycle} stays as it is written: its way is the control's own, and not corrected; the tool stands over the corrected place"
    )
}

/// Motions of a file to which its run does not come, by their lines; none where there are none.
pub(crate) fn unreached_motions(file: usize, mut lines: Vec<usize>) -> Option<Finding> {
    lines.sort_unstable();
    lines.dedup();
    let line = lines.first().copied()?;
    let message = format!(
        "the run of the program does not come to the motions on {}: they stay as they are written",
        in_words(&lines)
    );
    Some(Finding {
        file,
        line,
        message,
    })
}
