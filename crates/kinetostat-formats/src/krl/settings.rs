//! What statements put in force: `$BASE=`, `$VEL.CP=`, `$APO=`, `FDAT_ACT=`, `BAS(#CP_PARAMS,0.2)`, `WITH $TOOL=STOOL2(FP1)`.

use std::ops::Range;

use crate::krl::aggregate::{aggregate_of, number_of};
use crate::krl::lex::TokenFile;
use crate::krl::moving_settings::{EXTERNAL_TOOL, TAKE_OUT, moves_no_points};
use crate::krl::role::Role;
use crate::krl::state::{Settings, Slot, State, Thing, Things};
use crate::krl::turning::{
    auxiliary_turn, data_turn_as_followed, keeps_its_orientation, turns_as_followed,
};
use crate::krl::values::{Reason, Values};
use crate::model::motion::Speed;

/// What a line sets.
pub(crate) struct Setter<'s, 'p> {
    pub values: &'s Values<'p>,
    pub settings: &'s mut Settings,
    pub routine: usize,
}

/// The parts of $APO.
const ROUNDINGS: [(&str, Thing); 3] = [
    ("CDIS", Thing::Distance),
    ("CPTP", Thing::Percent),
    ("CVEL", Thing::VelocityPercent),
];

/// What an assignment to a name may change.
pub(crate) fn touched(file: &TokenFile<'_>, at: usize) -> Things {
    let Some(name) = file.name(at) else {
        return Things::default();
    };
    let one = |thing: Thing| Things::of(&[thing]);
    match name.letters() {
        b"$BASE" => one(Thing::Base),
        b"$TOOL" => one(Thing::Tool),
        b"$VEL" => one(Thing::Speed),
        b"$APO" => Things::of(&[Thing::Distance, Thing::Percent, Thing::VelocityPercent]),
        b"FDAT_ACT" => one(Thing::PointData),
        b"LDAT_ACT" => Things::of(&[Thing::LinearData, Thing::Orientation]),
        b"$ORI_TYPE" => one(Thing::Orientation),
        b"PDAT_ACT" => one(Thing::JointData),
        _ => Things::default(),
    }
}

/// What BAS may change.
pub(crate) const BAS: [Thing; 6] = [
    Thing::Base,
    Thing::Tool,
    Thing::Speed,
    Thing::Distance,
    Thing::Percent,
    Thing::VelocityPercent,
];

impl Setter<'_, '_> {
    fn number(&mut self, value: Option<f64>) -> Slot {
        value.map_or(Slot::Unknown, |value| self.settings.numbers.slot(value))
    }

    fn speed(&mut self, metres_per_s: Option<f64>, text: String) -> Slot {
        let mm_per_s = metres_per_s.map(|speed| 1000.0 * speed);
        // Equal speeds are one, however they are written.
        let key = mm_per_s.map_or_else(|| text.clone(), |speed| format!("{speed:?}"));
        self.settings.speeds.slot_of(key, Speed { mm_per_s, text })
    }

    /// `name = value`, of tokens, with the place of the sign.
    pub(crate) fn assign(
        &mut self,
        tokens: &Range<usize>,
        equals: usize,
        state: &mut State,
    ) -> Result<(), Reason> {
        let file = self.values.file(self.routine);
        let Some(name) = file.name(tokens.start) else {
            return Ok(());
        };
        let value = equals + 1..tokens.end;
        let whole = equals == tokens.start + 1;
        let part = (!whole && file.is(tokens.start + 1, b'.'))
            .then(|| file.name(tokens.start + 2))
            .flatten();
        let called = file
            .name(value.start)
            .filter(|_| file.is(value.start + 1, b'('));
        let argument = value.start + 2..tokens.end.saturating_sub(1).max(value.start);
        match name.letters() {
            b"$BASE" | b"$TOOL" => {
                let (role, thing) = match name.is("$BASE") {
                    true => (Role::Base, Thing::Base),
                    false => (Role::Tool, Thing::Tool),
                };
                let slot = match (whole, called) {
                    (false, _) => Slot::Unknown,
                    (true, Some(_)) => self.of_point(role, &argument)?,
                    (true, None) => {
                        let frame = self
                            .values
                            .frame(self.routine, &value, &self.settings.given);
                        self.settings.frames.slot(frame)
                    }
                };
                state.set(thing, slot);
            }
            b"$VEL" => {
                let metres_per_s = match (called, part) {
                    (Some(_), _) => {
                        let end = file.find(argument.clone(), b',').unwrap_or(argument.end);
                        self.values.number(self.routine, &(argument.start..end))
                    }
                    (None, Some(part)) if part.is("CP") => self.values.number(self.routine, &value),
                    (None, Some(_)) => return Ok(()),
                    (None, None) => {
                        aggregate_of(file, &value).and_then(|all| all.number(file, "CP"))
                    }
                };
                let slot = self.speed(metres_per_s, file.text(tokens));
                state.set(Thing::Speed, slot);
            }
            b"$APO" => self.rounding(
                &value,
                part.map(|part| part.letters().to_vec()),
                called.is_some(),
                state,
            ),
            b"$IPO_MODE" if called.is_some() => self.mode_of_point(&argument)?,
            b"$ORI_TYPE" | b"$CIRC_TYPE" => {
                let kept = turns_as_followed(self.values, self.routine, (&name, tokens, &value))?;
                if name.is("$ORI_TYPE") {
                    self.orientation(kept, state);
                }
            }
            b"$SINGUL_STRATEGY" => {
                keeps_its_orientation(self.values.number(self.routine, &value))?;
            }
            b"FDAT_ACT" => {
                let point = self.values.point_data(self.routine, &value);
                let slot = point.map_or(Slot::Unknown, |point| self.settings.points.slot(point));
                state.set(Thing::PointData, slot);
            }
            b"LDAT_ACT" | b"PDAT_ACT" => {
                let distance = self.values.member(self.routine, &value, "APO_DIST");
                let slot = self.number(distance);
                let thing = match name.is("LDAT_ACT") {
                    true => Thing::LinearData,
                    false => Thing::JointData,
                };
                state.set(thing, slot);
                let kept = if thing == Thing::LinearData && whole {
                    data_turn_as_followed(self.values, self.routine, (tokens, &value))?
                } else if thing == Thing::LinearData
                    && part.is_some_and(|part| part.is("ORI_TYP") || part.is("CIRC_TYP"))
                {
                    turns_as_followed(self.values, self.routine, (&name, tokens, &value))?
                } else {
                    false
                };
                // Other data do not take it back before BAS puts them in force.
                if kept {
                    self.orientation(true, state);
                }
            }
            b"$CIRC_MODE" => {
                let of_data = called.and_then(|_| {
                    let stated = self.values.choice(self.routine, &argument, "CIRC_MODE");
                    stated.ok().flatten()
                });
                auxiliary_turn(&file.text(tokens), of_data.as_deref())?;
            }
            _ => moves_no_points(file, (&name, tokens, &value))?,
        }
        Ok(())
    }

    fn orientation(&mut self, kept: bool, state: &mut State) {
        self.settings.may_keep_orientation |= kept;
        let slot = self.number(Some(f64::from(u8::from(kept))));
        state.set(Thing::Orientation, slot);
    }

    /// `$IPO_MODE=SIPO_MODE(FP1.IPO_FRAME)`.
    fn mode_of_point(&self, argument: &Range<usize>) -> Result<(), Reason> {
        let file = self.values.file(self.routine);
        let end = file.find(argument.clone(), b'.').unwrap_or(argument.end);
        let point = self.values.point_data(self.routine, &(argument.start..end));
        match point.is_some_and(|point| point.is_external) {
            true => Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT)),
            false => Ok(()),
        }
    }

    /// `$APO.CDIS=3`, `$APO={CDIS 3}`, `$APO=SAPO(LCPDAT1)`.
    fn rounding(
        &mut self,
        value: &Range<usize>,
        part: Option<Vec<u8>>,
        is_call: bool,
        state: &mut State,
    ) {
        let file = self.values.file(self.routine);
        for (name, thing) in ROUNDINGS {
            let stated = match &part {
                Some(part) if part != name.as_bytes() => continue,
                Some(_) => self.values.number(self.routine, value),
                None if is_call => {
                    let argument =
                        value.start + 2..value.end.saturating_sub(1).max(value.start + 2);
                    self.values.member(self.routine, &argument, "APO_DIST")
                }
                None => aggregate_of(file, value).and_then(|all| all.number(file, name)),
            };
            let slot = self.number(stated);
            state.set(thing, slot);
        }
    }

    /// The frame of a point's data: `STOOL2(FP1)`, `SBASE(FP1.BASE_NO)`.
    fn of_point(&mut self, role: Role, argument: &Range<usize>) -> Result<Slot, Reason> {
        let file = self.values.file(self.routine);
        let end = file.find(argument.clone(), b'.').unwrap_or(argument.end);
        let point = self.values.point_data(self.routine, &(argument.start..end));
        let Some(point) = point else {
            let number = self.values.number(self.routine, argument);
            return Ok(number.map_or(Slot::Unknown, |number| self.numbered(role, number as u32)));
        };
        if point.is_external {
            return Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT));
        }
        let number = match role {
            Role::Tool => point.tool,
            Role::Base => point.base,
        };
        Ok(number.map_or(Slot::Unknown, |number| self.numbered(role, number)))
    }

    fn numbered(&mut self, role: Role, number: u32) -> Slot {
        let frame = self.values.numbered(role, number, &self.settings.given);
        self.settings.frames.slot(frame)
    }

    /// `BAS(#COMMAND,value)`: tokens of the whole call.
    pub(crate) fn bas(&mut self, tokens: &Range<usize>, state: &mut State) -> Result<(), Reason> {
        let file = self.values.file(self.routine);
        let command = tokens.start + 3;
        let is_command = file.is(tokens.start + 1, b'(') && file.is(tokens.start + 2, b'#');
        let command = is_command.then(|| file.name(command)).flatten();
        let comma = file.find(tokens.start + 2..tokens.end, b',');
        let close = file
            .find(tokens.start + 2..tokens.end, b')')
            .unwrap_or(tokens.end);
        let value = comma.map_or(close..close, |comma| comma + 1..close);
        let text = || file.text(tokens);
        let Some(command) = command else {
            *state = state.without(Things::of(&BAS));
            return Ok(());
        };
        match command.letters() {
            b"CP_PARAMS" | b"PTP_PARAMS" | b"FRAMES" => {
                self.frames_of_point(state)?;
                if command.is("CP_PARAMS") {
                    let speed = self.values.number(self.routine, &value);
                    let slot = self.speed(speed, text());
                    state.set(Thing::Speed, slot);
                    state.set(Thing::Distance, state.get(Thing::LinearData));
                } else if command.is("PTP_PARAMS") {
                    state.set(Thing::Percent, state.get(Thing::JointData));
                }
            }
            b"TOOL" | b"BASE" => {
                let (role, thing) = match command.is("TOOL") {
                    true => (Role::Tool, Thing::Tool),
                    false => (Role::Base, Thing::Base),
                };
                let slot = match number_of(file, &value).filter(|number| *number >= 0.0) {
                    Some(number) => self.numbered(role, number as u32),
                    None if value.is_empty() => Slot::Unknown,
                    None => {
                        let frame = self.values.computed(role, &file.text(&value));
                        self.settings.frames.slot(frame)
                    }
                };
                state.set(thing, slot);
            }
            b"VEL_CP" => {
                let speed = self.values.number(self.routine, &value);
                let slot = self.speed(speed, text());
                state.set(Thing::Speed, slot);
            }
            b"CP_DAT" => {
                state.set(Thing::Speed, Slot::Unknown);
                state.set(Thing::Distance, state.get(Thing::LinearData));
            }
            b"PTP_DAT" => state.set(Thing::Percent, state.get(Thing::JointData)),
            b"VEL_PTP" | b"ACC_CP" | b"ACC_PTP" | b"OUT_SYNC" | b"OUT_ASYNC" | b"GROUP" => {}
            _ => {
                *state = state.without(Things::of(&BAS));
                if command.is("INITMOV") {
                    self.orientation(false, state);
                }
            }
        }
        Ok(())
    }

    fn frames_of_point(&mut self, state: &mut State) -> Result<(), Reason> {
        let point = self
            .settings
            .points
            .get(state.get(Thing::PointData))
            .copied();
        if point.is_some_and(|point| point.is_external) {
            return Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT));
        }
        let tool = point.and_then(|point| point.tool);
        let base = point.and_then(|point| point.base);
        let tool = tool.map_or(Slot::Unknown, |number| self.numbered(Role::Tool, number));
        let base = base.map_or(Slot::Unknown, |number| self.numbered(Role::Base, number));
        state.set(Thing::Tool, tool);
        state.set(Thing::Base, base);
        Ok(())
    }
}
