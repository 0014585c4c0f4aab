//! Facts and acts of a language: all that files outside its folder ask of it.

use crate::error::{ProgramError, WriteError};
use crate::file_form::FileForm;
use crate::model::parsed::Parsed;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::refused_run::RefusedRun;
use crate::table::StatementRow;
use crate::text::flat::FlatText;
use crate::text::source::SourceFile;
use crate::writing::piece::Piece;

/// A file of a program that a language writes: its name and its bytes.
pub type WrittenFile = (String, Vec<u8>);

/// A language of robots or machines. A method with a default has the answer that most languages give.
///
/// Code outside the folder of a language asks for what it needs to know here, and names no language.
pub trait ProgramLanguage: Sync {
    /// Its name as options write it, in small letters.
    fn word(&self) -> &'static str;

    /// Short name in sentences.
    fn name(&self) -> &'static str;

    /// Name in a list of languages.
    fn title(&self) -> &'static str;

    /// Endings of its files, in small letters, the usual one first.
    fn endings(&self) -> &'static [&'static str];

    /// Beginning of a comment that goes to the end of its line.
    fn comment(&self) -> &'static str;

    /// Each statement with what it is taken for.
    fn statements(&self) -> &'static [StatementRow];

    /// What its writer keeps and changes, in sentences.
    fn written(&self) -> &'static str;

    /// Reads all that can be read of the files of a program.
    fn parse(&self, files: Vec<SourceFile>, options: &ReadOptions) -> Parsed;

    /// Files of a program with pieces in place of its motions ([`crate::write()`]).
    ///
    /// # Errors
    /// A motion that cannot take its pieces, by file and line.
    fn write(
        &self,
        program: &RobotProgram,
        pieces: &[Piece],
        options: &WriteOptions,
    ) -> Result<Vec<WrittenFile>, WriteError>;

    /// Runs a program once and writes it flat ([`crate::expand`]); `None` where the reader follows what the language has.
    ///
    /// # Errors
    /// What the run refuses, with the text that it wrote all the same.
    fn expand(
        &self,
        _files: &[SourceFile],
        _options: &ReadOptions,
    ) -> Result<Option<FlatText>, RefusedRun> {
        Ok(None)
    }

    /// True for a file of a program that stays beside its flat text.
    fn stays_beside_flat(&self, _file: &SourceFile) -> bool {
        false
    }

    /// Names of files of programs that a file may call, as often as they stand there.
    fn called_files(&self, _file: &SourceFile) -> Vec<String> {
        Vec::new()
    }

    /// True where its reader knows lines that end with a carriage return alone.
    fn reads_all_line_ends(&self) -> bool {
        false
    }

    /// True where a rapid goes straight: robots move all joints in step.
    fn rapids_are_straight(&self) -> bool {
        false
    }

    /// Word in capitals that a file holds where its ending does not say enough; `None` where the ending says it.
    fn held_word(&self) -> Option<&'static str> {
        None
    }

    /// Words by which a file with another ending is known to be of this language, each with the ending that it is to have.
    fn own_words(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// True for the beginning of a file, in capitals, that has an ending of G-code and is of this language.
    fn is_beginning(&self, _beginning: &[u8]) -> bool {
        false
    }

    /// A file of it in sentences.
    fn file_title(&self) -> &'static str {
        self.name()
    }

    /// Endings that a written program may have, in small letters, the usual one first.
    fn written_endings(&self) -> &'static [&'static str] {
        self.endings()
    }

    /// Form of a file by its name and bytes, where the language has several.
    fn form(&self, _name: &str, _bytes: &[u8]) -> Option<FileForm> {
        None
    }

    /// What a line of the header of a corrected program begins with.
    fn header_opens(&self, _program: &[u8]) -> String {
        format!("{} ", self.comment())
    }

    /// What a line of the header ends with.
    fn header_closes(&self) -> &'static str {
        ""
    }

    /// Word in capitals of the line below which the header stands; `None`: the first line.
    fn header_below(&self) -> Option<&'static str> {
        None
    }

    /// Place of the header of a program, of which the place below its line is given.
    fn header_place(&self, _program: &[u8], below: usize) -> Option<usize> {
        Some(below)
    }

    /// True where the header is the mark of a corrected program alone, as lines are short.
    fn header_is_mark(&self) -> bool {
        false
    }

    /// Words of a line behind its number.
    fn behind_number<'l>(&self, line: &'l [u8]) -> &'l [u8] {
        line
    }

    /// A program to which lines were added, numbered again; `None` where its lines have no numbers.
    fn numbered_again(&self, _program: &[u8]) -> Option<Vec<u8>> {
        None
    }
}

/// Names of files with an ending for the names that a program calls.
pub(crate) fn with_ending(names: Vec<String>, ending: &str) -> Vec<String> {
    let all = names.into_iter();
    all.map(|name| format!("{name}.{ending}")).collect()
}

/// A run that stops at what it refuses, and writes nothing then.
pub(crate) fn of_run(
    flat: Result<FlatText, Vec<ProgramError>>,
) -> Result<Option<FlatText>, RefusedRun> {
    flat.map(Some).map_err(RefusedRun::from)
}
