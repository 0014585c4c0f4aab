//! Stands between the blocks that a program runs and the compensation of the tool's radius.

use std::borrow::Cow;

use nalgebra::Vector3;

use crate::expanding::coordinates::{Block, Map, Switch};
use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Programmed, ProgrammedShape};
use crate::expanding::radius::geometry::{Axes, in_plane};
use crate::expanding::radius::pending::Shape;
use crate::expanding::radius::stage::Radius;
use crate::expanding::radius::words::{Motion, divided, no_motion, other_side};
use crate::expanding::translate::{MotionBlock, Polar};
use crate::expanding::{Dialect, Origin, Trouble, Wrong, wrong};
use crate::path::curve::Curve;
use crate::path::moves::{Move, MoveKind};
use crate::reading::interpreting::Interpreter;
use crate::reading::options::Units;
use crate::text::lex::{Spanned, Token, tokens_of};

/// Codes that mean places of the machine, or change what the places rest on, in tenths.
const REFUSED: &[u32] = &[
    100, 170, 180, 190, 280, 281, 300, 301, 382, 383, 384, 385, 530, 920, 921, 922, 923,
];

/// Coordinates as the program has them now.
#[derive(Default)]
pub(crate) struct Coordinates<'o> {
    map: Map,
    /// The blocks as programmed, where these are others than the flat ones.
    programmed: Option<Flat<'o>>,
    /// Axes that the next motion must state.
    to_state: [bool; 3],
    /// The code of motion of the program, where the flat one has another in force: behind mirrored arcs, say, or G80 of Fanuc. Whatever
    /// ends coordinates (G50, G50.1, G69) is in another group, and leaves it as it is.
    code_due: Option<&'static str>,
}

impl<'o> Coordinates<'o> {
    /// The run that knows the modes and the programmed places.
    pub fn interpreter(&self) -> Option<&Interpreter<'o>> {
        self.programmed.as_ref().map(|flat| &flat.interpreter)
    }

    /// Reason for which canned cycles cannot be run; `None` if they can.
    pub fn refuses_cycles(&self) -> Option<Wrong> {
        match (self.map.scale, self.to_state) {
            (Some(_), _) => Some((
                "a canned cycle in scaled or mirrored coordinates: which of its words are scaled depends on the controller".to_owned(),
                "write G50 before it, or the holes as moves",
            )),
            (None, to_state) if to_state != [false; 3] => Some((
                "a canned cycle is the first motion in turned coordinates".to_owned(),
                "move to its first hole with G0 before it",
            )),
            _ => None,
        }
    }

    /// A block of plain words, behind all blocks so far.
    pub fn block(
        &mut self,
        text: &[u8],
        origin: Origin,
        radius: &mut Radius<'o>,
        flat: &mut Flat<'o>,
        dialect: Dialect,
    ) -> Result<(), Trouble> {
        // LinuxCNC has none of these words.
        if dialect == Dialect::LinuxCnc {
            return radius.block(text, origin, flat);
        }
        let may_switch = text.contains(&b'5') || text.contains(&b'6');
        if self.programmed.is_none() && !may_switch && self.code_due.is_none() {
            return radius.block(text, origin, flat);
        }
        let block = Block::of(text)?;
        if let Some(switch) = block.switch {
            return self.switch(switch, origin, radius, flat);
        }
        let mut map = self.map;
        map.take_away(block.ends)?;
        map.turn = map.turn.filter(|_| !block.ends_turn);
        if map != self.map {
            refuse_contour(radius)?;
            let ended = |axis: usize| map.scale.is_none_or(|(_, factors)| factors[axis] == 1.0);
            if map.turn.is_none() {
                self.to_state = [0, 1, 2].map(|axis| self.to_state[axis] && !ended(axis));
            }
            self.become_(map, origin, radius, flat)?;
        }
        let rest = self.with_code_due(block.rest.trim_ascii_end());
        match (rest.as_ref(), &mut self.programmed) {
            ([], _) => Ok(()),
            (rest, None) => radius.block(rest, origin, flat),
            (rest, Some(_)) => {
                let refused = |code: &&u32| {
                    REFUSED.contains(code)
                        || matches!(**code, 540..=593 | 1540) && !self.map.only_shifts()
                };
                if let Some(code) = block.codes.iter().find(refused) {
                    return wrong(
                        format!(
                            "G{} in coordinates that are shifted, scaled or turned",
                            f64::from(*code) / 10.0
                        ),
                        "write G69, G50 or G52 X0 Y0 Z0 before it",
                    );
                }
                self.run(rest, origin, radius, flat)
            }
        }
    }

    /// A block with the code of motion that the program has in force, where it counts on it and the flat program has another.
    fn with_code_due<'b>(&mut self, text: &'b [u8]) -> Cow<'b, [u8]> {
        let Some(code) = self.code_due else {
            return Cow::Borrowed(text);
        };
        let block = MotionBlock::of(text, Polar::default());
        let has_centre = b"IJKR".iter().any(|letter| block.value(*letter).is_some());
        let moves = block.has_place() || block.has_other_axis() || has_centre;
        if block.motion.is_some_and(|code| code != 800) {
            self.code_due = None;
        } else if moves && !block.wants_axes {
            self.code_due = None;
            let mut tokens: Vec<Spanned> = Vec::new();
            tokens_of(text, &mut tokens);
            // The code goes after the block number.
            let is_head = |one: &&Spanned| {
                let number = matches!(one.token, Token::Word { letter: b'N', .. });
                number || matches!(one.token, Token::Other(b'/') | Token::Blank)
            };
            let at = tokens.iter().take_while(is_head).last();
            let (head, rest) = text.split_at(at.map_or(0, |one| one.span.end));
            return Cow::Owned([head, code.as_bytes(), b" ", rest].concat());
        }
        Cow::Borrowed(text)
    }

    /// The next move without a code is of this one.
    pub fn owe(&mut self, code: Option<&'static str>) {
        self.code_due = code;
    }

    /// The coordinates are others from here on.
    fn become_(
        &mut self,
        map: Map,
        origin: Origin,
        radius: &mut Radius<'o>,
        flat: &mut Flat<'o>,
    ) -> Result<(), Trouble> {
        self.map = map;
        if map.is_nothing() {
            let code = self
                .programmed
                .take()
                .map(|run| run.interpreter.motion_code());
            self.to_state = [false; 3];
            match code.filter(|code| *code != flat.interpreter.motion_code()) {
                None => {}
                Some(None) => return radius.block(b"G80", origin, flat),
                Some(code) => self.code_due = code,
            }
            return Ok(());
        }
        let mut run = match self.programmed.take() {
            Some(run) => run,
            None => flat.following(),
        };
        let places = [0, 1, 2].map(|axis| flat.interpreter.place_mm(axis));
        let [Some(x), Some(y), Some(z)] = places else {
            return wrong(
                "where the tool is before the coordinates change is not known",
                "state X, Y and Z with G0 before it, or give the start position",
            );
        };
        run.interpreter
            .stand_at(map.programmed(Vector3::new(x, y, z)));
        self.programmed = Some(run);
        Ok(())
    }

    fn switch(
        &mut self,
        switch: Switch,
        origin: Origin,
        radius: &mut Radius<'o>,
        flat: &mut Flat<'o>,
    ) -> Result<(), Trouble> {
        refuse_contour(radius)?;
        let state = self.interpreter().unwrap_or(&flat.interpreter);
        let Some(unit) = state.units().map(Units::mm_per_unit) else {
            return wrong(
                "the units are not named before the coordinates change",
                "write G21 or G20 before it",
            );
        };
        let axes = state.plane_axes();
        let origin_mm = state.origin_mm() + self.map.shift;
        // Centres are places of the program.
        let place = |axis: usize, word: f64| origin_mm[axis] + word * unit;
        let here = [0, 1, 2].map(|axis| flat.interpreter.place_mm(axis));
        let mut map = self.map;
        let mut to_state = self.to_state;
        match switch {
            Switch::Shift(words) => {
                if !map.only_shifts() {
                    return wrong(
                        "G52 in coordinates that are scaled or turned",
                        "write G69 or G50 before it",
                    );
                }
                for axis in 0..3 {
                    map.shift[axis] = words[axis].map_or(map.shift[axis], |word| word * unit);
                }
            }
            Switch::Scale(..) | Switch::Mirror(_) if map.scale.is_some() || map.turn.is_some() => {
                return wrong(
                    "G51 or G51.1 in coordinates that are scaled, mirrored or turned already",
                    "write G50, G50.1 or G69 before it",
                );
            }
            Switch::Scale(centre, factors) => {
                let mut about = Vector3::zeros();
                for axis in 0..3 {
                    about[axis] = match (centre[axis], here[axis]) {
                        (Some(word), _) => place(axis, word),
                        (None, Some(here)) if factors[axis] != 1.0 => here,
                        _ => 0.0,
                    };
                    to_state[axis] |= factors[axis] != 1.0;
                }
                map.scale = Some((about, Vector3::from(factors)));
            }
            Switch::Mirror(mirrors) => {
                let (mut about, mut factors) = (Vector3::zeros(), Vector3::repeat(1.0));
                for axis in 0..3 {
                    if let Some(word) = mirrors[axis] {
                        (about[axis], factors[axis], to_state[axis]) =
                            (place(axis, word), -1.0, true);
                    }
                }
                map.scale = Some((about, factors));
                map.is_mirror = true;
            }
            Switch::Turn(..) if map.turn.is_some() => {
                return wrong(
                    "G68 in coordinates that are turned already",
                    "write G69 before it",
                );
            }
            Switch::Turn(..) if state.is_incremental() => {
                return wrong(
                    "G68 with G91 turns by R to some controllers, and adds it to the angle before to others",
                    "write G90 before it",
                );
            }
            Switch::Turn(centre, angle) => {
                let [Some(a), Some(b)] =
                    [axes[0], axes[1]].map(|axis| Some(place(axis, centre[axis]?)))
                else {
                    return wrong(
                        "G68 without its centre turns about the tool's place to some controllers, about zero to others",
                        "write both axes of the plane",
                    );
                };
                if centre[axes[2]].is_some() {
                    return wrong(
                        "G68 with three axes tilts the plane",
                        "write the two axes of the plane and R",
                    );
                }
                let angle = match (map.turns_over(axes), map.is_mirror) {
                    (false, _) => angle,
                    // Fanuc turns the other way in the mirror.
                    (true, true) => -angle,
                    (true, false) => {
                        return wrong(
                            "G68 in coordinates that G51 mirrors with a negative factor: which way it turns depends on the controller",
                            "mirror with G51.1",
                        );
                    }
                };
                let mut at = Vector3::zeros();
                (at[axes[0]], at[axes[1]]) = (a, b);
                // A centre in scaled coordinates is scaled.
                let scaled = Map {
                    shift: Vector3::zeros(),
                    turn: None,
                    ..map
                };
                map.turn = Some((axes, in_plane(&scaled.place(at), axes), angle.to_radians()));
                (to_state[axes[0]], to_state[axes[1]]) = (true, true);
            }
        }
        self.to_state = to_state;
        self.become_(map, origin, radius, flat)
    }

    /// A block in other coordinates than the machine's.
    fn run(
        &mut self,
        text: &[u8],
        origin: Origin,
        radius: &mut Radius<'o>,
        flat: &mut Flat<'o>,
    ) -> Result<(), Trouble> {
        let Some(programmed) = self.programmed.as_mut() else {
            return radius.block(text, origin, flat);
        };
        let turned_over = self.map.turns_over(programmed.interpreter.plane_axes());
        let text = &match turned_over {
            true => other_side(text),
            false => text.to_vec(),
        };
        let (switch, rest) = divided(text)?;
        let Some(motion) = Motion::of(&rest, &programmed.interpreter) else {
            if !rest.trim_ascii().is_empty() {
                programmed.add(&rest, origin)?;
            }
            return radius.block(text, origin, flat);
        };
        if !switch.is_empty() {
            radius.block(&switch, origin, flat)?;
        }
        if !motion.before.is_empty() {
            radius.block(&motion.before, origin, flat)?;
        }
        let stated = motion.states();
        let made = motion.run(origin, programmed)?.ok_or_else(no_motion)?;
        if !made.extra.is_empty() {
            return wrong(
                "an axis other than X, Y, Z moves in coordinates that are shifted, scaled or turned",
                "move it before G68, G51 and G52, or behind their end",
            );
        }
        let state = &programmed.interpreter;
        let axes = state.plane_axes();
        if self.to_state != [false; 3] {
            self.to_state = first_motion(self.to_state, stated, state.is_incremental(), axes)?;
        }
        let shape = shape(&self.map, &made, axes)?;
        let to = self.map.place(made.end);
        let after = motion.after.clone();
        let mut dress = motion.dress(&made, axes, origin);
        dress.depth = dress.depth.map(|_| to[axes[2]]);
        let piece = dress.last(shape, in_plane(&to, axes));
        // The words are those of the run that the machine's own coordinates have.
        if let Some(text) = piece.text(radius.interpreter(flat))? {
            radius.block(&text, origin, flat)?;
        }
        if !after.is_empty() {
            programmed.add(&after, origin)?;
            radius.block(&after, origin, flat)?;
        }
        Ok(())
    }
}

fn refuse_contour(radius: &Radius<'_>) -> Result<(), Trouble> {
    match radius.refuses_cycles() {
        Some(_) => wrong(
            "coordinates are shifted, scaled or turned while cutter radius compensation is on, or before the first move behind G40",
            "write G40 and a move before it",
        ),
        None => Ok(()),
    }
}

/// The first motion in other coordinates states its place by all axes that they change: which place an axis has that is not
/// named depends on the controller.
fn first_motion(
    to_state: [bool; 3],
    stated: [bool; 3],
    incremental: bool,
    axes: Axes,
) -> Result<[bool; 3], Trouble> {
    let plane = [axes[0], axes[1]];
    let moves_in_plane = plane.iter().any(|axis| stated[*axis]);
    let missing = plane.iter().any(|axis| to_state[*axis] && !stated[*axis]);
    let any = (0..3).any(|axis| to_state[axis] && stated[axis]);
    if any && incremental || moves_in_plane && missing {
        return wrong(
            "the first motion in scaled or turned coordinates does not state its place",
            "write G90 and all axes that are scaled or turned",
        );
    }
    Ok([0, 1, 2].map(|axis| to_state[axis] && !stated[axis]))
}

fn shape(map: &Map, made: &Move, axes: Axes) -> Result<Shape, Trouble> {
    if made.curve == Curve::Line {
        return Ok(Shape::Straight(match made.kind {
            MoveKind::Rapid => "G0",
            MoveKind::Feed => "G1",
        }));
    }
    match Programmed::of(made, axes)?.shape {
        ProgrammedShape::Straight(code) => Ok(Shape::Straight(code)),
        ProgrammedShape::Arc(arc) => {
            let Some(sense) = map.sense(arc.sense, axes) else {
                return wrong(
                    "an arc whose axes are scaled differently is no arc any more",
                    "write the same factor for both axes of the plane",
                );
            };
            if arc.sweep > std::f64::consts::TAU + 1e-9 {
                return wrong(
                    "an arc of more than one turn in scaled or turned coordinates",
                    "write each turn as a block",
                );
            }
            let mut centre = made.end;
            (centre[axes[0]], centre[axes[1]]) = (arc.centre.x, arc.centre.y);
            let centre = in_plane(&map.place(centre), axes);
            Ok(Shape::Arc { centre, sense })
        }
    }
}
