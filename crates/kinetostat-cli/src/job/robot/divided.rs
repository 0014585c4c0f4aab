//! A program divided into a main file and parts that it calls: read as one, and written back as its files.
//!
//! KRL and RAPID allow all routines in one file. The files are joined with a comment between them, so that the run goes along
//! one program; at these comments the written program is divided again.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{Language, SourceFile};
use kinetostat_program::COMPENSATED_MARK;

use crate::ui::failure::{Answer, Failing};

/// Marker line between the files of a joined program, in front of their numbers; it is no line of a header.
const MARK: &str = "kinetostat, next file of the program,";

/// The files of which a program was joined.
#[derive(Clone, Debug)]
pub(crate) struct Divided {
    /// Start of a comment.
    comment: &'static str,
    /// The word of the line below which they may stand.
    below: &'static [u8],
    files: Vec<SourceFile>,
}

impl Divided {
    /// Files of a program that are to be joined; none in a language that has one routine a file.
    pub(crate) fn of(language: Language, files: Vec<SourceFile>) -> Option<Self> {
        let below = language.header_below()?.as_bytes();
        language.files_are_joined().then(|| Self {
            comment: language.comment(),
            below,
            files,
        })
    }

    fn mark(&self, index: usize) -> String {
        format!(
            "{} {MARK} {} of {}",
            self.comment,
            index + 1,
            self.files.len()
        )
    }

    /// True if every file has routines of its own, and is no data for another one.
    pub(crate) fn are_programs(&self) -> bool {
        self.files.iter().all(|file| {
            let mut lines = file.bytes().split(|byte| *byte == b'\n');
            let is_data = file.name().to_ascii_lowercase().ends_with(".dat");
            !is_data && lines.any(|line| begins(line, self.below))
        })
    }

    /// Their names.
    pub(crate) fn names(&self) -> Vec<String> {
        let names = self.files.iter().map(|file| file.name().to_owned());
        names.collect()
    }

    /// The files in one, under the name of the first.
    pub(crate) fn joined(&self) -> Answer<SourceFile> {
        let mut bytes = Vec::new();
        for (index, file) in self.files.iter().enumerate() {
            if file
                .bytes()
                .windows(MARK.len())
                .any(|part| part == MARK.as_bytes())
            {
                return Err(ErrorCode::ProgramRefused.failure(format!(
                        "{}: the words '{MARK}' stand in it: they are for divided programs while they are read as one; take them out",
                        file.name()
                    ),
                ));
            }
            if index > 0 {
                bytes.extend_from_slice(self.mark(index).as_bytes());
                bytes.push(b'\n');
            }
            bytes.extend_from_slice(file.bytes());
            let is_last = index + 1 == self.files.len();
            if !is_last && !file.bytes().ends_with(b"\n") {
                bytes.push(b'\n');
            }
        }
        let name = self.files.first().map_or("", SourceFile::name);
        Ok(SourceFile::new(name, bytes))
    }

    /// File and line (from 1) of every line of the joined program.
    pub(crate) fn sources(&self) -> Vec<(u32, u32)> {
        let number = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
        let mut all = Vec::new();
        for (index, file) in self.files.iter().enumerate() {
            if index > 0 {
                all.push((number(index), 1));
            }
            let lines = 1..=line_count(file);
            all.extend(lines.map(|line| (number(index), number(line))));
        }
        all
    }

    /// The line of the joined program that is a line of the files counted through them.
    pub(crate) fn line_of(&self, through: usize) -> usize {
        let mut last = 0;
        let before = self.files.iter().take_while(|file| {
            last += line_count(file);
            last < through
        });
        through + before.count()
    }

    /// The files of a joined program that was written.
    pub(crate) fn split(&self, written: &[u8]) -> Answer<Vec<Vec<u8>>> {
        let mut files = vec![Vec::new()];
        for line in written.split_inclusive(|byte| *byte == b'\n') {
            let text = line.trim_ascii_end();
            let is_next = text.ends_with(self.mark(files.len()).as_bytes());
            match (is_next, files.last_mut()) {
                (false, Some(file)) => file.extend_from_slice(line),
                _ => files.push(Vec::new()),
            }
        }
        if files.len() != self.files.len() {
            return Err(ErrorCode::Internal.failure("the written program cannot be divided into its files again; nothing was written, please report this",
            ));
        }
        let is_marked = files[0]
            .windows(COMPENSATED_MARK.len())
            .any(|part| part == COMPENSATED_MARK.as_bytes());
        for (index, (file, own)) in files.iter_mut().zip(&self.files).enumerate() {
            let was_open = !own.bytes().ends_with(b"\n");
            if was_open && index + 1 < self.files.len() && file.ends_with(b"\n") {
                file.pop();
            }
            if is_marked && index > 0 && file != own.bytes() {
                self.mark_compensated(file);
            }
        }
        Ok(files)
    }

    /// A part that was compensated says so, as the main file does.
    fn mark_compensated(&self, file: &mut Vec<u8>) {
        let mut at = 0;
        for line in file.split_inclusive(|byte| *byte == b'\n') {
            at += line.len();
            if begins(line, self.below) && line.ends_with(b"\n") {
                let ending = match line.ends_with(b"\r\n") {
                    true => "\r\n",
                    false => "\n",
                };
                let mark = format!("{} {COMPENSATED_MARK}{ending}", self.comment);
                file.splice(at..at, mark.into_bytes());
                return;
            }
        }
    }
}

fn begins(line: &[u8], word: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    (line.get(..word.len())).is_some_and(|start| start.eq_ignore_ascii_case(word))
}

/// Lines of a file as it stands in a joined program.
fn line_count(file: &SourceFile) -> usize {
    file.bytes().split_inclusive(|byte| *byte == b'\n').count()
}
