//! Inputs of a run: model, tool, load, tolerances and files.

use crate::number;
use crate::paper::block::{Block, Cell, Column, Table};
use crate::paper::content::of::Of;
use crate::paper::words::table::fill;
use crate::text::clean;

type Fact = (String, Vec<String>);

fn fact(name: &str, text: String) -> Fact {
    (name.to_owned(), vec![text])
}

fn list(name: &str, lines: &[String], otherwise: &str) -> Fact {
    let mut lines: Vec<String> = lines.iter().map(|line| clean(line)).collect();
    if lines.is_empty() {
        lines.push(otherwise.to_owned());
    }
    (name.to_owned(), lines)
}

/// The first lines: what the paper is about.
pub(super) fn head(of: &Of<'_>) -> Vec<Fact> {
    let (words, inputs) = (of.words, &of.result.run_inputs);
    let mut facts = vec![fact(
        words.date,
        of.text(inputs.date.as_deref().unwrap_or_default()),
    )];
    facts.push(fact(words.program, of.text(&inputs.program)));
    if let Some(verified) = &of.paper.verified {
        facts.push(fact(words.original, of.text(&verified.original)));
    }
    facts.push(fact(words.machine, of.text(&inputs.model)));
    facts
}

/// Model, tool, load and tolerances.
pub(super) fn inputs(of: &Of<'_>) -> Vec<Fact> {
    let (words, inputs) = (of.words, &of.result.run_inputs);
    let summary = &of.result.summary;
    let setting = |mm: f64| of.figure(&number::length_setting(mm));
    let bytes = |blocks: usize, bytes: usize| {
        let [blocks, bytes] = [blocks, bytes].map(number::count);
        fill(
            words.bytes,
            &[("blocks", blocks.as_str()), ("bytes", &bytes)],
        )
    };
    let mut facts = vec![
        fact(words.machine, of.text(&inputs.model)),
        fact(words.model_from, of.text(&inputs.model_source)),
        list(words.deviations, &inputs.model_deviations, words.none),
        list(words.stiffnesses, &inputs.stiffnesses, words.not_stated),
        fact(words.tool, of.text(&inputs.tool)),
        fact(words.orientation, of.text(&inputs.tool_orientation)),
        fact(words.load, of.text(&inputs.load)),
        list(words.material, &inputs.cut, words.no_material),
        fact(words.placement, of.text(&inputs.placement)),
        fact(words.path, of.figure(&of.result.figures.feed_length)),
    ];
    if let Some(flat) = &inputs.flat {
        facts.push(list(words.flat, &flat.settings, words.not_stated));
    }
    facts.push(fact(
        words.blocks_read,
        bytes(summary.blocks, summary.bytes_in),
    ));
    if !inputs.compensated || of.paper.verified.is_some() {
        return facts;
    }
    let tolerance = setting(inputs.tolerance_mm);
    let from = clean(&inputs.tolerance_from);
    facts.extend([
        fact(
            words.blocks_written,
            bytes(summary.blocks_out, summary.bytes_out),
        ),
        fact(
            words.tolerance_path,
            match from.is_empty() {
                true => tolerance,
                false => format!("{tolerance}: {from}"),
            },
        ),
        fact(words.tolerance_chords, setting(inputs.chord_tolerance_mm)),
        fact(words.decimals, inputs.decimals.to_string()),
    ]);
    facts
}

/// Files with their hashes.
pub(super) fn files(of: &Of<'_>) -> Block {
    let words = of.words;
    let files = of.result.run_inputs.files.iter().chain(&of.paper.written);
    let rows: Vec<Vec<Cell>> = files
        .map(|file| {
            let what = words.file(&clean(&file.what));
            [what, clean(&file.name), clean(&file.sha256)]
                .map(Cell::from)
                .to_vec()
        })
        .collect();
    if rows.is_empty() {
        return Block::Paragraph(words.not_stated.to_owned());
    }
    Block::Table(Table {
        columns: vec![
            Column::words(words.file_what),
            Column::words(words.file_name),
            Column::short("SHA-256"),
        ],
        rows,
    })
}
