//! Format of a list of poses: table or YAML.

use crate::text::source::{SourceFile, beginning};

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
