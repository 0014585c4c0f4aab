//! The G codes in force while a program runs, and the statements of its programmable frame: SAVE puts them back.

use std::rc::Rc;

/// Code that a modal group returns to if the program stated none of it before.
#[derive(Clone, Copy)]
enum Unstated {
    /// The code that programs are read with from their beginning.
    Basic(&'static str),
    /// The machine alone knows it.
    Unknown,
    /// The code moves no axis.
    Free,
}

/// Groups of codes of which one is in force, as far as they are put back.
const GROUPS: [(&[&str], Unstated); 10] = [
    (&["G0", "G1", "G2", "G3", "CIP"], Unstated::Basic("G1")),
    (&["G17", "G18", "G19"], Unstated::Basic("G17")),
    (&["G90", "G91"], Unstated::Basic("G90")),
    (&["G70", "G71", "G700", "G710"], Unstated::Basic("G71")),
    (
        &["G93", "G94", "G95", "G96", "G961", "G97", "G971"],
        Unstated::Basic("G94"),
    ),
    (
        &["G60", "G64", "G641", "G642", "G643", "G644", "G645"],
        Unstated::Free,
    ),
    (&["G40", "G41", "G42"], Unstated::Basic("G40")),
    (&["ORIWKS", "ORIMKS"], Unstated::Unknown),
    (&["ORIEULER", "ORIRPY"], Unstated::Unknown),
    (&["ORIAXES", "ORIVECT", "ORIPLANE"], Unstated::Unknown),
];

/// Groups that say how the values of a frame are read: the plane, for RPL, and the unit.
const OF_FRAMES: [usize; 2] = [1, 3];

/// One code of each group, where one was stated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Modes {
    codes: [Option<&'static str>; GROUPS.len()],
    /// The number of the settable zero: G54 to G57, G500, G505 to G599.
    zero: Option<u16>,
}

impl Modes {
    /// A code is stated.
    pub(super) fn state(&mut self, code: &str) {
        for (held, (group, _)) in self.codes.iter_mut().zip(GROUPS) {
            if let Some(found) = group.iter().find(|known| **known == code) {
                *held = Some(found);
            }
        }
        let number = code.strip_prefix('G').and_then(|code| code.parse().ok());
        if let Some(number @ (54..=57 | 500 | 505..=599)) = number {
            self.zero = Some(number);
        }
    }

    /// The code of motion.
    pub(super) fn motion(&self) -> Option<&'static str> {
        self.codes[0]
    }

    /// The axis across the plane.
    pub(super) fn normal(&self) -> char {
        match self.codes[1] {
            Some("G18") => 'Y',
            Some("G19") => 'X',
            _ => 'Z',
        }
    }

    /// Length of the unit of coordinates, mm.
    pub(super) fn unit_mm(&self) -> f64 {
        match self.in_force(OF_FRAMES[1]) {
            Some("G70" | "G700") => 25.4,
            _ => 1.0,
        }
    }

    /// The code of a group in force, as programs are read.
    fn in_force(&self, group: usize) -> Option<&'static str> {
        match (self.codes[group], GROUPS[group].1) {
            (None, Unstated::Basic(basic)) => Some(basic),
            (code, _) => code,
        }
    }

    /// Codes that put these in force where others are.
    ///
    /// # Errors
    /// A code that was stated since, where the program stated none of its group before.
    pub(super) fn restored_from(&self, now: &Self) -> Result<String, String> {
        let mut codes = Vec::new();
        for (group, (_, unstated)) in GROUPS.iter().enumerate() {
            let (old, new) = (self.in_force(group), now.in_force(group));
            match (old, new, unstated) {
                (old, new, _) if old == new => {}
                (Some(old), ..) => codes.push(old.to_owned()),
                (None, Some(new), Unstated::Unknown) => return Err(new.to_owned()),
                (None, ..) => {}
            }
        }
        match (self.zero, now.zero) {
            (old, new) if old == new => {}
            (Some(old), _) => codes.push(format!("G{old}")),
            (None, Some(new)) => return Err(format!("G{new}")),
            (None, None) => {}
        }
        Ok(codes.join(" "))
    }

    /// Codes that values of a frame are read with, where others are in force now; these are in force then.
    pub(super) fn of_frame_from(&self, now: &mut Self) -> String {
        let mut codes = Vec::new();
        for group in OF_FRAMES {
            let (old, new) = (self.in_force(group), now.in_force(group));
            if let (Some(old), true) = (old, old != new) {
                now.codes[group] = Some(old);
                codes.push(old);
            }
        }
        codes.join(" ")
    }
}

/// Words that put a frame in place of all before, or back to none.
const INSTEAD: [&[u8]; 4] = [b"TRANS", b"ROT", b"SCALE", b"MIRROR"];
/// Words that add to the frame in force.
const FURTHER: [&[u8]; 4] = [b"ATRANS", b"AROT", b"ASCALE", b"AMIRROR"];

/// True if a word in capitals states a programmable frame.
pub(super) fn is_frame(word: &[u8]) -> bool {
    INSTEAD.contains(&word) || FURTHER.contains(&word)
}

/// A statement of a frame, with numbers in place of its expressions, and the codes that its values are read with.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Statement {
    pub text: Vec<u8>,
    pub modes: Modes,
    pub instead: bool,
}

/// The statements that make the programmable frame in force.
#[derive(Debug, Clone, Default)]
pub(super) struct Frames(Rc<Vec<Statement>>);

impl Frames {
    /// Adds the words of a block that states a frame, as they were written.
    pub(super) fn state(&mut self, word: &[u8], text: &[u8], modes: Modes) {
        let instead = INSTEAD.contains(&word);
        if instead {
            *self = Self::default();
        }
        let statement = Statement {
            text: text.to_vec(),
            modes,
            instead,
        };
        // Copied where a program that called still holds the frame of its call.
        Rc::make_mut(&mut self.0).push(statement);
    }

    /// True if both hold the same statements.
    pub(super) fn is(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }

    /// In their order.
    pub(super) fn statements(&self) -> &[Statement] {
        &self.0
    }
}
