//! Problems in a model file: where, what, and what to do, shown with the line they are in.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

/// A step on the path from the root of a document to a value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PathStep {
    /// Shared: paths are made for every number of a model, thousands of times, and read where there is a finding.
    Key(Arc<str>),
    Index(usize),
}

/// The path from the root of a document to a value; resolved to a line only where a message needs it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct KeyPath(pub(crate) Vec<PathStep>);

impl KeyPath {
    pub(crate) fn root() -> Self {
        Self::default()
    }

    pub(crate) fn key(&self, key: &str) -> Self {
        self.then(PathStep::Key(key.into()))
    }

    pub(crate) fn index(&self, index: usize) -> Self {
        self.then(PathStep::Index(index))
    }

    fn then(&self, step: PathStep) -> Self {
        let mut steps = Vec::with_capacity(self.0.len() + 1);
        steps.extend_from_slice(&self.0);
        steps.push(step);
        Self(steps)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                PathStep::Key(key) if i == 0 => write!(f, "{key}")?,
                PathStep::Key(key) => write!(f, ".{key}")?,
                PathStep::Index(index) => write!(f, "[{}]", index + 1)?,
            }
        }
        Ok(())
    }
}

/// A finding before its line is known.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub(crate) place: KeyPath,
    /// Overrides the place where the exact span is known (a key, a syntax error).
    pub(crate) span: Option<Range<usize>>,
    pub(crate) message: String,
    pub(crate) help: String,
    /// Replacement with which the file can be read on.
    pub(crate) remedy: Box<Remedy>,
}

/// Replacement of a faulty part, so that further mistakes are found in the same run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Remedy {
    /// A key that the table at the place should have.
    pub(crate) missing: Option<String>,
    /// A value of the right form, as TOML; none where there is no simple one.
    pub(crate) stand_in: Option<String>,
}

impl Finding {
    pub(crate) fn new(
        place: &KeyPath,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            place: place.clone(),
            span: None,
            message: message.into(),
            help: help.into(),
            remedy: Box::default(),
        }
    }

    pub(crate) fn at(mut self, span: Range<usize>) -> Self {
        self.span = Some(span);
        self
    }
}

/// Severity of a [`Problem`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Severity {
    /// The model cannot be used.
    Error,
    /// The model can be used, but something looks wrong.
    Warning,
}

/// One finding in a model file, with its line.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Error or warning.
    pub severity: Severity,
    /// Description of the mistake.
    pub message: String,
    /// Remedy; may be empty.
    pub help: String,
    /// File as it was named.
    pub file: String,
    /// Line, from 1; `None` where the file could not be read.
    pub line: Option<usize>,
    /// Column in characters, from 1.
    pub column: Option<usize>,
    /// Path to the value: `chain.leg.elements[3].length_mm` (counted from 1).
    pub path: String,
    plain: String,
    styled: String,
}

/// Style of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextStyle {
    /// Characters only.
    Plain,
    /// Text with the colours of a terminal.
    Terminal,
}

impl Problem {
    /// The message with the line it refers to.
    #[must_use]
    pub fn rendered(&self, style: TextStyle) -> &str {
        match style {
            TextStyle::Plain => &self.plain,
            TextStyle::Terminal => &self.styled,
        }
    }

    /// A problem that another reader found in `text`, at the bytes of `span`; `path` is its path to
    /// the value in words.
    #[must_use]
    pub fn found(
        severity: Severity,
        file: &str,
        text: &str,
        span: Range<usize>,
        path: &str,
        [message, help]: [String; 2],
    ) -> Self {
        let finding = Finding::new(&KeyPath::root(), message, help);
        let mut problem = Self::in_text(severity, file, text, span, &finding);
        problem.path = shortened(path);
        problem
    }

    /// A problem with a file that could not be read as text.
    #[must_use]
    pub fn without_text(file: &str, message: String, help: String) -> Self {
        let mut problem = Self::bare(Severity::Error, file, message, help, String::new());
        problem.render(None);
        problem
    }

    pub(crate) fn in_text(
        severity: Severity,
        file: &str,
        text: &str,
        span: Range<usize>,
        finding: &Finding,
    ) -> Self {
        let mut problem = Self::bare(
            severity,
            file,
            finding.message.clone(),
            finding.help.clone(),
            finding.place.to_string(),
        );
        let excerpt = Excerpt::new(text, span);
        problem.line = Some(excerpt.line);
        problem.column = Some(excerpt.column);
        problem.render(Some(&excerpt));
        problem
    }

    fn bare(severity: Severity, file: &str, message: String, help: String, path: String) -> Self {
        Self {
            severity,
            message: shortened(&message),
            help: shortened(&help),
            file: file.to_owned(),
            line: None,
            column: None,
            path: shortened(&path),
            plain: String::new(),
            styled: String::new(),
        }
    }

    fn render(&mut self, excerpt: Option<&Excerpt>) {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level.primary_title(visible(&self.message));
        let origin = Origin::path(visible(&self.file));
        let mut group: Group<'_> = match excerpt {
            Some(e) => {
                let snippet = Snippet::source(e.text.as_str())
                    .line_start(e.line)
                    .annotation(AnnotationKind::Primary.span(e.span.clone()));
                // The column of a line that was cut cannot be counted from the excerpt.
                if e.cut {
                    title
                        .element(origin.line(e.line).char_column(e.column))
                        .element(snippet)
                } else {
                    title.element(snippet.path(visible(&self.file)))
                }
            }
            None => title.element(origin),
        };
        if !self.help.is_empty() {
            group = group.element(Level::HELP.message(visible(&self.help)));
        }
        let report = [group];
        self.plain = Renderer::plain().render(&report);
        self.styled = Renderer::styled().render(&report);
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.plain)
    }
}

/// Text from a file, made safe for a terminal and short enough for it.
fn visible(text: &str) -> String {
    shortened(text)
        .chars()
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect()
}

/// Longest word that a message shows whole, characters.
const LONGEST_WORD: usize = 200;
/// Longest message that is shown whole, characters.
const LONGEST_MESSAGE: usize = 4000;

/// A message that may hold text from a file (a key of megabytes): words and the whole are cut in
/// their middle where no reader would want them, so that what is said around them stays.
///
/// ```
/// let key = "x".repeat(10_000_000);
/// let message = kinetostat_model::shortened(&format!("unknown key '{key}'; did you mean 'x'?"));
/// assert!(message.starts_with("unknown key 'xxx") && message.ends_with("did you mean 'x'?"));
/// assert!(message.len() < 400);
/// assert_eq!(kinetostat_model::shortened("plain words\nstay"), "plain words\nstay");
/// ```
#[must_use]
pub fn shortened(text: &str) -> String {
    let words = text.split_inclusive(char::is_whitespace);
    let cut = words.map(|word| middle_cut(word, LONGEST_WORD, 60));
    middle_cut(
        &cut.collect::<String>(),
        LONGEST_MESSAGE,
        LONGEST_MESSAGE / 3,
    )
}

/// Text of more than `most` characters as its first and last `side` ones.
fn middle_cut(text: &str, most: usize, side: usize) -> String {
    // Few characters are few bytes: most texts need not be counted.
    if text.len() <= most || text.chars().count() <= most {
        return text.to_owned();
    }
    let first: String = text.chars().take(side).collect();
    let last: Vec<char> = text.chars().rev().take(side).collect();
    let last: String = last.into_iter().rev().collect();
    let left_out = text.chars().count() - 2 * side;
    format!("{first}… ({left_out} characters are left out) …{last}")
}

/// The line a span begins in. A line that is too long for a screen is cut around the span.
struct Excerpt {
    line: usize,
    column: usize,
    text: String,
    span: Range<usize>,
    cut: bool,
}

impl Excerpt {
    const SIDE: usize = 60;

    fn new(text: &str, span: Range<usize>) -> Self {
        let start = floor_boundary(text, span.start.min(text.len()));
        // A finding at the very end is shown at the last line that holds anything.
        let start = if text[start..].trim().is_empty() {
            floor_boundary(text, text.trim_end().len().saturating_sub(1)).min(start)
        } else {
            start
        };
        let end = floor_boundary(text, span.end.clamp(start, text.len()));
        let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let content = text[line_start..line_end].trim_end_matches('\r');
        let line = text[..start].matches('\n').count() + 1;
        let column = text[line_start..start].chars().count() + 1;
        let first = (start - line_start).min(content.len());
        let last = (end.min(line_end) - line_start).clamp(first, content.len());
        let (text, span) = Self::window(content, first..last);
        Self {
            line,
            column,
            cut: text.chars().count() != content.chars().count(),
            text,
            span,
        }
    }

    fn window(content: &str, span: Range<usize>) -> (String, Range<usize>) {
        let before: Vec<char> = content[..span.start].chars().collect();
        let inside: Vec<char> = content[span.clone()].chars().collect();
        let after: Vec<char> = content[span.end..].chars().collect();
        let show = |chars: &[char]| visible(&chars.iter().collect::<String>());
        let mut text = String::new();
        if before.len() > 2 * Self::SIDE {
            text.push('…');
            text.push_str(&show(&before[before.len() - Self::SIDE..]));
        } else {
            text.push_str(&show(&before));
        }
        let first = text.len();
        if inside.len() > 2 * Self::SIDE {
            text.push_str(&show(&inside[..Self::SIDE]));
            text.push('…');
            return (text.clone(), first..text.len());
        }
        text.push_str(&show(&inside));
        let last = text.len();
        if after.len() > 2 * Self::SIDE {
            text.push_str(&show(&after[..Self::SIDE]));
            text.push('…');
        } else {
            text.push_str(&show(&after));
        }
        (text, first..last)
    }
}

fn floor_boundary(text: &str, index: usize) -> usize {
    (0..=index)
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}

/// Error of a model file: one or more problems, each with its line.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelError {
    problems: Vec<Problem>,
}

impl ModelError {
    /// Maximum number of problems that are shown; more are counted.
    const SHOWN: usize = 100;

    /// Creates the error for readers of other formats that lead to a model.
    #[must_use]
    pub fn new(problems: Vec<Problem>) -> Self {
        Self { problems }
    }

    /// Every problem, in the order of the file.
    #[must_use]
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// The messages with the lines they refer to.
    #[must_use]
    pub fn rendered(&self, style: TextStyle) -> String {
        let mut text = self
            .problems
            .iter()
            .take(Self::SHOWN)
            .map(|p| p.rendered(style))
            .collect::<Vec<_>>()
            .join("\n\n");
        if self.problems.len() > Self::SHOWN {
            text.push_str(&format!(
                "\n\nand {} more problems",
                self.problems.len() - Self::SHOWN
            ));
        }
        text
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.rendered(TextStyle::Plain))
    }
}

impl std::error::Error for ModelError {}
