//! A document of any answer: headings, sentences, tables and pictures.

use crate::ReportError;
use crate::paper::block::{Block, Cell, Column, Contents, Table};
use crate::paper::language::Language;
use crate::paper::{page, words};
use crate::text::clean;

/// A document in English, as HTML with pictures or as PDF without.
///
/// ```
/// let mut document = kinetostat_report::Document::new("Identification", "My robot", "kinetostat");
/// document.heading("Numbers");
/// document.table(&["number"], &["N m/rad"], [vec!["A1".to_owned(), "3.1e6".to_owned()]]);
/// assert!(document.html().contains("<h2>Numbers</h2>"));
/// ```
#[derive(Clone, Debug)]
pub struct Document {
    contents: Contents,
}

impl Document {
    /// A document without parts; `kind` stands small above the title, `made_by` below everything.
    #[must_use]
    pub fn new(kind: &str, title: &str, made_by: &str) -> Self {
        let language = Language::English;
        Self {
            contents: Contents {
                language,
                kind: clean(kind),
                title: clean(title),
                running: [clean(title), clean(made_by)],
                page_of: words::words(language).page_of,
                date: None,
                blocks: Vec::new(),
            },
        }
    }

    /// The day, `2026-11-20`: an archive wants it.
    pub fn dated(&mut self, day: Option<String>) {
        self.contents.date = day;
    }

    /// A heading.
    pub fn heading(&mut self, text: &str) {
        self.add(Block::Heading(clean(text)));
    }

    /// A paragraph.
    pub fn paragraph(&mut self, text: &str) {
        self.add(Block::Paragraph(clean(text)));
    }

    /// A list.
    pub fn list(&mut self, items: impl IntoIterator<Item = String>) {
        self.add(Block::List(items.into_iter().map(|t| clean(&t)).collect()));
    }

    /// A table: columns of words, and behind them columns of figures.
    pub fn table(
        &mut self,
        words: &[&str],
        figures: &[&str],
        rows: impl IntoIterator<Item = Vec<String>>,
    ) {
        let words = words.iter().map(|head| Column::short(head));
        let cells = |row: Vec<String>| row.iter().map(|c| Cell::from(clean(c))).collect();
        self.add(Block::Table(Table {
            columns: words
                .chain(figures.iter().map(|head| Column::figures(head)))
                .collect(),
            rows: rows.into_iter().map(cells).collect(),
        }));
    }

    /// A picture that was drawn by this crate (SVG), and what it shows.
    pub fn picture(&mut self, svg: String, shows: &str) {
        let shows = clean(shows);
        self.add(Block::Picture { svg, shows });
    }

    fn add(&mut self, block: Block) {
        self.contents.blocks.push(block);
    }

    /// The document as one HTML file, without scripts and network.
    #[must_use]
    pub fn html(&self) -> String {
        page::html(&self.contents)
    }

    /// The document as PDF, without its pictures.
    ///
    /// # Errors
    /// [`ReportError::NoPdf`] in a build without PDF; [`ReportError::Pdf`] is a fault of this crate.
    pub fn pdf(&self) -> Result<Vec<u8>, ReportError> {
        #[cfg(feature = "pdf")]
        return crate::paper::typeset::pdf(&self.contents);
        #[cfg(not(feature = "pdf"))]
        Err(ReportError::NoPdf)
    }
}
