//! Contents of a paper, in order.

mod chatter;
mod inputs;
mod of;
mod results;
mod tables;

use kinetostat_machining::Level;

use crate::number;
use crate::paper::block::{Block, Contents};
use crate::paper::content::of::{MOST, Of, more};
use crate::paper::question::Paper;
use crate::paper::words::table::fill;
use crate::paper::words::{statement, words};
use crate::run::meaning::assessment;
use crate::run::shown::Shown;
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
    let mut blocks = vec![Block::Facts(inputs::head(&of)), verdict(&of)];
    if !words.quoted.is_empty() {
        blocks.push(Block::Note(words.quoted.to_owned()));
    }
    blocks.extend(results::results(&of));
    blocks.extend(tables::features(&of));
    blocks.extend(tables::worst(&of));
    blocks.extend(tables::drives(&of));
    blocks.extend(tables::cut(&of));
    blocks.extend(chatter::chatter(&of));
    blocks.extend(results::left(&of));
    blocks.extend(warnings(&of));
    blocks.push(Block::Heading(words.head_inputs.to_owned()));
    blocks.push(Block::Facts(inputs::inputs(&of)));
    blocks.push(Block::Heading(words.head_files.to_owned()));
    blocks.push(inputs::files(&of));
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
