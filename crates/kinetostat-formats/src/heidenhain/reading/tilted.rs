//! Tilted working planes (PLANE SPATIAL, VECTOR and RESET), rotary axes whose words are followed, and tool centre point control (M128 and
//! FUNCTION TCPM).
//!
//! Places of a tilted plane are turned about the datum, whatever the machine's axes are. The tool stands across the plane once the rotary
//! axes have turned: by TURN or MOVE, or in a block of their own with the angles that the control computed (Q120, Q121, Q122). Until
//! then, and behind a reset that leaves the axes turned (STAY), X, Y and Z are places of the slides, unless M128 is on.

use std::ops::Range;

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::heidenhain::arcs::XY;
use crate::heidenhain::datum::Bend;
use crate::heidenhain::path_words::{FeedWord, PathWords};
use crate::heidenhain::reading::walker::{EXPAND, Reader, TILTED, TILTED_REMEDY};
use crate::heidenhain::state::{Stands, TipControl, is_of_plane};
use crate::heidenhain::words::{Value, Word};
use crate::turned_axis::{AxisTurn, TipWords, Turning};

/// Entries of rotations and directions that differ by less are one.
const SAME: f64 = 1e-9;

/// The rotation of a plane: angles in space turn about the axes that are not tilted, A first (HEIDENHAIN, TNC 620, user's manual,
/// conversational programming, "Defining the working plane with the spatial angle": tilting sequence A-B-C); of two vectors
/// the second is Z, and the first lies in the plane of X and Z.
fn rotation(words: &[Word]) -> Option<Matrix3<f64>> {
    let value = |name: &str| words.iter().find(|word| word.is(name))?.value();
    let all = |names: [&str; 3]| {
        let [a, b, c] = names.map(value);
        Some(Vector3::new(a?, b?, c?))
    };
    let kind = words.get(1)?;
    let turn = if kind.is("SPATIAL") {
        let angles = all(["SPA", "SPB", "SPC"])?.map(f64::to_radians);
        Rotation3::from_euler_angles(angles.x, angles.y, angles.z).into_inner()
    } else if kind.is("VECTOR") {
        let z = all(["NX", "NY", "NZ"])?.try_normalize(1e-6)?;
        let base = all(["BX", "BY", "BZ"])?;
        let x = (base - z * z.dot(&base)).try_normalize(1e-6)?;
        Matrix3::from_columns(&[x, z.cross(&x), z])
    } else {
        let all_zero = words[1..].iter().all(|word| match word.value {
            Value::Parameter { .. } => false,
            _ => kind.is("RESET") || word.value().unwrap_or(0.0) == 0.0,
        });
        all_zero.then(Matrix3::identity)?
    };
    // Digits that the arithmetic leaves are none.
    Some(
        turn.map(|entry| match (entry - entry.round()).abs() < 1e-15 {
            true => entry.round(),
            false => entry,
        }),
    )
}

impl Reader<'_> {
    /// PLANE.
    pub(crate) fn plane(&mut self, words: &[Word], span: &Range<usize>) {
        let is = |name: &str| words.iter().any(|word| word.is(name));
        let Some(turn) = rotation(words) else {
            return self.fault(span, TILTED, TILTED_REMEDY);
        };
        let tilted = (turn - Matrix3::identity()).amax() > SAME;
        if tilted && (turn * Vector3::z()).xy().norm() < SAME {
            return self.fault(
                span,
                "the plane is turned about Z alone, or over: how far the rotary axes turn for that is the machine's (COORD ROT, TABLE ROT)",
                "turn the coordinates by cycle 10 (CYCL DEF 10.1 ROT), or give this plane as a program of its own",
            );
        }
        let before = self.state.datum.bend;
        let was = match before {
            Bend::Tilt(before) => before,
            _ => Matrix3::identity(),
        };
        if tilted && (self.state.plane != XY || !matches!(before, Bend::None | Bend::Tilt(_))) {
            return self.fault(span, TILTED, TILTED_REMEDY);
        }
        let moved = (turn - was).amax() > SAME;
        if moved {
            self.state.datum.bend = match tilted {
                true => Bend::Tilt(turn),
                false => Bend::None,
            };
            self.state.lost();
            self.state.pole = None;
            self.state.tilt.told = false;
        }
        let across = turn * Vector3::z();
        self.state.tilt.across = (!is("RESET")).then_some(across);
        let as_words = self.state.tilt.stands == Stands::AsWords;
        if (is("TURN") || is("MOVE")) && (moved || tilted || !as_words) {
            self.stand_along(across);
        }
        if tilted && !self.options.rotary_axes.is_empty() && (is("SEQ") || is("SYM")) {
            let taken = "chooses between two postures of the rotary axes: taken is the one nearest to where they stood";
            self.remark(span, "SEQ or SYM", taken);
        }
    }

    /// The rotary axes turn until the tool lies along a direction.
    fn stand_along(&mut self, along: Vector3<f64>) {
        if self.state.tilt.stands != Stands::Along(along) {
            self.state.lost();
        }
        self.state.standing.take_direction_instead();
        self.state.tilt.stands = Stands::Along(along);
        self.state.tilt.told = false;
    }

    /// Follows the words of a block that turn rotary axes to the angles of the plane (`L B+Q121 C+Q122`): HEIDENHAIN, TNC 640, user's
    /// manual, Klartext programming, "Preassigned Q parameters": Q120, Q121 and Q122 are the angles of A, B and C that the
    /// control computed. The other words.
    pub(crate) fn turn_to_plane(
        &mut self,
        words: &[Word],
        span: &Range<usize>,
    ) -> Option<Vec<Word>> {
        let bytes = self.file.bytes();
        let (own, rest): (Vec<&Word>, Vec<&Word>) =
            words.iter().partition(|word| is_of_plane(word, bytes));
        if own.is_empty() {
            return None;
        }
        let letters = own.iter().map(|word| word.letters.letters()[0]);
        let letters: Vec<char> = letters.map(char::from).collect();
        let rest: Vec<Word> = rest.into_iter().cloned().collect();
        let of_machine = &self.options.rotary_axes;
        let moves = |word: &Word| {
            let letters = word.letters.letters();
            !matches!(
                letters,
                b"L" | b"R" | b"F" | b"FMAX" | b"MAX" | b"FAUTO" | b"AUTO" | b"M"
            )
        };
        let missing = of_machine.iter().find(|letter| !letters.contains(letter));
        let Some(across) = self.state.tilt.across else {
            self.fault(span, "no PLANE before it has computed these angles", EXPAND);
            return Some(rest);
        };
        let leans = (across - Vector3::z()).norm() > SAME;
        if rest.iter().any(moves) || missing.is_some() {
            self.fault(
                span,
                "the angles of the plane stand beside places, or not with those of all rotary axes of the model",
                "turn all of them in a block of its own: L A+Q120 C+Q122 R0 FMAX",
            );
        } else if leans && let Some(letter) = letters.iter().find(|own| !of_machine.contains(own)) {
            self.fault(
                span,
                format!("a rotary axis ({letter}) turns the part or the tool, and there is no model of it"),
                "describe the rotary axes of the machine in the model ([[rotary_axis]]), or divide the program there",
            );
        }
        self.stand_along(across);
        Some(rest)
    }

    /// Words turn rotary axes from where PLANE has left them.
    pub(crate) fn turned_by_words(&mut self, has_model: bool) {
        let leans = match self.state.tilt.stands {
            Stands::Along(along) => (along - Vector3::z()).norm() > SAME,
            Stands::AsWords => return,
            Stands::Unknown => true,
        };
        self.state.tilt.stands = match leans && !has_model {
            true => Stands::Unknown,
            false => Stands::AsWords,
        };
        self.state.tilt.told = false;
    }

    /// The direction of the tool where PLANE has turned the rotary axes, as it is programmed.
    pub(crate) fn follow_plane(&mut self) {
        if let Stands::Along(along) = self.state.tilt.stands {
            self.state.axis = match self.state.tip.on {
                true => self.state.datum.programmed_direction(&along),
                false => self.state.plane.across(),
            };
        }
    }

    /// True if, due to the plane, positions are not those of the tool tip in the part; a cut is refused there, once.
    pub(crate) fn no_place_by_plane(&mut self, span: &Range<usize>, rapid: bool) -> bool {
        let across = self.state.datum.direction(&self.state.plane.across());
        let aligned = match self.state.tilt.stands {
            Stands::AsWords => !matches!(self.state.datum.bend, Bend::Tilt(_)),
            Stands::Along(along) => (along - across).norm() < SAME,
            Stands::Unknown => false,
        };
        let (reason, remedy) = match (self.state.tilt.shifted, aligned || self.state.tip.on) {
            ([false, false, false], true) => return false,
            ([false, false, false], false) => (
                "the rotary axes do not stand as the plane in force says: X, Y and Z are places of the machine's slides",
                "turn them with the plane (TURN in place of STAY, or L A+Q120 C+Q122 behind it), and back with PLANE RESET TURN",
            ),
            _ => (
                "the datum was shifted while the plane was tilted, and where it is now is not followed",
                "reset the plane (PLANE RESET) before the shift, and state the shift of all axes behind it",
            ),
        };
        if !rapid && !std::mem::replace(&mut self.state.tilt.told, true) {
            self.fault(span, reason, remedy);
        }
        true
    }
}

const TIP: TipWords = TipWords {
    control: "M128",
    rapid: "L ",
    zero: "+0 FMAX",
    step: |letter, by| format!("I{letter}{by:+}"),
    shorter: |letter, to| format!("M126 in the block, with {letter}{to:+}, for the shorter way"),
};

impl Reader<'_> {
    /// FUNCTION TCPM and FUNCTION RESET TCPM.
    pub(crate) fn tip_function(&mut self, words: &[Word]) {
        let has = |name: &str| words.iter().any(|word| word.is(name));
        if !has("TCPM") {
            return;
        }
        self.state.tip = match has("RESET") {
            true => TipControl::default(),
            false => TipControl {
                on: true,
                spatial: has("SPAT"),
                by_vector: has("VECTOR"),
            },
        };
    }

    /// Functions that act on rotary axes at the beginning of a block, or at its end.
    pub(crate) fn axis_function(&mut self, number: u32) {
        match number {
            128 => {
                self.state.tip = TipControl {
                    on: true,
                    ..TipControl::default()
                }
            }
            129 => self.state.tip = TipControl::default(),
            126 => self.state.shorter = true,
            127 => self.state.shorter = false,
            _ => {}
        }
    }

    /// Turns the axes as the words of a block say, to places of the machine with M91; whether there are words of followed axes.
    pub(crate) fn turn_axes(
        &mut self,
        words: &[Word],
        parsed: &PathWords,
        span: &Range<usize>,
        machine: bool,
    ) -> bool {
        self.state.standing.begin_block();
        let mut turns = false;
        let turning = Turning {
            words: &TIP,
            rapid: parsed.feed == FeedWord::Max,
        };
        if !parsed.rotary.is_empty() {
            self.turned_by_words(!self.options.rotary_axes.is_empty());
        }
        for word in &parsed.rotary {
            let at = &words[word.at].span;
            let Some(place) = self.state.standing.place_of_letter(word.letter) else {
                if word.value != 0.0 {
                    self.fault(
                        at,
                        format!(
                            "a rotary axis ({}) turns the part or the tool, and there is no model of it",
                            char::from(word.letter)
                        ),
                        "describe the rotary axes of the machine in the model ([[rotary_axis]]), or divide the program there",
                    );
                }
                continue;
            };
            turns = true;
            if machine {
                self.state.standing.send_axis(place);
                if self.state.tip.on {
                    self.state.lost();
                }
                continue;
            }
            let turn = match (word.step, self.state.shorter) {
                (true, _) => AxisTurn::By(word.value),
                (_, true) => AxisTurn::Shorter(word.value.rem_euclid(360.0)),
                (_, false) => AxisTurn::To(word.value),
            };
            if let Err((reason, remedy)) = self.state.standing.turn_axis(place, turn, turning) {
                self.fault(at, reason, &remedy);
            }
        }
        if turns && self.state.tip.on {
            self.state.axis = self.state.plane.across();
            self.turns_otherwise(words, parsed, span);
        }
        turns
    }

    /// Turns under tool centre point control that are not those of rotary axes, each evenly.
    fn turns_otherwise(&mut self, words: &[Word], parsed: &PathWords, span: &Range<usize>) {
        if self.state.tip.spatial {
            return self.fault(
                span,
                "A, B and C are angles in space here (AXIS SPAT), and not those of rotary axes",
                "let the CAM system write angles of the axes (AXIS POS), or LN blocks with TX, TY, TZ",
            );
        }
        if parsed.axis.iter().any(Option::is_some) {
            return self.fault(
                span,
                "angles and a direction of the tool stand in one block",
                "keep one of them",
            );
        }
        if !self.state.standing.is_turning() {
            return;
        }
        let straight = matches!(words[0].letters.letters(), b"L" | b"LN" | b"LP" | b"");
        if !straight {
            self.fault(
                span,
                "a rotary axis turns on an arc",
                "let the CAM system write L blocks there",
            );
        } else if self.state.tip.by_vector && parsed.feed != FeedWord::Max {
            self.fault(
                span,
                "the tool's axis stays in a plane here (PATHCTRL VECTOR), so that its axes do not turn evenly",
                "write PATHCTRL AXIS, or M128",
            );
        }
    }

    /// A block that turns axes alone, without tool centre point control.
    pub(crate) fn turn_alone(&mut self, span: &Range<usize>, rapid: bool) {
        if self.no_place_by_axes(span, rapid) {
            self.state.place = [None; 3];
            self.state.direction = None;
        }
    }

    /// True if the positions of a block are not those of the tool tip in the part; a cut is refused there.
    pub(crate) fn no_place_by_axes(&mut self, span: &Range<usize>, rapid: bool) -> bool {
        let tip = self.state.tip.on;
        if !rapid {
            if let Some((reason, remedy)) = self.state.standing.no_cut(tip, &TIP) {
                self.fault(span, reason, &remedy);
            }
            return false;
        }
        self.state.standing.loses_place(tip)
    }
}
