//! Contents of a paper, in order.

mod of;
mod pictures;
pub(crate) mod sections;

use kinetostat_machining::Level;

use crate::number;
use crate::paper::block::{Block, Cell, Column, Contents, Remark, Table};
use crate::paper::content::of::{MOST, Of, more};
use crate::paper::question::Paper;
use crate::paper::words::table::fill;
use crate::paper::words::{left as in_words, statement, words};
use crate::run::meaning::assessment;
use crate::run::{Shown, facts};
use crate::text::{clean, shorten};

/// A paper of a run.
pub(crate) fn contents(paper: &Paper<'_>, result: &Shown<'_>) -> Contents {
    let language = paper.language;
    let words = words(language);
    let of = Of {
        paper,
        result,
        words,
        language,
    };
    let inputs = &result.run_inputs;
    let kind = match (&paper.verified, inputs.compensated) {
        (Some(_), _) => words.kind_verified,
        (None, true) => words.kind_compensated,
        (None, false) => words.kind_analysed,
    };
    let program = shorten(&of.text(&inputs.program), 80);
    let machine = shorten(&of.text(&inputs.model), 80);
    let version = shorten(&result.kinetostat_version, 40);
    let mut blocks = vec![Block::Facts(head(&of)), verdict(&of)];
    if !words.quoted.is_empty() {
        blocks.push(Block::Note(words.quoted.to_owned()));
    }
    blocks.extend(results(&of));
    blocks.extend(pictures::pictures(&of));
    blocks.extend(sections::features(&of));
    blocks.extend(sections::worst(&of));
    blocks.extend(sections::drives(&of));
    blocks.extend(sections::cut(&of));
    blocks.extend(sections::chatter(&of));
    blocks.extend(left(&of));
    blocks.extend(warnings(&of));
    blocks.push(Block::Heading(words.head_inputs.to_owned()));
    blocks.push(Block::Facts(input_facts(&of)));
    blocks.push(Block::Heading(words.head_files.to_owned()));
    blocks.push(files(&of));
    blocks.push(Block::Heading(words.head_signatures.to_owned()));
    blocks.push(Block::Signatures(
        words
            .signed_by
            .map(|who| [who, words.name_and_date, words.signature].map(str::to_owned))
            .to_vec(),
    ));
    Contents {
        language,
        kind: kind.to_owned(),
        title: fill(
            words.title,
            &[("program", program.as_str()), ("machine", &machine)],
        ),
        running: [program, fill(words.made_by, &[("version", &version)])],
        page_of: words.page_of,
        date: inputs.date.clone(),
        blocks,
    }
}

/// True if the tolerance is kept along the program and by every feature of it.
fn keeps_tolerances(of: &Of<'_>) -> bool {
    let features = &of.result.features;
    of.result.tolerance.held == Some(true) && features.iter().all(|f| f.held != Some(false))
}

fn verdict(of: &Of<'_>) -> Block {
    let words = of.words;
    let assessment = assessment(of.result);
    let (level, word) = match (&of.paper.verified, assessment.level) {
        (_, Level::Stop) => (Level::Stop, words.stop),
        (Some(verified), level) if verified.held && level != Level::Attention => {
            (Level::Good, words.verified)
        }
        (Some(verified), _) if verified.held => (Level::Attention, words.attention),
        (Some(_), _) if keeps_tolerances(of) => (Level::Attention, words.not_verified),
        (Some(_), _) => (Level::Attention, words.missed),
        (None, Level::Good) => (Level::Good, words.good),
        (None, Level::Unchanged) => (Level::Unchanged, words.unchanged),
        (None, Level::Analysis) => (Level::Analysis, words.analysis),
        (None, Level::Attention) => (Level::Attention, words.attention),
    };
    let mut sentences: Vec<String> = assessment
        .statements
        .iter()
        .filter_map(|said| statement(of.language, said, of.result))
        .map(|sentence| clean(&sentence))
        .collect();
    for (lines, length_mm) in of.paper.verified.iter().flat_map(|v| &v.uncut) {
        let several = usize::from(lines[1] != lines[0]);
        let [first, last] = lines.map(number::count);
        let length = of.length(*length_mm);
        sentences.push(fill(
            words.uncut[several],
            &[
                ("first", first.as_str()),
                ("last", &last),
                ("length", &length),
            ],
        ));
    }
    let lists = of.paper.verified.iter().flat_map(|verified| {
        let rapids = verified
            .rapids
            .iter()
            .map(|own| (words.rapid_elsewhere, own));
        let cuts = verified.extra_cuts.iter().map(|own| (words.extra_cut, own));
        rapids.chain(cuts)
    });
    for (sentence, (line, mm)) in lists {
        let (line, length) = (number::count(*line), of.length(*mm));
        let values = [("line", line.as_str()), ("length", &length)];
        sentences.push(fill(sentence, &values));
    }
    for line in of.paper.verified.iter().flat_map(|v| &v.other_words) {
        let line = number::count(*line);
        sentences.push(fill(words.other_word, &[("line", line.as_str())]));
    }
    sentences.push(words.model_only.to_owned());
    Block::Verdict {
        level,
        word: word.to_owned(),
        sentences,
    }
}

fn warnings(of: &Of<'_>) -> Vec<Block> {
    let all = &of.result.warnings;
    let shown = all.iter().take(MOST);
    let lines: Vec<String> = shown.map(|warning| clean(&warning.to_string())).collect();
    let mut blocks = vec![
        Block::Heading(of.words.head_warnings.to_owned()),
        match lines.is_empty() {
            true => Block::Paragraph(of.words.none.to_owned()),
            false => Block::List(lines),
        },
    ];
    blocks.extend(more(of.words.more_warnings, all.len()));
    blocks
}

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
fn head(of: &Of<'_>) -> Vec<Fact> {
    let (words, inputs) = (of.words, &of.result.run_inputs);
    let mut facts = vec![fact(
        words.date,
        of.text(inputs.date.as_deref().unwrap_or_default()),
    )];
    facts.push(fact(words.program, of.text(&inputs.program)));
    if let Some(verified) = &of.paper.verified {
        facts.push(fact(words.original, of.text(&verified.original)));
    }
    let part = [
        (words.part_number, &inputs.part_number),
        (words.revision, &inputs.revision),
    ];
    let stated = part
        .into_iter()
        .filter_map(|(name, text)| Some(fact(name, of.text(text.as_ref()?))));
    facts.extend(stated);
    facts.push(fact(words.machine, of.text(&inputs.model)));
    facts
}

/// Model, tool, load and tolerances.
fn input_facts(of: &Of<'_>) -> Vec<Fact> {
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
fn files(of: &Of<'_>) -> Block {
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

/// Figures of the whole run.
fn results(of: &Of<'_>) -> Vec<Block> {
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
fn left(of: &Of<'_>) -> Vec<Block> {
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
