//! Statements that put something in force: `$BASE=`, `$VEL.CP=`, `$APO=`, `FDAT_ACT=`, `BAS(#CP_PARAMS,0.2)`; those that move the tool on its
//! points are refused.

use std::ops::Range;

use crate::error::excerpt;
use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::Reason;
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::{Datum, Value};
use crate::krl::expression::expression_of;
use crate::krl::state::{PointData, Role, Run, auxiliary_turn, choice_of, keeps_its_orientation};
use crate::model::motion::{FrameUse, Speed};
use crate::text::Name;

/// Names of what is in force: an assignment to one changes how motions run.
const IN_FORCE: [&str; 15] = [
    "$BASE",
    "$TOOL",
    "$VEL",
    "$APO",
    "FDAT_ACT",
    "LDAT_ACT",
    "PDAT_ACT",
    "$ORI_TYPE",
    "$CIRC_TYPE",
    "$CIRC_MODE",
    "$IPO_MODE",
    "$SINGUL_STRATEGY",
    "$EX_AX_IGNORE",
    "$TECH",
    "$ROBROOT",
];

/// True for a name of what is in force.
pub(super) fn is_in_force(name: &Name) -> bool {
    IN_FORCE.iter().any(|own| name.is(own))
}

impl Run<'_, '_> {
    /// Puts in force what an assignment sets, if it sets something.
    pub(super) fn set(&mut self, tokens: &Range<usize>, equals: usize) -> Result<(), Reason> {
        let file = self.file();
        let Some(name) = file.name(tokens.start) else {
            return Ok(());
        };
        let left = tokens.start..equals;
        if is_in_force(&name) && expression_of(file, left).node == Node::Unreadable {
            let what = excerpt(file.text(&(tokens.start..equals)).as_bytes());
            let reason = format!("`{what}` is no variable");
            return Err((reason, "write the variable alone before the sign `=`"));
        }
        let value = expression_of(file, equals + 1..tokens.end);
        let is_whole = equals == tokens.start + 1;
        let part = (!is_whole && file.is(tokens.start + 1, b'.'))
            .then(|| file.name(tokens.start + 2))
            .flatten();
        let called = match &value.node {
            Node::Call(..) => Some(first_argument(file, &value)),
            _ => None,
        };
        match name.letters() {
            b"$BASE" | b"$TOOL" => {
                let role = match name.is("$BASE") {
                    true => Role::Base,
                    false => Role::Tool,
                };
                let is_of_point = file.is_word(value.tokens.start, "STOOL2")
                    || file.is_word(value.tokens.start, "SBASE");
                let frame = match (is_whole, called) {
                    (false, _) => None,
                    (true, Some(argument)) if is_of_point => self.of_point(role, &argument)?,
                    (true, _) => Some(self.frame(&value)),
                };
                match role {
                    Role::Base => self.own.force.base = frame,
                    Role::Tool => self.own.force.tool = frame,
                }
            }
            b"$VEL" => {
                let metres_per_s = match (called, part) {
                    (Some(argument), _) => self.value(&argument).as_number(),
                    (None, Some(part)) if part.is("CP") => self.value(&value).as_number(),
                    (None, Some(_)) => return Ok(()),
                    (None, None) => {
                        let value = self.value(&value);
                        value.member("CP").and_then(Datum::as_number)
                    }
                };
                self.set_speed(metres_per_s, file.text(tokens));
            }
            b"$APO" => self.set_rounding(&value, part, called),
            b"$IPO_MODE" if called.is_some() => {
                let point = called.and_then(|argument| self.point_of(&argument));
                if point.is_some_and(|point| point.is_external) {
                    return Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT));
                }
            }
            b"$ORI_TYPE" => {
                let kept = self.turns_as_followed("ORI_TYP", tokens, &value)?;
                self.own.force.keeps_orientation = kept;
            }
            b"$CIRC_TYPE" => {
                self.turns_as_followed("CIRC_TYP", tokens, &value)?;
            }
            b"$SINGUL_STRATEGY" => keeps_its_orientation(self.value(&value).as_number())?,
            b"FDAT_ACT" => self.own.force.point = self.point_data(&value),
            b"LDAT_ACT" | b"PDAT_ACT" => {
                let data = self.value(&value);
                let distance = data.member("APO_DIST").and_then(Datum::as_number);
                if name.is("PDAT_ACT") {
                    self.own.force.joint = distance;
                    return Ok(());
                }
                self.own.force.linear_mm = distance;
                let kept = match part {
                    None if is_whole => self.data_turn_as_followed(tokens, &data)?,
                    Some(part) if part.is("ORI_TYP") => {
                        self.turns_as_followed("ORI_TYP", tokens, &value)?
                    }
                    Some(part) if part.is("CIRC_TYP") => {
                        self.turns_as_followed("CIRC_TYP", tokens, &value)?
                    }
                    _ => false,
                };
                // Other data do not take it back before BAS puts them in force.
                self.own.force.keeps_orientation |= kept;
            }
            b"$CIRC_MODE" => {
                let of_data = called.and_then(|argument| {
                    let data = self.value(&argument);
                    choice_of(&data, "CIRC_MODE")
                });
                auxiliary_turn(&file.text(tokens), of_data.as_deref())?;
            }
            _ => moves_no_points(file, &name, tokens, &value.tokens)?,
        }
        Ok(())
    }

    pub(super) fn set_speed(&mut self, metres_per_s: Option<f64>, text: String) {
        let mm_per_s = metres_per_s.map(|speed| 1000.0 * speed);
        self.own.force.speed = Some(Speed { mm_per_s, text });
    }

    /// `$APO.CDIS=3`, `$APO={CDIS 3}`, `$APO=SAPO(LCPDAT1)`.
    fn set_rounding(&mut self, value: &Expression, part: Option<Name>, called: Option<Expression>) {
        let is_call = called.is_some();
        let data = self.value(called.as_ref().unwrap_or(value));
        let stated = |name: &str| match (&part, is_call) {
            (Some(_), _) => data.as_number(),
            (None, true) => data.member("APO_DIST").and_then(Datum::as_number),
            (None, false) => data.member(name).and_then(Datum::as_number),
        };
        let is_set = |name: &str| part.is_none_or(|part| part.is(name));
        let force = &mut self.own.force;
        for (name, own) in [
            ("CDIS", &mut force.distance_mm),
            ("CPTP", &mut force.joint_percent),
            ("CVEL", &mut force.speed_percent),
        ] {
            if is_set(name) {
                *own = stated(name);
            }
        }
    }

    /// The numbers that data of a point state.
    fn point_data(&mut self, value: &Expression) -> Option<PointData> {
        let data = self.value(value);
        if !matches!(data.value, Value::Members(_)) {
            return None;
        }
        let number = |name: &str| {
            let value = data.member(name)?.as_number()?;
            ((0.0..1e6).contains(&value) && value.fract() == 0.0).then_some(value as u32)
        };
        let mode = choice_of(&data, "IPO_FRAME");
        Some(PointData {
            tool: number("TOOL_NO"),
            base: number("BASE_NO"),
            is_external: mode.is_some_and(|mode| mode == "TCP"),
        })
    }

    /// The data of a point that an argument names, or of which it names a member: `FP1`, `FP1.BASE_NO`.
    fn point_of(&mut self, argument: &Expression) -> Option<PointData> {
        match &argument.node {
            Node::Field(of, _) => self.point_data(of),
            _ => self.point_data(argument),
        }
    }

    /// The frame of a point's data: `STOOL2(FP1)`, `SBASE(FP1.BASE_NO)`.
    fn of_point(&mut self, role: Role, argument: &Expression) -> Result<Option<FrameUse>, Reason> {
        let Some(point) = self.point_of(argument) else {
            let number = self.value(argument).as_number();
            return Ok(number.map(|number| self.numbered(role, number as u32)));
        };
        if point.is_external {
            return Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT));
        }
        let number = match role {
            Role::Tool => point.tool,
            Role::Base => point.base,
        };
        Ok(number.map(|number| self.numbered(role, number)))
    }
}

/// The first argument of a call.
fn first_argument(file: &TokenFile<'_>, call: &Expression) -> Expression {
    let open = call.tokens.start + 2;
    let close = call.tokens.end.saturating_sub(1).max(open);
    let end = file.find(open..close, b',').unwrap_or(close);
    expression_of(file, open..end)
}

// BAS, by which inline forms put in force what their data state: `BAS(#CP_PARAMS,0.2)`.

impl Run<'_, '_> {
    /// `BAS(#COMMAND,value)`: tokens of the whole call.
    pub(super) fn bas(&mut self, tokens: &Range<usize>) -> Result<(), Reason> {
        let file = self.file();
        let is_command = file.is(tokens.start + 1, b'(') && file.is(tokens.start + 2, b'#');
        let command = is_command.then(|| file.name(tokens.start + 3)).flatten();
        let comma = file.find(tokens.start + 2..tokens.end, b',');
        let close = file
            .find(tokens.start + 2..tokens.end, b')')
            .unwrap_or(tokens.end);
        let value = comma.map_or(close..close, |comma| comma + 1..close);
        let number = match value.is_empty() {
            true => None,
            false => self.value(&expression_of(file, value.clone())).as_number(),
        };
        let Some(command) = command else {
            self.own.force.forget();
            return Ok(());
        };
        let linear_mm = self.own.force.linear_mm;
        match command.letters() {
            b"CP_PARAMS" | b"PTP_PARAMS" | b"FRAMES" => {
                self.frames_of_point()?;
                if command.is("CP_PARAMS") {
                    self.set_speed(number, file.text(tokens));
                    self.own.force.distance_mm = linear_mm;
                } else if command.is("PTP_PARAMS") {
                    self.own.force.joint_percent = self.own.force.joint;
                }
            }
            b"TOOL" | b"BASE" => {
                let role = match command.is("TOOL") {
                    true => Role::Tool,
                    false => Role::Base,
                };
                let frame = match number.filter(|number| *number >= 0.0) {
                    Some(number) => Some(self.numbered(role, number as u32)),
                    None if value.is_empty() => None,
                    None => Some(self.computed(role, &file.text(&value))),
                };
                match role {
                    Role::Base => self.own.force.base = frame,
                    Role::Tool => self.own.force.tool = frame,
                }
            }
            b"VEL_CP" => self.set_speed(number, file.text(tokens)),
            b"CP_DAT" => {
                self.own.force.speed = None;
                self.own.force.distance_mm = linear_mm;
            }
            b"PTP_DAT" => self.own.force.joint_percent = self.own.force.joint,
            b"VEL_PTP" | b"ACC_CP" | b"ACC_PTP" | b"OUT_SYNC" | b"OUT_ASYNC" | b"GROUP" => {}
            _ => {
                self.own.force.forget();
                if command.is("INITMOV") {
                    self.own.force.keeps_orientation = false;
                }
            }
        }
        Ok(())
    }

    fn frames_of_point(&mut self) -> Result<(), Reason> {
        let point = self.own.force.point;
        if point.is_some_and(|point| point.is_external) {
            return Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT));
        }
        let tool = point.and_then(|point| point.tool);
        let base = point.and_then(|point| point.base);
        self.own.force.tool = tool.map(|number| self.numbered(Role::Tool, number));
        self.own.force.base = base.map(|number| self.numbered(Role::Base, number));
        Ok(())
    }
}

// Assignments to system variables that move the tool on its points, or apart from them: refused.

/// The tool stands still and the part is in the hand: base and tool change their parts.
pub(crate) const EXTERNAL_TOOL: &str =
    "the tool stands still and the robot holds the part (#TCP), which is not followed";
pub(crate) const TAKE_OUT: &str = "take the motions of such a tool into a program of their own";

/// Frames on which all others stand.
const ROOTS: [&str; 4] = ["$ROBROOT", "$WORLD", "$ERSYSROOT", "$NULLFRAME"];

/// Refuses an assignment of a value to such a variable.
pub(crate) fn moves_no_points(
    file: &TokenFile<'_>,
    name: &Name,
    tokens: &Range<usize>,
    value: &Range<usize>,
) -> Result<(), Reason> {
    let is_watched = |all: &[&str]| all.iter().any(|one| name.is(one));
    if !is_watched(&ROOTS) && !is_watched(&["$IPO_MODE", "$EX_AX_IGNORE", "$TECH"]) {
        return Ok(());
    }
    let shown = || excerpt(file.text(tokens).as_bytes());
    let stated = file.text(value).trim().to_uppercase();
    let says = |word: &str| stated.contains(word);
    if name.is("$IPO_MODE") && !says("#BASE") {
        return match says("#TCP") {
            true => Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT)),
            false => Err((
                format!(
                    "`{}`: whether the robot holds the tool or the part is computed while the program runs",
                    shown()
                ),
                "write $IPO_MODE=#BASE where the robot holds the tool",
            )),
        };
    }
    if is_watched(&ROOTS) {
        return Err((
            format!(
                "`{}`: all points behind it stand elsewhere, which is not followed",
                shown()
            ),
            "leave it as the controller has it, and shift $BASE",
        ));
    }
    if name.is("$EX_AX_IGNORE") && !matches!(stated.as_str(), "0" | "'B0'" | "'B00'" | "'B000000'")
    {
        return Err((
            format!(
                "`{}`: external axes do not go to what the points say",
                shown()
            ),
            "write points with the external axes where they stand",
        ));
    }
    if name.is("$TECH") && !says("#OFF") {
        return Err((
            format!(
                "`{}`: a function of the controller may move the tool beside the program",
                shown()
            ),
            "take the motions with it into a program of their own",
        ));
    }
    Ok(())
}
