//! One block, its words sorted by letter.

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::path::moves::Motion;
use crate::reading::dialect::{Treatment, lookup};
use crate::text::program::Program;
use crate::text::{Line, LineKind, Word};

/// The codes of a block that are followed, at most one of each group.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Codes {
    pub motion: Option<Motion>,
    pub plane: Option<u32>,
    pub units: Option<u32>,
    pub distance: Option<u32>,
    pub arc_distance: Option<u32>,
    pub feed_mode: Option<u32>,
    pub work_offset: Option<u32>,
    /// G5, G5.1, G103, G187: how far the control looks ahead, and how exactly it follows the path.
    pub looks_ahead: bool,
    pub tool_length: Option<u32>,
    /// G43.4 and G43.5: a G43 with tool centre point control.
    pub tool_centre_point: bool,
    /// G43.5: the tool stands as I, J and K say.
    pub by_direction: bool,
    /// Axes that G43.1 and G43.2 name: their words are lengths.
    pub length_axes: [bool; 3],
    pub position_offset: Option<u32>,
    /// G28, G30, G53.
    pub machine: Option<u32>,
    pub extruder: Option<u32>,
    pub path_mode: Option<u32>,
    pub speed_mode: Option<u32>,
    pub retract_mode: Option<u32>,
    /// A canned cycle that may be carried as it is written, in tenths.
    pub cycle: Option<u32>,
    pub spindle: Option<u32>,
    pub coolant: Option<u32>,
    pub overrides: Option<u32>,
    pub stop: Option<u32>,
    pub dwell: bool,
    /// G10.
    pub sets: bool,
    pub ends: bool,
}

impl Codes {
    /// Notes a code of motion; true where another stands beside it.
    fn moves(&mut self, motion: Motion) -> bool {
        let before = self.motion.replace(motion);
        before.is_some_and(|before| before != Motion::Off)
    }
}

/// A block: its codes and its other words.
pub(crate) struct Block<'p> {
    pub program: &'p Program,
    pub line_number: usize,
    pub line: &'p Line,
    pub codes: Codes,
    /// Values by letter, G M N O left out.
    values: [Option<(f64, usize)>; 26],
    pub words: &'p [Word],
}

impl<'p> Block<'p> {
    pub fn of(program: &'p Program, index: usize) -> Result<Self, ProgramError> {
        match Self::read(program, index) {
            (block, None) => Ok(block),
            (_, Some(fault)) => Err(fault),
        }
    }

    /// The block on a line, by its number.
    pub fn on(program: &'p Program, number: usize) -> Result<Self, ProgramError> {
        Self::of(program, program.index_of(number).unwrap_or(0))
    }

    /// Understood words of a block: refused ones are left out.
    pub fn understood(program: &'p Program, index: usize) -> Self {
        Self::read(program, index).0
    }

    /// G codes of the block that are refused, in tenths.
    pub fn refused_codes(&self) -> Vec<u32> {
        let codes = self.words.iter().filter(|word| word.letter == b'G');
        let refused = codes.map(Word::tenths).filter(|tenths| {
            let code = lookup('G', *tenths);
            code.is_none_or(|code| matches!(code.treatment, Treatment::Refused { .. }))
        });
        refused.collect()
    }

    fn read(program: &'p Program, index: usize) -> (Self, Option<ProgramError>) {
        let mut fault = None;
        let line = &program.lines()[index];
        let mut block = Self {
            program,
            line_number: program.number_of(index),
            line,
            codes: Codes::default(),
            values: [None; 26],
            words: program.words(line),
        };
        for index in 0..block.words.len() {
            let word = block.words[index];
            match word.letter {
                b'G' | b'M' => {
                    let refused = block.note_code(&word).err();
                    fault = fault.or(refused);
                }
                b'N' if word.value < 0.0 => {
                    let below = block.refuse(
                        ProgramErrorKind::Malformed,
                        Some(&word),
                        &format!("N{} is no number of a block", word.value),
                        "write it without a sign",
                    );
                    fault = fault.or(Some(below));
                }
                b'N' | b'O' => {}
                letter => {
                    let slot = &mut block.values[usize::from(letter - b'A')];
                    if slot.is_some() {
                        let twice = block.refuse(
                            ProgramErrorKind::Malformed,
                            Some(&word),
                            &format!(
                                "the letter {} appears twice in one block",
                                char::from(letter)
                            ),
                            "keep one of the two words",
                        );
                        fault = fault.or(Some(twice));
                        continue;
                    }
                    *slot = Some((word.value, index));
                }
            }
        }
        block.drop_parameters();
        (block, fault)
    }

    pub fn is_vendor(&self) -> bool {
        self.line.kind == LineKind::Vendor
    }

    pub fn value(&self, letter: u8) -> Option<f64> {
        self.values[usize::from(letter - b'A')].map(|(value, _)| value)
    }

    pub fn word(&self, letter: u8) -> Option<&Word> {
        self.values[usize::from(letter - b'A')].map(|(_, index)| &self.words[index])
    }

    /// A refusal of the block, at one of its words or at all of it.
    pub fn refuse(
        &self,
        kind: ProgramErrorKind,
        word: Option<&Word>,
        reason: &str,
        remedy: &str,
    ) -> ProgramError {
        let content = self.program.content(self.line);
        ProgramError {
            kind,
            line: self.line_number,
            span: word.map_or_else(|| content.clone(), Word::span),
            found: excerpt(&self.program.bytes()[content]),
            reason: reason.to_owned(),
            remedy: remedy.to_owned(),
        }
    }

    fn note_code(&mut self, word: &Word) -> Result<(), ProgramError> {
        let letter = char::from(word.letter);
        let tenths = word.value * 10.0;
        let whole = tenths.round();
        let code = lookup(letter, whole as u32);
        let shown = || format!("{letter}{}", word.value);
        if (tenths - whole).abs() > 1e-6 || !(0.0..1e6).contains(&tenths) {
            return Err(self.refuse(
                ProgramErrorKind::Malformed,
                Some(word),
                &format!("{} is no code", shown()),
                "mend the number",
            ));
        }
        let tenths = whole as u32;
        let of_word = |wanted: u8| self.words.iter().find(|w| w.letter == wanted);
        let value = |wanted: u8| of_word(wanted).map(|w| w.value);
        if letter == 'G' && looks_ahead(tenths, value) {
            let twice = std::mem::replace(&mut self.codes.looks_ahead, true);
            return match twice {
                true => Err(self.meets_its_like(word)),
                false => Ok(()),
            };
        }
        match code.map(|code| (code.meaning, code.treatment)) {
            Some((_, Treatment::Refused { .. }))
                if letter == 'G' && matches!(tenths, 740 | 760 | 840 | 870 | 880) =>
            {
                return match self.codes.cycle.replace(tenths) {
                    Some(_) => Err(self.meets_its_like(word)),
                    None => Ok(()),
                };
            }
            Some((meaning, Treatment::Refused { reason, remedy })) => {
                return Err(self.refuse(
                    ProgramErrorKind::UnknownCode,
                    Some(word),
                    &format!("{} ({meaning}): {reason}", shown()),
                    remedy,
                ));
            }
            // Builders give their own functions whole numbers; only vendors' commands have others.
            None if letter == 'G' || !tenths.is_multiple_of(10) && !self.is_vendor() => {
                return Err(self.refuse(
                    ProgramErrorKind::UnknownCode,
                    Some(word),
                    &format!("{} is not known here and may move the tool", shown()),
                    "remove it, or write what it does with codes that are known",
                ));
            }
            _ => {}
        }
        let codes = &mut self.codes;
        let twice = match (letter, tenths) {
            ('G', 0) => codes.moves(Motion::Rapid),
            ('G', 10) => codes.moves(Motion::Feed),
            ('G', 20) => codes.moves(Motion::Clockwise),
            ('G', 30) => codes.moves(Motion::CounterClockwise),
            // G80 beside another motion code has no effect (LinuxCNC); on Fanuc's controls it is in a group of its
            // own.
            ('G', 800) => {
                codes.motion.get_or_insert(Motion::Off);
                false
            }
            ('G', 170 | 180 | 190) => codes.plane.replace(tenths).is_some(),
            ('G', 200 | 210) => codes.units.replace(tenths).is_some(),
            ('G', 900 | 910) => codes.distance.replace(tenths).is_some(),
            ('G', 901 | 911) => codes.arc_distance.replace(tenths).is_some(),
            ('G', 930 | 940 | 950) => codes.feed_mode.replace(tenths).is_some(),
            ('G', 540..=593 | 1540) => codes.work_offset.replace(tenths).is_some(),
            ('G', 434 | 435) => {
                codes.tool_centre_point = true;
                codes.by_direction = tenths == 435;
                codes.tool_length.replace(430).is_some()
            }
            ('G', 430..=432 | 490) => codes.tool_length.replace(tenths).is_some(),
            ('G', 920..=923) => codes.position_offset.replace(tenths).is_some(),
            ('G', 280 | 300 | 530) => codes.machine.replace(tenths).is_some(),
            ('M', 820 | 830) => codes.extruder.replace(tenths).is_some(),
            ('G', 100) => std::mem::replace(&mut codes.sets, true),
            ('G', 40) => std::mem::replace(&mut codes.dwell, true),
            ('G', 610 | 611 | 640) => codes.path_mode.replace(tenths).is_some(),
            ('G', 960 | 970) => codes.speed_mode.replace(tenths).is_some(),
            ('G', 980 | 990) => codes.retract_mode.replace(tenths).is_some(),
            ('M', 30 | 40 | 50 | 130 | 140 | 190) => codes.spindle.replace(tenths).is_some(),
            // Mist and flood go together; off goes with neither.
            ('M', 70 | 80 | 90) => {
                let before = codes.coolant.replace(tenths);
                before.is_some_and(|before| before == tenths || before == 90 || tenths == 90)
            }
            ('M', 480 | 490) => codes.overrides.replace(tenths).is_some(),
            ('M', 0 | 10 | 20 | 300 | 600) => {
                codes.ends |= matches!(tenths, 20 | 300);
                codes.stop.replace(tenths).is_some()
            }
            _ => false,
        };
        if twice {
            return Err(self.meets_its_like(word));
        }
        Ok(())
    }

    fn meets_its_like(&self, word: &Word) -> ProgramError {
        let code = format!("{}{}", char::from(word.letter), word.value);
        self.refuse(
            ProgramErrorKind::Malformed,
            Some(word),
            &format!("{code} meets another code of its group in the same block"),
            "write the two codes in two blocks",
        )
    }

    /// `G4 P1 G0 X5`, or `G4 P1 X5` behind a G0: the time is P, so the axis words are those of the straight move that follows in
    /// the same block (LinuxCNC 2.9 dwells, then moves).
    pub fn dwells_before_motion(&self) -> bool {
        let codes = &self.codes;
        let has = |letters: &[u8]| self.words.iter().any(|word| letters.contains(&word.letter));
        let other = codes.position_offset.is_some()
            || codes.machine.is_some()
            || codes.sets
            || matches!(codes.tool_length, Some(431 | 432));
        let moves = match codes.motion {
            Some(Motion::Rapid | Motion::Feed) => true,
            Some(_) => false,
            // U, too, is a time on some controllers.
            None => !other && has(b"XYZABC") && !has(b"UVW"),
        };
        codes.dwell && moves && has(b"P")
    }

    /// Letters that are parameters of another code of the block are no coordinates.
    fn drop_parameters(&mut self) {
        let takes = |letter: u8, among: fn(u32) -> bool| {
            let own = self.words.iter().filter(|word| word.letter == letter);
            let mut tenths = own.map(Word::tenths);
            tenths.any(|tenths| tenths.is_multiple_of(10) && among(tenths / 10))
        };
        let mut dropped: Vec<u8> = Vec::new();
        match (self.codes.dwell, self.dwells_before_motion()) {
            (true, true) => dropped.push(b'P'),
            (true, false) => dropped.extend(b"XUPSFABCEVWYZQR"),
            (false, _) => {}
        }
        if matches!(self.codes.tool_length, Some(431 | 432)) {
            let named = b"XYZ".map(|letter| self.value(letter).is_some());
            self.codes.length_axes = named;
            dropped.extend(b"XYZIJK");
        }
        if self.codes.sets {
            dropped.extend(b"XYZABCUVWRPIJQLKD");
        }
        if takes(b'G', |code| code == 64) {
            dropped.extend(b"PQ");
        }
        if self.codes.looks_ahead {
            dropped.extend(b"PQER");
            let is_contour = |word: &Word| word.letter == b'G' && word.tenths() == 51;
            if self.words.iter().any(is_contour) {
                dropped.extend(b"XYZABCUVW");
            }
        }
        if matches!(self.codes.work_offset, Some(541 | 1540)) {
            dropped.push(b'P');
        }
        if takes(b'M', |code| matches!(code, 62..=68)) {
            dropped.extend(b"PELQ");
        }
        if takes(b'M', |code| code == 19) {
            dropped.extend(b"RPQ");
        }
        if takes(b'M', |code| matches!(code, 3..=6 | 50..=53 | 100..=199)) {
            dropped.extend(b"PQ");
        }
        for letter in dropped {
            self.values[usize::from(letter - b'A')] = None;
        }
    }
}

/// True if a code with these words only sets look-ahead or path accuracy and moves nothing: `G5 P0`, `P2` and `P10000` and
/// `G5.1 Q1` (Fanuc; `G5.1 Q3 X0 Y0 Z0` names axes), G103 and G187 (Haas). With places they are splines, and G5 with other
/// numbers runs a cycle that lies in the control.
pub(crate) fn looks_ahead(tenths: u32, value: impl Fn(u8) -> Option<f64>) -> bool {
    let has = |letters: &[u8]| letters.iter().any(|letter| value(*letter).is_some());
    let stays = b"XYZABCUVW"
        .iter()
        .all(|l| value(*l).is_none_or(|v| v == 0.0));
    match tenths {
        50 => !has(b"XYZABCUVWIJKQRL") && [0.0, 2.0, 10_000.0].map(Some).contains(&value(b'P')),
        51 => value(b'Q').is_some() && stays && !has(b"IJK"),
        1030 | 1870 => true,
        _ => false,
    }
}
