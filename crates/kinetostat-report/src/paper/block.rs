//! Contents of a paper before its layout on pages: the same for PDF and HTML.

use kinetostat_machining::Level;

use crate::paper::language::Language;

/// A paper: headed, in its order.
#[derive(Clone, Debug)]
pub(crate) struct Contents {
    pub(crate) language: Language,
    /// Stands small above the title.
    pub(crate) kind: String,
    pub(crate) title: String,
    /// Text on every page: the program, and who made the paper.
    pub(crate) running: [String; 2],
    /// `page {page} of {pages}`.
    pub(crate) page_of: &'static str,
    /// Day, `2026-11-20`.
    pub(crate) date: Option<String>,
    pub(crate) blocks: Vec<Block>,
}

/// A part of a paper.
#[derive(Clone, Debug)]
pub(crate) enum Block {
    Heading(String),
    Paragraph(String),
    /// Small print.
    Note(String),
    /// The verdict: how good it is, one word, sentences.
    Verdict {
        level: Level,
        word: String,
        sentences: Vec<String>,
    },
    /// Names with what is to be said of them, a line or more.
    Facts(Vec<(String, Vec<String>)>),
    /// Names with a size and an explanation.
    Remarks(Vec<Remark>),
    List(Vec<String>),
    /// A drawing (SVG, a document of its own) and what it shows.
    Picture {
        svg: String,
        shows: String,
    },
    Table(Table),
    /// Room for names, dates and signatures: what is to be written on each line.
    Signatures(Vec<[String; 3]>),
}

/// Something with a size and an explanation.
#[derive(Clone, Debug)]
pub(crate) struct Remark {
    pub(crate) name: String,
    pub(crate) size: String,
    pub(crate) text: String,
}

impl Remark {
    pub(crate) fn new(name: &str, size: String, text: String) -> Self {
        Self {
            name: name.to_owned(),
            size,
            text,
        }
    }
}

/// A table: its head stands again on every page.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<Vec<Cell>>,
}

/// A column.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    pub(crate) head: String,
    pub(crate) side: Side,
    /// True if its text may be broken into lines; the width of others is that of their widest cell.
    pub(crate) wraps: bool,
}

/// Alignment of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// A cell of a table.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) text: String,
    pub(crate) strong: bool,
}

impl Column {
    /// Words, to the left, broken into lines.
    pub(crate) fn words(head: &str) -> Self {
        Self {
            head: head.to_owned(),
            side: Side::Left,
            wraps: true,
        }
    }

    /// Short words, to the left.
    pub(crate) fn short(head: &str) -> Self {
        Self {
            wraps: false,
            ..Self::words(head)
        }
    }

    /// Figures, to the right.
    pub(crate) fn figures(head: &str) -> Self {
        Self {
            head: head.to_owned(),
            side: Side::Right,
            wraps: false,
        }
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self {
            text,
            strong: false,
        }
    }
}

impl Cell {
    /// Cell in bold type.
    pub(crate) fn strong(text: String) -> Self {
        Self { text, strong: true }
    }
}

impl Contents {
    /// Everything that is said, in its order, a line for each piece: what tests read.
    #[cfg(test)]
    pub(crate) fn text(&self) -> String {
        let mut lines = vec![self.kind.clone(), self.title.clone()];
        for block in &self.blocks {
            match block {
                Block::Heading(t) | Block::Paragraph(t) | Block::Note(t) => lines.push(t.clone()),
                Block::Verdict {
                    word, sentences, ..
                } => {
                    lines.push(word.clone());
                    lines.extend(sentences.iter().cloned());
                }
                Block::Facts(facts) => {
                    lines.extend(facts.iter().map(|(n, l)| format!("{n}: {}", l.join(" "))))
                }
                Block::Remarks(all) => lines.extend(
                    all.iter()
                        .map(|r| format!("{}: {}: {}", r.name, r.size, r.text)),
                ),
                Block::List(items) => lines.extend(items.iter().cloned()),
                Block::Picture { shows, .. } => lines.push(shows.clone()),
                Block::Table(table) => {
                    let heads: Vec<&str> = table.columns.iter().map(|c| c.head.as_str()).collect();
                    lines.push(heads.join(" | "));
                    lines.extend(table.rows.iter().map(|row| {
                        let cells: Vec<&str> = row.iter().map(|c| c.text.as_str()).collect();
                        cells.join(" | ")
                    }));
                }
                Block::Signatures(all) => lines.extend(all.iter().map(|row| row.join(" | "))),
            }
        }
        lines.join("\n")
    }
}
