//! Words with more than one meaning while a program runs: G10 and G52 are written as words that mean one thing, numbers without a
//! point are warned of.
//!
//! `G10 L20` becomes `G10 L2` with the machine coordinates that it means, P0 the number of the system in force; G52 becomes the
//! G92 that sets the same offset (LinuxCNC, where G52 is the offset of G92; `docs/linuxcnc.md`, section 6).

use crate::error::ProgramError;
use crate::expanding::Dialect;
use crate::expanding::run::Runner;
use crate::expanding::translate::G_WITHOUT_WORDS;
use crate::expanding::translate::cycle::is_cycle;
use crate::number::number;
use crate::reading::options::Units;
use crate::text::lex::{Spanned, Token, tokens_of};

const AXES: [u8; 3] = *b"XYZ";

/// The words of a block by letter.
struct Words(Vec<(u8, f64)>);

impl Words {
    fn of(text: &[u8]) -> Self {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let words = tokens
            .into_iter()
            .filter_map(|spanned| match spanned.token {
                Token::Word { letter, value, .. } => Some((letter, value)),
                _ => None,
            });
        Self(words.collect())
    }

    fn has(&self, letter: u8, value: f64) -> bool {
        self.0.contains(&(letter, value))
    }

    fn value(&self, letter: u8) -> Option<f64> {
        let mut own = self.0.iter().filter(|(own, _)| *own == letter);
        own.next().map(|(_, value)| *value)
    }

    /// True if the block has only a code and some letters.
    fn only(&self, code: f64, letters: &[u8]) -> bool {
        self.0.iter().all(|(letter, value)| match letter {
            b'G' => *value == code,
            b'N' => true,
            letter => letters.contains(letter),
        })
    }
}

impl Runner<'_> {
    /// Modes beside G52 (and G15, which ends polar coordinates), which hold before it; then G52 with its axes.
    pub fn beside_shift(&self, text: &[u8]) -> Option<[Vec<u8>; 2]> {
        if !text.windows(2).any(|two| two == b"52") {
            return None;
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let [mut modes, mut shift] = [Vec::new(), Vec::new()];
        let (mut shifts, mut is_there) = (false, false);
        for one in &tokens {
            let to = match one.token {
                Token::Word {
                    letter: b'G',
                    value,
                    ..
                } if value != 52.0 => {
                    let is_polar = value == 15.0 && self.options.dialect != Dialect::LinuxCnc;
                    if !is_polar && !G_WITHOUT_WORDS.contains(&value) {
                        return None;
                    }
                    is_there = true;
                    &mut modes
                }
                Token::Word { letter: b'G', .. } => {
                    shifts = true;
                    &mut shift
                }
                Token::Other(_) => return None,
                _ => &mut shift,
            };
            to.extend_from_slice(&text[one.span.clone()]);
        }
        (shifts && is_there).then_some([modes, shift])
    }

    /// The blocks in the place of one with G10 or G52; `None` if the block is another, or may stand as it is.
    pub fn offsets(&mut self, text: &[u8]) -> Result<Option<Vec<String>>, ProgramError> {
        if !text.contains(&b'1') && !text.contains(&b'5') {
            return Ok(None);
        }
        let words = Words::of(text);
        let is_g10 = words.has(b'G', 10.0);
        if !is_g10 && !words.has(b'G', 52.0) {
            return Ok(None);
        }
        if self.radius.refuses_cycles().is_some() {
            return Err(self.refuse(
                "offsets are changed while cutter radius compensation is on, or before the first move behind G40",
                "write G40 and a move before it",
            ));
        }
        match is_g10 {
            true => self.data(&words),
            false => self.local(&words),
        }
    }

    /// G10.
    fn data(&mut self, words: &Words) -> Result<Option<Vec<String>>, ProgramError> {
        let list = words.value(b'L');
        if matches!(list, Some(1.0 | 10.0 | 11.0)) {
            self.tool_radius(words);
            return Ok(None);
        }
        if !matches!(list, Some(2.0 | 20.0)) {
            return Ok(None);
        }
        if !words.only(10.0, b"LPRXYZABC") {
            return Err(self.refuse(
                "G10 and other words are in one block",
                "write them in two blocks; only the origins of X, Y, Z, A, B and C are followed",
            ));
        }
        self.refuse_rotary_place(words, list)?;
        let state = self.state();
        let active = 1 + state.work_system();
        let system = match words.value(b'P') {
            Some(0.0) if self.options.dialect == Dialect::LinuxCnc => active,
            Some(0.0) => {
                return Err(self.refuse(
                    "G10 P0 means the system in force to LinuxCNC, and an offset of all systems to Fanuc",
                    "write P1 for G54 to P9 for G59.3, or name the dialect (--dialect linuxcnc)",
                ));
            }
            Some(p) if p.fract() == 0.0 && (1.0..=9.0).contains(&p) => p as usize,
            _ => {
                return Err(self.refuse(
                    "G10 names no system (P)",
                    "write P1 for G54 to P9 for G59.3",
                ));
            }
        };
        let incremental = state.is_incremental();
        if incremental && self.options.dialect != Dialect::LinuxCnc {
            return Err(self.refuse(
                "G10 L2 with G91 states the origin to LinuxCNC, and adds to it on Fanuc",
                "write G90 before it, or name the dialect (--dialect linuxcnc)",
            ));
        }
        let mut made = format!("G10 L2 P{system}");
        for (axis, letter) in AXES.into_iter().enumerate() {
            let Some(word) = words.value(letter) else {
                continue;
            };
            let value = match list {
                Some(20.0) => self.origin_for(axis, word)?,
                _ => word,
            };
            made.push_str(&format!(" {}{}", char::from(letter), number(value)));
        }
        for letter in *b"ABC" {
            if let Some(word) = words.value(letter) {
                made.push_str(&format!(" {}{}", char::from(letter), number(word)));
            }
        }
        if let Some(turned) = words.value(b'R') {
            made.push_str(&format!(" R{}", number(turned)));
        }
        Ok(Some(match incremental {
            true => vec!["G90".to_owned(), made, "G91".to_owned()],
            false => vec![made],
        }))
    }

    /// L20 makes the place of an axis the reference.
    fn refuse_rotary_place(&self, words: &Words, list: Option<f64>) -> Result<(), ProgramError> {
        let mut rotary = b"ABC"
            .iter()
            .filter(|letter| words.value(**letter).is_some());
        match (list, rotary.next()) {
            (Some(20.0), Some(letter)) => Err(self.refuse(
                &format!(
                    "G10 L20 with {}: where the machine's zero of a rotary axis is, is not known here",
                    char::from(*letter)
                ),
                "write G10 L2 with the angle of the machine",
            )),
            _ => Ok(()),
        }
    }

    /// The origin, in machine coordinates and program units, that gives the tool's place a coordinate.
    fn origin_for(&self, axis: usize, coordinate: f64) -> Result<f64, ProgramError> {
        let state = self.state();
        let unit = state.units().map_or(1.0, Units::mm_per_unit);
        let zero = self.options.reading.machine_zero_mm;
        match (zero, state.place_mm(axis), state.position_offset_mm(axis)) {
            (Some(zero), Some(place), Some(offset)) => {
                Ok((place - zero[axis] - offset) / unit - coordinate)
            }
            _ => Err(self.refuse(
                &format!(
                    "G10 L20 makes the tool's place the reference, and where that is in the machine along {} is not known",
                    char::from(AXES[axis])
                ),
                "state the place and give the machine's zero (--machine-zero-mm), or set the offsets at the machine and give work offsets (--work-offset)",
            )),
        }
    }

    /// G10 L1 P R: the radius of a tool.
    fn tool_radius(&mut self, words: &Words) {
        let state = self.state();
        let unit = state.units().map_or(1.0, Units::mm_per_unit);
        let tool = words
            .value(b'P')
            .filter(|p| p.fract() == 0.0 && (0.0..1e9).contains(p));
        if let (Some(tool), Some(radius)) = (tool, words.value(b'R')) {
            self.radius.know_diameter(tool as u32, 2.0 * radius * unit);
        }
    }

    /// G52.
    fn local(&mut self, words: &Words) -> Result<Option<Vec<String>>, ProgramError> {
        match (self.options.dialect, self.functions.is_shifted()) {
            (Dialect::LinuxCnc, _) => {}
            (Dialect::Undecided, true) => {
                return Err(self.refuse(
                    "G52 while G92 is in force: LinuxCNC has one offset for both, so that G52 takes its place; Fanuc adds them",
                    "write G92.1 before it, or name the dialect (--dialect linuxcnc or fanuc)",
                ));
            }
            _ => return Ok(None),
        }
        if !words.only(52.0, b"XYZ") {
            return Err(self.refuse(
                "G52 and other words are in one block",
                "write them in two blocks; only X, Y and Z are followed",
            ));
        }
        let state = self.state();
        let mut made = "G92".to_owned();
        for (axis, letter) in AXES.into_iter().enumerate() {
            let Some(shift) = words.value(letter) else {
                continue;
            };
            let unit = state.units().map_or(1.0, Units::mm_per_unit);
            let (Ok(place), Some(offset)) =
                (state.coordinate(axis), state.position_offset_mm(axis))
            else {
                return Err(self.refuse(
                    &format!(
                        "G52 shifts the coordinates, and where the tool is along {} is not known",
                        char::from(letter)
                    ),
                    "state the place with G0 before it, or give the start position",
                ));
            };
            let bare = place + offset / unit;
            made.push_str(&format!(" {}{}", char::from(letter), number(bare - shift)));
        }
        Ok(Some(match made.len() {
            3 => Vec::new(),
            _ => vec![made],
        }))
    }
}

/// Letters of lengths and angles.
const LETTERS: &[u8] = b"XYZABCUVWIJKRQ";

const TEXT: &str = "numbers without a decimal point are read as they stand, X5 as 5 mm (calculator type); a Fanuc control that is set to count least increments takes it for 0.005 mm: give these numbers a point where the control may be set so";

/// Settings and switches of a Fanuc control: numbers without a decimal point, which are lengths (calculator-type input) or least
/// increments, and optional block skip with a slash and a number.
impl Runner<'_> {
    /// `/2`: a switch of the machine of its own, which the flat program has no words for.
    pub fn note_skip_number(&mut self) -> Result<(), ProgramError> {
        let remedy = match self.options.dialect {
            Dialect::Fanuc => {
                let line = self.flat.blocks().max(1);
                self.flat.warn_of_lines(line, "blocks marked with / and a number, behind this line, are taken as run, and their marks are left out: the machine's switches have no effect on them (--block-delete skip leaves the blocks out)");
                return Ok(());
            }
            Dialect::LinuxCnc => "write / alone",
            Dialect::Undecided => "write / alone, or name the dialect (--dialect fanuc)",
        };
        Err(self.refuse(
            "a number behind / names a switch of Fanuc's controllers",
            remedy,
        ))
    }

    /// Counts a line of the program whose words rest on the setting of the control; `before` is the number of flat blocks before it.
    pub fn note_points(&mut self, text: &[u8], before: usize) {
        if self.options.dialect != Dialect::Fanuc || !self.lacks_a_point(text) {
            return;
        }
        let line = (before + 1).min(self.flat.blocks()).max(1);
        self.flat.warn_of_lines(line, TEXT);
    }

    fn lacks_a_point(&self, text: &[u8]) -> bool {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let codes: Vec<u32> = tokens.iter().filter_map(Spanned::g_code).collect();
        // Arguments of macros are scaled by other rules, and K repeats cycles.
        let repeats = self.cycle.is_some() || codes.iter().copied().any(is_cycle);
        !codes.contains(&650)
            && tokens.iter().any(|one| match &one.token {
                Token::Word {
                    letter,
                    number,
                    value,
                } => {
                    let counts = LETTERS.contains(letter) && !(*letter == b'K' && repeats);
                    counts && *value != 0.0 && !text[number.clone()].contains(&b'.')
                }
                _ => false,
            })
    }
}
