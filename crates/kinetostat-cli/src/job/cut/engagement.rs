//! Engagement that a job states.

use std::ops::RangeInclusive;

use kinetostat_cutting::{Engagement, Side, Tool};
use kinetostat_machining::EngagementSource;
use serde_spanned::Spanned;

use crate::job::cut::refused::refused;
use crate::job::cut_tables::EngagementTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::short;

/// The engagement of `[engagement]` for a tool, and it in words.
pub(super) fn engagement(
    job: &JobFile,
    table: &Spanned<EngagementTable>,
    tool: &Tool,
) -> Answer<(EngagementSource, String)> {
    let t = table.get_ref();
    let straight = |width: f64, depth: f64, part: Option<Side>| {
        let slot = width >= 2.0 * tool.radius_mm();
        let part = match part {
            Some(side) => side,
            None if slot => Side::Left,
            None => {
                return Err(job.error(
                    table,
                    "it is not said on which side of the feed the part is",
                    "write part = \"left\" or part = \"right\"",
                ));
            }
        };
        Engagement::straight(tool.radius_mm(), width, depth, part)
            .map_err(|error| refused(job, table, &error))
    };
    match (&t.width_mm, &t.depth_mm, t.lines.is_empty()) {
        (Some(width), Some(depth), true) => {
            let (width, depth) = (*width.get_ref(), *depth.get_ref());
            let words = format!(
                "engagement as stated on all feed moves: {} mm wide, {} mm deep",
                short(width),
                short(depth)
            );
            let source = EngagementSource::Constant(straight(width, depth, t.part)?);
            Ok((source, words))
        }
        (None, None, false) => {
            let mut ranges = Vec::new();
            for lines in &t.lines {
                let l = lines.get_ref();
                if l.from == 0 || l.to < l.from {
                    return Err(job.error(
                        lines,
                        "lines count from 1, the first before the last",
                        "correct 'from' and 'to'",
                    ));
                }
                let before = ranges
                    .iter()
                    .find(|(range, _): &&(RangeInclusive<usize>, _)| {
                        *range.start() <= l.to && l.from <= *range.end()
                    });
                if let Some((range, _)) = before {
                    return Err(job.error(
                        lines,
                        &format!(
                            "lines {} to {} have an engagement already",
                            range.start(),
                            range.end()
                        ),
                        "let no line stand in two ranges",
                    ));
                }
                ranges.push((l.from..=l.to, straight(l.width_mm, l.depth_mm, l.part)?));
            }
            Ok((
                EngagementSource::Lines(ranges),
                "engagement as stated for lines of the program, air on all others".to_owned(),
            ))
        }
        _ => Err(missing(job, table)),
    }
}

fn missing(job: &JobFile, table: &Spanned<EngagementTable>) -> Failure {
    job.error(
        table,
        "an engagement is 'width_mm' and 'depth_mm', or 'lines'",
        "write both, or lines = [{ from = 10, to = 40, width_mm = 2, depth_mm = 3, part = \"right\" }]",
    )
}
