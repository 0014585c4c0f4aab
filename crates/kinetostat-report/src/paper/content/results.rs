//! Figures before and after, and what is left.

use crate::number;
use crate::paper::block::{Block, Cell, Column, Remark, Table};
use crate::paper::content::of::Of;
use crate::paper::words::left as in_words;
use crate::run::facts;

/// Figures of the whole run.
pub(super) fn results(of: &Of<'_>) -> Vec<Block> {
    let (words, result) = (of.words, of.result);
    let (summary, figures) = (&result.summary, &result.figures);
    let verified = of.paper.verified.as_ref();
    let after = of.has_after();
    let mut columns = vec![Column::words(words.figure)];
    columns.extend(
        match (verified, after) {
            (Some(_), _) => vec![words.of_original, words.of_verified],
            (None, true) => vec![words.before, words.after],
            (None, false) => vec![words.before],
        }
        .into_iter()
        .map(Column::figures),
    );
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    let mut row = |name: &str, before: &str, behind: &str| {
        let mut cells = vec![Cell::from(name.to_owned())];
        match after {
            true => cells.extend([before, behind].map(|text| Cell::from(of.figure(text)))),
            false if before.is_empty() => cells.push(of.figure(behind).into()),
            false => cells.push(of.figure(before).into()),
        }
        rows.push(cells);
    };
    row(
        words.largest_error,
        &figures.error_before,
        &figures.error_after,
    );
    row(words.rms_error, &figures.rms_before, &figures.rms_after);
    let allowed_mm = verified.map_or_else(|| result.allowed_mm(), |v| v.allowed_mm);
    if after {
        let allowed = number::against(summary.max_position_error_after_mm, allowed_mm).1;
        row(words.allowed_in_all, "", &allowed);
        let [yes, no] = words.yes_no;
        if let Some(held) = result.tolerance.held {
            row(words.held, "", if held { yes } else { no });
        }
    }
    if after && verified.is_none() {
        row(words.rounding, "", &figures.rounding);
        row(words.largest_correction, "", &figures.correction);
        row(words.speed, "", &figures.speed);
        if let Some(most) = &figures.blocks_per_second {
            row(words.blocks_per_second, "", most);
        }
    }
    row(words.tilt, "", &figures.rotation);
    row(words.stiffness, "", &figures.stiffness);
    match &figures.share_to_buckling {
        Some(share) => row(words.buckling, "", share),
        None => row(words.no_buckling, "", ""),
    }
    row(words.points, "", &number::count(summary.points));
    let [yes, no] = words.yes_no;
    row(words.stable, "", if summary.stable { yes } else { no });
    let mut blocks = vec![
        Block::Heading(words.head_results.to_owned()),
        Block::Table(Table { columns, rows }),
    ];
    if result.run_inputs.compensated && verified.is_none() {
        blocks.push(Block::Note(words.read_back.to_owned()));
    }
    blocks
}

/// Uncorrected errors, and effects that no figure covers.
pub(super) fn left(of: &Of<'_>) -> Vec<Block> {
    let words = of.words;
    // A program that was verified was written by others: of its steps nothing is known.
    let all = facts::left(of.result).into_iter();
    let known = all.filter(|left| of.paper.verified.is_none() || *left == facts::Left::Tilt);
    let remarks: Vec<Remark> = known
        .map(|left| {
            let [name, size, text] = in_words(of.language, left, of.result);
            Remark { name, size, text }
        })
        .collect();
    vec![
        Block::Heading(words.head_left.to_owned()),
        Block::Paragraph(
            match of.result.chatter {
                None => words.not_covered,
                Some(_) => words.not_covered_beside_chatter,
            }
            .to_owned(),
        ),
        Block::Remarks(remarks),
    ]
}
