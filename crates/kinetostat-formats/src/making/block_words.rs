//! The words of blocks, one by one, as the readers of SINUMERIK and Heidenhain divide them.

use crate::heidenhain::blocks::blocks_of;
use crate::model::language::Language;
use crate::model::program::RobotProgram;
use crate::siemens::block::{Block, What};
use crate::siemens::expression::Expression;
use crate::siemens::table::row;
use crate::table::Treatment;
use crate::text::source::SourceFile;

/// A word of a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BlockWord {
    /// Letters of the word in capitals; `/` for a block that a switch of the control skips.
    pub name: String,
    /// All of it in capitals, without blanks, and without zeros that say nothing: `M3`, `ADIS=0.5`, `CYCLE832(0.5,1)`.
    pub text: String,
    /// It is in the path, the frames, feeds or speeds that are read from the blocks.
    pub is_in_path: bool,
}

/// Gives the words of every block with its line; of languages without blocks there are none.
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, each_block, read_siemens};
///
/// let text = "N10 G0 X0 Y0 Z5 M03 ; start\nG642 ADIS = 0.50\n";
/// let program = read_siemens(vec![SourceFile::new("a.mpf", text)], &ReadOptions::default()).unwrap();
/// let mut said = Vec::new();
/// each_block(&program, |line, words| said.extend(words.iter().map(|word| (line, word.text.clone()))));
/// assert_eq!(said[4], (1, "M3".to_owned()));
/// assert_eq!(said[6], (2, "ADIS=0.5".to_owned()));
/// ```
pub fn each_block(program: &RobotProgram, mut say: impl FnMut(usize, &[BlockWord])) {
    let file = program.motions.first().map_or(0, |motion| motion.file);
    let Some(source) = program.files.get(file) else {
        return;
    };
    match program.language {
        Language::Siemens => {
            for line in 1..=source.line_count() {
                say(line, &words_of_siemens(source, line));
            }
        }
        Language::Heidenhain => {
            for block in blocks_of(source.bytes()) {
                let words = block.words(source.bytes());
                let words = words.iter().map(|word| {
                    let name = capitals(word.letters.letters());
                    let text = match word.value() {
                        Some(value) => format!("{name}{value}"),
                        None => capitals(source.part(&word.span)),
                    };
                    BlockWord {
                        name,
                        text,
                        is_in_path: false,
                    }
                });
                let words: Vec<BlockWord> = slash(block.skipped).chain(words).collect();
                say(source.line_of(block.text.start), &words);
            }
        }
        _ => {}
    }
}

/// The words of a line; none of one that cannot be read.
fn words_of_siemens(source: &SourceFile, line: usize) -> Vec<BlockWord> {
    let Ok((block, _)) = Block::of(source.bytes(), source.range_of(line)) else {
        return Vec::new();
    };
    let words = block.items.iter().map(|item| {
        let name = capitals(source.part(&item.name));
        let text = match &item.what {
            What::Value {
                value: Expression::Number(number),
                indices,
                set,
                ..
            } if indices.is_empty() => {
                format!("{name}{}{number}", if *set { "=" } else { "" })
            }
            _ => capitals(source.part(&item.span)),
        };
        // Of `S2=1000`, `R1=5`, `G505` the table has no rows.
        let has_no_row = || name.starts_with(['S', 'R', 'G']) && is_numbered(&name);
        let is_in_path = row(&name)
            .or_else(|| row(&text))
            .map_or_else(has_no_row, |row| {
                row.treatment == Treatment::Understood || matches!(row.name, "N" | "S")
            });
        BlockWord {
            name,
            text,
            is_in_path,
        }
    });
    slash(block.skip).chain(words).collect()
}

fn slash(stands: bool) -> impl Iterator<Item = BlockWord> {
    let word = || BlockWord {
        name: "/".to_owned(),
        text: "/".to_owned(),
        is_in_path: true,
    };
    stands.then(word).into_iter()
}

fn capitals(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes).to_uppercase();
    text.split_whitespace().collect()
}

/// True for one letter with digits behind it, if any.
fn is_numbered(name: &str) -> bool {
    name.chars().skip(1).all(|c| c.is_ascii_digit())
}
