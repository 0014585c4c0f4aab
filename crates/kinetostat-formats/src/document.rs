//! Reading and writing by language, and comments in a flat program with the lines that its blocks are from.

use std::collections::BTreeSet;

use crate::error::{ProgramError, WriteError};
use crate::model::Language;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::text::source::{FlatText, SourceFile};
use crate::writing::piece::Piece;

/// Reads the files of a program together.
///
/// ```
/// use kinetostat_formats::{Language, ReadOptions, SourceFile, read};
///
/// let text = "MODULE M\nPROC main()\n MoveL p10, v100, fine, tool0;\nENDPROC\nENDMODULE\n";
/// let files = vec![SourceFile::new("m.mod", text)];
/// let errors = read(Language::Rapid, files, &ReadOptions::default()).unwrap_err();
/// assert_eq!(errors[0].line, 3);
/// assert!(errors[0].to_string().contains("no `p10` is declared"));
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read(
    language: Language,
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    ended_by_line_feeds(language, &files)?;
    language.parse(files, options).without_faults()
}

/// Runs a program once and writes it flat, where its language has loops, jumps and calls that are followed so; `None` where the reader
/// follows what its language has.
///
/// ```
/// use kinetostat_formats::{Language, ReadOptions, SourceFile, expand};
///
/// let text = "BEGIN PGM A MM\nFN 0: Q1 = +5\nL X+Q1 F200\nEND PGM A MM\n";
/// let files = vec![SourceFile::new("a.h", text)];
/// let flat = expand(Language::Heidenhain, files, &ReadOptions::default()).unwrap().unwrap();
/// assert_eq!(flat.file.bytes(), b"BEGIN PGM A MM\nL X+5 F200\nEND PGM A MM\n");
/// ```
///
/// # Errors
/// All that is refused by the run, and by the reader of what it wrote behind refused lines, in the order of files and lines.
pub fn expand(
    language: Language,
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<Option<FlatText>, Vec<ProgramError>> {
    ended_by_line_feeds(language, &files)?;
    language.expand(&files, options).map_err(|refused| {
        refused.with_reading(&files, |flat| {
            read(language, vec![flat], options)
                .err()
                .unwrap_or_default()
        })
    })
}

/// True for a file of a program that stays beside its flat text: a data list of KRL.
///
/// ```
/// use kinetostat_formats::{Language, SourceFile, stays_beside_flat};
///
/// let data = SourceFile::new("part.dat", "DEFDAT part\nENDDAT\n");
/// assert!(stays_beside_flat(Language::Krl, &data));
/// assert!(!stays_beside_flat(Language::Krl, &SourceFile::new("part.src", "DEF part()\nEND\n")));
/// ```
#[must_use]
pub fn stays_beside_flat(language: Language, file: &SourceFile) -> bool {
    language.stays_beside_flat(file)
}

/// A file whose lines end with a carriage return alone would be one line: refused, as no controller reads it.
fn ended_by_line_feeds(language: Language, files: &[SourceFile]) -> Result<(), Vec<ProgramError>> {
    if language.reads_all_line_ends() {
        return Ok(());
    }
    let is_one_line = |file: &&SourceFile| {
        let bytes = file.bytes().trim_ascii_end();
        bytes.contains(&b'\r') && !bytes.contains(&b'\n')
    };
    let faults: Vec<ProgramError> = (files.iter().filter(is_one_line))
        .map(|file| {
            let first = file.bytes().iter().position(|byte| *byte == b'\r');
            ProgramError::at(
                file,
                0..first.unwrap_or_default(),
                "the lines of the file end with a carriage return alone",
                "save it with line feeds (LF or CR LF), as controllers do",
            )
        })
        .collect();
    match faults.is_empty() {
        true => Ok(()),
        false => Err(faults),
    }
}

/// Files of other programs that a program may call, by the names under which controls keep them, each once; of languages whose
/// programs are run once and written flat ([`expand`]).
///
/// ```
/// use kinetostat_formats::{Language, SourceFile, called_files};
///
/// let main = SourceFile::new("MAIN.MPF", "G0 Z10\nHOLE(5)\nL20\nHOLE(7)\nM30\n");
/// assert_eq!(called_files(Language::Siemens, &main), ["HOLE.SPF", "L20.SPF"]);
/// let main = SourceFile::new("A.H", "0 BEGIN PGM A MM\n1 CALL PGM TNC:\\parts\\B.H\n2 END PGM A MM\n");
/// assert_eq!(called_files(Language::Heidenhain, &main), ["B.H"]);
/// ```
#[must_use]
pub fn called_files(language: Language, file: &SourceFile) -> Vec<String> {
    let mut known = BTreeSet::new();
    let mut names = language.called_files(file);
    names.retain(|name| known.insert(name.clone()));
    names
}

/// The files of a program with pieces in place of its motions: names and bytes, in the order of the files.
///
/// What no piece is of comes back byte for byte. Numbers keep their decimals, or get those of the options where they change;
/// quaternions keep the sign of the text. A declaration that several motions use is edited where they agree in the last
/// digit, and copied under a free name where they do not. The pieces before the last are written as straight motions, or as
/// circles where they have a place in between and the language has circles through places, before the statement, with its speed,
/// tool and work object; other pieces of circles become straight.
///
/// ```
/// use kinetostat_formats::{Piece, ReadOptions, SourceFile, WriteOptions, read_rapid, write};
/// use nalgebra::Vector3;
///
/// let text = "MODULE M\nPROC main()\n\
///     MoveL [[100.0,0,5],[0,0,-1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0; ! groove\n\
///     ENDPROC\nENDMODULE\n";
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
/// let options = WriteOptions::default();
/// assert_eq!(write(&program, &[], &options).unwrap()[0].1, text.as_bytes());
///
/// let pieces = [Piece::to(0, Vector3::new(100.0123, 0.0, 4.98))];
/// let written = write(&program, &pieces, &options).unwrap();
/// let line = "MoveL [[100.012,0,4.980],[0,0,-1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0; ! groove";
/// assert_eq!(written[0].1, text.replace(text.lines().nth(2).unwrap(), line).into_bytes());
/// ```
///
/// # Errors
/// A motion that cannot take its pieces, by file and line; nothing is written then.
pub fn write(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    program.language.write(program, pieces, options)
}

/// Longest line that a comment is added to, bytes.
const LONGEST: usize = 120;

impl FlatText {
    /// Adds the source line of every block as a comment, as in `;line 12` or `;drill.spf, line 3`.
    /// Lines without a block stay, and so do long ones, those that the next line goes on with, and blocks of Heidenhain that are
    /// a comment or begin and end the program.
    ///
    /// ```
    /// use kinetostat_formats::{Language, SourceFile, expand_siemens};
    ///
    /// let file = SourceFile::new("a.mpf", "G90\n;begins\nG1 X5 F200\nM30\n");
    /// let flat = expand_siemens(&[file]).unwrap();
    /// let said = flat.with_origins(Language::Siemens, &["a.mpf".to_owned()]);
    /// assert_eq!(said.file.bytes(), b"G90 ;line 1\n;begins\nG1 X5 F200 ;line 3\nM30 ;line 4\n");
    /// ```
    #[must_use]
    pub fn with_origins(&self, language: Language, names: &[String]) -> Self {
        let mut bytes = Vec::with_capacity(2 * self.file.bytes().len());
        let lines = self.file.bytes().split_inclusive(|byte| *byte == b'\n');
        for (index, line) in lines.enumerate() {
            let text = line.trim_ascii_end();
            let end = &line[text.len()..];
            bytes.extend_from_slice(text);
            let origin = self.origins.get(index);
            if let Some((file, from)) = origin.filter(|_| is_block(language, text)) {
                let named = names.get(*file).filter(|_| *file > 0);
                let named = named.map_or_else(String::new, |name| format!("{name}, "));
                bytes.extend_from_slice(format!(" ;{named}line {from}").as_bytes());
            }
            bytes.extend_from_slice(end);
        }
        Self {
            file: SourceFile::new(self.file.name(), bytes),
            ..self.clone()
        }
    }
}

/// True if a line is a block that a comment may follow.
fn is_block(language: Language, text: &[u8]) -> bool {
    let text = text.trim_ascii_start();
    language.takes_origin(text) && text.len() <= LONGEST && !text.contains(&b';')
}
