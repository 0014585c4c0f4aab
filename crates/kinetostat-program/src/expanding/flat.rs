//! The flat program as it grows, and where the tool is after its last block.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::{ProgramError, excerpt};
use crate::expanding::{ExpandOptions, Origin, OriginComments, in_source_lines, of_source};
use crate::path::moves::{Path, Warning};
use crate::reading::faults::take_over_understood;
use crate::reading::interpreting::Interpreter;
use crate::reading::repeated::Repeated;
use crate::text::program::{Program, Reader};

/// Plain blocks, read and interpreted one by one.
pub(crate) struct Flat<'o> {
    reader: Reader,
    pub interpreter: Interpreter<'o>,
    origins: Vec<Origin>,
    /// Names of the files that blocks came from, by their index.
    files: BTreeMap<usize, String>,
    comments: OriginComments,
    /// Warnings in addition to those of the path.
    warnings: Vec<Warning>,
    /// Warnings given once for many lines.
    repeated: Repeated,
    options: &'o ExpandOptions,
    /// True if the position in the plane of arcs rested on a refused line when the last block came.
    was_unsure: bool,
}

impl<'o> Flat<'o> {
    /// A flat program whose lines end as the first one of the source does.
    pub fn of(source: &[u8], options: &'o ExpandOptions) -> Self {
        Self {
            reader: Reader::new(Vec::new()).with_ending_of(source),
            interpreter: Interpreter::new(&options.reading),
            origins: Vec::new(),
            files: BTreeMap::new(),
            comments: options.origin_comments,
            warnings: Vec::new(),
            repeated: Repeated::default(),
            options,
            was_unsure: false,
        }
    }

    /// A run of other blocks from where this one is, in its modes.
    pub fn following(&self) -> Self {
        Self {
            reader: Reader::new(Vec::new()),
            interpreter: self.interpreter.following(),
            origins: Vec::new(),
            files: BTreeMap::new(),
            comments: OriginComments::Left,
            warnings: Vec::new(),
            repeated: Repeated::default(),
            options: self.options,
            was_unsure: false,
        }
    }

    /// Adds a warning about the last block.
    pub fn warn(&mut self, text: &str) {
        self.warnings
            .push(Warning::new(self.origins.len(), text.to_owned()));
    }

    /// Adds a warning about a line that may hold for many.
    pub fn warn_of_lines(&mut self, line: usize, text: &str) {
        self.repeated.note(line, text);
    }

    /// A text about lines of the flat program, which nobody has seen yet: about those of the files that they came from.
    pub fn in_source_lines(&self, text: &str) -> String {
        in_source_lines(text, &self.origins, &self.files)
    }

    /// Tool point at machine zero, mm, if known.
    pub fn machine_zero_mm(&self) -> Option<Vector3<f64>> {
        self.options.reading.machine_zero_mm
    }

    /// True after the closing tape mark.
    pub fn is_closed(&self) -> bool {
        self.reader.is_closed()
    }

    /// True if there are blocks with words so far.
    pub fn has_words(&self) -> bool {
        self.reader.has_blocks()
    }

    /// Blocks so far.
    pub fn blocks(&self) -> usize {
        self.origins.len()
    }

    /// Blocks come from a file of this name.
    pub fn name_file(&mut self, file: usize, name: &str) {
        self.files.entry(file).or_insert_with(|| name.to_owned());
    }

    /// Adds a block that came from a line of a file; what is wrong with it is said of that line.
    pub fn add(&mut self, text: &[u8], origin: Origin) -> Result<(), ProgramError> {
        if self.is_full() {
            return Err(self.too_many(text, origin));
        }
        let commented = match self.comments {
            OriginComments::Written => {
                let file = self.files.get(&origin.file);
                commented(text, origin.line, file.map_or("", String::as_str))
            }
            OriginComments::Left => None,
        };
        self.was_unsure = self.is_unsure_in_plane();
        let bare = text.len();
        let text = commented.as_deref().unwrap_or(text);
        let file = self.files.get(&origin.file).map_or("", String::as_str);
        let of_source = |mut error: ProgramError| {
            // The comment with the line stands in no file of the user.
            if let Some(found) = error.found.strip_suffix(excerpt(&text[bare..]).as_str()) {
                error.found = found.trim_ascii_end().to_owned();
            }
            of_source(error, origin.line, file)
        };
        let read = self.reader.add_line(text);
        self.origins.push(origin);
        let index = self.origins.len() - 1;
        let done = read.and_then(|()| {
            let program = self.reader.program();
            self.interpreter.run_line(program, index)
        });
        done.map_err(|mut error| {
            error.reason = self.in_source_lines(&error.reason);
            of_source(error)
        })
    }

    /// True if no further block is allowed.
    pub fn is_full(&self) -> bool {
        self.origins.len() >= self.options.most_blocks
    }

    /// Takes over what is understood of a line that was refused, so that the lines behind it have no fault because of it.
    pub fn take_over(&mut self, text: &[u8], origin: Origin) {
        // The error of the line is reported already.
        let _ = self.reader.add_line(text);
        self.origins.push(origin);
        let program = self.reader.program();
        if let Some(index) = program.lines().len().checked_sub(1) {
            take_over_understood(&mut self.interpreter, program, index);
        }
    }

    /// Marks the tool position as unknown; it is not asked for.
    pub fn doubt_places(&mut self) {
        self.interpreter.places.doubt();
    }

    /// True if the position in the plane of arcs rested on a refused line when the last block came.
    pub fn came_from_nowhere(&self) -> bool {
        self.was_unsure
    }

    fn is_unsure_in_plane(&self) -> bool {
        let plane = self.interpreter.modes.plane;
        plane[..2]
            .iter()
            .any(|axis| self.interpreter.places.unsure[*axis])
    }

    fn too_many(&self, text: &[u8], origin: Origin) -> ProgramError {
        ProgramError {
            kind: crate::error::ProgramErrorKind::Malformed,
            line: origin.line,
            span: 0..0,
            found: excerpt(text),
            reason: format!(
                "the program has more than {} blocks when it is written flat",
                self.options.most_blocks
            ),
            remedy: "check the ends of its loops, or divide the program".to_owned(),
        }
    }

    pub fn finish(self) -> Result<(Program, Path, Vec<Origin>, Vec<Warning>), ProgramError> {
        let program = self.reader.into_program();
        let (origins, files) = (self.origins, self.files);
        let path = self.interpreter.finish(&program).map_err(|mut error| {
            error.reason = in_source_lines(&error.reason, &origins, &files);
            match origins.get(error.line.wrapping_sub(1)) {
                Some(origin) => {
                    let file = files.get(&origin.file).map_or("", String::as_str);
                    of_source(error, origin.line, file)
                }
                None => error,
            }
        })?;
        let mut warnings = self.warnings;
        warnings.extend(self.repeated.finish());
        Ok((program, path, origins, warnings))
    }
}

/// A block with its origin behind it; `None` for tape marks, numbers of programs and lines without a word.
fn commented(text: &[u8], line: usize, file: &str) -> Option<Vec<u8>> {
    let first = text.trim_ascii_start().first()?;
    let is_block = first.is_ascii_alphabetic() && !matches!(first, b'O' | b'o');
    if !is_block && *first != b'/' {
        return None;
    }
    let origin = match file {
        "" => format!(" (line {line})"),
        file => format!(" ({file}, line {line})"),
    };
    Some([text, origin.as_bytes()].concat())
}
