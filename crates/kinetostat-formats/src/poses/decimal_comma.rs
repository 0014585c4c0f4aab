//! Tables with decimal commas, as spreadsheets in German or French write them: semicolons or tabs between cells.

use std::ops::Range;

use crate::poses::cells::{cells_of, number_of, separator_of};
use crate::poses::csv::lines_of;
use crate::text::source::{SourceFile, beginning};

/// The table with points in place of its decimal commas, byte for byte in the same places; none where it has no such commas, or points
/// too.
pub(crate) fn with_points(file: &SourceFile) -> Option<SourceFile> {
    let mut commas = Vec::new();
    for cell in cells(file) {
        let mut text = file.part(&cell).to_vec();
        let Some(mark) = text.iter().position(|byte| matches!(byte, b',' | b'.')) else {
            continue;
        };
        let is_comma = std::mem::replace(&mut text[mark], b'.') == b',';
        match (number_of(&text, &(0..text.len())), is_comma) {
            (Some(_), true) => commas.push(cell.start + mark),
            // The decimal point could precede thousandths or group thousands.
            (Some(_), false) => return None,
            (None, _) => {}
        }
    }
    (!commas.is_empty()).then(|| {
        let mut points = file.bytes().to_vec();
        for at in commas {
            points[at] = b'.';
        }
        SourceFile::new(file.name(), points)
    })
}

/// A written table with commas in place of the points of its numbers.
pub(crate) fn with_commas(name: &str, bytes: Vec<u8>) -> Vec<u8> {
    let file = SourceFile::new(name, bytes);
    let mut commas = file.bytes().to_vec();
    for cell in cells(&file).filter(|cell| number_of(file.bytes(), cell).is_some()) {
        if let Some(point) = cell.clone().find(|at| commas[*at] == b'.') {
            commas[point] = b',';
        }
    }
    commas
}

/// The cells below the line of names of a table between whose cells no commas stand.
fn cells(file: &SourceFile) -> impl Iterator<Item = Range<usize>> {
    let bytes = file.bytes();
    let mut lines = lines_of(bytes, beginning(bytes));
    let head = lines.next().filter(|_| Carrier::of(file) == Carrier::Table);
    let separator = head.map_or(b',', |head| separator_of(file.part(&head)));
    lines
        .take_while(move |_| separator != b',')
        .flat_map(move |line| cells_of(bytes, line, separator).unwrap_or_default())
}

/// Format of a list of poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Carrier {
    /// Lines of cells below a line of names.
    Table,
    /// YAML.
    Yaml,
}
impl Carrier {
    /// Format by the file ending; if that is unknown, by the first line that is neither empty nor a comment.
    pub(crate) fn of(file: &SourceFile) -> Self {
        let ending = file.name().rsplit_once('.').map(|(_, ending)| ending);
        match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("csv" | "tsv" | "parquet") => return Self::Table,
            Some("yaml" | "yml") => return Self::Yaml,
            _ => {}
        }
        let text = &file.bytes()[beginning(file.bytes())..];
        let line = text
            .split(|byte| *byte == b'\n')
            .map(<[u8]>::trim_ascii)
            .find(|line| !line.is_empty() && !line.starts_with(b"#"));
        let is_yaml = |line: &[u8]| {
            line.starts_with(b"- ")
                || line == b"-"
                || line.starts_with(b"---")
                || line.starts_with(b"%YAML")
                || line.starts_with(b"{")
                || line.starts_with(b"[")
                || line.ends_with(b":")
                || line.windows(2).any(|pair| pair == b": ")
        };
        match line.is_some_and(is_yaml) {
            true => Self::Yaml,
            false => Self::Table,
        }
    }
}
