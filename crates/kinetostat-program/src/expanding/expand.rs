//! Runs a program once; to list all lines that are refused, behind these too.

use std::collections::BTreeMap;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::expanding::run::Runner;
use crate::expanding::run::source::Subprograms;
use crate::expanding::source::{Piece, Statement, Structure};
use crate::expanding::{ExpandOptions, Expanded};
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::library::only_definitions;

/// Runs a program once and writes it flat: subprograms, loops and branches as the blocks that they run, expressions as
/// numbers.
///
/// ```
/// use kinetostat_program::{ExpandOptions, NoSubprograms, expand};
///
/// let text = "G21 G90\n#1 = 2\nO1 while [#1 GT 0]\nG0 X[10 * #1] Y0 Z0\n#1 = [#1 - 1]\nO1 endwhile\nM2\n";
/// let flat = expand(text, &ExpandOptions::default(), &NoSubprograms)?;
/// assert_eq!(flat.program.bytes(), b"G21 G90\nG0 X20 Y0 Z0\nG0 X10 Y0 Z0\nM2\n");
/// assert_eq!(flat.origins[2].line, 4);
/// assert_eq!(flat.path.moves[1].end.x, 10.0);
/// # Ok::<(), kinetostat_program::ProgramError>(())
/// ```
///
/// Cutter radius compensation becomes the way of the tool's centre, by the rules of LinuxCNC: outside corners are rounded, inside
/// corners end where the tool touches both sides. The tool's diameter is one of [`ExpandOptions::tool_diameters_mm`], or stands
/// in the program (G41.1, G42.1). Neighbouring blocks are looked at, not a contour that meets itself further on.
///
/// ```
/// use kinetostat_program::{ExpandOptions, NoSubprograms, expand};
///
/// let mut options = ExpandOptions::default();
/// options.tool_diameters_mm.insert(3, 6.0);
/// let text = "G21 G90 F200\nG0 X0 Y-20 Z0\nG41 D3\nG1 X0 Y0\nY40\nX30\nG40\nG0 Z5\nM2\n";
/// let flat = expand(text, &options, &NoSubprograms)?;
/// let blocks = "G21 G90 F200\nG0 X0 Y-20 Z0\nG1 X-3 Y0\nG1 Y40\nG2 X0 Y43 I3 J0\nG1 X30\nG0 Y40 Z5\nM2\n";
/// assert_eq!(flat.program.bytes(), blocks.as_bytes());
/// # Ok::<(), kinetostat_program::ProgramError>(())
/// ```
///
/// # Errors
/// The first line that is not followed ([`expansion_faults`] lists them all), or that makes a block that [`crate::interpret`] refuses; a program that does not end; a contour that the tool cannot follow.
pub fn expand(
    bytes: impl Into<Vec<u8>>,
    options: &ExpandOptions,
    subprograms: &dyn Subprograms,
) -> Result<Expanded, ProgramError> {
    let bytes = bytes.into();
    if let Some(library) = only_definitions(&bytes) {
        return Err(library);
    }
    let options = options.of_dialect();
    let mut runner = Runner::new(bytes, &options, subprograms);
    runner.run()?;
    finished(runner)
}

/// Variant of [`expand`] that returns, from the same single run, everything that is refused, as [`expansion_faults`]
/// lists it.
///
/// ```
/// use kinetostat_program::{ExpandOptions, NoSubprograms, expand_or_faults};
///
/// let options = ExpandOptions::default();
/// let flat = expand_or_faults("G21 G90\nO1 repeat [2]\nG0 X1\nO1 endrepeat\n", &options, &NoSubprograms);
/// assert_eq!(flat.unwrap().program.bytes(), b"G21 G90\nG0 X1\nG0 X1\n");
/// let refused = expand_or_faults("G21 G90\nM98 P77\nG38.2 Z-10\n", &options, &NoSubprograms);
/// assert_eq!(refused.unwrap_err().len(), 2);
/// ```
///
/// # Errors
/// Everything that is refused, at least one fault.
pub fn expand_or_faults(
    bytes: impl Into<Vec<u8>>,
    options: &ExpandOptions,
    subprograms: &dyn Subprograms,
) -> Result<Expanded, Vec<ProgramError>> {
    let bytes = bytes.into();
    if let Some(library) = only_definitions(&bytes) {
        return Err(vec![library]);
    }
    let options = options.of_dialect();
    let mut runner = Runner::new(bytes, &options, subprograms);
    let found = runner.refused_lines();
    match found.is_empty() {
        true => finished(runner).map_err(|fault| vec![fault]),
        false => Err(found),
    }
}

/// Result of a completed run.
fn finished(runner: Runner<'_>) -> Result<Expanded, ProgramError> {
    let files = runner.sources.iter().map(|s| s.name.clone()).collect();
    let (program, path, origins, warnings) = runner.flat.finish()?;
    Ok(Expanded {
        program,
        path,
        origins,
        warnings,
        files,
    })
}

/// Everything that is refused while a program is run once, in the order of the lines, those of its subprograms behind those of
/// the program; empty where [`expand`] takes it.
///
/// The understood words of a refused line are followed: its end and its modes. A line on which the rest depends, such as the
/// condition of a loop, ends the list and says so.
///
/// ```
/// use kinetostat_program::{ExpandOptions, NoSubprograms, expansion_faults};
///
/// let text = "G21 G90\nG0 X0 Y0 Z0\nM98 P77\nG38.2 Z-10\nO1 if [1/0]\nG0 X1\nO1 endif\nM2\n";
/// let found = expansion_faults(text, &ExpandOptions::default(), &NoSubprograms);
/// assert_eq!(found.iter().map(|fault| fault.line).collect::<Vec<_>>(), [3, 4, 5]);
/// assert!(found[2].remedy.contains("lines behind this one were not run"));
/// ```
pub fn expansion_faults(
    bytes: impl Into<Vec<u8>>,
    options: &ExpandOptions,
    subprograms: &dyn Subprograms,
) -> Vec<ProgramError> {
    expand_or_faults(bytes, options, subprograms)
        .err()
        .unwrap_or_default()
}

/// End of the message of the last refused line.
const NOT_RUN: &str = " (the lines behind this one were not run: what they do depends on it)";

/// A program is run on behind lines that are refused, to list them all.
///
/// The understood words of a refused line are taken over: its end and its modes. A line on which the rest depends (branches, loops,
/// assignments, lines in other coordinates or with radius compensation) ends the list.
impl Runner<'_> {
    /// All lines that are refused, of the program and then of its subprograms, in the order of their lines.
    pub fn refused_lines(&mut self) -> Vec<ProgramError> {
        let mut found: BTreeMap<(usize, usize), ProgramError> = BTreeMap::new();
        loop {
            let steps = self.steps;
            let Err(mut fault) = self.run() else {
                break;
            };
            let at = (self.origin().file, fault.line);
            let goes_on = self.steps > steps && self.rest_is_independent();
            if !goes_on && self.is_more_behind() {
                fault.remedy.push_str(NOT_RUN);
            }
            if !goes_on || !self.is_arc_from_nowhere(&fault) {
                found.entry(at).or_insert(fault);
            }
            if !goes_on {
                break;
            }
            self.take_over_refused_line();
        }
        found.into_values().collect()
    }

    fn statement(&self) -> Option<&Statement> {
        let lines = &self.sources[self.frame().file].lines;
        lines.get(self.running()).map(|line| &line.statement)
    }

    fn running_text(&self) -> &[u8] {
        let source = &self.sources[self.frame().file];
        match source.lines.is_empty() {
            true => &[],
            false => source.text(self.running()),
        }
    }

    fn is_more_behind(&self) -> bool {
        let frame = self.frame();
        self.frames.len() > 1 || frame.next < self.sources[frame.file].lines.len()
    }

    /// True if the program can be run on after the line that was refused.
    fn rest_is_independent(&self) -> bool {
        let elsewhere =
            self.radius.refuses_cycles().is_some() || self.coordinates.interpreter().is_some();
        if elsewhere || self.flat.is_full() || self.has_run_too_long() {
            return false;
        }
        let file = self.frame().file;
        let line = self.running() + 1;
        let is_unread = self.sources[file].faults.iter().any(|f| f.line == line);
        match self.statement() {
            Some(Statement::Plain) if is_unread => !controls(self.running_text()),
            Some(Statement::Plain) => true,
            Some(Statement::Block(pieces)) => !pieces
                .iter()
                .any(|piece| matches!(piece, Piece::Assignment(..))),
            Some(Statement::Structure(_, Structure::Call(_))) => true,
            _ => false,
        }
    }

    /// Places behind a line whose end is not known prove nothing about an arc.
    fn is_arc_from_nowhere(&self, fault: &ProgramError) -> bool {
        fault.kind == ProgramErrorKind::Arc && self.flat.came_from_nowhere()
    }

    fn take_over_refused_line(&mut self) {
        let text = self.running_text();
        let (words, doubt) = match self.statement() {
            Some(Statement::Plain) => (text.to_vec(), calls(text)),
            Some(Statement::Block(pieces)) => {
                let plain = pieces.iter().filter_map(|piece| match piece {
                    Piece::Text(range) => text.get(range.clone()),
                    _ => None,
                });
                (plain.collect::<Vec<_>>().concat(), true)
            }
            _ => (Vec::new(), true),
        };
        let origin = self.origin();
        self.flat.take_over(&words, origin);
        if doubt {
            self.flat.doubt_places();
        }
    }
}

/// True if a line that could not be read decides which line comes next, or sets a parameter.
fn controls(text: &[u8]) -> bool {
    let text: Vec<u8> = text
        .iter()
        .filter(|byte| !byte.is_ascii_whitespace())
        .map(u8::to_ascii_uppercase)
        .collect();
    let bare = text.strip_prefix(b"/").unwrap_or(&text);
    let bare = match bare.strip_prefix(b"N") {
        Some(rest) => {
            let digits = rest.iter().take_while(|byte| byte.is_ascii_digit());
            &rest[digits.count()..]
        }
        None => bare,
    };
    let words: [&[u8]; 6] = [b"O", b"IF", b"WHILE", b"GOTO", b"END", b"DO"];
    text.contains(&b'=') || words.iter().any(|word| bare.starts_with(word))
}

/// True if a block calls a subprogram: the tool position after it is not known.
fn calls(text: &[u8]) -> bool {
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(text, &mut tokens);
    tokens.iter().any(|spanned| match spanned.token {
        Token::Word { letter, value, .. } => {
            (letter, value) == (b'M', 98.0) || (letter, value) == (b'G', 65.0)
        }
        _ => false,
    })
}
