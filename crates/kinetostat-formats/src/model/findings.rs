//! Findings on the motions that were read.

use std::collections::BTreeSet;

use crate::model::frame::Frame;
use crate::model::language::Language;
use crate::model::motion::{Motion, MotionKind};
use crate::model::outside_call::{OutsideCall, by_name};
use crate::model::target::Target;
use crate::text::finding::Finding;
use crate::text::line_words::in_words;

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

/// Findings on calls that no file defines: each name once, with its lines and the assumption.
pub(crate) fn outside_calls(language: Language, calls: &[OutsideCall]) -> Vec<Finding> {
    let all = by_name(calls).into_iter().map(|of| Finding {
        file: of.file,
        line: of.line(),
        message: of.message(language, None),
    });
    all.collect()
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
