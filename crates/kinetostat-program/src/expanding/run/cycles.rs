//! Blocks that a running program translates to plain ones: canned cycles, arcs of many turns, polar moves, splines, rigid taps.

use crate::error::ProgramError;
use crate::expanding::Dialect;
use crate::expanding::run::{Rigid, Runner};
use crate::expanding::translate::cycle::cycle;
use crate::expanding::translate::spline::{Spline, is_spline, spline};
use crate::expanding::translate::turns::turns;
use crate::expanding::translate::{MotionBlock, Place};
use crate::number::number;
use crate::path::moves::FeedMode;
use crate::path::spindle::{SpeedMode, SpindleRotation};
use crate::text::lex::{Spanned, tokens_of};

/// Meaning of a block without a code while a cycle is in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum InCycle {
    /// One more hole.
    Hole,
    /// Words of the cycle that make no hole, and are not kept (Fanuc, Operator's Manual B-63534EN, section 13.1).
    Words,
    /// Other words.
    Nothing,
}

impl Runner<'_> {
    /// Holds M29 back until a tap writes it; gives the rest of its block.
    pub fn hold_rigid(&mut self, text: &[u8]) -> Option<Vec<u8>> {
        if self.options.dialect == Dialect::LinuxCnc || !text.windows(2).any(|two| two == b"29") {
            return None;
        }
        let (rigid, rest) = Rigid::of(text)?;
        self.rigid = Some(rigid);
        Some(rest)
    }

    /// A block with G28 or G30 and both G90 and G91, with the last of these alone (Fanuc, Operator's Manual B-64304EN,
    /// preparatory function).
    pub fn last_distance(&self, text: &[u8]) -> Option<Vec<u8>> {
        if self.options.dialect != Dialect::Fanuc || !text.windows(2).any(|two| two == b"91") {
            return None;
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let is =
            |one: &&Spanned, codes: &[u32]| one.g_code().is_some_and(|code| codes.contains(&code));
        let goes_home = tokens.iter().any(|one| is(&one, &[280, 300]));
        let modes: Vec<&Spanned> = tokens.iter().filter(|one| is(one, &[900, 910])).collect();
        match modes[..] {
            [first, last] if goes_home && first.g_code() != last.g_code() => {
                let mut made = text.to_vec();
                made.splice(first.span.clone(), []);
                Some(made)
            }
            _ => None,
        }
    }

    /// G80 and other motions end it; what no tap has written stands before them.
    pub fn end_rigid(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        if matches!(block.motion, None | Some(740 | 840)) {
            return Ok(());
        }
        match self.rigid.take() {
            Some(rigid) if !rigid.is_written => self.add(rigid.text.as_bytes()),
            _ => Ok(()),
        }
    }

    /// Meaning of a block that names no motion while a cycle is in force.
    pub fn in_cycle(&self, block: &MotionBlock) -> Result<InCycle, ProgramError> {
        if block.wants_axes {
            return Ok(InCycle::Nothing);
        }
        if block.has_place() || block.has_other_axis() {
            return Ok(InCycle::Hole);
        }
        if !block.has_cycle_words() {
            return Ok(InCycle::Nothing);
        }
        match (block.value(b'R'), self.options.dialect) {
            (_, Dialect::LinuxCnc) => Err(self.refuse(
                "words of a cycle without a place: LinuxCNC refuses them",
                "write them into a block with a place",
            )),
            (Some(_), Dialect::Fanuc) => Ok(InCycle::Hole),
            (Some(_), Dialect::Undecided) => Err(self.refuse(
                "R without a place while a cycle is in force: Fanuc drills once more where the tool is, LinuxCNC refuses it",
                "write R into a block with a place, or name the dialect (--dialect)",
            )),
            _ => Ok(InCycle::Words),
        }
    }

    /// Notes G0 to G3. G80 is of another group to Fanuc and Haas, so that the last of them holds behind it (B-64304EN,
    /// list of G codes); elsewhere nothing does.
    pub fn note_move(&mut self, block: &MotionBlock) {
        match block.motion {
            Some(0) => self.move_named = Some("G0"),
            Some(10) => self.move_named = Some("G1"),
            Some(20) => self.move_named = Some("G2"),
            Some(30) => self.move_named = Some("G3"),
            Some(800) => {
                let is_fanuc = self.options.dialect == Dialect::Fanuc;
                let code = self.move_named.filter(|_| is_fanuc);
                self.coordinates.owe(code);
            }
            _ => {}
        }
    }

    /// An arc of more than one turn (LinuxCNC).
    pub fn turns(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        self.add_rest(&block.before)?;
        let made = turns(block, self.state());
        for text in made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))? {
            self.add(text.as_bytes())?;
        }
        self.add_rest(&block.after)
    }

    /// A block that makes holes.
    pub fn cycle(&mut self, code: u32, block: &MotionBlock) -> Result<(), ProgramError> {
        let refused = self.radius.refuses_cycles();
        let refused = refused.or_else(|| self.coordinates.refuses_cycles());
        if let Some((reason, remedy)) = refused {
            return Err(self.refuse(&reason, remedy));
        }
        self.add_rest(&block.before)?;
        let is_fanuc = self.options.dialect == Dialect::Fanuc;
        if self.rigid.is_some() && matches!(code, 740 | 840) && !is_fanuc {
            return Err(self.refuse(
                "behind M29 the feed of the tap is tied to the turns of the spindle (rigid tapping): plain blocks have no words for it",
                "take M29 out where the tap floats in its holder, or have the cycle left as it is written (--dialect fanuc)",
            ));
        }
        let rigid = self.rigid.as_ref().map(|rigid| rigid.text.as_str());
        let dialect = self.options.dialect;
        let made = cycle(code, block, self.cycle, self.state(), dialect, rigid);
        let (texts, cycle) = made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        let stays = is_fanuc && cycle.is_the_controls(self.rigid.is_some());
        if stays && self.coordinates.interpreter().is_some() {
            return Err(self.refuse(
                &format!("the cycle G{} stays as it is written, and the coordinates are shifted, scaled or turned", code / 10),
                "end that before it (G52 X0 Y0 Z0, G50, G69), or write its moves as G0 and G1 blocks",
            ));
        }
        if let Some(rigid) = &mut self.rigid {
            rigid.is_written |= matches!(code, 740 | 840);
        }
        for text in texts {
            self.add(text.as_bytes())?;
        }
        self.cycle = Some(cycle);
        let is_peck = matches!(code, 730 | 830) && self.options.dialect == Dialect::Fanuc;
        if is_peck && !std::mem::replace(&mut self.pecks_warned, true) {
            self.flat.warn("each peck of G73 and G83 begins 0.254 mm (0.010 inch) above the last depth here, as LinuxCNC has it; on Fanuc's controllers parameters 5114 and 5115 say how far above. The depths are the same");
        }
        self.add_rest(&block.after)
    }
}

/// Moves whose ends are given by a radius and an angle.
impl Runner<'_> {
    /// A straight move or an arc whose end is given by a radius and an angle.
    pub fn polar(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        let remedy = "write the place with X and Y";
        if block.value(b'X').or(block.value(b'Y')).is_some() {
            return Err(self.refuse("X or Y beside polar words", remedy));
        }
        self.add_rest(&block.before)?;
        let state = self.state();
        if state.plane_axes()[2] != 2 {
            return Err(self.refuse(
                "polar words outside the plane XY (G17)",
                "write G17 before it, or the place with X, Y and Z",
            ));
        }
        let (x, y) = match (state.coordinate(0), state.coordinate(1)) {
            (Ok(x), Ok(y)) => (x, y),
            (Err(reason), _) | (_, Err(reason)) => {
                return Err(self.refuse(&reason, "state X and Y before polar words"));
            }
        };
        let incremental = state.is_incremental();
        let end = block.polar.place([x, y], incremental);
        let end = end.map_err(|reason| self.refuse(reason, remedy))?;
        let words = match incremental {
            true => [end[0] - x, end[1] - y],
            false => end,
        };
        let mut text = block.motion_words();
        text.push_str(&format!("X{} Y{}", number(words[0]), number(words[1])));
        text.push_str(&block.other_words());
        self.add(text.as_bytes())?;
        self.add_rest(&block.after)
    }
}

/// Blocks of splines while a program runs.
impl Runner<'_> {
    /// The code of the spline that a block makes or goes on with, in tenths; `None` if it is no spline.
    pub fn code_of_spline(&self, block: &MotionBlock) -> Option<u32> {
        let goes_on = block.motion.is_none() && !block.wants_axes;
        let has_words = block.has_place() || block.value(b'P').is_some();
        match (block.motion, &self.spline) {
            // G5.1 Q1 and G5 P10000 are contour modes of Fanuc: the reader carries them.
            (Some(_), _) if self.options.dialect == Dialect::Fanuc => None,
            (Some(code @ (50 | 51)), _) => block.has_place().then_some(code),
            (Some(code), _) => Some(code).filter(|code| is_spline(*code)),
            (None, Some(Spline::Cubic { .. })) if goes_on && has_words => Some(50),
            (None, Some(Spline::Quadratic)) if goes_on && has_words => Some(51),
            (None, Some(Spline::Open { .. })) if goes_on && has_words => Some(52),
            (None, _) => None,
        }
    }

    /// A spline as its chords.
    pub fn spline(&mut self, code: u32, block: &MotionBlock) -> Result<(), ProgramError> {
        if self.radius.refuses_cycles().is_some() {
            return Err(self.refuse(
                "a spline cannot be run while cutter radius compensation is on, or before the first move behind G40",
                "write G40 and a move before it",
            ));
        }
        if block.motion.is_none() && code != 52 {
            return Err(self.refuse(
                "a spline goes on without its code: LinuxCNC wants G5 and G5.1 in each block",
                "write the code into the block",
            ));
        }
        self.add_rest(&block.before)?;
        let state = self.state();
        if state.plane_axes() != [0, 1, 2] {
            return Err(self.refuse("a spline outside the plane XY", "write G17 before it"));
        }
        if state.feed_mode() == FeedMode::InverseTime {
            return Err(self.refuse(
                "a spline with the feed of inverse time (G93)",
                "write G94 and F before it",
            ));
        }
        let mut place = Place::of(state);
        let [Some(x), Some(y), _] = place.at else {
            return Err(self.refuse(
                "where the tool is before the spline is not known",
                "state X and Y before it, or give the start position",
            ));
        };
        let before = self.spline.take();
        let made = spline(code, block, before, [x, y], place.incremental);
        let made = made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        for end in made.ends {
            if let Some(text) = place.go("G1", [Some(end[0]), Some(end[1]), None]) {
                self.add(text.as_bytes())?;
            }
        }
        self.spline = made.next;
        if code == 53 {
            // No motion is in force after a NURBS.
            self.add(b"G80")?;
        }
        self.add_rest(&block.after)
    }

    /// Ends the spline when another motion begins.
    pub fn leave_spline(&mut self) -> Result<(), ProgramError> {
        match self.spline.take() {
            Some(Spline::Open { .. }) => Err(self.refuse(
                "the NURBS before it is not ended: its control points would be lost",
                "write G5.3 behind its last control point",
            )),
            _ => Ok(()),
        }
    }
}

/// G33.1: a rigid tap, as a feed to its end with the pitch times the speed, and back with the spindle reversed.
///
/// That is how G84 is written; the tool must float in its holder, which a warning says. LinuxCNC ties the feed to the spindle
/// (`docs/src/gcode/g-code.adoc`, G33.1) and makes one canonical call of it, `rigid_tap`: to the end and back.
impl Runner<'_> {
    /// A block with G33.1.
    pub fn rigid_tap(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        if self.radius.refuses_cycles().is_some() {
            return Err(self.refuse(
                "a thread cannot be tapped while cutter radius compensation is on, or before the first move behind G40",
                "write G40 and a move before it",
            ));
        }
        self.add_rest(&block.before)?;
        let state = self.state();
        let spindle = state.spindle();
        let [own, other] = match spindle.rotation {
            SpindleRotation::Clockwise => ["M3", "M4"],
            SpindleRotation::CounterClockwise => ["M4", "M3"],
            SpindleRotation::Stopped => {
                return Err(self.refuse(
                    "G33.1 needs a spindle that turns",
                    "write M3 or M4 before it",
                ));
            }
        };
        let pitch = block
            .value(b'K')
            .filter(|pitch| *pitch > 0.0)
            .ok_or_else(|| {
                self.refuse(
                    "G33.1 has no pitch above zero (K)",
                    "write K, the way in a turn",
                )
            })?;
        let speed = spindle
            .speed
            .filter(|_| spindle.mode == SpeedMode::Constant);
        let feed = match (state.feed_mode(), speed) {
            (FeedMode::PerRevolution, _) => pitch,
            (FeedMode::PerMinute, Some(speed)) if speed > 0.0 => pitch * speed,
            _ => {
                return Err(self.refuse(
                    "the feed of G33.1 is its pitch times the speed of the spindle, which is not known here",
                    "write S in turns a minute (G97), and G94 or G95, before it",
                ));
            }
        };
        let faster = block
            .value(b'I')
            .map_or(1.0, |scale| if scale > 1.0 { scale } else { 1.0 });
        let before = state.feed_in_units();
        let mut place = Place::of(state);
        let start = place.at;
        let mut end = start;
        for (axis, letter) in (0..).zip(*b"XYZ") {
            let Some(word) = block.value(letter) else {
                continue;
            };
            end[axis] = match (place.incremental, start[axis]) {
                (_, None) => {
                    return Err(self.refuse(
                        "where the tool is before G33.1 is not known",
                        "state X, Y and Z before it, or give the start position",
                    ));
                }
                (true, Some(at)) => Some(at + word),
                (false, _) => Some(word),
            };
        }
        let there = place.go("G1", end);
        let back = place.go("G1", start);
        let (Some(there), Some(back)) = (there, back) else {
            return Err(self.refuse("G33.1 goes nowhere", "write the end of the thread"));
        };
        let fed = |scale: f64| format!(" F{}", number(feed * scale));
        let mut texts = vec![there + &fed(1.0), "M5".to_owned(), other.to_owned()];
        texts.push(back + &fed(faster));
        texts.extend(["M5".to_owned(), own.to_owned()]);
        texts.extend(before.map(|feed| format!("F{}", number(feed))));
        // LinuxCNC takes no bare places behind it.
        texts.push("G80".to_owned());
        for text in texts {
            self.add(text.as_bytes())?;
        }
        self.no_feed |= before.is_none();
        self.flat.warn("a thread is tapped here (G33.1) by a feed and a reversed spindle, as G84 does it: the tool must float in its holder");
        self.add_rest(&block.after)
    }
}
